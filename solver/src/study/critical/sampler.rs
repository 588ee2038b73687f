//! Modes at places of an axis, their roots, and the errors of these.

use super::super::{Axis, Setup};
use super::grid::{Beside, Grid, Site};
use super::{Critical, Quantity, Question, ROUNDING, TOLERANCE, UNRESOLVED};
use crate::base::BaseState;
use crate::error::{Error, Result};
use crate::model::C64;
use crate::numerics::dense::dot;
use crate::numerics::{Applied, brent};
use crate::pencil::Spectrum;
use crate::problem::Problem;
use crate::spectrum::{self, EigenPair};
use crate::wavevector::WaveVector;
use crate::weakly::{self, Selection};
use std::sync::Arc;

/// Part of the axis by which the slope at a root is differenced.
const NUDGE: f64 = 1e-5;
/// A growth rate that rounding alone may have made, relative to the unit of rates.
pub(super) const NEUTRAL: f64 = 1e-13;

/// One mode at one place of the axis.
#[derive(Clone)]
pub(super) struct Sample {
    pub x: f64,
    pub value: f64,
    pub pair: EigenPair,
    pub site: Site,
}

/// The unit of rates of a mode's problem: the slow eigenvalues, or the terms of the slowest balance where there are too
/// few of these to tell.
pub(super) fn unit(problem: &Problem, k: WaveVector, scale: f64) -> f64 {
    let rate = problem.rate(k);
    if rate.is_finite() {
        scale.max(rate)
    } else {
        scale
    }
}

/// The unit of rates of a mode, against which its growth rate is rounding: no smaller than the terms that the growth
/// rate is the sum of, |y| |terms of L − c M0| |x| / |yᴴ M0 x|, where each of them is one number. A collocated problem
/// shows their rounding on other grids.
pub(super) fn unit_of(problem: &Problem, pair: &EigenPair) -> f64 {
    let unit = unit(problem, pair.k, pair.scale).max(pair.c.norm());
    if problem.resolution.is_some() {
        return unit;
    }
    let layout = &problem.direct.layout;
    let sizes = layout.columns.map(|block| pair.right[block.offset].norm());
    let shares = problem.direct.shares(pair.k, pair.c, &sizes);
    let rows = layout.rows.pairs().zip(shares);
    let terms: f64 = rows
        .map(|((_, block), shares)| pair.left[block.offset].norm() * shares.iter().sum::<f64>())
        .sum();
    let mass = problem.direct.mass::<C64>(pair.k).apply(&pair.right);
    unit.max(terms / dot(&pair.left, &mass).norm())
}

/// The quantity of a mode that changes sign.
pub(super) fn value(quantity: Quantity, problem: &Arc<Problem>, pair: &EigenPair) -> Result<f64> {
    if quantity == Quantity::Growth {
        return Ok(pair.c.re);
    }
    let point = weakly::from_pair(problem, pair.clone())?.conserving()?;
    let c2 = point.c2.re;
    Ok(match quantity {
        Quantity::Resonance => 1.0 / c2,
        _ => c2,
    })
}

/// What samples a question along its axis.
pub(super) struct Sampler<'s> {
    pub setup: &'s Setup,
    pub question: &'s Question,
    /// Base states along the axis; one alone where k varies.
    bases: Vec<(f64, Arc<BaseState>)>,
    /// The problem of all places, where k varies.
    site: Option<Site>,
}

impl<'s> Sampler<'s> {
    /// With base states at some places, each from the one before.
    ///
    /// # Errors
    /// Base states that can be had nowhere.
    pub fn new(setup: &'s Setup, question: &'s Question, places: &[f64]) -> Result<Self> {
        let mut sampler = Sampler {
            setup,
            question,
            bases: Vec::new(),
            site: None,
        };
        if question.axis() == Axis::Wavenumber {
            sampler.site = Some(Grid::of(setup).site(setup, None)?);
            return Ok(sampler);
        }
        let mut failure = None;
        for &x in places {
            let near = sampler.bases.last().map(|(_, base)| base.clone());
            let moved = setup.moved(question.axis(), x)?;
            match moved.base(near.as_deref()).or_else(|_| moved.base(None)) {
                Ok(base) => sampler.bases.push((x, base)),
                Err(error) => failure = Some(error),
            }
        }
        match failure {
            Some(error) if sampler.bases.is_empty() => Err(error),
            _ => Ok(sampler),
        }
    }

    /// The problem at a place.
    pub fn site(&self, x: f64) -> Result<Site> {
        if let Some(site) = &self.site {
            return Ok(site.clone());
        }
        let distance = |(place, _): &&(f64, Arc<BaseState>)| (place - x).abs();
        let nearest = self
            .bases
            .iter()
            .min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let moved = self.setup.moved(self.question.axis(), x)?;
        Grid::of(self.setup).site(&moved, nearest.map(|(_, base)| base.as_ref()))
    }

    /// The spectrum at a place, and the unit of rates there.
    pub fn spectrum(&self, x: f64) -> Result<(Spectrum, f64)> {
        let site = self.site(x)?;
        let k = self.question.k(x);
        let spectrum = spectrum::eigenvalues(&site.problem, k)?;
        let unit = unit(&site.problem, k, spectrum.scale());
        Ok((spectrum, unit))
    }

