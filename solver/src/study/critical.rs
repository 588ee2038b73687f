//! Critical points: where growth or c2 changes sign, where c2 jumps through infinity.

use super::root::brent;
use super::sensitivity::wavenumber;
use super::{Axis, Carried, Setup};
use crate::error::{Error, Result};
use crate::model::C64;
use crate::spectrum::EigenPair;
use crate::weakly::{self, Selection};
use indicatif::ProgressBar;

/// Points at which an interval is scanned for sign changes.
const SCAN: usize = 61;
/// Every so many of them the whole spectrum is computed, to find the mode to follow.
const STRIDE: usize = 6;
/// Steps of a range of k in which the largest growth is looked for.
const CREST_STEPS: usize = 16;
/// Relative accuracy of roots.
const TOLERANCE: f64 = 1e-12;

/// What changes sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    Growth,
    C2,
    /// 1/c2: where 2 c0(k) meets an eigenvalue at 2k.
    Resonance,
}

/// A question of the command `critical`.
#[derive(Clone, Copy, Debug)]
pub struct Question {
    pub axis: Axis,
    pub from: f64,
    pub to: f64,
    pub quantity: Quantity,
    /// The fixed wavenumber, unless it is the axis or minimised over.
    pub k: f64,
    pub near: Option<C64>,
}

/// Its answer.
#[derive(Clone, Debug)]
pub struct Critical {
    pub value: f64,
    pub k: f64,
    pub c0: C64,
}

/// One evaluation along the axis.
#[derive(Clone)]
struct Sample {
    x: f64,
    value: f64,
    c0: C64,
    carried: Carried,
}

struct Sampler<'s, 'm> {
    setup: &'s Setup<'m>,
    question: Question,
}

impl Sampler<'_, '_> {
    fn k(&self, x: f64) -> f64 {
        if self.question.axis == Axis::Wavenumber {
            x
        } else {
            self.question.k
        }
    }

    fn sample(&self, x: f64, near: Option<&Carried>) -> Result<Sample> {
        let moved = self.setup.moved(self.question.axis, x)?;
        let base = match (self.question.axis, near) {
            (Axis::Wavenumber, Some(carried)) => carried.base.clone(),
            _ => moved.base(near.map(|c| &c.base))?,
        };
        let selection = match (near, self.question.near) {
            (Some(carried), _) => Selection::Like(&carried.pair),
            (None, Some(target)) => Selection::Near(target),
            (None, None) => Selection::Leading,
        };
        let k = self.k(x);
        let (value, pair) = moved.with_problem(&base, |problem| {
            let pair = weakly::select(problem, k, selection)?;
            if self.question.quantity == Quantity::Growth {
                return Ok((pair.c.re, pair));
            }
            let point = weakly::from_pair(problem, pair.clone())?;
            let c2 = point.c2.re;
            Ok((
                if self.question.quantity == Quantity::C2 {
                    c2
                } else {
                    1.0 / c2
                },
                pair,
            ))
        })?;
        Ok(Sample {
            x,
            value,
            c0: pair.c,
            carried: Carried { base, pair },
        })
    }

