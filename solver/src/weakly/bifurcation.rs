//! The kind of a bifurcation, as far as the errors of its coefficients leave it decided.

use crate::model::C64;
use serde::{Deserialize, Serialize};
use std::fmt;

/// The side on which the bifurcating solution lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Side {
    /// Re c2 < 0
    Supercritical,
    /// Re c2 > 0
    Subcritical,
    /// Re c2 is zero within its error: the next order decides.
    Degenerate,
}

/// The side on which the bifurcating solution lies, and whether it oscillates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Bifurcation {
    /// Where the bifurcating solution lies.
    pub side: Side,
    /// Whether a pair of complex eigenvalues crosses the axis (Hopf), rather than a real one (pitchfork).
    pub oscillatory: bool,
}

impl Bifurcation {
    /// The bifurcation with these c0 and c2, each with its absolute error.
    pub fn new((c0, error0): (C64, f64), (c2, error2): (C64, f64)) -> Self {
        let side = if c2.re.abs() <= error2 {
            Side::Degenerate
        } else if c2.re < 0.0 {
            Side::Supercritical
        } else {
            Side::Subcritical
        };
        Bifurcation {
            side,
            oscillatory: c0.im.abs() > error0,
        }
    }
}

impl fmt::Display for Bifurcation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let side = match self.side {
            Side::Supercritical => "supercritical",
            Side::Subcritical => "subcritical",
            Side::Degenerate => "degenerate",
        };
        let kind = if self.oscillatory {
            "Hopf"
        } else {
            "pitchfork"
        };
        write!(f, "{side} {kind}")
    }
}

/// A_e = √(−a0/a2), P (4.1), from c0 and c2 with their absolute errors. `None` where a0 or a2 is zero within its error, or
/// both have one sign.
pub fn equilibrium((c0, error0): (C64, f64), (c2, error2): (C64, f64)) -> Option<f64> {
    let decided = c0.re.abs() > error0 && c2.re.abs() > error2;
    let square = -c0.re / c2.re;
    (decided && square.is_finite() && square > 0.0).then(|| square.sqrt())
}

#[cfg(test)]
mod tests {
    use super::{Bifurcation, C64, equilibrium};

    #[test]
    fn kinds() {
        let kind = |c0: C64, c2: f64| {
            Bifurcation::new((c0, 1e-12), (C64::new(c2, 0.0), 1e-12)).to_string()
        };
        assert_eq!(kind(C64::new(0.1, 0.0), -1.0), "supercritical pitchfork");
        assert_eq!(kind(C64::new(0.1, 1e-16), 1.0), "subcritical pitchfork");
        assert_eq!(kind(C64::new(0.1, 0.3), 1e-14), "degenerate Hopf");
    }

    #[test]
    fn amplitudes_need_decided_signs() {
        let at =
            |a0: f64, a2: f64| equilibrium((C64::new(a0, 0.0), 1e-12), (C64::new(a2, 0.0), 1e-12));
        assert_eq!(at(0.04, -4.0), Some(0.1));
        assert_eq!(at(0.04, 4.0), None);
        assert_eq!(at(1e-14, -4.0), None);
        assert_eq!(at(0.04, -1e-14), None);
    }
}
