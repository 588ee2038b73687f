//! The spectrum of L beside that of L†, with what tells them apart: what `spectrum` prints.

use super::Setup;
use super::accuracy::UNCONVERGED;
use super::error_bars::{ROUNDINGS, TRUNCATION};
use crate::error::{Error, Result};
use crate::measured::Measured;
use crate::model::C64;
use crate::numerics::Noise;
use crate::problem::Problem;
use crate::spectrum::{Spectrum, adjoint_eigenvalues, eigenvalues, unit_of_time};
use crate::wavevector::WaveVector;
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
    /// Absolute errors of the eigenvalues of L, the leading one first.
    pub errors: Vec<f64>,
    /// The unit of time of the slow eigenvalues.
    scale: f64,
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
        let q = WaveVector::along_x(k);
        let base = setup.base(None)?;
        let problem = setup.problem(&base)?;
        let direct = eigenvalues(&problem, q)?;
        let adjoint = adjoint_eigenvalues(&problem, q).map_err(|e| e.to_string());
        let scale = unit_of_time(&problem, q, &direct);
        let errors = errors(setup, &problem, q, &direct, scale)?;
        let structure = setup.model.structure();
        Ok(SpectrumReport {
            model: structure.name.clone(),
            title: structure.title.clone(),
            parameters: base.parameters.json(base.structure()),
            k,
            resolution: setup.resolution,
            has_coordinate: structure.coordinate.is_some(),
            errors,
            scale,
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
            "error": self.errors.first().map(|&e| words::number(e)),
            "errors": self.errors.iter().map(|&e| words::number(e)).collect::<Vec<_>>(),
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

/// How far another M, or other rounding where there is none, moves each eigenvalue.
fn errors(
    setup: &Setup,
    problem: &Problem,
    q: WaveVector,
    direct: &Spectrum,
    scale: f64,
) -> Result<Vec<f64>> {
    let (beside, weight) = match setup.finer_resolution() {
        Some(finer) => (Problem::new(&problem.base, Some(finer))?, TRUNCATION),
        None => {
            let weight = ROUNDINGS * f64::EPSILON / Noise::SIZE;
            (problem.disturbed(Noise::new(0)), weight)
        }
    };
    let there = eigenvalues(&beside, q)?;
    let rounding = |c: C64| 1e-14 * scale.max(c.norm());
    let error = |&c: &C64| (weight * there.distance(c)).max(rounding(c));
    let errors: Vec<f64> = direct.values.iter().map(error).collect();
    let leading = direct.values.first().zip(errors.first());
    if let Some((c, error)) = leading
        && !converged(*c, *error, scale)
    {
        let what = format!("the leading eigenvalue at k = {q}");
        let how_far = format!("another M moves it by {error:.1e}");
        return Err(Error::unresolved(what, problem.resolution, how_far));
    }
    Ok(errors)
}

fn converged(c: C64, error: f64, scale: f64) -> bool {
    error <= UNCONVERGED * scale.max(c.norm())
}

impl fmt::Display for SpectrumReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} at k = {}", self.title, self.k)?;
        if self.has_coordinate {
            write!(f, ", M = {}", self.resolution)?;
        }
        writeln!(f, ": leading eigenvalues")?;
        write!(f, "{:>50}   {:>50}   {:>10}", "L", "L†", "difference")?;
        let differences = self.differences();
        let adjoint: &[C64] = self.adjoint.as_ref().map_or(&[], |s| &s.values);
        let mut left_out = 0;
        let rows = self.direct.values.iter().zip(&self.errors).enumerate();
        for (i, (&c, &error)) in rows.take(SHOWN) {
            if !converged(c, error, self.scale) {
                left_out += 1;
                continue;
            }
            let difference = differences.get(i).copied();
            let of_adjoint = |&c: &C64| {
                let error = error + difference.unwrap_or(0.0);
                Measured::new(c, error).to_string()
            };
            let direct = Measured::new(c, error).to_string();
            let adjoint = adjoint.get(i).map_or(String::new(), of_adjoint);
            let difference = difference.map_or(String::new(), |d| format!("{d:.1e}"));
            write!(f, "\n{direct:>50}   {adjoint:>50}   {difference:>10}")?;
        }
        if left_out > 0 {
            write!(
                f,
                "\n{left_out} of the first {SHOWN} are not converged at this M and left out"
            )?;
        }
        match &self.adjoint {
            Err(reason) => write!(f, "\nthe columns of L† are empty: {reason}")?,
            Ok(adjoint) if adjoint.values.len() < self.direct.values.len().min(SHOWN) => write!(
                f,
                "\nL† has {} eigenvalues and L has {}: the last rows have none of L†",
                adjoint.values.len(),
                self.direct.values.len()
            )?,
            Ok(_) => {}
        }
        Ok(())
    }
}
