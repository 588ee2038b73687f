//! Left and right: the two travelling waves of a mirror-symmetric model, and the standing wave that they make.

use super::system::AmplitudeSystem;
use crate::model::C64;
use crate::series::Monomial;
use serde::Serialize;
use std::fmt;

/// dR/dt = c0 R + (self |R|² + cross |L|²) R, and its mirror image for L.
#[derive(Clone, Copy, Debug)]
pub struct Waves {
    /// Of |R|² R: c2 of the travelling wave.
    pub own: C64,
    /// Of |L|² R.
    pub cross: C64,
    /// Absolute error of both.
    pub error: f64,
}

/// Which wave is stable above onset, at cubic order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Stable {
    /// |R| alone, or |L| alone.
    Travelling,
    /// |R| = |L|
    Standing,
    /// None of the two, or undecided.
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
        let [own, cross] = [([2, 0], [1, 0]), ([1, 1], [0, 1])].map(|(z, conj)| Monomial {
            z: z.to_vec(),
            conj: conj.to_vec(),
        });
        let coefficient = |monomial| system.coefficient(0, monomial).unwrap_or_default();
        Waves {
            own: coefficient(&own),
            cross: coefficient(&cross),
            error: errors.iter().skip(1).copied().fold(0.0, f64::max),
        }
    }

    /// Travelling waves exist above onset where Re self < 0, and are stable where besides Re cross < Re self;
    /// standing ones where Re (self + cross) < 0, and Re cross > Re self. What the error leaves undecided is neither.
    pub fn stable(&self) -> Stable {
        let (own, cross) = (self.own.re, self.cross.re);
        let below = |x: f64| x < -self.error;
        if below(own) && below(cross - own) {
            Stable::Travelling
        } else if below(own + cross) && below(own - cross) {
            Stable::Standing
        } else {
            Stable::Neither
        }
    }
}
