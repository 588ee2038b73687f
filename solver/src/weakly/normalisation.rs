//! The normalisation that the spec asks for, and the rule that fixes the phase.

use crate::error::{Error, Result};
use crate::model::layout::read_measure;
use crate::model::{C64, FieldId, KernelId, Measure, evaluate};
use crate::problem::{Problem, Profile, Turn};
use crate::space::Place;
use crate::wavevector::WaveVector;

/// Sizes of a fundamental whose square and cube, and the second-order modes they force, stay within double precision
/// (10⁻³⁰⁸ to 10³⁰⁸).
const SIZES: std::ops::Range<f64> = 1e-60..1e60;

/// The factor by which the eigenvector `values` has to be multiplied to become X[1;1].
///
/// Its modulus meets the condition of the spec's block `amplitude`. Its phase makes one value real and positive: the
/// point value of that condition, or the largest value of the first field that is present. For a field that is odd in
/// the mirror x → −x it makes that value imaginary, so that a steady pattern equals its mirror image.
///
/// # Errors
/// The quantity that is to be normalised vanishes, its place lies outside of the interval, or X[1;1] would be out of the
/// range of double precision.
pub fn normalise(problem: &Problem, k: WaveVector, values: &Profile) -> Result<C64> {
    let factor = unchecked(problem, k, values)?;
    let size = factor.norm() * values.largest();
    if SIZES.contains(&size) {
        return Ok(factor);
    }
    Err(Error::computation(format!(
        "the normalisation {} asks for a mode of size {size:.1e}: its square and cube are out of the range of \
         double precision",
        problem.structure().amplitude.description
    )))
}

/// [`normalise`] without the check of the size.
fn unchecked(problem: &Problem, k: WaveVector, values: &Profile) -> Result<C64> {
    let amplitude = &problem.structure().amplitude;
    let state = problem.base.at(Place::MIDDLE, k);
    let out = evaluate(problem.model(), KernelId::Amplitude, &state);
    let (wanted, place) = match read_measure(amplitude, &out) {
        Measure::Point { value, place } => (value.abs(), place),
        Measure::Integral { value, .. } => (value, 0.0),
    };
    if let Some(field) = amplitude.field {
        if let Some([low, high]) = problem.space().ends()
            && !(low..=high).contains(&place)
        {
            return Err(Error::input(format!(
                "the block `amplitude` names the place {place}, which lies outside of the interval {low}..{high}: {}",
                amplitude.description
            )));
        }
        let value = point_value(problem, values, field, place);
        if wanted.is_nan() || wanted <= 0.0 {
            return Err(vanishes(problem));
        }
        // Relative to the largest value of the field: at a node of the mode there is rounding alone.
        let profile = problem.direct.layout.columns[field].of(values);
        if value.norm() <= 1e-12 * profile.iter().map(|v| v.norm()).fold(0.0, f64::max) {
            return Err(vanishes(problem));
        }
        return Ok(phase_of(problem, field) * value.conj() / value.norm_sqr() * wanted);
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

fn point_value(problem: &Problem, values: &Profile, field: FieldId, place: f64) -> C64 {
    let (space, block) = (problem.space(), &problem.direct.layout.columns[field]);
    let profile = block.of(values);
    space.interpolated(block.points, profile, &[space.place(place)])[0]
}

/// ∫ Σ w|q|² dy
fn weighted_square(problem: &Problem, values: &Profile) -> f64 {
    let fields = &problem.structure().amplitude.weighted;
    let mut square = 0.0;
    for (&field, gram) in fields.iter().zip(&problem.gram) {
        let profile = problem.direct.layout.columns[field].of(values);
        for (j, y) in profile.iter().enumerate() {
            let column = gram.col(j);
            let product: C64 = profile
                .iter()
                .zip(column.iter())
                .map(|(x, g)| x.conj() * *g)
                .sum();
            square += (product * y).re;
        }
    }
    square
}

/// The phase factor that turns the largest value of the first field that is present, above 10⁻⁹ of all.
fn phase(problem: &Problem, values: &Profile) -> C64 {
    for (field, block) in problem.direct.layout.columns.pairs() {
        let profile = block.of(values).iter();
        let Some(largest) = profile.max_by(|a, b| a.norm().total_cmp(&b.norm())) else {
            continue;
        };
        if largest.norm() > 1e-9 * values.largest() {
            return phase_of(problem, field) * largest.conj() / largest.norm();
        }
    }
    C64::new(1.0, 0.0)
}

/// i for a field that is odd in the mirror x → −x, 1 for any other.
fn phase_of(problem: &Problem, field: FieldId) -> C64 {
    let parity = problem.structure().parity.as_ref();
    Turn::of(parity.is_some_and(|p| p.fields[field])).factor()
}
