//! Patterns in the plane: base state, fundamental, and the expansion through third order.

use super::cubic::LandauPoint;
use super::expansion::Expansion;
use super::mode::Mode;
use crate::error::Result;
use crate::model::C64;
use crate::model::{FieldId, Jet, Table};

/// Fields over a rectangle of the (x, y)-plane; arrays are `[field][y][x]`.
pub struct Pattern {
    /// Along the periodic coordinate.
    pub x: Vec<f64>,
    /// One height where the model has no cross-stream coordinate.
    pub y: Vec<f64>,
    /// A
    pub amplitude: f64,
    /// Of the fields.
    pub names: Table<FieldId, String>,
    /// X⁰, `[field][y]`
    pub base: Table<FieldId, Vec<f64>>,
    /// X⁰ + A X[1;1] e^{ikx} + c.c., P (4.5)
    pub linear: Table<FieldId, Vec<Vec<f64>>>,
    /// X⁰ and all modes through third order, P (4.4)
    pub nonlinear: Table<FieldId, Vec<Vec<f64>>>,
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
    let expansion = Expansion::to(&point.problem, vec![point.pair.clone()], ORDER)?;
    let (problem, k) = (point.problem.as_ref(), point.k());
    let (structure, space) = (problem.structure(), problem.space());
    let places = space.evenly(window.rows.max(2));
    let length = window.wavelengths * 2.0 * std::f64::consts::PI / k;
    let columns = window.columns.max(2);
    let x: Vec<f64> = (0..columns)
        .map(|i| length * i as f64 / (columns - 1) as f64)
        .collect();
    let states: Vec<Vec<f64>> = places.iter().map(|&at| problem.base.at(at, k)).collect();
    let profile = |field: FieldId| -> Vec<f64> {
        let value = |state: &Vec<f64>| structure.base_value(state, field, 0);
        states.iter().map(value).collect()
    };
    let base: Table<FieldId, Vec<f64>> = structure.profiles().map(profile).collect();
    let modes = expansion.known();
    let sum = |order: usize| -> Table<FieldId, Vec<Vec<f64>>> {
        let modes = modes
            .iter()
            .filter(|(monomial, _)| monomial.degree() <= order);
        let modes: Vec<(f64, &Mode)> = modes
            .map(|(monomial, mode)| (amplitude.powi(monomial.degree() as i32), mode))
            .collect();
        let field = |(field, base): (FieldId, &Vec<f64>)| {
            let profile = |&(size, mode): &(f64, &Mode)| {
                let profile = mode.at(problem, Jet::value(field), &places);
                (mode.q, profile.into_iter().map(|v| v * size).collect())
            };
            superpose(base, &modes.iter().map(profile).collect::<Vec<_>>(), &x)
        };
        base.pairs().map(field).collect()
    };
    Ok(Pattern {
        amplitude,
        linear: sum(1),
        nonlinear: sum(ORDER),
        names: structure
            .profiles()
            .map(|field| structure.fields[field].name.clone())
            .collect(),
        y: places.iter().map(|&place| space.y(place)).collect(),
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

impl Pattern {
    /// A field by name.
    pub fn field(&self, name: &str) -> Option<FieldId> {
        self.names.position(|n| n == name)
    }
}
