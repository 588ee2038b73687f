//! Modes followed along an axis of wavenumbers.

use super::called;
use landau_solver::error::Result;
use landau_solver::problem::Problem;
use landau_solver::spectrum::EigenPair;
use landau_solver::wavevector::WaveVector;
use landau_solver::weakly::{Selection, select};

/// The value at each place of an axis, the modes at multiples of k being followed along it; why there is none where there
/// is none.
pub(super) fn along<R>(
    problem: &Problem,
    places: &[f64],
    value: impl Fn(Vec<EigenPair>) -> Result<R>,
    multiples: &[f64],
) -> Vec<Result<R>> {
    let mut last: Option<Vec<EigenPair>> = None;
    let mut values = Vec::new();
    for &k in places {
        let pairs: Result<Vec<EigenPair>> = multiples
            .iter()
            .enumerate()
            .map(|(j, multiple)| {
                let near = last.as_ref().map(|pairs| Selection::Like(&pairs[j]));
                let q = WaveVector::wave(multiple * k)?;
                select(problem, q, near.unwrap_or(Selection::Leading))
            })
            .collect();
        values.push(pairs.and_then(|pairs| {
            last = Some(pairs.clone());
            value(pairs)
        }));
    }
    values
}

/// Why a case has no place at all with a value: the reason of its first.
pub(super) fn nothing_in<R>(label: &str, values: &[Result<R>]) -> Option<String> {
    let first = values.first().and_then(|value| value.as_ref().err())?;
    let count = values.len();
    let none = values.iter().all(Result::is_err);
    let label = called(label);
    none.then(|| format!("{label}: none of {count} places came out; the first: {first}"))
}
