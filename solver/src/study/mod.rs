//! Studies: what is asked of a model beyond one Landau point.

pub mod accuracy;
pub mod amplitudes;
pub mod critical;
mod journal;
pub use journal::journal_path;
pub use progress::{Progress, Silent};
pub mod minimise;
pub mod modes;
pub mod orders;
pub mod point;
mod progress;
pub mod quadrature;
mod root;
pub mod row;
pub mod sensitivity;
pub mod shard;
pub mod spectrum;
pub mod sweep;
pub mod verify;

use crate::base::{self, BaseState};
use crate::collocation::Discretisation;
use crate::error::{Error, Result};
use crate::model::Model;
use crate::parameters::Parameters;
use crate::problem::Problem;
use crate::spectrum::EigenPair;
use crate::weakly::{self, LandauPoint, Selection};
use std::sync::Arc;

/// A model with parameters and resolution: what the command line sets up.
#[derive(Clone)]
pub struct Setup<'m> {
    /// The kernels.
    pub model: &'m dyn Model,
    /// Values, and which of them the base state determines.
    pub parameters: Parameters,
    /// M
    pub resolution: usize,
    /// Differentiation matrices, shared by all problems of the study.
    pub discretisation: Arc<Discretisation>,
}

/// A coordinate of a study: the wavenumber or a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// k
    Wavenumber,
    /// A parameter by position.
    Parameter(usize),
}

impl Axis {
    /// `k` or the name of a parameter.
    ///
    /// # Errors
    /// A name that the model does not have.
    pub fn named(model: &dyn Model, name: &str) -> Result<Self> {
        if name == "k" {
            return Ok(Axis::Wavenumber);
        }
        let structure = model.structure();
        let index = Parameters::index(structure, name)?;
        if !structure.parameters[index].choices.is_empty() {
            return Err(Error::input(format!(
                "`{name}` is a switch: it cannot vary continuously"
            )));
        }
        Ok(Axis::Parameter(index))
    }
}

impl<'m> Setup<'m> {
    /// The defaults of a model at a resolution.
    pub fn new(model: &'m dyn Model, resolution: usize) -> Self {
        let parameters = Parameters::defaults(model.structure());
        let discretisation = Arc::new(Discretisation::new());
        Setup {
            model,
            parameters,
            resolution,
            discretisation,
        }
    }

    /// Sets parameters from `NAME=VALUE`.
    ///
    /// # Errors
    /// What is no assignment, a parameter that the model does not have, a value out of range.
    pub fn set(&mut self, assignments: &[String]) -> Result<()> {
        for assignment in assignments {
            let (name, value) = assignment.split_once('=').ok_or_else(|| {
                Error::input(format!("--set {assignment}: --set accepts NAME=VALUE"))
            })?;
            self.parameters
                .set_text(self.model.structure(), name.trim(), value.trim())?;
        }
        Ok(())
    }

    /// The sources of the model, spec and laws, as a short number.
    pub fn hash(&self) -> String {
        let sources = self.model.sources();
        let text = sources.iter().flat_map(|(_, text)| text.bytes());
        let hash = crate::file::hash(text);
        format!("{hash:016x}")
    }

    /// The resolution to collocate with: 0 without a cross-stream coordinate.
    pub fn effective_resolution(&self) -> usize {
        if self.model.structure().coordinate.is_some() {
            self.resolution
        } else {
            0
        }
    }

    /// The setup with one coordinate moved.
    ///
    /// # Errors
    /// A value out of the parameter's range.
    pub fn moved(&self, axis: Axis, value: f64) -> Result<Self> {
        let mut setup = self.clone();
        if let Axis::Parameter(index) = axis {
            setup.parameters.set(self.model.structure(), index, value)?;
        }
        Ok(setup)
    }

    /// The base state, from a neighbouring one where that is given.
    ///
    /// # Errors
    /// See [`base::solve`].
    pub fn base(&self, near: Option<&BaseState>) -> Result<BaseState> {
        base::solve_near(self.model, &self.parameters, near)
    }

    /// Calls `study` with the Landau point of a selected mode.
    ///
    /// # Errors
    /// Whatever fails on the way.
    pub fn with_point<R>(
        &self,
        base: &BaseState,
        k: f64,
        selection: Selection,
        study: impl FnOnce(&LandauPoint) -> Result<R>,
    ) -> Result<R> {
        self.with_problem(base, |problem| {
            study(&weakly::point(problem, k, selection)?)
        })
    }

    /// Calls `study` with the collocated problem.
    ///
    /// # Errors
    /// Whatever fails on the way.
    pub fn with_problem<R>(
        &self,
        base: &BaseState,
        study: impl FnOnce(&Problem) -> Result<R>,
    ) -> Result<R> {
        let resolution = self.effective_resolution();
        study(&Problem::new(
            self.model,
            base,
            &self.discretisation,
            resolution,
        )?)
    }
}

/// A mode carried from one point of a study to the next.
#[derive(Clone)]
pub struct Carried {
    /// The base state there.
    pub base: BaseState,
    /// The mode there.
    pub pair: EigenPair,
}

/// Refuses a wavenumber that cannot be one.
///
/// # Errors
/// Zero, negative or not finite.
pub fn check_wavenumber(k: f64) -> Result<()> {
    if k.is_finite() && k > 0.0 {
        return Ok(());
    }
    Err(Error::input(format!(
        "k = {k} is not a wavenumber: it has to be a positive number"
    )))
}