    /// A mode at a place.
    pub fn sample(&self, x: f64, selection: Selection) -> Result<Sample> {
        let site = self.site(x)?;
        let pair = weakly::select(&site.problem, self.question.k(x), selection)?;
        let value = value(self.question.quantity(), &site.problem, &pair)?;
        Ok(Sample {
            x,
            value,
            pair,
            site,
        })
    }

    pub fn like(&self, x: f64, near: &Sample) -> Result<Sample> {
        self.sample(x, Selection::Like(&near.pair))
    }

    /// The place at which the mode of two samples has no quantity left; nothing where the sign changes through infinity.
    pub fn root(&self, a: &Sample, b: &Sample) -> Result<Option<Sample>> {
        let span = a.x.abs().max(b.x.abs()) * TOLERANCE;
        let mut last = a.clone();
        // The mode is followed from whichever sample is nearest.
        let nearest = |x: f64, last: &Sample| -> Sample {
            let mut nearest = a;
            for sample in [b, last] {
                if (sample.x - x).abs() < (nearest.x - x).abs() {
                    nearest = sample;
                }
            }
            nearest.clone()
        };
        let evaluate = |x: f64| {
            last = self.like(x, &nearest(x, &last))?;
            Ok(last.value)
        };
        let (x, value) = brent(evaluate, (a.x, a.value), (b.x, b.value), span)?;
        // One of the two may be the root itself, to rounding.
        let rounding = self.rounding(a, (b.value - a.value) / (b.x - a.x));
        if value.abs() > (0.1 * a.value.abs().min(b.value.abs())).max(rounding) {
            return Ok(None);
        }
        self.like(x, &nearest(x, a)).map(Some)
    }

    /// What counts as zero of the quantity, which rises by `slope`.
    fn rounding(&self, near: &Sample, slope: f64) -> f64 {
        let [from, to] = self.question.between();
        ROUNDING
            * match self.question.quantity() {
                Quantity::Growth => near.pair.scale.max(near.pair.c.norm()),
                Quantity::C2 | Quantity::Resonance => (slope * (to - from)).abs(),
            }
    }

    /// The critical point of a root, with its errors.
    ///
    /// # Errors
    /// A root that another collocation moves by a good part of its value.
    pub fn answer(&self, root: &Sample) -> Result<Critical> {
        let (x, c0) = (root.x, root.pair.c);
        let k = self.question.k(x);
        let [from, to] = self.question.between();
        let step = NUDGE * (to - from).abs();
        let step = if x + step > from.max(to) { -step } else { step };
        let slope = (self.like(x + step, root)?.value - root.value) / step;
        let unit = unit_of(&root.site.problem, &root.pair);
        // What rounding leaves of the quantity, and what the search has left of it.
        let rounding = 0.1 * NEUTRAL * unit;
        let (leftover, mut c0_error) = match self.question.quantity() {
            Quantity::Growth => (root.value.abs() + rounding, root.value.abs() + rounding),
            Quantity::C2 | Quantity::Resonance => (root.value.abs(), rounding),
        };
        let leftover = (leftover / slope).abs();
        let mut error = leftover.max(TOLERANCE * x.abs());
        for Beside { grid, factor } in Grid::beside(self.setup, &root.site.base) {
            let (moved, c) = self
                .displaced(grid, root, slope)
                .unwrap_or((f64::INFINITY, c0));
            error = error.max(factor * (moved - x).abs());
            c0_error = c0_error.max(factor * (c - c0).norm());
        }
        // A root at zero has no size of its own: there it is rounding alone that may move it.
        let allowed = (UNRESOLVED * x.abs()).max(self.rounding(root, slope) / slope.abs());
        if error.is_nan() || error > allowed.max(leftover) {
            return Err(Error::unresolved(
                format!("the critical point near {x}"),
                self.setup.effective_resolution(),
                format!("another M moves it by {error:.1e}"),
            ));
        }
        let leading = spectrum::eigenvalues(&root.site.problem, k)?;
        let leading_growth = leading.values.first().map_or(c0.re, |c| c.re.max(c0.re));
        Ok(Critical {
            value: x,
            error,
            k: k.k(),
            k_error: if self.site.is_some() { error } else { 0.0 },
            c0,
            c0_error,
            leading_growth,
            scale: unit,
        })
    }

    /// The same root on another grid, and the eigenvalue there; by two steps along the secant.
    fn displaced(&self, grid: Grid, root: &Sample, slope: f64) -> Result<(f64, C64)> {
        let quantity = self.question.quantity();
        let at = |x: f64| {
            grid.site(
                &self.setup.moved(self.question.axis(), x)?,
                Some(&root.site.base),
            )
        };
        let here = at(root.x)?;
        let pair = spectrum::transferred(&root.site.problem, &root.pair, &here.problem)?;
        let first = value(quantity, &here.problem, &pair)?;
        let x = root.x - first / slope;
        if first == 0.0 || (x - root.x).abs() <= TOLERANCE * x.abs() {
            return Ok((x, pair.c));
        }
        let there = at(x)?;
        let moved = spectrum::follow(&there.problem, self.question.k(x), &pair)?;
        let second = value(quantity, &there.problem, &moved)?;
        let step = second * (x - root.x) / (second - first);
        let next = if step.is_finite() { x - step } else { x };
        Ok((next, moved.c))
    }
}
