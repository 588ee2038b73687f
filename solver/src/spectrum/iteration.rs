//! Two-sided inverse iteration.

use super::EigenPair;
use crate::dense::{Factorised, Scalar, dot, norm, scalars, scaled};
use crate::model::C64;
use crate::problem::Problem;

const MOST_ITERATIONS: usize = 30;

/// The mode that continues `near`, if the iteration finds one.
pub(super) fn continued(problem: &Problem, k: f64, near: &EigenPair) -> Option<EigenPair> {
    let shift = predict(problem, k, near);
    refine(problem, k, shift, near.scale, &near.right, &near.left)
}

/// yᴴ L x / yᴴ M0 x with the vectors found nearby: off by the square of the distance.
fn predict(problem: &Problem, k: f64, near: &EigenPair) -> C64 {
    let c = if problem.is_real() && near.c.im == 0.0 {
        quotient::<f64>(problem, k, near)
    } else {
        quotient::<C64>(problem, k, near)
    };
    beside(if c.norm().is_finite() { c } else { near.c }, near.scale)
}

fn quotient<T: Scalar>(problem: &Problem, k: f64, near: &EigenPair) -> C64 {
    let (right, left): (Vec<T>, Vec<T>) = (scalars(&near.right), scalars(&near.left));
    let above = dot(&left, &problem.operator::<T>(k).apply(&right));
    above / dot(&left, &problem.mass::<T>(k).apply(&right))
}

/// A shift next to an eigenvalue: off it by a little, so that the matrix can be factorised.
pub fn beside(c: C64, scale: f64) -> C64 {
    c + C64::new(1e-7 * c.norm().max(1e-3 * scale), 0.0)
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
    k: f64,
    shift: C64,
    scale: f64,
    right: &[C64],
    left: &[C64],
) -> Option<EigenPair> {
    if problem.is_real() && shift.im.abs() <= 1e-12 * shift.norm().max(1e-6 * scale) {
        let real = C64::new(shift.re, 0.0);
        let (right, left) = (turned::<f64>(right), turned::<f64>(left));
        if let Some(pair) = iterate(problem, k, real, scale, right, left) {
            return Some(pair);
        }
    }
    iterate(problem, k, shift, scale, turned::<C64>(right), turned(left))
}

/// A vector with its largest entry turned real: a real mode may come with a complex factor.
fn turned<T: Scalar>(x: &[C64]) -> Vec<T> {
    let largest = x
        .iter()
        .max_by(|a, b| a.norm().total_cmp(&b.norm()))
        .copied();
    let phase = largest
        .filter(|l| l.norm() > 0.0)
        .map_or(C64::new(1.0, 0.0), |l| l.conj() / l.norm());
    x.iter().map(|v| T::from_complex(v * phase)).collect()
}

fn iterate<T: Scalar>(
    problem: &Problem,
    k: f64,
    shift: C64,
    scale: f64,
    mut x: Vec<T>,
    mut y: Vec<T>,
) -> Option<EigenPair> {
    let mass = problem.mass::<T>(k);
    let factorised = Factorised::new(problem.shifted::<T>(k, shift));
    let mut mass_x = mass.apply(&x);
    let mut mass_y = mass.apply_adjoint(&y);
    let (mut c, mut change) = (shift, f64::INFINITY);
    for iteration in 0..MOST_ITERATIONS {
        let new_x = factorised.solve(&mass_x);
        let new_y = factorised.solve_adjoint(&mass_y);
        let (size_x, size_y) = (norm(&new_x), norm(&new_y));
        if !(size_x.is_finite() && size_y.is_finite()) || size_x == 0.0 || size_y == 0.0 {
            return None;
        }
        let new_mass_x = mass.apply(&new_x);
        // (σ M0 − L) x_new = M0 x_old
        let denominator = dot(&new_y, &new_mass_x);
        if denominator.norm() == 0.0 {
            return None;
        }
        let next = shift - dot(&new_y, &mass_x) / denominator;
        x = scaled(&new_x, 1.0 / size_x);
        y = scaled(&new_y, 1.0 / size_y);
        mass_x = scaled(&new_mass_x, 1.0 / size_x);
        mass_y = mass.apply_adjoint(&y);
        let step = (next - c).norm();
        c = next;
        // The eigenvalue converges twice as fast as the vectors: one more turn after it settles.
        let floor = 1e-14 * c.norm().max((shift - c).norm()) + 1e-17 * scale;
        if iteration > 0
            && (step <= floor
                || (step < 1e-10 * c.norm().max(1e-6 * scale) && step >= 0.5 * change))
        {
            let complex = |v: Vec<T>| v.into_iter().map(Scalar::complex).collect();
            return Some(EigenPair {
                k,
                c,
                right: complex(x),
                left: complex(y),
                scale,
            });
        }
        change = step;
    }
    None
}
