//! A mode refined, or followed, by inverse iteration.

use super::EigenPair;
use crate::model::C64;
use crate::numerics::dense::{Scalar, dot, norm, scalars};
use crate::numerics::{Applied, beside, inverse_iteration};
use crate::problem::{Combination, Problem, Turned};
use crate::wavevector::WaveVector;

/// The mode to which inverse iteration converges from `near`, a mode of the same layout; `None` where it does not.
pub(super) fn continued(problem: &Problem, k: WaveVector, near: &EigenPair) -> Option<EigenPair> {
    let shift = predict(problem, k, near);
    refine(problem, k, shift, near.scale, &near.right, &near.left)
}

/// A shift beside yᴴ L x / yᴴ M0 x, with the vectors of `near`. The error of that eigenvalue is quadratic in the error of
/// the vectors.
fn predict(problem: &Problem, k: WaveVector, near: &EigenPair) -> C64 {
    let c = if problem.is_real() && near.c.im == 0.0 {
        quotient::<f64>(problem, k, near)
    } else {
        quotient::<C64>(problem, k, near)
    };
    beside(if c.norm().is_finite() { c } else { near.c }, near.scale)
}

/// yᴴ L x / yᴴ M0 x at k with the vectors of `near`.
fn quotient<T: Scalar>(problem: &Problem, k: WaveVector, near: &EigenPair) -> C64 {
    let (right, left): (Vec<T>, Vec<T>) = (scalars(&near.right), scalars(&near.left));
    let operator = problem.direct.blocks::<T>(k, Combination::OPERATOR);
    let above = dot(&left, &operator.apply(&right));
    above / dot(&left, &problem.direct.mass::<T>(k).apply(&right))
}

/// |Cosine| of the angle between two vectors; zero where their lengths differ.
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

/// [`refine`] in the arithmetic of `T`.
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
    let eigen = inverse_iteration(shifted, &mass, shift, scale, starts)?;
    let sources = problem.carrier(&mass, &eigen.right, &eigen.left);
    let mut right = Turned(eigen.right).complex();
    let left = Turned(eigen.left).complex();
    problem.clear_absent(k, eigen.c, &mut right, sources);
    Some(EigenPair {
        k,
        c: eigen.c,
        right,
        left,
        scale,
    })
}

/// A vector turned so that its largest entry is real. A real mode may come with a complex factor, which real arithmetic
/// would cut off.
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
