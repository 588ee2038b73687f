//! Patterns in the plane: fields, and expressions in them, of the base state with the modes of the expansion through third
//! order.

use super::cubic::LandauPoint;
use super::expansion::Expansion;
use super::mode::Mode;
use crate::error::{Error, Result};
use crate::model::{C64, Expression, FieldId, Jet, Table};
use crate::problem::Problem;
use crate::space::Place;

/// One quantity over the plane; arrays are `[y][x]`.
#[derive(Clone, Debug)]
pub struct PlaneField {
    /// The field, or the expression as it was written.
    pub name: String,
    /// Values in the base state X⁰, `[y]`.
    pub base: Vec<f64>,
    /// Values at X⁰ + A X[1;1] e^{ikx} + c.c., P (4.5).
    pub linear: Vec<Vec<f64>>,
    /// Values at X⁰ and all modes through third order, P (4.4).
    pub nonlinear: Vec<Vec<f64>>,
}

/// Fields over a rectangle of the (x, y)-plane.
#[derive(Clone, Debug)]
pub struct Pattern {
    /// Places along the periodic coordinate.
    pub x: Vec<f64>,
    /// Heights; a single one where the model has no cross-stream coordinate.
    pub y: Vec<f64>,
    /// The amplitude A.
    pub amplitude: f64,
    /// The fields that are profiles.
    pub fields: Table<FieldId, PlaneField>,
    /// The expressions that were asked for, in the order of asking.
    pub derived: Vec<PlaneField>,
}

/// The order of the expansion that is drawn.
const ORDER: usize = 3;

/// The rectangle, and the grid in it.
#[derive(Clone, Copy, Debug)]
pub struct Window {
    /// Points along x.
    pub columns: usize,
    /// Points along y.
    pub rows: usize,
    /// Length along x, in wavelengths 2π/k.
    pub wavelengths: f64,
}

/// The pattern of a Landau point at amplitude A: every field, and the given expressions in fields.
///
/// # Errors
/// A problem of third order is singular, or a value is not finite.
pub fn pattern(
    point: &LandauPoint,
    amplitude: f64,
    window: Window,
    expressions: &[Expression],
) -> Result<Pattern> {
    let expansion = Expansion::to(&point.problem, vec![point.pair.clone()], ORDER)?;
    let (problem, k) = (point.problem.as_ref(), point.k());
    let (structure, space) = (problem.structure(), problem.space());
    let places = space.evenly(window.rows.max(2));
    let length = window.wavelengths * 2.0 * std::f64::consts::PI / k;
    let columns = window.columns.max(2);
    let x: Vec<f64> = (0..columns)
        .map(|i| length * i as f64 / (columns - 1) as f64)
        .collect();
    let states: Vec<Vec<f64>> = places
        .iter()
        .map(|&at| problem.base.at(at, point.pair.k))
        .collect();
    let modes = expansion.coefficients().into_iter();
    let sum = Superposition {
        problem,
        places: &places,
        states: &states,
        modes: modes.map(|(alpha, mode)| (alpha.degree(), mode)).collect(),
        amplitude,
        x: &x,
    };
    let field = |field: FieldId| PlaneField {
        name: structure.fields[field].name.clone(),
        base: sum.base(Jet::value(field)),
        linear: sum.to(1, Jet::value(field)),
        nonlinear: sum.to(ORDER, Jet::value(field)),
    };
    let derived = |expression: &Expression| {
        let at_base = |state: &Vec<f64>| expression.at_base(structure, state);
        PlaneField {
            name: expression.written.clone(),
            base: states.iter().map(at_base).collect(),
            linear: sum.of(1, expression),
            nonlinear: sum.of(ORDER, expression),
        }
    };
    let fields: Table<FieldId, PlaneField> = structure.profiles().map(field).collect();
    let derived: Vec<PlaneField> = expressions.iter().map(derived).collect();
    let pattern = Pattern {
        amplitude,
        fields,
        derived,
        y: places.iter().map(|&place| space.y(place)).collect(),
        x,
    };
    pattern.check_finite()?;
    Ok(pattern)
}

/// X⁰ + Σ A^m X[k;m] e^{ikx} over modes and their conjugates, on the grid of places and x.
struct Superposition<'a> {
    problem: &'a Problem,
    places: &'a [Place],
    states: &'a [Vec<f64>],
    /// Every mode with its degree in A.
    modes: Vec<(usize, Mode)>,
    amplitude: f64,
    x: &'a [f64],
}

impl Superposition<'_> {
    /// A jet of the base state, `[y]`.
    fn base(&self, jet: Jet) -> Vec<f64> {
        let structure = self.problem.structure();
        let value = |state: &Vec<f64>| structure.base_jet(jet, state);
        self.states.iter().map(value).collect()
    }

    /// A jet of the sum through an order, `[y][x]`.
    fn to(&self, order: usize, jet: Jet) -> Vec<Vec<f64>> {
        let base = self.base(jet);
        let modes = self.modes.iter().filter(|(degree, _)| *degree <= order);
        let profiles: Vec<(f64, Vec<C64>)> = modes
            .map(|(degree, mode)| {
                let size = self.amplitude.powi(*degree as i32);
                let profile = mode.at(self.problem, jet, self.places).into_iter();
                (mode.q.k(), profile.map(|v| v * size).collect())
            })
            .collect();
        let value = |j: usize, x: f64| {
            let part = |(q, profile): &(f64, Vec<C64>)| (profile[j] * C64::cis(q * x)).re;
            base[j] + profiles.iter().map(part).sum::<f64>()
        };
        let row = |j| self.x.iter().map(|&x| value(j, x)).collect();
        (0..base.len()).map(row).collect()
    }

    /// An expression at the sum through an order, `[y][x]`.
    fn of(&self, order: usize, expression: &Expression) -> Vec<Vec<f64>> {
        let jets = expression.jets.iter();
        let jets: Vec<Vec<Vec<f64>>> = jets.map(|&jet| self.to(order, jet)).collect();
        let value = |j: usize, i: usize| {
            let jets: Vec<f64> = jets.iter().map(|values| values[j][i]).collect();
            expression.evaluate(&self.states[j], &jets)
        };
        let row = |j: usize| (0..self.x.len()).map(|i| value(j, i)).collect();
        (0..self.states.len()).map(row).collect()
    }
}

impl PlaneField {
    fn is_finite(&self) -> bool {
        let planes = self.linear.iter().chain(&self.nonlinear).flatten();
        self.base
            .iter()
            .chain(planes)
            .all(|value| value.is_finite())
    }
}

impl Pattern {
    /// The error of a field or expression that is not finite somewhere.
    fn check_finite(&self) -> Result<()> {
        let mut fields = self.fields.iter().chain(&self.derived);
        let Some(field) = fields.find(|field| !field.is_finite()) else {
            return Ok(());
        };
        Err(Error::computation(format!(
            "`{}` has no finite value somewhere in the plane at amplitude A = {:e}; try a smaller --amplitude",
            field.name, self.amplitude
        )))
    }

    /// The field of a name, or the expression that was written so.
    pub fn quantity(&self, name: &str) -> Option<&PlaneField> {
        let mut all = self.fields.iter().chain(&self.derived);
        all.find(|field| field.name == name)
    }
}
