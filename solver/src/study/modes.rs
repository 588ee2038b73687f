//! The modes of the expansion as profiles: what `point --plot` draws and `--out` stores.

use super::Setup;
use super::accuracy::Converged;
use super::quadrature::{AdjointMode, adjoint_mode};
use crate::error::Result;
use crate::model::{C64, Jet};
use crate::problem::{LinearProblem, Problem};
use crate::space::Place;
use crate::wavevector::WaveVector;
use crate::weakly::{Expansion, Mode, Selection};
use serde_json::Value;

/// Heights of a profile.
const HEIGHTS: usize = 201;

/// One mode, field by field.
#[derive(Clone, Debug)]
pub struct ModeProfile {
    /// `X[1;1]`, `X[0;2]`, …, or `X†`.
    pub name: String,
    /// Names of the fields; of the adjoint mode, those of the balances.
    pub parts: Vec<String>,
    /// Physical values, `[part][height]`.
    pub values: Vec<Vec<C64>>,
}

/// All modes through third order, and the adjoint mode where the model has one.
#[derive(Clone, Debug)]
pub struct Modes {
    /// By name; switches by the name of their choice.
    pub parameters: Value,
    /// The wavenumber.
    pub k: f64,
    /// The eigenvalue of the fundamental.
    pub c0: C64,
    /// y; one zero without a cross-stream coordinate.
    pub heights: Vec<f64>,
    /// The fundamental first.
    pub profiles: Vec<ModeProfile>,
}

impl Modes {
    /// The modes at one wavenumber.
    ///
    /// # Errors
    /// A mode that is not found, a resonance, a coefficient that is not converged.
    pub fn compute(setup: &Setup, k: f64, selection: Selection) -> Result<Self> {
        WaveVector::wave(k)?;
        let base = setup.base(None)?;
        let point = Converged::new(setup, &base, k, selection)?.point;
        let problem = point.problem.as_ref();
        let places = problem.space().evenly(HEIGHTS);
        let expansion = Expansion::to(&point.problem, vec![point.pair.clone()], 3)?;
        // One of each pair of conjugates.
        let coefficients = expansion.coefficients().into_iter();
        let mut profiles: Vec<ModeProfile> = coefficients
            .filter(|(monomial, _)| monomial.z >= monomial.conj)
            .map(|(monomial, mode)| {
                let harmonic: f64 = monomial.differences().sum();
                let name = format!("X[{harmonic};{}]", monomial.degree());
                direct(problem, name, &mode, &places)
            })
            .collect();
        if let Ok(mode) = adjoint_mode(problem, &point.pair) {
            profiles.push(adjoint(problem, &mode, &places)?);
        }
        Ok(Modes {
            parameters: base.parameters.json(base.structure()),
            k,
            c0: point.c0,
            heights: places.iter().map(|&at| problem.space().y(at)).collect(),
            profiles,
        })
    }
}

fn direct(problem: &Problem, name: String, mode: &Mode, places: &[Place]) -> ModeProfile {
    let structure = problem.structure();
    ModeProfile {
        name,
        parts: structure
            .profiles()
            .map(|field| structure.fields[field].name.clone())
            .collect(),
        values: structure
            .profiles()
            .map(|field| mode.at(problem, Jet::value(field), places))
            .collect(),
    }
}

/// The adjoint mode, scaled to a largest value of one.
fn adjoint(problem: &Problem, mode: &AdjointMode, places: &[Place]) -> Result<ModeProfile> {
    let LinearProblem { layout, space, .. } = problem.adjoint()?;
    let largest = mode
        .values
        .iter()
        .max_by(|a, b| a.norm().total_cmp(&b.norm()));
    let values = mode
        .values
        .times(largest.map_or(C64::new(1.0, 0.0), |v| v.inv()));
    Ok(ModeProfile {
        name: "X†".to_owned(),
        parts: problem.structure().balances.to_vec(),
        values: layout
            .columns
            .iter()
            .map(|block| space.interpolated(block.points, block.of(&values), places))
            .collect(),
    })
}
