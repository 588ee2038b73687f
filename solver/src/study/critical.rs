//! Critical points along an axis: where growth or c2 changes sign, where c2 jumps through infinity.

use super::{Axis, Carried, Progress, Setup};
use crate::error::{Error, Result};
use crate::model::C64;
use crate::numerics::brent;
use crate::problem::Problem;
use crate::spectrum::EigenPair;
use crate::weakly::{self, Selection};
use std::sync::Arc;

/// Points at which an interval is scanned for sign changes.
const SCAN: usize = 61;
/// Every so many of them the whole spectrum is computed, to find the mode to follow.
const STRIDE: usize = 6;
/// Relative accuracy of roots.
pub(super) const TOLERANCE: f64 = 1e-12;
/// What counts as zero of a quantity, relative to its size: of the growth rate, to the slow eigenvalues.
const ROUNDING: f64 = 1e-12;
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

/// A question of the command `critical`.
#[derive(Clone, Copy, Debug)]
pub struct Question {
    /// What varies.
    pub axis: Axis,
    /// Where it begins.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
    /// What has to change sign.
    pub quantity: Quantity,
    /// The fixed wavenumber, unless it is the axis or minimised over.
    pub k: Option<f64>,
    /// The mode that is followed; the most unstable one otherwise.
    pub near: Option<C64>,
}

/// Its answer.
#[derive(Clone, Debug)]
pub struct Critical {
    /// Where along the axis.
    pub value: f64,
    /// Absolute error of the value: where another collocation puts it.
    pub error: f64,
    /// The wavenumber.
    pub k: f64,
    /// The eigenvalue there.
    pub c0: C64,
}

/// One evaluation along the axis.
#[derive(Clone)]
pub(super) struct Sample {
    pub x: f64,
    pub value: f64,
    pub c0: C64,
    pub carried: Carried,
}

pub(super) struct Sampler<'s> {
    pub setup: &'s Setup,
    pub question: Question,
}

impl Sampler<'_> {
    fn k(&self, x: f64) -> f64 {
        self.question
            .k
            .filter(|_| self.question.axis != Axis::Wavenumber)
            .unwrap_or(x)
    }

    fn sample(&self, x: f64, near: Option<&Carried>) -> Result<Sample> {
        let moved = self.setup.moved(self.question.axis, x)?;
        let base = match (self.question.axis, near) {
            (Axis::Wavenumber, Some(carried)) => carried.base.clone(),
            _ => moved.base(near.map(|c| c.base.as_ref()))?,
        };
        let selection = match (near, self.question.near) {
            (Some(carried), _) => Selection::Like(&carried.pair),
            (None, Some(target)) => Selection::Near(target),
            (None, None) => Selection::Leading,
        };
        let k = self.k(x);
        let problem = moved.problem(&base)?;
        let (value, pair) = self.value(&problem, weakly::select(&problem, k, selection)?)?;
        Ok(Sample {
            x,
            value,
            c0: pair.c,
            carried: Carried { base, pair },
        })
    }

    /// The mode that is most unstable somewhere in the interval.
    fn seed(&self, points: &[f64], progress: &dyn Progress) -> Result<(usize, Sample)> {
        let mut best: Option<(usize, Sample)> = None;
        let mut last = None;
        for index in (0..points.len()).step_by(STRIDE) {
            progress.advance(1);
            match self.sample(points[index], None) {
                Ok(sample) => {
                    if best.as_ref().is_none_or(|(_, b)| sample.c0.re > b.c0.re) {
                        best = Some((index, sample));
                    }
                }
                Err(error) => last = Some(error),
            }
            if self.question.near.is_some() && best.is_some() {
                break;
            }
        }
        best.ok_or_else(|| last.unwrap_or_else(|| Error::computation("the interval is empty")))
    }

    /// Samples on both sides of the seed as far as the mode can be followed.
    fn scan(&self, points: &[f64], progress: &dyn Progress) -> Result<Vec<Sample>> {
        let (start, seed) = self.seed(points, progress)?;
        let walk = |indices: &mut dyn Iterator<Item = usize>| {
            let mut found: Vec<Sample> = Vec::new();
            for index in indices {
                progress.advance(1);
                let near = found.last().unwrap_or(&seed).carried.clone();
                match self.sample(points[index], Some(&near)) {
                    Ok(sample) => found.push(sample),
                    Err(_) => break,
                }
            }
            found
        };
        let mut samples = walk(&mut (0..start).rev());
        samples.reverse();
        samples.push(seed.clone());
        samples.extend(walk(&mut (start + 1..points.len())));
        Ok(samples)
    }

    /// The root between two samples; `None` where the sign changes through infinity.
    fn refine(&self, a: &Sample, b: &Sample) -> Result<Option<Critical>> {
        let mut last = a.clone();
        let span = (a.x.abs().max(b.x.abs())) * TOLERANCE;
        let near = |x: f64, last: &Sample| {
            // Follow from whichever known sample is nearest.
            let candidates = [a, b, last];
            let nearest = candidates
                .iter()
                .min_by(|p, q| (p.x - x).abs().total_cmp(&(q.x - x).abs()));
            nearest.map_or(a.carried.clone(), |s| s.carried.clone())
        };
        let evaluate = |x: f64| {
            last = self.sample(x, Some(&near(x, &last)))?;
            Ok(last.value)
        };
        let (x, value) = brent(evaluate, (a.x, a.value), (b.x, b.value), span)?;
        let slope = (b.value - a.value) / (b.x - a.x);
        // One of the two may be the root itself, to rounding.
        let rounding = self.rounding(a, slope);
        if value.abs() > (0.1 * a.value.abs().min(b.value.abs())).max(rounding) {
            return Ok(None);
        }
        let root = self.sample(x, Some(&near(x, a)))?;
        let error = self.error(&root, slope)?.max(span);
        Ok(Some(Critical {
            value: x,
            error,
            k: self.k(x),
            c0: root.c0,
        }))
    }

    /// What counts as zero of the quantity, which rises by `slope`.
    fn rounding(&self, near: &Sample, slope: f64) -> f64 {
        let size = match self.question.quantity {
            Quantity::Growth => near.carried.pair.scale.max(near.c0.norm()),
            Quantity::C2 | Quantity::Resonance => slope * (self.question.to - self.question.from),
        };
        ROUNDING * size.abs()
    }

    /// How far another M, and the base state at another degree, move a root: their values there over the slope.
    ///
    /// # Errors
    /// A root that they move by a good part of its value: it is not converged.
    pub fn error(&self, root: &Sample, slope: f64) -> Result<f64> {
        let (m, base) = (self.setup.effective_resolution(), &root.carried.base);
        let own = self.setup.problem(base)?;
        let finer = self
            .setup
            .finer_resolution()
            .map(|m| (base.clone(), Some(m)));
        let refined = base.refined().map(|base| (Arc::new(base), m));
        let mut error = 0.0_f64;
        for (base, m) in finer.into_iter().chain(refined) {
            let other = Arc::new(Problem::new(&base, m)?);
            let value = crate::spectrum::transferred(&own, &root.carried.pair, &other)
                .and_then(|pair| self.value(&other, pair))
                .map_or(f64::INFINITY, |(value, _)| value);
            error = error.max(((value - root.value) / slope).abs());
        }
        // A root at zero has no size of its own: there it is rounding alone that may move it.
        let rounding = (self.rounding(root, slope) / slope).abs();
        if error > (UNRESOLVED * root.x.abs()).max(rounding) {
            let what = format!("the critical point near {}", root.x);
            let how_far = format!("another M moves it by {error:.1e}");
            return Err(Error::unresolved(what, m, how_far));
        }
        Ok(error)
    }

    /// The quantity that changes sign, of a mode.
    fn value(&self, problem: &Arc<Problem>, pair: EigenPair) -> Result<(f64, EigenPair)> {
        if self.question.quantity == Quantity::Growth {
            return Ok((pair.c.re, pair));
        }
        let c2 = weakly::from_pair(problem, pair.clone())?
            .conserving()?
            .c2
            .re;
        let value = match self.question.quantity {
            Quantity::Resonance => 1.0 / c2,
            _ => c2,
        };
        Ok((value, pair))
    }
}

