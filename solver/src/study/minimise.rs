//! The extremum over k of a neutral curve: growth = 0 and dc0/dk = 0 (real parts) together.

use super::critical::{Critical, Question, Sample, Sampler, TOLERANCE};
use super::root::brent;
use super::sensitivity::wavenumber;
use super::{Carried, Progress, Setup};
use crate::error::{Error, Result};
use crate::model::C64;
use crate::problem::Problem;
use crate::spectrum::{self, EigenPair};
use crate::weakly::{self, Selection};

/// Values of the parameter that are scanned.
const SCAN: usize = 12;
/// Steps of a range of k in which the largest growth is looked for.
const CREST_STEPS: usize = 16;
/// Times that a higher crest may turn up at what seemed a root.
const MOST_CRESTS: usize = 4;

/// The largest growth over a range of k.
#[derive(Clone)]
struct Crest {
    carried: Carried,
    /// Whether it lies at an end of the range, where growth still rises outwards.
    at_end: bool,
}

impl Crest {
    fn growth(&self) -> f64 {
        self.carried.pair.c.re
    }
}

/// The critical point at which the largest growth over `range` of k passes through zero.
///
/// # Errors
/// An interval in which it does not; a largest growth at an end of the range.
pub fn minimise(
    setup: &Setup,
    question: Question,
    range: (f64, f64),
    progress: &dyn Progress,
) -> Result<Critical> {
    progress.begin(SCAN + 1);
    let search = Search {
        setup,
        question,
        range,
    };
    let mut previous: Option<(f64, Crest)> = None;
    let mut trouble = None;
    let mut seen: Vec<(f64, f64)> = Vec::new();
    for step in 0..=SCAN {
        progress.advance(1);
        let x = question.from + (question.to - question.from) * step as f64 / SCAN as f64;
        // Each scan point looks over the whole range of k, in case another mode takes over.
        let crest = match search.crest(x, None) {
            Ok(crest) => crest,
            Err(error) => {
                trouble = Some(error);
                continue;
            }
        };
        seen.push((x, crest.growth()));
        if let Some((before, last)) = previous.take()
            && last.growth() * crest.growth() <= 0.0
        {
            let found = search.refine((before, last), (x, crest))?;
            progress.end();
            return Ok(found);
        }
        previous = Some((x, crest));
    }
    let (from, to) = range;
    let (Some(first), Some(last)) = (seen.first(), seen.last()) else {
        return Err(trouble.unwrap_or_else(|| Error::computation("the interval is empty")));
    };
    Err(Error::computation(format!(
        "the largest growth rate over k in {from}..{to} does not change sign between {} and {}: {:.4e} at {:.6}, \
         {:.4e} at {:.6}; try another interval",
        question.from, question.to, first.1, first.0, last.1, last.0
    )))
}

struct Search<'s, 'm> {
    setup: &'s Setup<'m>,
    question: Question,
    range: (f64, f64),
}

impl Search<'_, '_> {
    /// The largest growth at one value of the parameter: over the whole range, or on the crest of `near`.
    fn crest(&self, x: f64, near: Option<&Carried>) -> Result<Crest> {
        let moved = self.setup.moved(self.question.axis, x)?;
        let base = moved.base(near.map(|c| &c.base))?;
        let (pair, at_end) = moved.with_problem(&base, |problem| {
            let (start, reach) = match near {
                Some(carried) => (carried.pair.clone(), 1e-3 * carried.pair.k),
                None => {
                    let (from, to) = self.range;
                    let highest = highest(problem, self.question.near, self.range)?;
                    (highest, (to - from) / CREST_STEPS as f64)
                }
            };
            climb(problem, start, reach, self.range)
        })?;
        Ok(Crest {
            carried: Carried { base, pair },
            at_end,
        })
    }

