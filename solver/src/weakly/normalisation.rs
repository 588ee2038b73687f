//! The normalisation that the spec asks for, and the rule that fixes the phase.

use crate::collocation::{Grid, GridKind, clenshaw_curtis};
use crate::error::{Error, Result};
use crate::model::layout::read_measure;
use crate::model::{C64, KernelId, Measure, evaluate};
use crate::problem::{Problem, quarter_turn};

/// Sizes of a fundamental whose powers double precision can hold.
const SIZES: std::ops::Range<f64> = 1e-60..1e60;

/// The factor by which the fundamental has to be multiplied.
///
/// Its modulus meets the spec's condition. Its phase makes the profile value of largest modulus of
/// the first field real and positive, or, for a point value, that value; imaginary for a field that is odd
/// in the mirror x → −x, so that a steady pattern is its own mirror image.
///
/// # Errors
/// A mode whose normalising quantity vanishes.
pub fn normalise(problem: &Problem, k: f64, values: &[C64]) -> Result<C64> {
    let factor = unchecked(problem, k, values)?;
    let size = factor.norm() * values.iter().map(|v| v.norm()).fold(0.0, f64::max);
    if SIZES.contains(&size) {
        return Ok(factor);
    }
    Err(Error::computation(format!(
        "the normalisation {} asks for a mode of size {size:.1e}: its square and cube are out of the range of \
         double precision",
        problem.structure().amplitude.description
    )))
}

fn unchecked(problem: &Problem, k: f64, values: &[C64]) -> Result<C64> {
    let amplitude = &problem.structure().amplitude;
    let state = problem.base.point(problem.model, 0.0, k);
    let out = evaluate(problem.model, KernelId::Amplitude, &state);
    let (wanted, place) = match read_measure(amplitude, &out) {
        Measure::Point { value, place } => (value.abs(), place),
        Measure::Integral { value, .. } => (value, 0.0),
    };
    if let Some(field) = amplitude.field {
        let value = point_value(problem, values, field, place);
        if wanted.is_nan() || wanted <= 0.0 {
            return Err(vanishes(problem));
        }
        let block = &problem.direct.layout.columns[field];
        let own = &values[block.offset..][..block.len];
        if value.norm() <= 1e-12 * own.iter().map(|v| v.norm()).fold(0.0, f64::max) {
            return Err(vanishes(problem));
        }
        return Ok(turn(problem, field) * value.conj() / value.norm_sqr() * wanted);
    }
    let square = weighted_square(problem, values);
    if !(square > 0.0 && wanted > 0.0) {
        return Err(vanishes(problem));
    }
    Ok(phase(problem, values) * (wanted / square).sqrt())
}

fn vanishes(problem: &Problem) -> Error {
    Error::computation(format!(
        "the mode cannot be normalised: {} is not possible for it",
        problem.structure().amplitude.description
    ))
}

fn point_value(problem: &Problem, values: &[C64], field: usize, place: f64) -> C64 {
    let block = &problem.direct.layout.columns[field];
    let values = &values[block.offset..block.offset + block.len];
    if problem.resolution == 0 {
        return values[0];
    }
    let xi = -1.0 + (place - problem.base.lower) * problem.base.scale();
    let row = Grid::new(block.grid).interpolate_to(&[xi]);
    values
        .iter()
        .enumerate()
        .map(|(j, v)| v * row[(0, j)])
        .sum()
}

/// ∫ Σ w|q|² dy
fn weighted_square(problem: &Problem, values: &[C64]) -> f64 {
    let fields = &problem.structure().amplitude.weighted;
    let mut square = 0.0;
    for (&field, gram) in fields.iter().zip(&problem.gram) {
        let block = &problem.direct.layout.columns[field];
        let own = &values[block.offset..block.offset + block.len];
        for (j, y) in own.iter().enumerate() {
            let column = gram.col(j);
            let product: C64 = own
                .iter()
                .zip(column.iter())
                .map(|(x, g)| x.conj() * *g)
                .sum();
            square += (product * y).re;
        }
    }
    square
}

/// A grid on which products of two profiles integrate exactly.
pub fn quadrature_grid(problem: &Problem) -> GridKind {
    match problem.resolution {
        0 => GridKind::Point,
        m => GridKind::Lobatto(4 * m + 1),
    }
}

/// Weights of ∫ dy on that grid.
pub fn quadrature_weights(problem: &Problem, grid: GridKind) -> Vec<f64> {
    match grid {
        GridKind::Lobatto(n) => {
            let half = 0.5 * (problem.base.upper - problem.base.lower);
            clenshaw_curtis(n).into_iter().map(|w| w * half).collect()
        }
        _ => vec![1.0],
    }
}

fn phase(problem: &Problem, values: &[C64]) -> C64 {
    for (field, block) in problem.direct.layout.columns.iter().enumerate() {
        let own = &values[block.offset..block.offset + block.len];
        let Some(largest) = own.iter().max_by(|a, b| a.norm().total_cmp(&b.norm())) else {
            continue;
        };
        if largest.norm() > 1e-9 * values.iter().map(|v| v.norm()).fold(0.0, f64::max) {
            return turn(problem, field) * largest.conj() / largest.norm();
        }
    }
    C64::new(1.0, 0.0)
}

/// i for a field that is odd in the mirror.
fn turn(problem: &Problem, field: usize) -> C64 {
    let parity = problem.structure().parity.as_ref();
    quarter_turn(usize::from(parity.is_some_and(|p| p.fields[field])))
}
