//! Critical points along an axis: where growth or c2 changes sign, where c2 jumps through infinity; and the extremum
//! over k of a neutral curve.

mod crest;
mod extremum;
mod first;
mod grid;
mod hills;
mod newton;
mod question;
mod report;
mod sampler;
mod scan;
mod summit;
mod survey;

pub(super) use extremum::RootOn;
pub use extremum::{Extremal, minimise};
pub(super) use newton::Root;
pub use question::{Question, Request, Tracking, Wavenumber};
pub use report::{CriticalReport, Curve};
pub use scan::{Place, Scan, scan};

use super::{Progress, Setup};
use crate::error::Result;
use crate::model::C64;

/// Relative accuracy of roots.
const TOLERANCE: f64 = 1e-12;
/// What counts as zero of a quantity, relative to its size: of the growth rate, to the slow eigenvalues.
const ROUNDING: f64 = 1e-12;
/// A mode that grows faster than a neutral one by more than this, relative to the slow eigenvalues, leads.
const LEADS: f64 = 1e-9;
/// A root that another M moves by a larger part of it is not converged.
const UNRESOLVED: f64 = 1e-2;

/// What changes sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Re c0
    Growth,
    /// Re c2
    C2,
    /// 1/c2: where 2 c0(k) meets an eigenvalue at 2k.
    Resonance,
}

impl Quantity {
    /// As the command line and its answers call it.
    pub fn name(self) -> &'static str {
        match self {
            Quantity::Growth => "growth",
            Quantity::C2 => "c2",
            Quantity::Resonance => "resonance",
        }
    }

    /// What passes through zero, as a formula.
    pub fn symbol(self) -> &'static str {
        match self {
            Quantity::Growth => "a0",
            Quantity::C2 => "a2",
            Quantity::Resonance => "1/a2",
        }
    }
}

/// A critical point.
#[derive(Clone, Debug)]
pub struct Critical {
    /// Where along the axis.
    pub value: f64,
    /// Absolute error of the value: where another collocation puts it.
    pub error: f64,
    /// The wavenumber.
    pub k: f64,
    /// Its absolute error; zero where it was given.
    pub k_error: f64,
    /// The eigenvalue there.
    pub c0: C64,
    /// Its absolute error: how far it is from that of another collocation at the root there.
    pub c0_error: f64,
    /// The growth rate of the mode that grows fastest there, at the same wavenumber.
    pub leading_growth: f64,
    /// Size of the slow eigenvalues there, against which a growth rate is as good as zero.
    pub scale: f64,
}

impl Critical {
    /// Whether another mode grows faster at the critical point.
    pub fn is_overtaken(&self) -> bool {
        self.leading_growth > self.c0.re + self.c0_error.max(LEADS * self.scale)
    }
}

/// All critical points that a question asks for, in order from `from` to `to`; one where it asks for the extremum over k.
///
/// # Errors
/// As [`scan`] and [`minimise`], and an interval without a critical point.
pub fn critical(
    setup: &Setup,
    question: &Question,
    progress: &dyn Progress,
) -> Result<Vec<Critical>> {
    match question.wavenumber() {
        Wavenumber::Range(..) => Ok(vec![minimise(setup, question, progress)?.critical]),
        _ => scan(setup, question, progress)?.critical(question),
    }
}
