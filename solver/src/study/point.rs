//! A Landau point with everything that it rests on: what `point` prints.

use super::accuracy::{Accuracy, Resonance, accuracy, resonance};
use super::{Setup, check_wavenumber, sensitivity};
use crate::base::BaseState;
use crate::error::{Error, Result};
use crate::model::C64;
use crate::weakly::{Bifurcation, LandauPoint, Selection, equilibrium, outputs};
use crate::words;
use serde_json::{Map, Value, json};
use std::fmt;

/// A coefficient whose error is a larger part of it is no answer.
pub const UNCONVERGED: f64 = 0.05;
/// Below this part of what it is the sum of, a coefficient counts as a computed zero.
const CANCELLED: f64 = 1e-6;
/// A second-order problem that is nearer to singularity than this, relative to the slow rates, has no answer
/// that rounding leaves standing.
pub const SINGULAR: f64 = 1e-8;

/// c0, c2 and what belongs to them at one wavenumber; owns its data.
#[derive(Clone, Debug)]
pub struct PointReport {
    pub model: String,
    pub title: String,
    /// By name; switches by the name of their choice.
    pub parameters: Value,
    pub k: f64,
    /// M, where there is a cross-stream coordinate.
    pub resolution: usize,
    has_coordinate: bool,
    pub c0: C64,
    pub c2: C64,
    /// A_e
    pub amplitude: Option<f64>,
    pub bifurcation: Bifurcation,
    pub normalization: String,
    pub error: Accuracy,
    pub resonance: Resonance,
    /// Name, value at the base state, A² correction.
    pub outputs: Vec<(String, [f64; 2])>,
    /// Name and dc0/d(parameter).
    pub dc0: Vec<(String, C64)>,
}

impl PointReport {
    /// The Landau point of a selected mode, its errors and resonances.
    ///
    /// # Errors
    /// A mode that is not found, a resonance, a coefficient that is not converged, anything that is no
    /// finite number.
    pub fn compute(setup: &Setup, k: f64, selection: Selection) -> Result<Self> {
        check_wavenumber(k)?;
        let base = setup.base(None)?;
        setup.with_point(&base, k, selection, |point| Self::of(setup, &base, point))
    }

    fn of(setup: &Setup, base: &BaseState, point: &LandauPoint) -> Result<Self> {
        let structure = setup.model.structure();
        let resonance = resonance(point)?;
        check_distances(point, &resonance)?;
        let error = accuracy(setup, base, point)?;
        check_errors(setup, point, &error)?;
        let mut values = Vec::new();
        for (info, value) in structure.outputs.iter().zip(outputs(point)) {
            if !value.iter().all(|v| v.is_finite()) {
                return Err(Error::computation(format!(
                    "the output `{}` has no value at this base state",
                    info.name
                )));
            }
            values.push((info.name.clone(), value));
        }
        let mut slopes = Vec::new();
        for (index, slope) in sensitivity::parameters(setup, base, &point.pair) {
            let name = structure.parameters[index].name.clone();
            let slope = slope.map_err(|error| {
                Error::computation(format!("dc0/d{name} cannot be formed: {error}"))
            })?;
            slopes.push((name, slope));
        }
        let (c0, c2) = ((point.c0, error.c0), (point.c2, error.c2));
        Ok(PointReport {
            model: structure.name.clone(),
            title: structure.title.clone(),
            parameters: words::parameters(setup, &base.parameters),
            k: point.k(),
            resolution: setup.resolution,
            has_coordinate: structure.coordinate.is_some(),
            c0: point.c0,
            c2: point.c2,
            amplitude: equilibrium(c0, c2),
            bifurcation: Bifurcation::new(c0, c2),
            normalization: structure.amplitude.description.clone(),
            error,
            resonance,
            outputs: values,
            dc0: slopes,
        })
    }

    /// The object that the command line prints: the keys are a contract.
    pub fn json(&self) -> Value {
        let outputs: Map<String, Value> = self
            .outputs
            .iter()
            .map(|(name, v)| (name.clone(), json!([v[0], v[1]])))
            .collect();
        let slopes: Map<String, Value> = self
            .dc0
            .iter()
            .map(|(name, slope)| (name.clone(), words::complex(*slope)))
            .collect();
        json!({
            "model": self.model,
            "parameters": self.parameters,
            "k": self.k,
            "M": self.resolution,
            "c0": words::complex(self.c0),
            "c2": words::complex(self.c2),
            "amplitude": self.amplitude,
            "bifurcation": self.bifurcation.to_string(),
            "normalization": self.normalization,
            "error": {"c0": self.error.c0, "c2": self.error.c2},
            "resonance": {
                "mean_flow": words::number(self.resonance.mean_flow),
                "second_harmonic": words::number(self.resonance.second_harmonic),
            },
            "outputs": outputs,
            "dc0": slopes,
        })
    }
}

