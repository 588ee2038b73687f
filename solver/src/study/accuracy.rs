//! How far a Landau point can be trusted: errors of c0 and c2, distances from resonance, and what they leave standing.

use super::Setup;
use super::error_bars::Companions;
use super::quadrature::{adjoint_mode, second_landau};
use crate::base::BaseState;
use crate::error::{Error, Result};
use crate::measured::{Decided, Measured};
use crate::model::C64;
use crate::problem::Problem;
use crate::spectrum;
use crate::wavevector::WaveVector;
use crate::weakly::{self, AmplitudeEquation, CANCELLED_SUM, LandauPoint, Selection};
use std::slice;
use std::sync::Arc;

/// A second-order problem that is nearer to singularity than this, relative to the slow rates, has no answer
/// that rounding leaves standing.
pub const SINGULAR: f64 = 1e-8;

/// A coefficient whose error is a larger part of it is no answer, unless it is a computed zero.
pub const UNCONVERGED: f64 = 0.05;
/// Below this part of what it is the sum of, a coefficient counts as a computed zero.
const CANCELLED: f64 = 1e-6;
/// Below this M a distance from resonance is compared with that at a finer collocation.
const FEW: usize = 13;
/// Rounding errors of an eigenvalue of a whole spectrum, relative to the slow ones.
const ROUNDING: f64 = 1e-13;
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

/// Distances of the second-order problems from singularity.
#[derive(Clone, Copy, Debug)]
pub struct Resonance {
    /// min |2 a0 − λ(L_0)|, conserved directions set aside, P (5.5); infinite where no mean mode is left.
    pub mean_flow: Measured,
    /// min |2 c0 − λ(L_2)|, P (5.6).
    pub second_harmonic: Measured,
}

/// The errors of a Landau point; infinite where one of the computations beside it has no answer.
///
/// # Errors
/// A c2 by quadrature that cannot be formed.
pub fn accuracy(setup: &Setup, point: &LandauPoint) -> Result<Accuracy> {
    let companions = Companions::of(setup, &point.problem, slice::from_ref(&point.pair));
    let errors = companions.errors(&[point.c0, point.c2], |companion| {
        let beside = weakly::from_pair(&companion.problem, companion.pairs[0].clone())?;
        Ok(vec![beside.c0, beside.c2])
    });
    let [c0, c2] = [errors[0], errors[1]];
    Accuracy { c0, c2 }.beside_the_adjoint(point)
}

/// A Landau point whose coefficients are converged.
pub struct Converged {
    /// The point.
    pub point: LandauPoint,
    /// Errors of its coefficients.
    pub error: Accuracy,
}

impl Converged {
    /// The Landau point of a selected mode.
    ///
    /// # Errors
    /// A mode that is not found, a resonance, a coefficient that is not converged.
    pub fn new(setup: &Setup, base: &Arc<BaseState>, k: f64, selection: Selection) -> Result<Self> {
        let point = setup.point(base, k, selection)?;
        let error = standing(setup, &point, accuracy(setup, &point)?)?;
        Ok(Converged { point, error })
    }

    /// A_e at cubic order, or why there is none.
    pub fn amplitude(&self) -> Decided {
        let equation = AmplitudeEquation {
            coefficients: vec![
                Measured::new(self.point.c0, self.error.c0),
                Measured::new(self.point.c2, self.error.c2),
            ],
        };
        equation.equilibrium(3)
    }
}

impl Accuracy {
    /// No smaller than rounding and the difference to the second route, by the continuous adjoint.
    ///
    /// # Errors
    /// A c2 by quadrature that cannot be formed.
    pub fn beside_the_adjoint(mut self, point: &LandauPoint) -> Result<Self> {
        let [rounding0, rounding2] = point.rounding();
        self.c0 = self.c0.max(rounding0);
        self.c2 = self.c2.max(rounding2);
        // Without adjoint conditions, or where the adjoint mode hides in a cluster, one route remains.
        if let Ok(adjoint) = adjoint_mode(&point.problem, &point.pair) {
            self.c0 = self.c0.max((adjoint.c.conj() - point.c0).norm());
            if let Some(c2) = second_landau(point, &adjoint)? {
                self.c2 = self.c2.max((c2 - point.c2).norm());
            }
        }
        Ok(self)
    }
}

/// How near the second-order problems are to resonance; the errors are what a coarser collocation changes (a finer one
/// where M is small), and what the error of c0 does.
///
/// # Errors
/// Spectra that cannot be computed.
pub fn resonance(point: &LandauPoint, error0: f64) -> Result<Resonance> {
    let problem = &point.problem;
    let here = distances(problem, point)?;
    let beside = problem.resolution.map(|m| {
        let m = if m < FEW {
            m + m.div_ceil(2)
        } else {
            m - m.div_ceil(6)
        };
        let beside = Problem::new(&problem.base, Some(m))?;
        distances(&beside, point)
    });
    let measured = |index: usize| {
        let value: f64 = here[index];
        let difference = match &beside {
            Some(Ok(there)) if there[index] != value => (there[index] - value).abs(),
            Some(Err(_)) => f64::INFINITY,
            _ => 0.0,
        };
        let rounding = ROUNDING * (value + slow_rate(point));
        Measured::new(value, difference.max(rounding) + 2.0 * error0)
    };
    Ok(Resonance {
        mean_flow: measured(0),
        second_harmonic: measured(1),
    })
}

/// The distances of 2 a0 from the eigenvalues at k = 0, and of 2 c0 from those at 2k.
fn distances(problem: &Problem, point: &LandauPoint) -> Result<[f64; 2]> {
    let second = spectrum::eigenvalues(problem, 2.0 * point.pair.k)?;
    // A model whose mean modes are all closed by integrals has no mean spectrum to meet.
    let mean_flow = match spectrum::eigenvalues(problem, WaveVector::MEAN) {
        Ok(mean) => mean.distance(C64::new(2.0 * point.c0.re, 0.0)),
        Err(Error::Input(message)) => return Err(Error::Input(message)),
        Err(_) => f64::INFINITY,
    };
    Ok([mean_flow, second.distance(2.0 * point.c0)])
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

/// The errors of coefficients that they leave standing.
///
/// # Errors
/// A coefficient that is not converged.
pub fn standing(setup: &Setup, point: &LandauPoint, error: Accuracy) -> Result<Accuracy> {
    let size = point.c0.norm();
    if !stands(error.c0, size, slow_rate(point)) {
        return Err(unconverged(setup, "c0", error.c0, size));
    }
    match landau_error(point, error.c2) {
        Some(c2) => Ok(Accuracy { c2, ..error }),
        None => Err(unconverged(setup, "c2", error.c2, point.c2.norm())),
    }
}

/// What to say of a coefficient that is not converged.
pub fn unconverged(setup: &Setup, name: &str, error: f64, size: f64) -> Error {
    let how_far = match error.is_finite() {
        true if size <= error => {
            format!("it is {size:.1e} with an error of {error:.1e}")
        }
        true => format!(
            "its error is {:.1} times its size",
            error / size.max(1e-300)
        ),
        false if setup.effective_resolution().is_none() => {
            "a change of the data in the last digits has no such mode".to_owned()
        }
        false => "another resolution has no such mode".to_owned(),
    };
    let mut found = Error::unresolved(name, setup.effective_resolution(), how_far);
    if let Error::Unresolved {
        advice,
        resolution: Some(_),
        ..
    } = &mut found
        && error > 0.5 * size
    {
        *advice += "; where that does not help, another mode (--near): one that changes with every M is singular at a \
                    wall, or one of a continuous spectrum";
    }
    found
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
