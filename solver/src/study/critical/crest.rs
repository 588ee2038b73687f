//! Crests of growth over k.

use super::grid::Site;
use super::summit::Growth;
use crate::error::{Error, Result};
use crate::problem::Problem;
use crate::spectrum::{self, EigenPair};
use crate::wavevector::WaveVector;
use crate::weakly::{self, Envelope, Selection};
use rayon::prelude::*;

/// The first step uphill, as a part of the range of k.
const REACH: f64 = 1.0 / 16.0;
/// Steps uphill.
const MOST_STEPS: usize = 100;
/// Relative accuracy of the wavenumber.
const SETTLED: f64 = 1e-10;

/// A largest growth rate over k, for one value of the parameter.
#[derive(Clone)]
pub(super) struct Crest {
    pub x: f64,
    pub pair: EigenPair,
    pub site: Site,
    /// Whether it lies at an end of the range, where growth still rises outwards.
    pub at_end: bool,
}

impl Crest {
    /// Its height.
    pub fn growth(&self) -> Growth {
        Growth {
            x: self.x,
            rate: self.pair.c.re,
        }
    }
}

/// The mode of largest growth rate among some wavenumbers.
///
/// # Errors
/// Modes that are found nowhere.
pub(super) fn highest(
    problem: &Problem,
    selection: Selection,
    wavenumbers: &[f64],
) -> Result<EigenPair> {
    let modes: Vec<Result<EigenPair>> = wavenumbers
        .par_iter()
        .map(|&k| weakly::select(problem, WaveVector::along_x(k), selection))
        .collect();
    let (modes, failures): (Vec<_>, Vec<_>) = modes.into_iter().partition(Result::is_ok);
    let best = modes
        .into_iter()
        .flatten()
        .reduce(|best, pair| if pair.c.re > best.c.re { pair } else { best });
    let failure = failures.into_iter().find_map(Result::err);
    best.ok_or_else(|| {
        failure.unwrap_or_else(|| Error::computation("no mode was found in the range of k"))
    })
}

/// The crest of a mode's growth over k next to `start`: dc0/dk = 0 by Newton's method, uphill where growth is not
/// concave; or the end of the range that it rises to.
///
/// # Errors
/// A mode that cannot be followed, a crest that is not found.
pub(super) fn climb(
    x: f64,
    site: Site,
    start: &EigenPair,
    (from, to): (f64, f64),
) -> Result<Crest> {
    let problem = &site.problem;
    let mut pair = spectrum::follow(problem, start.k, start)?;
    let mut reach = REACH * (to - from);
    for _ in 0..MOST_STEPS {
        let Envelope { slope, curvature } = Envelope::of(problem, &pair)?;
        let newton = -slope.re / curvature.re;
        let step = match curvature.re < 0.0 && newton.abs() <= reach {
            true => newton,
            false => reach.copysign(slope.re),
        };
        let k = (pair.k.k() + step).clamp(from, to);
        if k == pair.k.k() {
            let at_end = slope.re != 0.0 && (k == from || k == to);
            return Ok(Crest {
                x,
                pair,
                site,
                at_end,
            });
        }
        let next = spectrum::follow(problem, WaveVector::along_x(k), &pair)?;
        // A step too far.
        if next.c.re < pair.c.re - 1e-12 * pair.scale {
            reach = 0.3 * step.abs();
            continue;
        }
        let settled = step.abs() <= SETTLED * k;
        pair = next;
        if settled {
            return Ok(Crest {
                x,
                pair,
                site,
                at_end: false,
            });
        }
    }
    Err(Error::computation("the extremum over k was not found"))
}
