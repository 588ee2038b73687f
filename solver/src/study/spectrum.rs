//! The spectrum of L beside that of L†, with what tells them apart: what `spectrum` prints.

use super::Setup;
use super::accuracy::UNCONVERGED;
use crate::error::{Error, Result};
use crate::model::C64;
use crate::problem::Problem;
use crate::spectrum::{Spectrum, adjoint_eigenvalues, eigenvalues};
use crate::words;
use serde_json::{Value, json};
use std::fmt;

/// Eigenvalues that are printed in words.
const SHOWN: usize = 20;

/// Both spectra at one wavenumber; owns its data.
#[derive(Clone, Debug)]
pub struct SpectrumReport {
    /// Name of the model.
    pub model: String,
    /// Its title.
    pub title: String,
    /// By name; switches by the name of their choice.
    pub parameters: Value,
    /// The wavenumber.
    pub k: f64,
    /// M, where there is a cross-stream coordinate.
    pub resolution: usize,
    has_coordinate: bool,
    /// Eigenvalues of L.
    pub direct: Spectrum,
    /// Eigenvalues of L† in the order of their conjugates, or why there are none.
    pub adjoint: std::result::Result<Spectrum, String>,
    /// Absolute error of the leading eigenvalue.
    pub error: f64,
}

impl SpectrumReport {
    /// All eigenvalues at one wavenumber.
    ///
    /// # Errors
    /// A spectrum that cannot be computed; a leading eigenvalue that another M moves by a good part of it.
    pub fn compute(setup: &Setup, k: f64) -> Result<Self> {
        if !(k.is_finite() && k >= 0.0) {
            return Err(Error::input(format!(
                "--k {k}: a wavenumber is a number from 0 on"
            )));
        }
        let base = setup.base(None)?;
        let problem = setup.problem(&base)?;
        let direct = eigenvalues(&problem, k)?;
        let adjoint = adjoint_eigenvalues(&problem, k).map_err(|e| e.to_string());
        let structure = setup.model.structure();
        Ok(SpectrumReport {
            model: structure.name.clone(),
            title: structure.title.clone(),
            parameters: base.parameters.json(base.structure()),
            k,
            resolution: setup.resolution,
            has_coordinate: structure.coordinate.is_some(),
            error: error(setup, &problem, k, &direct)?,
            direct,
            adjoint,
        })
    }

    /// The distance of each eigenvalue of L to the nearest conjugate of one of L†: zero without truncation.
    fn differences(&self) -> Vec<f64> {
        let Ok(adjoint) = &self.adjoint else {
            return Vec::new();
        };
        let conjugates = Spectrum::new(adjoint.values.iter().map(|c| c.conj()).collect());
        let values = self.direct.values.iter();
        values.map(|&c| conjugates.distance(c)).collect()
    }

    /// The object that the command line prints: the keys are a contract.
    pub fn json(&self) -> Value {
        let list = |spectrum: &Spectrum| -> Value {
            spectrum.values.iter().map(|&c| words::complex(c)).collect()
        };
        let mut object = json!({
            "model": self.model,
            "parameters": self.parameters,
            "k": self.k,
            "M": self.resolution,
            "direct": list(&self.direct),
            "error": self.error,
        });
        match &self.adjoint {
            Ok(spectrum) => {
                object["adjoint"] = list(spectrum);
                object["difference"] = self.differences().into();
            }
            Err(reason) => {
                object["adjoint"] = Value::Null;
                object["adjoint_missing"] = Value::String(reason.clone());
            }
        }
        object
    }
}

/// How far another M moves the leading eigenvalue.
fn error(setup: &Setup, problem: &Problem, k: f64, direct: &Spectrum) -> Result<f64> {
    let leading = direct.values.first().copied().unwrap_or_default();
    let scale = direct.scale().max(leading.norm());
    let Some(finer) = setup.finer_resolution() else {
        return Ok(1e-14 * scale);
    };
    let other = Problem::new(&problem.base, Some(finer))?;
    let error = eigenvalues(&other, k)?.distance(leading).max(1e-14 * scale);
    if error > UNCONVERGED * scale {
        let what = format!("the leading eigenvalue at k = {k}");
        let how_far = format!("another M moves it by {error:.1e}");
        return Err(Error::unresolved(what, problem.resolution, how_far));
    }
    Ok(error)
}

impl fmt::Display for SpectrumReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} at k = {}", self.title, self.k)?;
        if self.has_coordinate {
            write!(f, ", M = {}", self.resolution)?;
        }
        writeln!(f, ": leading eigenvalues, the first ± {:.1e}", self.error)?;
        write!(f, "{:>44}   {:>44}   {:>10}", "L", "L†", "difference")?;
        let differences = self.differences();
        let others: &[C64] = match &self.adjoint {
            Ok(spectrum) => &spectrum.values,
            Err(_) => &[],
        };
        for (i, &c) in self.direct.values.iter().take(SHOWN).enumerate() {
            let other = others.get(i).map_or(String::new(), |&a| words::shown(a));
            let difference = differences
                .get(i)
                .map_or(String::new(), |d| format!("{d:.1e}"));
            let own = words::shown(c);
            write!(f, "\n{own:>44}   {other:>44}   {difference:>10}")?;
        }
        if let Err(reason) = &self.adjoint {
            write!(f, "\nL†: {reason}")?;
        }
        Ok(())
    }
}
