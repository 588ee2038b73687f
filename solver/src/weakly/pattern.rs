//! Patterns in the plane: base state, fundamental, and the expansion through third order.

use super::expansion::Expansion;
use super::landau::LandauPoint;
use crate::collocation::{Grid, GridKind};
use crate::error::Result;
use crate::model::C64;

/// Fields over a rectangle of the (x, y)-plane; arrays are `[field][y][x]`.
pub struct Pattern {
    pub x: Vec<f64>,
    /// One height where the model has no cross-stream coordinate.
    pub y: Vec<f64>,
    /// A
    pub amplitude: f64,
    pub names: Vec<String>,
    /// X⁰, `[field][y]`
    pub base: Vec<Vec<f64>>,
    /// X⁰ + A X[1;1] e^{ikx} + c.c., P (4.5)
    pub linear: Vec<Vec<Vec<f64>>>,
    /// X⁰ and all modes through third order, P (4.4)
    pub nonlinear: Vec<Vec<Vec<f64>>>,
}

/// How fine, and how many wavelengths.
#[derive(Clone, Copy, Debug)]
pub struct Window {
    pub columns: usize,
    pub rows: usize,
    pub wavelengths: f64,
}

/// The pattern of a Landau point at amplitude A.
///
/// # Errors
/// A resonance at third order.
pub fn pattern(point: &LandauPoint, amplitude: f64, window: Window) -> Result<Pattern> {
    let expansion = point.third_order()?;
    let problem = expansion.problem;
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
    let length = window.wavelengths * 2.0 * std::f64::consts::PI / expansion.k;
    let columns = window.columns.max(2);
    let x: Vec<f64> = (0..columns)
        .map(|i| length * i as f64 / (columns - 1) as f64)
        .collect();
    let profiles = structure.profiles();
    let base: Vec<Vec<f64>> = (0..profiles)
        .map(|field| {
            let position = structure.base_position(field, 0);
            let at = |xi: &f64| problem.base.point(model, *xi, expansion.k)[position];
            places.iter().map(at).collect()
        })
        .collect();
    let sum = |keys: &[(usize, usize)]| {
        let fields = base.iter().enumerate();
        fields
            .map(|(field, base)| {
                let modes: Vec<(usize, Vec<C64>)> = keys
                    .iter()
                    .map(|&(harmonic, order)| {
                        let size = amplitude.powi(order as i32);
                        let profile = profile(&expansion, (harmonic, order), field, &places);
                        (harmonic, profile.into_iter().map(|v| v * size).collect())
                    })
                    .collect();
                superpose(base, &modes, expansion.k, &x)
            })
            .collect()
    };
    Ok(Pattern {
        amplitude,
        linear: sum(&[(1, 1)]),
        nonlinear: sum(&[(1, 1), (0, 2), (2, 2), (1, 3), (3, 3)]),
        names: structure.fields[..profiles]
            .iter()
            .map(|f| f.name.clone())
            .collect(),
        y: places.iter().map(|&xi| problem.base.y(xi)).collect(),
        x,
        base,
    })
}

/// X⁰ + Σ (X[0;m] once, the others with their complex conjugates)
fn superpose(base: &[f64], modes: &[(usize, Vec<C64>)], k: f64, x: &[f64]) -> Vec<Vec<f64>> {
    let value = |j: usize, x: f64| {
        let part = |(harmonic, profile): &(usize, Vec<C64>)| match harmonic {
            0 => profile[j].re,
            _ => 2.0 * (profile[j] * C64::cis(*harmonic as f64 * k * x)).re,
        };
        base[j] + modes.iter().map(part).sum::<f64>()
    };
    let row = |j| x.iter().map(|&x| value(j, x)).collect();
    (0..base.len()).map(row).collect()
}

/// One field of a mode at places in [−1, 1].
fn profile(expansion: &Expansion, key: (usize, usize), field: usize, places: &[f64]) -> Vec<C64> {
    let block = &expansion.problem.direct.layout.columns[field];
    let own = &expansion.modes[&key].values[block.offset..block.offset + block.len];
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
