//! The two travelling waves of a mirror-symmetric model, to the left and to the right, and the standing wave of both.

use super::system::AmplitudeSystem;
use crate::measured::Measured;
use crate::model::C64;
use crate::series::Monomial;
use serde::Serialize;
use std::fmt;

/// Cubic coefficients of dR/dt = c0 R + (self |R|² + cross |L|²) R, and of its mirror image for L.
#[derive(Clone, Copy, Debug)]
pub struct Waves {
    /// Coefficient of |R|² R: c2 of the travelling wave.
    pub self_coefficient: Measured<C64>,
    /// Coefficient of |L|² R.
    pub cross: Measured<C64>,
}

/// Which wave is stable above onset, at cubic order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Stable {
    /// |R| alone, or |L| alone.
    Travelling,
    /// |R| = |L|
    Standing,
    /// None of the two.
    Neither,
}

impl fmt::Display for Stable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Stable::Travelling => "travelling",
            Stable::Standing => "standing",
            Stable::Neither => "neither",
        })
    }
}

impl Waves {
    /// The coefficients in the first equation of a system of two waves. `errors` are the absolute errors of its terms.
    pub fn of(system: &AmplitudeSystem, errors: &[f64]) -> Self {
        let terms = || system.equations[0].iter().zip(errors);
        let coefficient = |z: [u8; 2], conj: [u8; 2]| {
            let monomial = Monomial {
                z: z.to_vec(),
                conj: conj.to_vec(),
            };
            let term = terms().find(|(term, _)| term.monomial == monomial);
            term.map_or(Measured::new(C64::default(), 0.0), |(term, &error)| {
                Measured::new(term.g, error)
            })
        };
        Waves {
            self_coefficient: coefficient([2, 0], [1, 0]),
            cross: coefficient([1, 1], [0, 1]),
        }
    }

    /// Re (cross − self): where it is positive, the travelling wave is unstable to the opposite one.
    fn excess(&self) -> Measured {
        self.cross.re() - self.self_coefficient.re()
    }

    /// Which wave is stable above onset; `None` where errors leave that undecided.
    ///
    /// Travelling waves exist above onset where Re self < 0, and are stable where Re cross < Re self besides. Standing
    /// waves exist where Re (self + cross) < 0, and are stable where Re cross > Re self besides.
    pub fn stable(&self) -> Option<Stable> {
        let (travelling, excess) = (self.self_coefficient.re(), self.excess());
        let standing = travelling + self.cross.re();
        if travelling.is_negative() && excess.is_negative() {
            Some(Stable::Travelling)
        } else if standing.is_negative() && excess.is_positive() {
            Some(Stable::Standing)
        } else {
            let no_travelling = travelling.is_positive() || excess.is_positive();
            let no_standing = standing.is_positive() || excess.is_negative();
            (no_travelling && no_standing).then_some(Stable::Neither)
        }
    }

    /// Whether the opposite wave does not grow on the travelling wave; `None` where errors leave that undecided.
    pub fn resists_the_opposite(&self) -> Option<bool> {
        self.excess().sign().map(|sign| sign < 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::{C64, Measured, Stable, Waves};

    fn waves(itself: f64, cross: f64) -> Option<Stable> {
        let measured = |x: f64| Measured::new(C64::new(x, 1.0), 1e-3);
        Waves {
            self_coefficient: measured(itself),
            cross: measured(cross),
        }
        .stable()
    }

    #[test]
    fn what_errors_leave_undecided_is_no_verdict() {
        assert_eq!(waves(-1.0, -2.0), Some(Stable::Travelling));
        assert_eq!(waves(-1.0, 0.5), Some(Stable::Standing));
        assert_eq!(waves(1.0, -3.0), Some(Stable::Neither));
        assert_eq!(waves(1.0, 2.0), Some(Stable::Neither));
        assert_eq!(waves(-1.0, -1.0005), None);
        assert_eq!(waves(-1e-4, -2.0), None);
        assert_eq!(waves(-1.0, 1.0), None);
    }
}
