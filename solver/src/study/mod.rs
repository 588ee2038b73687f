//! Studies: what is asked of a model beyond one Landau point.

pub mod accuracy;
pub mod amplitudes;
mod bases;
pub mod critical;
pub mod derived;
pub mod error_bars;
pub mod identity;
mod journal;
use crate::wavevector::WaveVector;
use bases::Bases;
pub use journal::journal_path;
pub use progress::{Progress, Silent};
pub mod modes;
pub mod onset;
pub mod orders;
pub mod point;
pub mod profiles;
mod progress;
pub mod quadrature;
pub mod row;
pub mod sensitivity;
pub mod shard;
pub mod spectrum;
pub mod states;
pub mod sweep;
pub mod verify;

use crate::base::{self, BaseState};
use crate::error::{Error, Result};
use crate::model::{Model, ParameterId, Structure};
use crate::parameters::Parameters;
use crate::problem::Problem;
use crate::space::Matrices;
use crate::spectrum::EigenPair;
use crate::weakly::{self, LandauPoint, Selection};
use crate::words;
use std::sync::Arc;

/// A model with parameters and resolution: what the command line sets up.
#[derive(Clone)]
pub struct Setup {
    /// The kernels.
    pub model: Arc<dyn Model>,
    /// Values, and which of them the base state determines.
    pub parameters: Parameters,
    /// M
    resolution: usize,
    /// Parameters that [`Setup::set`] was told, which an axis must not vary.
    assigned: Vec<ParameterId>,
    /// Differentiation matrices, shared by all problems of the study.
    pub matrices: Arc<Matrices>,
    /// Base states that were solved, shared by all setups made from this one.
    bases: Arc<Bases>,
}

/// A coordinate of a study: the wavenumber or a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// k
    Wavenumber,
    /// A parameter.
    Parameter(ParameterId),
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
        let parameter = Parameters::named(structure, name)?;
        if !structure.parameters[parameter].choices.is_empty() {
            return Err(Error::input(format!(
                "`{name}` is a switch: it cannot vary continuously"
            )));
        }
        Ok(Axis::Parameter(parameter))
    }

    /// Refuses a parameter that takes whole numbers alone, where values between two others are asked for.
    ///
    /// # Errors
    /// Such a parameter.
    pub fn check_continuous(self, structure: &Structure) -> Result<()> {
        match self {
            Axis::Parameter(id) if !structure.parameters[id].is_continuous() => {
                let name = &structure.parameters[id].name;
                Err(Error::input(format!(
                    "`{name}` takes whole numbers: it cannot vary continuously; `sweep --over {name}=FROM:TO:COUNT` \
                     goes through them"
                )))
            }
            _ => Ok(()),
        }
    }
}

impl Setup {
    /// The defaults of a model at a resolution M.
    ///
    /// # Errors
    /// An M that is less than 4 or more than 1000.
    pub fn new(model: Arc<dyn Model>, resolution: usize) -> Result<Self> {
        check_resolution(resolution)?;
        let parameters = Parameters::defaults(model.structure());
        Ok(Setup {
            model,
            parameters,
            resolution,
            assigned: Vec::new(),
            matrices: Arc::default(),
            bases: Arc::default(),
        })
    }

    /// The same at another resolution M; matrices and base states stay shared.
    ///
    /// # Errors
    /// As [`Setup::new`].
    pub fn at_resolution(self, resolution: usize) -> Result<Self> {
        check_resolution(resolution)?;
        Ok(Setup { resolution, ..self })
    }

    /// M, whether or not the model has a cross-stream coordinate.
    pub fn resolution(&self) -> usize {
        self.resolution
    }

    /// Sets parameters from `NAME=VALUE`.
    ///
    /// # Errors
    /// What is no assignment, a parameter that the model does not have or that is set twice, a value out of range.
    pub fn set(&mut self, assignments: &[String]) -> Result<()> {
        let model = self.model.clone();
        let structure = model.structure();
        let mut earlier: Vec<(ParameterId, &String)> = Vec::new();
        for assignment in assignments {
            let (name, value) = assignment.split_once('=').ok_or_else(|| {
                let given = words::quoted(assignment);
                Error::input(format!("--set {given}: --set accepts NAME=VALUE"))
            })?;
            let name = name.trim();
            let parameter = Parameters::named(structure, name)?;
            if let Some((_, first)) = earlier.iter().find(|(id, _)| *id == parameter) {
                return Err(Error::input(format!(
                    "`{name}` is set twice, by `{}` and by `{}`: a parameter accepts one value",
                    words::quoted(first),
                    words::quoted(assignment)
                )));
            }
            self.parameters.set_text(structure, name, value.trim())?;
            earlier.push((parameter, assignment));
        }
        self.assigned.extend(earlier.iter().map(|(id, _)| *id));
        Ok(())
    }

