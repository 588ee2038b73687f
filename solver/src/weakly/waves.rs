//! Left and right: the two travelling waves of a mirror-symmetric model, and the standing wave that they make.

use super::system::AmplitudeSystem;
use crate::measured::Measured;
use crate::model::C64;
use crate::series::Monomial;
use serde::Serialize;
use std::fmt;

/// dR/dt = c0 R + (self |R|² + cross |L|²) R, and its mirror image for L.
#[derive(Clone, Copy, Debug)]
pub struct Waves {
    /// Of |R|² R: c2 of the travelling wave.
    pub own: Measured<C64>,
    /// Of |L|² R.
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
    /// Self and cross coefficient in the equation of the first of two waves, `errors` being those of its terms.
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
            own: coefficient([2, 0], [1, 0]),
            cross: coefficient([1, 1], [0, 1]),
        }
    }

    /// Re (cross − self): where it is positive, the travelling wave is unstable to the other one.
    fn excess(&self) -> Measured {
        self.cross.re() - self.own.re()
    }

    /// Travelling waves exist above onset where Re self < 0, and are stable where besides Re cross < Re self; standing
    /// ones exist where Re (self + cross) < 0, and are stable where besides Re cross > Re self. Nothing where errors
    /// leave it undecided.
    pub fn stable(&self) -> Option<Stable> {
        let (own, excess) = (self.own.re(), self.excess());
        let sum = own + self.cross.re();
        if own.is_negative() && excess.is_negative() {
            Some(Stable::Travelling)
        } else if sum.is_negative() && excess.is_positive() {
            Some(Stable::Standing)
        } else {
            let no_travelling = own.is_positive() || excess.is_positive();
            let no_standing = sum.is_positive() || excess.is_negative();
            (no_travelling && no_standing).then_some(Stable::Neither)
        }
    }

    /// Whether the travelling wave resists the one to the other side; nothing where errors leave it undecided.
    pub fn resists_the_opposite(&self) -> Option<bool> {
        self.excess().sign().map(|sign| sign < 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::{C64, Measured, Stable, Waves};

    fn waves(own: f64, cross: f64) -> Option<Stable> {
        let measured = |x: f64| Measured::new(C64::new(x, 1.0), 1e-3);
        Waves {
            own: measured(own),
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