    /// The mode that is most unstable somewhere in the interval.
    fn seed(&self, points: &[f64], progress: &ProgressBar) -> Result<(usize, Sample)> {
        let mut best: Option<(usize, Sample)> = None;
        let mut last = None;
        for index in (0..points.len()).step_by(STRIDE) {
            progress.inc(1);
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
    fn scan(&self, points: &[f64], progress: &ProgressBar) -> Result<Vec<Sample>> {
        let (start, seed) = self.seed(points, progress)?;
        let walk = |indices: &mut dyn Iterator<Item = usize>| {
            let mut found: Vec<Sample> = Vec::new();
            for index in indices {
                progress.inc(1);
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
        if value.abs() > 0.1 * a.value.abs().min(b.value.abs()) {
            return Ok(None);
        }
        let root = self.sample(x, Some(&near(x, a)))?;
        Ok(Some(Critical {
            value: x,
            k: self.k(x),
            c0: root.c0,
        }))
    }
}

/// All critical points of an interval, in order from `from` to `to`.
///
/// # Errors
/// An interval without one, or a mode that cannot be followed.
pub fn critical(
    setup: &Setup,
    question: Question,
    progress: &ProgressBar,
) -> Result<Vec<Critical>> {
    let sampler = Sampler { setup, question };
    let points: Vec<f64> = (0..SCAN)
        .map(|i| question.from + (question.to - question.from) * i as f64 / (SCAN - 1) as f64)
        .collect();
    progress.set_length((SCAN + SCAN.div_ceil(STRIDE)) as u64);
    let samples = sampler.scan(&points, progress)?;
    let mut found = Vec::new();
    for pair in samples.windows(2) {
        if pair[0].value == 0.0 || pair[0].value * pair[1].value < 0.0 {
            found.extend(sampler.refine(&pair[0], &pair[1])?);
        }
    }
    progress.finish_and_clear();
    if !found.is_empty() {
        return Ok(found);
    }
    let (first, last) = (&samples[0], &samples[samples.len() - 1]);
    let what = match question.quantity {
        Quantity::Growth => "the growth rate of the mode does not change sign",
        Quantity::C2 => "c2 does not pass through zero",
        Quantity::Resonance => "c2 does not jump through infinity",
    };
    Err(Error::computation(format!(
        "{what} between {} and {}: {:.4e} at {:.6}, {:.4e} at {:.6}; try another interval, or --near to name a mode",
        question.from, question.to, first.value, first.x, last.value, last.x
    )))
}

/// The extremum over k of the neutral curve: growth = 0 and dc0/dk = 0 (real parts) together.
///
/// # Errors
/// As [`critical`].
pub fn minimise(
    setup: &Setup,
    question: Question,
    (from, to): (f64, f64),
    progress: &ProgressBar,
) -> Result<Critical> {
    let steps = 12;
    progress.set_length(steps as u64 + 1);
    let peak = |x: f64, carried: &mut Option<Carried>| -> Result<(f64, EigenPair)> {
        let moved = setup.moved(question.axis, x)?;
        let base = moved.base(carried.as_ref().map(|c| &c.base))?;
        let near = carried.as_ref().map(|c| c.pair.clone());
        let pair = moved.with_problem(&base, |problem| {
            crest(problem, near.as_ref(), question.near, (from, to))
        })?;
        *carried = Some(Carried {
            base,
            pair: pair.clone(),
        });
        Ok((pair.c.re, pair))
    };
    let edge = |x: f64| -> Result<f64> {
        let moved = setup.moved(question.axis, x)?;
        let base = moved.base(None)?;
        moved.with_problem(&base, |problem| {
            highest(problem, question.near, (from, to)).map(|pair| pair.c.re)
        })
    };
    let mut previous: Option<(f64, f64, Option<Carried>)> = None;
    for step in 0..=steps {
        progress.inc(1);
        let x = question.from + (question.to - question.from) * step as f64 / steps as f64;
        // Each scan point looks over the whole range of k, in case another mode takes over.
        let mut fresh = None;
        let growth = match peak(x, &mut fresh) {
            Ok((growth, _)) => growth,
            // Largest at an end of the range: enough to say that nothing grows here.
            Err(_) => match edge(x) {
                Ok(growth) if growth < 0.0 => growth,
                _ => continue,
            },
        };
        if let Some((x0, g0, before)) = &previous
            && g0 * growth <= 0.0
        {
            // The mode that grows on one side is the one that is followed to zero.
            let mut carried = if growth > 0.0 { fresh } else { before.clone() };
            let span = TOLERANCE * x.abs().max(x0.abs());
            let (root, _) = brent(
                |x| peak(x, &mut carried).map(|(g, _)| g),
                (*x0, *g0),
                (x, growth),
                span,
            )?;
            let (_, pair) = peak(root, &mut carried)?;
            progress.finish_and_clear();
            return Ok(Critical {
                value: root,
                k: pair.k,
                c0: pair.c,
            });
        }
        previous = Some((x, growth, fresh));
    }
    Err(Error::computation(format!(
        "the largest growth rate over k in {from}..{to} does not change sign between {} and {}; try wider intervals",
        question.from, question.to
    )))
}

/// The mode of largest growth among evenly spaced k.
fn highest(
    problem: &crate::problem::Problem,
    target: Option<C64>,
    (from, to): (f64, f64),
) -> Result<EigenPair> {
    let selection = target.map_or(Selection::Leading, Selection::Near);
    let places = (0..=CREST_STEPS).map(|i| from + (to - from) * i as f64 / CREST_STEPS as f64);
    let modes = places.filter_map(|k| weakly::select(problem, k, selection).ok());
    modes
        .max_by(|a, b| a.c.re.total_cmp(&b.c.re))
        .ok_or_else(|| Error::computation("no mode was found in the range of k"))
}

/// The mode of largest growth over k: scanned where nothing is known, then dc0/dk = 0.
fn crest(
    problem: &crate::problem::Problem,
    near: Option<&EigenPair>,
    target: Option<C64>,
    (from, to): (f64, f64),
) -> Result<EigenPair> {
    let spacing = (to - from) / CREST_STEPS as f64;
    let start = match near {
        Some(pair) => pair.clone(),
        None => highest(problem, target, (from, to))?,
    };
    let mut pair = crate::spectrum::follow(problem, start.k, &start)?;
    let mut slope = |k: f64| -> Result<f64> {
        pair = crate::spectrum::follow(problem, k, &pair)?;
        Ok(wavenumber(problem, &pair).re)
    };
    // Bracket the extremum around the start.
    let first = slope(start.k)?;
    let mut reach = if near.is_some() {
        1e-3 * start.k
    } else {
        spacing
    };
    let side = first.signum();
    let (mut a, mut fa) = (start.k, first);
    for _ in 0..60 {
        let b = (a + side * reach).clamp(from, to);
        if b == a {
            let message =
                format!("the growth rate has its largest value at the end k = {a} of the range");
            return Err(Error::computation(message));
        }
        let fb = slope(b)?;
        if fa * fb <= 0.0 {
            let (k, _) = brent(&mut slope, (a, fa), (b, fb), 1e-12 * b)?;
            slope(k)?;
            return Ok(pair);
        }
        (a, fa) = (b, fb);
        reach *= 1.5;
    }
    Err(Error::computation("the extremum over k was not bracketed"))
}
