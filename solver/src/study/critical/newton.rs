//! a = Re c0 = 0 and a_k = Re dc0/dk = 0 in k and the parameter, by Newton's method on any grid.

use super::super::{Axis, Setup};
use super::TOLERANCE;
use super::grid::{Grid, Site};
use super::sampler::{NEUTRAL, unit_of};
use crate::base::BaseState;
use crate::error::{Error, Result};
use crate::numerics::{Failure, Linearised, Newton, System};
use crate::spectrum::{self, EigenPair};
use crate::wavevector::WaveVector;
use crate::weakly::Envelope;
use std::sync::Arc;

const METHOD: Newton = Newton {
    most_steps: 20,
    least_part: 1.0,
};
/// Relative change of the parameter by which derivatives along it are differenced.
const NUDGE: f64 = 1e-6;
/// Part of its bracket below which a parameter counts as zero.
pub(super) const SMALL: f64 = 1e-4;
/// Part of its bracket by which a parameter may leave it.
const SLACK: f64 = 1e-6;
/// Relative accuracy of the wavenumber.
const SETTLED: f64 = 1e-9;
/// A grid beside moves the wavenumber by a smaller part of it.
const NEARBY: f64 = 0.2;

/// An extremum of a neutral curve on one grid.
#[derive(Clone)]
pub(in crate::study) struct Root {
    /// The parameter.
    pub x: f64,
    /// The neutral mode.
    pub pair: EigenPair,
    /// Its problem.
    pub site: Site,
    /// dc0/dk and d²c0/dk².
    pub envelope: Envelope,
    /// Re ∂c0/∂x
    pub slope: f64,
}

/// A mode with its derivatives over k.
#[derive(Clone)]
struct Known {
    pair: EigenPair,
    site: Site,
    envelope: Envelope,
}

struct Extremum<'s> {
    setup: &'s Setup,
    axis: Axis,
    grid: Grid,
    /// Bounds of the parameter and of k.
    bounds: ((f64, f64), (f64, f64)),
    /// A base state nearby, at the degree at which it is resolved.
    base: Arc<BaseState>,
    /// The mode that is followed.
    near: EigenPair,
    /// What rounding of the growth rate makes of the parameter.
    rounding: f64,
}

/// The root from a parameter, a mode and a base state nearby, within bounds of the parameter and of k.
///
/// # Errors
/// An iteration that does not settle there.
pub(super) fn polish(
    setup: &Setup,
    axis: Axis,
    grid: Grid,
    (x, pair, base): (f64, &EigenPair, &Arc<BaseState>),
    bounds: ((f64, f64), (f64, f64)),
) -> Result<Root> {
    let start = vec![pair.k.k(), x];
    let mut system = Extremum {
        setup,
        axis,
        grid,
        bounds,
        base: base.clone(),
        near: pair.clone(),
        rounding: 0.0,
    };
    let lost = |failure: Failure| {
        Error::computation(format!(
            "the extremum over k was not found near {x}: {failure}"
        ))
    };
    let (at, found) = METHOD.solve(&mut system, start).map_err(lost)?;
    let Known {
        pair,
        site,
        envelope,
    } = found.byproduct;
    Ok(Root {
        x: at[1],
        pair,
        site,
        envelope,
        slope: found.jacobian[0][1],
    })
}

impl Root {
    /// The same root on another grid.
    ///
    /// # Errors
    /// A mode that is not found there, an iteration that does not settle nearby.
    pub fn on(&self, setup: &Setup, axis: Axis, grid: Grid) -> Result<Root> {
        let base = &self.site.base;
        let site = grid.site(&setup.moved(axis, self.x)?, Some(base))?;
        let pair = spectrum::transferred(&self.site.problem, &self.pair, &site.problem)?;
        let k = self.pair.k.k();
        let bounds = (
            (f64::NEG_INFINITY, f64::INFINITY),
            ((1.0 - NEARBY) * k, (1.0 + NEARBY) * k),
        );
        polish(setup, axis, grid, (self.x, &pair, base), bounds)
    }
}

impl Extremum<'_> {
    /// The mode followed to another place, with its derivatives over k.
    fn at(&self, k: f64, x: f64) -> Result<Known> {
        let moved = self.setup.moved(self.axis, x)?;
        let site = self.grid.site(&moved, Some(&self.base))?;
        let pair = spectrum::follow(&site.problem, WaveVector::along_x(k), &self.near)?;
        let envelope = Envelope::of(&site.problem, &pair)?;
        Ok(Known {
            pair,
            site,
            envelope,
        })
    }
}

impl System for Extremum<'_> {
    /// [a_k a_x; a_kk a_kx]
    type Jacobian = [[f64; 2]; 2];
    type Byproduct = Known;
    type Error = Failure;

    fn linearise(&mut self, at: &[f64]) -> std::result::Result<Option<Linearised<Self>>, Failure> {
        let (k, x) = (at[0], at[1]);
        let (low, high) = self.bounds.0;
        let width = if (high - low).is_finite() {
            (high - low).abs()
        } else {
            x.abs()
        };
        let nudge = NUDGE * if width > 0.0 { x.abs().max(width) } else { 1.0 };
        let both = self.at(k, x).and_then(|here| {
            self.near = here.pair.clone();
            if self.grid.keeps_degree() {
                self.base = here.site.base.clone();
            }
            // Backwards where the parameter's range ends.
            let beside = self.at(k, x + nudge).map(|there| (there, nudge));
            let beside = beside.or_else(|_| self.at(k, x - nudge).map(|there| (there, -nudge)));
            Ok((here, beside?))
        });
        let Ok((here, (there, nudge))) = both else {
            return Ok(None);
        };
        let along = (there.pair.c.re - here.pair.c.re) / nudge;
        let across = (there.envelope.slope.re - here.envelope.slope.re) / nudge;
        self.rounding = NEUTRAL * unit_of(&here.site.problem, &here.pair) / along.abs();
        let Envelope { slope, curvature } = here.envelope;
        Ok(Some(Linearised {
            residual: vec![here.pair.c.re, slope.re],
            jacobian: [[slope.re, along], [curvature.re, across]],
            byproduct: here,
        }))
    }

    fn admits(&self, at: &[f64]) -> bool {
        let ((a, b), (from, to)) = self.bounds;
        // The root may be an end of the bracket, to rounding.
        let slack = if (b - a).is_finite() {
            SLACK * (b - a).abs()
        } else {
            0.0
        };
        let (low, high) = (a.min(b) - slack, a.max(b) + slack);
        at[0] > from && at[0] < to && at[1] >= low && at[1] <= high
    }

    fn step(
        &mut self,
        _: &[f64],
        at: &Linearised<Self>,
    ) -> std::result::Result<Option<Vec<f64>>, Failure> {
        let [[a, b], [c, d]] = at.jacobian;
        let [growth, slope] = [at.residual[0], at.residual[1]];
        let determinant = a * d - b * c;
        let step = vec![
            (b * slope - d * growth) / determinant,
            (c * growth - a * slope) / determinant,
        ];
        Ok(step.iter().all(|s| s.is_finite()).then_some(step))
    }

    fn is_last(&self, at: &[f64], step: &[f64]) -> bool {
        let (low, high) = self.bounds.0;
        let width = if (high - low).is_finite() {
            (high - low).abs()
        } else {
            0.0
        };
        let size = at[1].abs().max(SMALL * width);
        let settled = (TOLERANCE * size).max(self.rounding);
        step[1].abs() <= settled && step[0].abs() <= SETTLED * at[0]
    }
}
