//! The modes of the expansion as profiles: what `point --plot` draws and `--out` stores.

use super::quadrature::{AdjointMode, adjoint_mode};
use super::{Setup, check_wavenumber};
use crate::collocation::{Block, Grid, GridKind};
use crate::error::Result;
use crate::model::C64;
use crate::problem::Problem;
use crate::weakly::{Expansion, Mode, Selection};

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
    /// A mode that is not found, a resonance.
    pub fn compute(setup: &Setup, k: f64, selection: Selection) -> Result<Self> {
        check_wavenumber(k)?;
        let base = setup.base(None)?;
        setup.with_point(&base, k, selection, |point| {
            let problem = point.problem;
            let places: Vec<f64> = match problem.resolution {
                0 => vec![0.0],
                _ => (0..HEIGHTS)
                    .map(|i| -1.0 + 2.0 * i as f64 / (HEIGHTS - 1) as f64)
                    .collect(),
            };
            let expansion = Expansion::to(problem, vec![point.pair.clone()], 3)?;
            let known = expansion.known().into_iter();
            let own = known.filter(|(monomial, _)| monomial.z >= monomial.conj);
            let mut profiles: Vec<ModeProfile> = own
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
                k,
                c0: point.c0,
                heights: places.iter().map(|&xi| base.y(xi)).collect(),
                profiles,
            })
        })
    }
}

fn direct(problem: &Problem, name: String, mode: &Mode, places: &[f64]) -> ModeProfile {
    let structure = problem.structure();
    let columns = &problem.direct.layout.columns;
    ModeProfile {
        name,
        parts: structure.fields[..columns.len()]
            .iter()
            .map(|field| field.name.clone())
            .collect(),
        values: columns
            .iter()
            .map(|block| interpolated(block, &mode.values, places))
            .collect(),
    }
}

/// The adjoint mode, scaled to a largest value of one.
fn adjoint(problem: &Problem, mode: &AdjointMode, places: &[f64]) -> Result<ModeProfile> {
    let columns = &problem.adjoint()?.layout.columns;
    let largest = mode
        .values
        .iter()
        .max_by(|a, b| a.norm().total_cmp(&b.norm()));
    let scale = largest.map_or(C64::new(1.0, 0.0), |v| v.inv());
    let values: Vec<C64> = mode.values.iter().map(|v| v * scale).collect();
    Ok(ModeProfile {
        name: "X†".to_owned(),
        parts: problem.structure().balances.clone(),
        values: columns
            .iter()
            .map(|block| interpolated(block, &values, places))
            .collect(),
    })
}

/// The values of a block at places in [−1, 1].
fn interpolated(block: &Block, values: &[C64], places: &[f64]) -> Vec<C64> {
    let own = &values[block.offset..][..block.len];
    if block.grid == GridKind::Point {
        return vec![own[0]; places.len()];
    }
    let matrix = Grid::new(block.grid).interpolate_to(places);
    let at = |i: usize| {
        own.iter()
            .enumerate()
            .map(|(j, v)| v * matrix[(i, j)])
            .sum()
    };
    (0..places.len()).map(at).collect()
}
