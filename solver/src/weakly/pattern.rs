//! Patterns in the plane: base state, fundamental, and the expansion through third order.

use super::cubic::LandauPoint;
use super::expansion::Expansion;
use super::mode::Mode;
use crate::collocation::{Grid, GridKind};
use crate::error::Result;
use crate::model::C64;
use crate::problem::Problem;

/// Fields over a rectangle of the (x, y)-plane; arrays are `[field][y][x]`.
pub struct Pattern {
    /// Along the periodic coordinate.
    pub x: Vec<f64>,
    /// One height where the model has no cross-stream coordinate.
    pub y: Vec<f64>,
    /// A
    pub amplitude: f64,
    /// Of the fields.
    pub names: Vec<String>,
    /// X⁰, `[field][y]`
    pub base: Vec<Vec<f64>>,
    /// X⁰ + A X[1;1] e^{ikx} + c.c., P (4.5)
    pub linear: Vec<Vec<Vec<f64>>>,
    /// X⁰ and all modes through third order, P (4.4)
    pub nonlinear: Vec<Vec<Vec<f64>>>,
}

/// The order of the expansion that is drawn.
const ORDER: usize = 3;

/// How fine, and how many wavelengths.
#[derive(Clone, Copy, Debug)]
pub struct Window {
    /// Points along x.
    pub columns: usize,
    /// Points along y.
    pub rows: usize,
    /// Length along x.
    pub wavelengths: f64,
}

/// The pattern of a Landau point at amplitude A.
///
/// # Errors
/// A resonance at third order.
pub fn pattern(point: &LandauPoint, amplitude: f64, window: Window) -> Result<Pattern> {
    let expansion = Expansion::to(point.problem, vec![point.pair.clone()], ORDER)?;
    let (problem, k) = (point.problem, point.k());
    let (model, structure) = (problem.model, problem.structure());
    let heights = match problem.resolution {
        0 => 1,
        _ => window.rows.max(2),
    };
    let places: Vec<f64> = (0..heights)
        .map(|j| match heights {
            1 => 0.0,
            _ => -1.0 + 2.0 * j as f64 / (heights - 1) as f64,
        })
        .collect();
    let length = window.wavelengths * 2.0 * std::f64::consts::PI / k;
    let columns = window.columns.max(2);
    let x: Vec<f64> = (0..columns)
        .map(|i| length * i as f64 / (columns - 1) as f64)
        .collect();
    let profiles = structure.profiles();
    let base: Vec<Vec<f64>> = (0..profiles)
        .map(|field| {
            let position = structure.base_position(field, 0);
            let at = |xi: &f64| problem.base.point(model, *xi, k)[position];
            places.iter().map(at).collect()
        })
        .collect();
    let modes = expansion.known();
    let sum = |order: usize| {
        let modes = modes
            .iter()
            .filter(|(monomial, _)| monomial.degree() <= order);
        let modes: Vec<(f64, &Mode)> = modes
            .map(|(monomial, mode)| (amplitude.powi(monomial.degree() as i32), mode))
            .collect();
        let fields = base.iter().enumerate();
        fields
            .map(|(field, base)| {
                let profile = |&(size, mode): &(f64, &Mode)| {
                    let profile = profile(problem, mode, field, &places);
                    (mode.q, profile.into_iter().map(|v| v * size).collect())
                };
                superpose(base, &modes.iter().map(profile).collect::<Vec<_>>(), &x)
            })
            .collect()
    };
    Ok(Pattern {
        amplitude,
        linear: sum(1),
        nonlinear: sum(ORDER),
        names: structure.fields[..profiles]
            .iter()
            .map(|f| f.name.clone())
            .collect(),
        y: places.iter().map(|&xi| problem.base.y(xi)).collect(),
        x,
        base,
    })
}

/// X⁰ + Σ over modes and their conjugates.
fn superpose(base: &[f64], modes: &[(f64, Vec<C64>)], x: &[f64]) -> Vec<Vec<f64>> {
    let value = |j: usize, x: f64| {
        let part = |(q, profile): &(f64, Vec<C64>)| (profile[j] * C64::cis(q * x)).re;
        base[j] + modes.iter().map(part).sum::<f64>()
    };
    let row = |j| x.iter().map(|&x| value(j, x)).collect();
    (0..base.len()).map(row).collect()
}

/// One field of a mode at places in [−1, 1].
fn profile(problem: &Problem, mode: &Mode, field: usize, places: &[f64]) -> Vec<C64> {
    let block = &problem.direct.layout.columns[field];
    let own = &mode.values[block.offset..block.offset + block.len];
    if block.grid == GridKind::Point {
        return vec![own[0]; places.len()];
    }
    let matrix = Grid::new(block.grid).interpolate_to(places);
    let value = |i: usize| {
        own.iter()
            .enumerate()
            .map(|(j, v)| v * matrix[(i, j)])
            .sum()
    };
    (0..places.len()).map(value).collect()
}

impl Pattern {
    /// The position of a field by name.
    pub fn field(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|n| n == name)
    }
}