    /// The root between two values of opposite growth.
    fn refine(&self, mut low: (f64, Crest), mut high: (f64, Crest)) -> Result<Critical> {
        if low.1.growth() > high.1.growth() {
            std::mem::swap(&mut low, &mut high);
        }
        for _ in 0..MOST_CRESTS {
            let span = TOLERANCE * low.0.abs().max(high.0.abs());
            // The mode that grows on one side is the one that is followed to zero.
            let mut last = high.1.clone();
            let slope = (high.1.growth() - low.1.growth()) / (high.0 - low.0);
            let ends = ((low.0, low.1.growth()), (high.0, high.1.growth()));
            let follow = |x: f64| {
                last = self.crest(x, Some(&last.carried))?;
                Ok(last.growth())
            };
            let (x, _) = brent(follow, ends.0, ends.1, span)?;
            let root = self.crest(x, Some(&last.carried))?;
            // Another mode, or another crest of this one, may be higher there.
            let fresh = self.crest(x, None)?;
            let scale = root.carried.pair.scale;
            if fresh.growth() > root.growth() + 1e-9 * scale {
                high = (x, fresh);
                continue;
            }
            return self.answer(x, root, slope);
        }
        Err(Error::computation(format!(
            "other modes keep overtaking the critical one near {}; try a smaller range of k",
            high.0
        )))
    }

    fn answer(&self, x: f64, root: Crest, slope: f64) -> Result<Critical> {
        let pair = &root.carried.pair;
        if root.at_end {
            return Err(Error::computation(format!(
                "the largest growth rate passes through zero near {x:.6}, but at the end k = {} of the range: try \
                 a wider range of k",
                pair.k
            )));
        }
        let (k, c0) = (pair.k, pair.c);
        let question = Question { k, ..self.question };
        let sampler = Sampler {
            setup: self.setup,
            question,
        };
        let sample = Sample {
            x,
            value: c0.re,
            c0,
            carried: root.carried,
        };
        Ok(Critical {
            value: x,
            error: sampler.error(&sample, slope)?.max(TOLERANCE * x.abs()),
            k,
            c0,
        })
    }
}

/// The mode of largest growth among evenly spaced k.
fn highest(problem: &Problem, target: Option<C64>, (from, to): (f64, f64)) -> Result<EigenPair> {
    let selection = target.map_or(Selection::Leading, Selection::Near);
    let mut trouble = None;
    let mut best: Option<EigenPair> = None;
    for i in 0..=CREST_STEPS {
        let k = from + (to - from) * i as f64 / CREST_STEPS as f64;
        match weakly::select(problem, k, selection) {
            Ok(pair) if best.as_ref().is_none_or(|b| pair.c.re > b.c.re) => best = Some(pair),
            Ok(_) => {}
            Err(error) => trouble = Some(error),
        }
    }
    best.ok_or_else(|| {
        trouble.unwrap_or_else(|| Error::computation("no mode was found in the range of k"))
    })
}

/// The crest of a mode's growth over k next to `start`: dc0/dk = 0, or the end of the range that it rises to.
fn climb(
    problem: &Problem,
    start: EigenPair,
    mut reach: f64,
    (from, to): (f64, f64),
) -> Result<(EigenPair, bool)> {
    let mut pair = spectrum::follow(problem, start.k, &start)?;
    let mut slope = |k: f64| -> Result<(f64, EigenPair)> {
        pair = spectrum::follow(problem, k, &pair)?;
        Ok((wavenumber(problem, &pair).re, pair.clone()))
    };
    let (first, _) = slope(start.k)?;
    let side = first.signum();
    let (mut a, mut fa) = (start.k, first);
    for _ in 0..60 {
        let b = (a + side * reach).clamp(from, to);
        if b == a {
            return Ok((slope(b)?.1, true));
        }
        let (fb, _) = slope(b)?;
        if fa * fb <= 0.0 {
            let (k, _) = brent(|k| Ok(slope(k)?.0), (a, fa), (b, fb), TOLERANCE * b)?;
            return Ok((slope(k)?.1, false));
        }
        (a, fa) = (b, fb);
        reach *= 1.5;
    }
    Err(Error::computation("the extremum over k was not bracketed"))
}
