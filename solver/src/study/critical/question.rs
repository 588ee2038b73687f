//! A question about critical points, checked before anything is computed.

use super::super::{Axis, Setup};
use super::{Critical, Quantity};
use crate::error::{Error, Result};
use crate::model::C64;
use crate::wavevector::WaveVector;
use crate::words::brief;

/// Which mode a question is about.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Tracking {
    /// At every place the mode that grows fastest there.
    #[default]
    Leading,
    /// One mode by its shape: that which grows fastest anywhere on the axis.
    Fastest,
    /// One mode by its shape: that nearest to this eigenvalue where it is first found.
    Near(C64),
}

impl Tracking {
    /// One mode by its shape.
    pub fn follows(self) -> bool {
        self != Tracking::Leading
    }
}

/// What wavenumbers a question is about.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wavenumber {
    /// k is what varies.
    Varies,
    /// One wavenumber.
    At(f64),
    /// The extremum over a range of k.
    Range(f64, f64),
}

/// The least length of an interval: below it products of its parts underflow.
const LEAST_SPAN: f64 = 1e-150;

/// A question as a user puts it.
#[derive(Clone, Copy, Debug)]
pub struct Request<'a> {
    /// `k` or the name of the parameter that varies.
    pub vary: &'a str,
    /// Where it begins and ends, in either order.
    pub between: [f64; 2],
    /// What has to change sign.
    pub of: Quantity,
    /// The fixed wavenumber, where a parameter varies.
    pub k: Option<f64>,
    /// The range of k over which the extremum is asked for, where a parameter varies.
    pub minimize: Option<[f64; 2]>,
    /// The mode.
    pub tracking: Tracking,
}

/// A question that makes sense for a model.
#[derive(Clone, Copy, Debug)]
pub struct Question {
    axis: Axis,
    from: f64,
    to: f64,
    quantity: Quantity,
    wavenumber: Wavenumber,
    tracking: Tracking,
}

impl Question {
    /// Checks a request.
    ///
    /// # Errors
    /// An axis that the model does not have; an interval that is none, or leaves the parameter's range; wavenumbers that
    /// are missing, given twice, no positive numbers, or out of order.
    pub fn new(setup: &Setup, request: &Request) -> Result<Self> {
        let axis = Axis::named(setup.model.as_ref(), request.vary)?;
        axis.check_continuous(setup.model.structure())?;
        setup.check_free(axis, None)?;
        let [from, to] = request.between;
        let span = (to - from).abs();
        if !(LEAST_SPAN..f64::INFINITY).contains(&span) {
            let reason = if !from.is_finite() || !to.is_finite() {
                "--from and --to accept finite numbers".to_owned()
            } else if span > LEAST_SPAN {
                format!("the difference has to be a number, below {:.1e}", f64::MAX)
            } else if from == to {
                "give two different numbers, --from and --to".to_owned()
            } else {
                format!("the difference has to be at least {LEAST_SPAN:e}")
            };
            return Err(Error::input(format!(
                "`{}` cannot vary from {} to {}: {reason}",
                request.vary,
                brief(from),
                brief(to)
            )));
        }
        for value in [from, to] {
            if axis == Axis::Wavenumber {
                WaveVector::wave(value)?;
            }
            setup.moved(axis, value)?;
        }
        if let Tracking::Near(target) = request.tracking
            && !(target.re.is_finite() && target.im.is_finite())
        {
            return Err(Error::input(format!(
                "{target} is no eigenvalue that a mode can be near: --near accepts finite numbers"
            )));
        }
        Ok(Question {
            axis,
            from,
            to,
            quantity: request.of,
            wavenumber: wavenumber(axis, request)?,
            tracking: request.tracking,
        })
    }

    /// What varies.
    pub fn axis(&self) -> Axis {
        self.axis
    }

    /// Where it begins and ends.
    pub fn between(&self) -> [f64; 2] {
        [self.from, self.to]
    }

    /// What has to change sign.
    pub fn quantity(&self) -> Quantity {
        self.quantity
    }

    /// The wavenumbers.
    pub fn wavenumber(&self) -> Wavenumber {
        self.wavenumber
    }

    /// The mode.
    pub fn tracking(&self) -> Tracking {
        self.tracking
    }

    /// The wavenumber at a place of the axis; that of the place itself where k varies.
    pub(super) fn k(&self, x: f64) -> WaveVector {
        WaveVector::along_x(match self.wavenumber {
            Wavenumber::At(k) => k,
            Wavenumber::Varies | Wavenumber::Range(..) => x,
        })
    }

    /// Evenly spaced places along the axis, both ends included.
    pub(super) fn places(&self, count: usize) -> Vec<f64> {
        super::survey::evenly(self.from, self.to, count)
    }

    /// The setup at an extremum over k, and the question how the growth rate varies over that range of k there; nothing
    /// where no range was asked for.
    pub fn across(&self, setup: &Setup, extremum: &Critical) -> Option<Result<(Setup, Self)>> {
        let Wavenumber::Range(from, to) = self.wavenumber else {
            return None;
        };
        let question = Question {
            axis: Axis::Wavenumber,
            from,
            to,
            wavenumber: Wavenumber::Varies,
            tracking: match self.tracking {
                Tracking::Leading => Tracking::Leading,
                _ => Tracking::Near(extremum.c0),
            },
            ..*self
        };
        let moved = setup.moved(self.axis, extremum.value);
        Some(moved.map(|moved| (moved, question)))
    }
}

/// The wavenumbers of a request.
fn wavenumber(axis: Axis, request: &Request) -> Result<Wavenumber> {
    let vary = request.vary;
    match (axis, request.k, request.minimize) {
        (Axis::Wavenumber, None, None) => Ok(Wavenumber::Varies),
        (Axis::Wavenumber, Some(k), _) => Err(Error::input(format!(
            "k varies and cannot be fixed at k = {k}: leave --k out, or vary a parameter"
        ))),
        (Axis::Wavenumber, None, Some([low, high])) => Err(Error::input(format!(
            "--minimize k={low}:{high}: it accepts k=A:B with A < B, for a parameter that varies, and here k varies"
        ))),
        (_, None, None) => Err(Error::input(format!(
            "`{vary}` varies, so that a wavenumber is needed: give it with --k, or a range with --minimize k=A:B"
        ))),
        (_, Some(_), Some(_)) => Err(Error::input(
            "--k and --minimize exclude each other: give one wavenumber, or a range k=A:B",
        )),
        (_, Some(k), None) => {
            WaveVector::wave(k)?;
            Ok(Wavenumber::At(k))
        }
        (_, None, Some([low, high])) => {
            if !(low > 0.0 && low < high && high.is_finite()) {
                return Err(Error::input(format!(
                    "--minimize k={low}:{high}: it accepts k=A:B with 0 < A < B, for a parameter that varies"
                )));
            }
            if request.of != Quantity::Growth {
                return Err(Error::input(format!(
                    "--minimize goes with --of growth, not with --of {}",
                    request.of.name()
                )));
            }
            Ok(Wavenumber::Range(low, high))
        }
    }
}
