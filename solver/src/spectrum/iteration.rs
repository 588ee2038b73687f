//! A mode refined, or followed, by inverse iteration.

use super::EigenPair;
use crate::model::C64;
use crate::numerics::dense::{Scalar, dot, norm, scalars};
use crate::numerics::{Applied, beside, inverse_iteration};
use crate::problem::{Combination, Problem, Turned};
use crate::wavevector::WaveVector;

/// The mode that continues `near`, if the iteration finds one.
pub(super) fn continued(problem: &Problem, k: WaveVector, near: &EigenPair) -> Option<EigenPair> {
    let shift = predict(problem, k, near);
    refine(problem, k, shift, near.scale, &near.right, &near.left)
}

/// yᴴ L x / yᴴ M0 x with the vectors found nearby: off by the square of the distance.
fn predict(problem: &Problem, k: WaveVector, near: &EigenPair) -> C64 {
    let c = if problem.is_real() && near.c.im == 0.0 {
        quotient::<f64>(problem, k, near)
    } else {
        quotient::<C64>(problem, k, near)
    };
    beside(if c.norm().is_finite() { c } else { near.c }, near.scale)
}

fn quotient<T: Scalar>(problem: &Problem, k: WaveVector, near: &EigenPair) -> C64 {
    let (right, left): (Vec<T>, Vec<T>) = (scalars(&near.right), scalars(&near.left));
    let operator = problem.direct.blocks::<T>(k, Combination::OPERATOR);
    let above = dot(&left, &operator.apply(&right));
    above / dot(&left, &problem.direct.mass::<T>(k).apply(&right))
}

/// |cosine| of the angle between two shapes.
pub fn likeness(a: &[C64], b: &[C64]) -> f64 {
    if a.len() != b.len() {
        return 0.0;
    }
    dot(a, b).norm() / (norm(a) * norm(b)).max(1e-300)
}

/// Two-sided inverse iteration with one factorisation at `shift`, in real arithmetic where that is possible.
pub(super) fn refine(
    problem: &Problem,
    k: WaveVector,
    shift: C64,
    scale: f64,
    right: &Turned,
    left: &Turned,
) -> Option<EigenPair> {
    if problem.is_real() && shift.im.abs() <= 1e-12 * shift.norm().max(1e-6 * scale) {
        let real = C64::new(shift.re, 0.0);
        if let Some(pair) = iterate::<f64>(problem, k, real, scale, (right, left)) {
            return Some(pair);
        }
    }
    iterate::<C64>(problem, k, shift, scale, (right, left))
}

fn iterate<T: Scalar>(
    problem: &Problem,
    k: WaveVector,
    shift: C64,
    scale: f64,
    (right, left): (&Turned, &Turned),
) -> Option<EigenPair> {
    let starts = (phased::<T>(right), phased(left));
    let shifted = problem.shifted::<T>(k, shift);
    let mass = problem.direct.mass::<T>(k);
    let found = inverse_iteration(shifted, &mass, shift, scale, starts)?;
    let known = problem.carrier(&mass, &found.right, &found.left);
    let mut right = Turned(found.right).complex();
    let left = Turned(found.left).complex();
    problem.clear_absent(k, found.c, &mut right, known);
    Some(EigenPair {
        k,
        c: found.c,
        right,
        left,
        scale,
    })
}

/// A vector with its largest entry turned real: a real mode may come with a complex factor.
fn phased<T: Scalar>(x: &[C64]) -> Vec<T> {
    let largest = x
        .iter()
        .max_by(|a, b| a.norm().total_cmp(&b.norm()))
        .copied();
    let phase = largest
        .filter(|l| l.norm() > 0.0)
        .map_or(C64::new(1.0, 0.0), |l| l.conj() / l.norm());
    x.iter().map(|v| T::from_complex(v * phase)).collect()
}