/// What a distance from singularity is small or large against: the slow eigenvalues, or the terms of the slowest
/// balance where there are too few of them to tell.
pub fn slow_rate(point: &LandauPoint) -> f64 {
    let pair = &point.pair;
    let rate = point.problem.rate(pair.k);
    let floor = if rate.is_finite() { rate } else { 0.0 };
    pair.scale.max(pair.c.norm()).max(floor)
}

/// Second-order problems that are singular to working precision, named.
fn check_distances(point: &LandauPoint, resonance: &Resonance) -> Result<()> {
    let scale = slow_rate(point);
    if resonance.mean_flow <= SINGULAR * scale {
        return Err(Error::computation(format!(
            "the problem for X[0;2] is nearly singular: an eigenvalue of the mean problem lies {:.1e} from 2 a0. \
             Does the model conserve an integral, or leave the constant of a field open, that the spec does not \
             name? The block `mean` accepts `conserved` and `gauge`",
            resonance.mean_flow
        )));
    }
    if resonance.second_harmonic <= SINGULAR * scale {
        return Err(Error::computation(format!(
            "the problem for X[2;2] is nearly singular: an eigenvalue at 2k lies {:.1e} from 2 c0, a 2:1 resonance; \
             try a wavenumber beside k = {}",
            resonance.second_harmonic,
            point.k()
        )));
    }
    Ok(())
}

/// An error of the size of its coefficient is no answer, unless the coefficient is a computed zero.
fn check_errors(setup: &Setup, point: &LandauPoint, error: &Accuracy) -> Result<()> {
    let scale = point.pair.scale;
    let judged = [
        ("c0", error.c0, point.c0.norm(), scale),
        ("c2", error.c2, point.c2.norm(), point.size()),
    ];
    for (name, error, size, sum) in judged {
        if error <= (UNCONVERGED * size).max(CANCELLED * sum) {
            continue;
        }
        let how_far = match error.is_finite() {
            true => format!(
                "its error is {:.1} times its size",
                error / size.max(1e-300)
            ),
            false => "another resolution has no such mode".to_owned(),
        };
        let advice = match setup.effective_resolution() {
            0 => "parameters off this place".to_owned(),
            m => format!("a larger M, such as -M {}", 2 * m),
        };
        return Err(Error::computation(format!(
            "{name} is not converged at M = {}: {how_far}; try {advice}",
            setup.resolution
        )));
    }
    Ok(())
}

impl fmt::Display for PointReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} at k = {}", self.title, self.k)?;
        match self.has_coordinate {
            true => writeln!(f, ", M = {}", self.resolution)?,
            false => writeln!(f)?,
        }
        let c0 = words::settled(self.c0, self.error.c0);
        let c2 = words::settled(self.c2, self.error.c2);
        writeln!(f, "  {}", words::amplitude_equation(c0, c2))?;
        let shown = words::shown;
        writeln!(f, "  c0 = {}   ± {:.1e}", shown(c0), self.error.c0)?;
        writeln!(f, "  c2 = {}   ± {:.1e}", shown(c2), self.error.c2)?;
        writeln!(f, "  {}", self.bifurcation)?;
        let by = &self.normalization;
        if let Some(amplitude) = self.amplitude {
            writeln!(f, "  A_e = {amplitude:.8}, normalised by {by}")?;
        } else if self.c0.re.abs() <= self.error.c0 {
            writeln!(f, "  neutral within the error of c0; normalised by {by}")?;
        } else {
            writeln!(f, "  no equilibrium at cubic order; normalised by {by}")?;
        }
        write!(f, "  distance to resonance: ")?;
        if self.resonance.mean_flow.is_finite() {
            write!(f, "mean flow {:.3e}, ", self.resonance.mean_flow)?;
        }
        write!(f, "2:1 {:.3e}", self.resonance.second_harmonic)?;
        for (name, value) in &self.outputs {
            write!(f, "\n  {name} = {:.8} + {:.8} A²", value[0], value[1])?;
        }
        for (name, slope) in &self.dc0 {
            write!(f, "\n  dc0/d{name} = {}", shown(*slope))?;
        }
        Ok(())
    }
}