/// A quantity along an interval, as far as its mode can be followed, and where it changes sign.
#[derive(Clone, Debug)]
pub struct Scan {
    /// Places and values.
    pub curve: Vec<(f64, f64)>,
    /// In order from `from` to `to`.
    pub found: Vec<Critical>,
}

/// The quantity of a question along its interval.
///
/// # Errors
/// A mode that can be found nowhere, a root that is not converged.
pub fn scan(setup: &Setup, question: Question, progress: &dyn Progress) -> Result<Scan> {
    question.axis.check_continuous(setup.model.structure())?;
    let sampler = Sampler { setup, question };
    let points: Vec<f64> = (0..SCAN)
        .map(|i| question.from + (question.to - question.from) * i as f64 / (SCAN - 1) as f64)
        .collect();
    progress.begin(SCAN + SCAN.div_ceil(STRIDE));
    let samples = sampler.scan(&points, progress)?;
    let mut found = Vec::new();
    let last = samples.len().saturating_sub(2);
    for (index, pair) in samples.windows(2).enumerate() {
        let [a, b] = [pair[0].value, pair[1].value];
        if a == 0.0 || a * b < 0.0 || (index == last && b == 0.0) {
            found.extend(sampler.refine(&pair[0], &pair[1])?);
        }
    }
    progress.end();
    let curve = samples.iter().map(|s| (s.x, s.value)).collect();
    Ok(Scan { curve, found })
}

/// All critical points of an interval, in order from `from` to `to`.
///
/// # Errors
/// As [`scan`], and an interval without one.
pub fn critical(
    setup: &Setup,
    question: Question,
    progress: &dyn Progress,
) -> Result<Vec<Critical>> {
    scan(setup, question, progress)?.critical(&question)
}

impl Scan {
    /// The critical points.
    ///
    /// # Errors
    /// An interval without one.
    pub fn critical(self, question: &Question) -> Result<Vec<Critical>> {
        if !self.found.is_empty() {
            return Ok(self.found);
        }
        let (first, last) = (self.curve[0], self.curve[self.curve.len() - 1]);
        let what = match question.quantity {
            Quantity::Growth => "the growth rate of the mode does not change sign",
            Quantity::C2 => "c2 does not pass through zero",
            Quantity::Resonance => "c2 does not jump through infinity",
        };
        Err(Error::NoCriticalPoint(format!(
            "{what} between {} and {}: {:.4e} at {:.6}, {:.4e} at {:.6}; try another interval, or --near to name a mode",
            question.from, question.to, first.1, first.0, last.1, last.0
        )))
    }
}
