//! How far a Landau point can be trusted.
//!
//! Differences that truncation, rounding and the base state's own error show themselves in: another M,
//! M + 1 (which rounds differently), the base state at the next degree, the continuous adjoint; and what a
//! relative change of the data by the machine's precision does.

use super::Setup;
use super::quadrature::{adjoint_mode, second_landau};
use crate::base::BaseState;
use crate::error::{Error, Result};
use crate::model::C64;
use crate::problem::Problem;
use crate::spectrum;
use crate::weakly::{self, CANCELLED_SUM, LandauPoint};
use std::sync::Arc;

/// A relative change of k, small enough for its effect to be linear, and large against rounding.
const NUDGE: f64 = 1e-6;
/// Rounding errors of the data that a result is allowed to be wrong by, in units of the machine's precision.
const ROUNDINGS: f64 = 32.0;
/// Safety factors of two differences that show rounding, which is as good as random.
const SAFETY: f64 = 5.0;

/// A second-order problem that is nearer to singularity than this, relative to the slow rates, has no answer
/// that rounding leaves standing.
pub const SINGULAR: f64 = 1e-8;

/// A coefficient whose error is a larger part of it is no answer, unless it is a computed zero.
pub const UNCONVERGED: f64 = 0.05;
/// Below this part of what it is the sum of, a coefficient counts as a computed zero.
const CANCELLED: f64 = 1e-6;
/// An error that is a larger part of c2 may be that of a c2 of rounding alone.
const SUSPECT: f64 = 1e-4;

/// Absolute errors of c0 and c2.
#[derive(Clone, Copy, Debug)]
pub struct Accuracy {
    /// Of c0.
    pub c0: f64,
    /// Of c2.
    pub c2: f64,
}

impl Accuracy {
    /// At least the difference of two computations, times a factor of safety.
    fn widen(&mut self, factor: f64, point: &LandauPoint, (c0, c2): (C64, C64)) {
        let wider = |error: f64, difference: f64| {
            if difference.is_finite() {
                error.max(factor * difference)
            } else {
                f64::INFINITY
            }
        };
        self.c0 = wider(self.c0, (c0 - point.c0).norm());
        self.c2 = wider(self.c2, (c2 - point.c2).norm());
    }
}

/// Distances of the second-order problems from singularity.
#[derive(Clone, Copy, Debug)]
pub struct Resonance {
    /// min |2 a0 − λ(L_0)|, conserved directions set aside, P (5.5).
    pub mean_flow: f64,
    /// min |2 c0 − λ(L_2)|, P (5.6).
    pub second_harmonic: f64,
}

/// The errors of a Landau point; infinite where one of the computations beside it has no answer.
///
/// # Errors
/// A c2 by quadrature that cannot be formed.
pub fn accuracy(setup: &Setup, point: &LandauPoint) -> Result<Accuracy> {
    let [c0, c2] = point.rounding();
    let mut found = Accuracy { c0, c2 };
    let k = point.k();
    let problem = &point.problem;
    let missing = (C64::new(f64::INFINITY, 0.0), C64::new(f64::INFINITY, 0.0));
    // |dc/dk| k ε, wherever c2 is sensitive, near a resonance too.
    let nudged = spectrum::follow(problem, k * (1.0 + NUDGE), &point.pair)
        .and_then(|pair| weakly::from_pair(problem, pair))
        .map_or(missing, |p| (p.c0, p.c2));
    found.widen(ROUNDINGS * f64::EPSILON / NUDGE, point, nudged);
    let (m, base) = (setup.effective_resolution(), &problem.base);
    if let Some((m, finer)) = m.zip(setup.finer_resolution()) {
        let near = beside(base, point, Some(m + 1)).unwrap_or(missing);
        found.widen(SAFETY, point, near);
        let finer = beside(base, point, Some(finer)).unwrap_or(missing);
        found.widen(1.0, point, finer);
    }
    if let Some(refined) = base.refined() {
        let same = beside(&Arc::new(refined), point, m).unwrap_or(missing);
        found.widen(SAFETY, point, same);
    }
    // Without adjoint conditions, or where the adjoint mode hides in a cluster, one route remains.
    if let Ok(adjoint) = adjoint_mode(problem, &point.pair) {
        found.c0 = found.c0.max((adjoint.c.conj() - point.c0).norm());
        if let Some(c2) = second_landau(point, &adjoint)? {
            found.c2 = found.c2.max((c2 - point.c2).norm());
        }
    }
    Ok(found)
}