    /// Refuses an axis whose values another option fixes: a parameter that was set, the wavenumber beside `k`.
    ///
    /// # Errors
    /// Such an axis.
    pub fn check_free(&self, axis: Axis, k: Option<f64>) -> Result<()> {
        match (axis, k) {
            (Axis::Wavenumber, Some(k)) => Err(Error::input(format!(
                "k varies, and k = {k} is given too: give the axis or --k, not both"
            ))),
            (Axis::Parameter(id), _) if self.assigned.contains(&id) => {
                let structure = self.model.structure();
                let name = &structure.parameters[id].name;
                let value = self.parameters.shown(structure, id);
                Err(Error::input(format!(
                    "`{name}` varies, and {name} = {value} is set too: give the axis or --set {name}, not both"
                )))
            }
            _ => Ok(()),
        }
    }

    /// The sources of the model, spec and laws, as a short number.
    pub fn hash(&self) -> String {
        let sources = self.model.sources();
        let text = sources.iter().flat_map(|(_, text)| text.bytes());
        let hash = crate::file::hash(text);
        format!("{hash:016x}")
    }

    /// The build of the solver and of the generator that made the model's kernels: digits may depend on it.
    pub fn build(&self) -> String {
        format!("{}-{}", crate::BUILD, self.model.generator())
    }

    /// The resolution to collocate with; nothing without a cross-stream coordinate.
    pub fn effective_resolution(&self) -> Option<usize> {
        let coordinate = self.model.structure().coordinate.as_ref();
        coordinate.map(|_| self.resolution)
    }

    /// A finer resolution beside which errors show: 3M/2.
    pub fn finer_resolution(&self) -> Option<usize> {
        self.effective_resolution().map(|m| m + m.div_ceil(2))
    }

    /// The setup with one coordinate moved.
    ///
    /// # Errors
    /// A value out of the parameter's range.
    pub fn moved(&self, axis: Axis, value: f64) -> Result<Self> {
        let mut setup = self.clone();
        if let Axis::Parameter(parameter) = axis {
            setup
                .parameters
                .set(self.model.structure(), parameter, value)?;
        }
        Ok(setup)
    }

    /// Refuses a value that a parameter does not accept.
    ///
    /// # Errors
    /// A value out of the parameter's range, or not finite.
    pub fn accepts(&self, axis: Axis, value: f64) -> Result<()> {
        match axis {
            Axis::Wavenumber => WaveVector::wave(value).map(|_| ()),
            Axis::Parameter(parameter) => {
                let mut parameters = self.parameters.clone();
                parameters.set(self.model.structure(), parameter, value)
            }
        }
    }

    /// The base state, from a neighbouring one where that is given.
    ///
    /// # Errors
    /// See [`base::solve`].
    pub fn base(&self, near: Option<&BaseState>) -> Result<Arc<BaseState>> {
        if near.is_some() {
            return base::solve(&self.model, &self.parameters, &self.matrices, near).map(Arc::new);
        }
        if let Some(base) = self.bases.at(&self.parameters) {
            return Ok(base);
        }
        let base = base::solve(&self.model, &self.parameters, &self.matrices, None)?;
        let base = Arc::new(base);
        self.bases.add(&self.parameters, &base);
        Ok(base)
    }

    /// The problem around a base state, collocated at M.
    ///
    /// # Errors
    /// See [`Problem::new`].
    pub fn problem(&self, base: &Arc<BaseState>) -> Result<Arc<Problem>> {
        Problem::new(base, self.effective_resolution()).map(Arc::new)
    }

    /// The Landau point of a selected mode at a wavenumber k.
    ///
    /// # Errors
    /// A k that is no positive number; whatever fails on the way.
    pub fn point(
        &self,
        base: &Arc<BaseState>,
        k: f64,
        selection: Selection,
    ) -> Result<LandauPoint> {
        weakly::point(&self.problem(base)?, WaveVector::wave(k)?, selection)?.conserving()
    }
}

/// A mode carried from one point of a study to the next.
#[derive(Clone)]
pub struct Carried {
    /// The base state there.
    pub base: Arc<BaseState>,
    /// The mode there.
    pub pair: EigenPair,
}

/// Refuses a number of collocation points out of range.
///
/// # Errors
/// Fewer than 4, more than 1000.
pub fn check_resolution(resolution: usize) -> Result<()> {
    if (4..=1000).contains(&resolution) {
        return Ok(());
    }
    Err(Error::input(format!(
        "M = {resolution} is out of range: M accepts 4 to 1000"
    )))
}