/// c0 and c2 of the same mode on another collocation, or another base state.
pub fn beside(
    base: &Arc<BaseState>,
    point: &LandauPoint,
    resolution: Option<usize>,
) -> Result<(C64, C64)> {
    let other = Arc::new(Problem::new(base, resolution)?);
    let pair = spectrum::transferred(&point.problem, &point.pair, &other)?;
    let point = weakly::from_pair(&other, pair)?;
    Ok((point.c0, point.c2))
}

/// How near the second-order problems are to resonance.
///
/// # Errors
/// Spectra that cannot be computed.
pub fn resonance(point: &LandauPoint) -> Result<Resonance> {
    let problem = &point.problem;
    let second = spectrum::eigenvalues(problem, 2.0 * point.k())?;
    // A model whose mean modes are all closed by integrals has no mean spectrum to meet.
    let mean_flow = match spectrum::eigenvalues(problem, 0.0) {
        Ok(mean) => mean.distance(C64::new(2.0 * point.c0.re, 0.0)),
        Err(Error::Input(message)) => return Err(Error::Input(message)),
        Err(_) => f64::INFINITY,
    };
    Ok(Resonance {
        mean_flow,
        second_harmonic: second.distance(2.0 * point.c0),
    })
}

/// Whether an error leaves a coefficient of some size standing; `sum` is what its terms have the size of.
pub fn stands(error: f64, size: f64, sum: f64) -> bool {
    error <= (UNCONVERGED * size).max(CANCELLED * sum)
}

/// Whether a coefficient is zero within an error that is small against `sum`, what its terms would sum to did nothing
/// cancel.
pub fn vanishes(error: f64, size: f64, sum: f64) -> bool {
    size <= error && error <= CANCELLED * sum
}

/// The error of c2, rounding where products cancel included; nothing where it leaves no c2 standing.
pub fn landau_error(point: &LandauPoint, error: f64) -> Option<f64> {
    let size = point.c2.norm();
    if size > 0.0 && error <= SUSPECT * size {
        return Some(error);
    }
    let sum = point.uncancelled();
    let error = error.max(CANCELLED_SUM * sum);
    let known = stands(error, size, point.size()) || vanishes(error, size, sum);
    known.then_some(error)
}

/// What a distance from singularity is small or large against: the slow eigenvalues, or the terms of the slowest
/// balance where there are too few of them to tell.
pub fn slow_rate(point: &LandauPoint) -> f64 {
    let pair = &point.pair;
    let rate = point.problem.rate(pair.k);
    let floor = if rate.is_finite() { rate } else { 0.0 };
    pair.scale.max(pair.c.norm()).max(floor)
}

#[cfg(test)]
mod tests {
    use super::{stands, vanishes};

    /// A coefficient that cancels to a millionth of its terms, and is known no better than to its own size, is no zero.
    #[test]
    fn a_cancelled_coefficient_is_no_zero() {
        assert!(vanishes(3e-16, 1e-17, 1.0));
        assert!(!vanishes(0.9, 1.0, 1e6));
        assert!(!stands(0.9, 1.0, 1.0));
        assert!(!vanishes(1e-3, 1e-4, 1.0));
        assert!(!vanishes(f64::NAN, 0.0, 1.0) && !stands(f64::INFINITY, 1.0, 1.0));
    }
}
