//! The extremum over k of a neutral curve: growth = 0 and dc0/dk = 0 (real parts) together, by Newton's method in
//! k and the parameter.

use super::critical::{Critical, Question, Sample, Sampler, TOLERANCE};
use super::{Carried, Progress, Setup};
use crate::error::{Error, Result};
use crate::model::C64;
use crate::numerics::{Failure, Linearised, Newton, System, brent};
use crate::problem::Problem;
use crate::spectrum::{self, EigenPair};
use crate::weakly::{self, Envelope, Selection};
use rayon::prelude::*;

/// Values of the parameter that are scanned.
const SCAN: usize = 12;
/// At every so many of them all modes over the whole range of k are looked at; in between, these are followed.
const STRIDE: usize = 6;
/// Steps of a range of k in which the largest growth is looked for.
const CREST_STEPS: usize = 16;
/// Steps of Newton's method, in k alone and in k and the parameter.
const MOST_STEPS: usize = 20;
const METHOD: Newton = Newton {
    most_steps: MOST_STEPS,
    least_part: 1.0,
};
/// Relative change of the parameter by which derivatives along it are differenced.
const NUDGE: f64 = 1e-6;
/// What rounding leaves undecided of a growth rate, relative to the slow ones.
const ROUNDING: f64 = 1e-14;
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
    question.axis.check_continuous(setup.model.structure())?;
    progress.begin(SCAN + 1);
    let search = Search {
        setup,
        question,
        range,
    };
    let (seen, mut trouble) = search.scan(progress);
    let crossing = |pair: &&[(f64, Crest)]| pair[0].1.growth() * pair[1].1.growth() <= 0.0;
    let mut crossings = seen.windows(2).filter(crossing).peekable();
    let crosses = crossings.peek().is_some();
    // One at an end of the range of k is an answer only to say so, where there is no other.
    for pair in crossings {
        match search.refine(pair[0].clone(), pair[1].clone()) {
            Ok(found) => {
                progress.end();
                return Ok(found);
            }
            Err(error) => trouble = Some(error),
        }
    }
    if let Some(error) = trouble.take_if(|_| crosses) {
        return Err(error);
    }
    let (from, to) = range;
    let (Some((x, first)), Some((y, last))) = (seen.first(), seen.last()) else {
        return Err(trouble.unwrap_or_else(|| Error::computation("the interval is empty")));
    };
    Err(Error::NoCriticalPoint(format!(
        "the largest growth rate over k in {from}..{to} does not change sign between {} and {}: {:.4e} at {x:.6}, \
         {:.4e} at {y:.6}; try another interval",
        question.from,
        question.to,
        first.growth(),
        last.growth()
    )))
}

struct Search<'s> {
    setup: &'s Setup,
    question: Question,
    range: (f64, f64),
}

impl Search<'_> {
    /// The largest growth along the parameter, wherever it is found, and what failed last.
    fn scan(&self, progress: &dyn Progress) -> (Vec<(f64, Crest)>, Option<Error>) {
        let question = &self.question;
        let place =
            |step: usize| question.from + (question.to - question.from) * step as f64 / SCAN as f64;
        let mut trouble = None;
        let mut found: Vec<Option<Crest>> = vec![None; SCAN + 1];
        for step in (0..=SCAN).step_by(STRIDE) {
            progress.advance(1);
            match self.crest(place(step), None) {
                Ok(crest) => found[step] = Some(crest),
                Err(error) => trouble = Some(error),
            }
        }
        // Followed from both sides: another mode may take over in between.
        let mut keep = |step: usize, near: Option<Crest>, found: &mut Vec<Option<Crest>>| {
            let crest = match near.map(|near| self.crest(place(step), Some(&near.carried))) {
                Some(Ok(crest)) => crest,
                // What cannot be followed is looked for anew.
                _ => match self.crest(place(step), None) {
                    Ok(crest) => crest,
                    Err(error) => {
                        trouble = Some(error);
                        return;
                    }
                },
            };
            let higher = |known: &Crest| known.growth() >= crest.growth();
            if !found[step].as_ref().is_some_and(higher) {
                found[step] = Some(crest);
            }
        };
        for step in (1..SCAN).filter(|step| !step.is_multiple_of(STRIDE)) {
            progress.advance(1);
            let near = found[step - 1].clone();
            keep(step, near, &mut found);
        }
        for step in (1..SCAN).filter(|step| !step.is_multiple_of(STRIDE)).rev() {
            let near = found[step + 1].clone();
            keep(step, near, &mut found);
        }
        let seen = found.into_iter().enumerate();
        let seen = seen.filter_map(|(step, crest)| Some((place(step), crest?)));
        (seen.collect(), trouble)
    }

    /// The largest growth at one value of the parameter: over the whole range, or on the crest of `near`.
    fn crest(&self, x: f64, near: Option<&Carried>) -> Result<Crest> {
        let moved = self.setup.moved(self.question.axis, x)?;
        let base = moved.base(near.map(|c| c.base.as_ref()))?;
        let problem = moved.problem(&base)?;
        let start = match near {
            Some(carried) => carried.pair.clone(),
            None => highest(&problem, self.question.near, self.range)?,
        };
        let (pair, at_end) = climb(&problem, start, self.range)?;
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
            let slope = (high.1.growth() - low.1.growth()) / (high.0 - low.0);
            // The mode that grows on one side is the one that is followed to zero.
            let (x, root) = match self.newton(&low, &high) {
                Some(found) => found,
                None => self.bracketed(&low, &high)?,
            };
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

    /// The root by Newton's method from between two values; nothing where it leaves the bracket, or k the range.
    fn newton(&self, low: &(f64, Crest), high: &(f64, Crest)) -> Option<(f64, Crest)> {
        let (a, b) = (low.1.growth(), high.1.growth());
        let x = low.0 - a * (high.0 - low.0) / (b - a);
        let mut extremum = Extremum {
            search: self,
            bracket: (low.0, high.0),
            near: high.1.carried.clone(),
        };
        let start = vec![high.1.carried.pair.k, x];
        let (at, found) = METHOD.solve(&mut extremum, start).ok()?;
        let crest = Crest {
            carried: found.known,
            at_end: false,
        };
        Some((at[1], crest))
    }

    /// A mode followed to another place, with its dc0/dk and d²c0/dk².
    fn envelope(&self, x: f64, k: f64, near: &Carried) -> Result<(Carried, Envelope)> {
        let moved = self.setup.moved(self.question.axis, x)?;
        let base = moved.base(Some(&near.base))?;
        let problem = moved.problem(&base)?;
        let pair = spectrum::follow(&problem, k, &near.pair)?;
        let envelope = Envelope::of(&problem, &pair)?;
        Ok((Carried { base, pair }, envelope))
    }

    /// The same root by Brent's method along the crest.
    fn bracketed(&self, low: &(f64, Crest), high: &(f64, Crest)) -> Result<(f64, Crest)> {
        let span = TOLERANCE * low.0.abs().max(high.0.abs());
        let mut last = high.1.clone();
        let follow = |x: f64| {
            last = self.crest(x, Some(&last.carried))?;
            Ok(last.growth())
        };
        let ends = ((low.0, low.1.growth()), (high.0, high.1.growth()));
        let (x, _) = brent(follow, ends.0, ends.1, span)?;
        Ok((x, self.crest(x, Some(&last.carried))?))
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
        // What rounding of the growth rate makes of the root, which may be zero.
        let rounding = (ROUNDING * c0.norm().max(pair.scale) / slope).abs();
        let question = Question {
            k: Some(k),
            ..self.question
        };
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
            error: sampler
                .error(&sample, slope)?
                .max(TOLERANCE * x.abs())
                .max(rounding),
            k,
            c0,
        })
    }
}

/// a = Re c0 = 0 and a_k = Re dc0/dk = 0 in (k, x).
struct Extremum<'s> {
    search: &'s Search<'s>,
    bracket: (f64, f64),
    /// The mode that is followed.
    near: Carried,
}

impl System for Extremum<'_> {
    /// [a_k a_x; a_kk a_kx]
    type Jacobian = [[f64; 2]; 2];
    type Known = Carried;
    type Error = Failure;

    fn linearise(&mut self, at: &[f64]) -> std::result::Result<Option<Linearised<Self>>, Failure> {
        let (k, x) = (at[0], at[1]);
        let (low, high) = self.bracket;
        let nudge = NUDGE * x.abs().max((high - low).abs());
        let values = self.search.envelope(x, k, &self.near).and_then(|here| {
            let there = self.search.envelope(x + nudge, k, &here.0)?;
            Ok((here, there))
        });
        let Ok(((here, envelope), (there, moved))) = values else {
            return Ok(None);
        };
        self.near = here.clone();
        let along = (there.pair.c.re - here.pair.c.re) / nudge;
        let across = (moved.slope.re - envelope.slope.re) / nudge;
        Ok(Some(Linearised {
            residual: vec![here.pair.c.re, envelope.slope.re],
            jacobian: [[envelope.slope.re, along], [envelope.curvature.re, across]],
            known: here,
        }))
    }

    fn admits(&self, at: &[f64]) -> bool {
        let ((from, to), (low, high)) = (self.search.range, self.bracket);
        at[0] > from && at[0] < to && (at[1] - low) * (at[1] - high) <= 0.0
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
        step[1].abs() <= TOLERANCE * at[1].abs() && step[0].abs() <= 1e-9 * at[0]
    }
}

/// The mode of largest growth among evenly spaced k.
fn highest(problem: &Problem, target: Option<C64>, (from, to): (f64, f64)) -> Result<EigenPair> {
    let selection = target.map_or(Selection::Leading, Selection::Near);
    let places: Vec<f64> = (0..=CREST_STEPS)
        .map(|i| from + (to - from) * i as f64 / CREST_STEPS as f64)
        .collect();
    let found: Vec<Result<EigenPair>> = places
        .par_iter()
        .map(|&k| weakly::select(problem, k, selection))
        .collect();
    let (found, trouble): (Vec<_>, Vec<_>) = found.into_iter().partition(Result::is_ok);
    let best = found
        .into_iter()
        .flatten()
        .reduce(|best, pair| if pair.c.re > best.c.re { pair } else { best });
    let trouble = trouble.into_iter().find_map(Result::err);
    best.ok_or_else(|| {
        trouble.unwrap_or_else(|| Error::computation("no mode was found in the range of k"))
    })
}

/// The crest of a mode's growth over k next to `start`: dc0/dk = 0 by Newton's method, uphill where growth is not
/// concave; or the end of the range that it rises to.
fn climb(problem: &Problem, start: EigenPair, (from, to): (f64, f64)) -> Result<(EigenPair, bool)> {
    let mut pair = spectrum::follow(problem, start.k, &start)?;
    let mut reach = (to - from) / CREST_STEPS as f64;
    for _ in 0..5 * MOST_STEPS {
        let Envelope { slope, curvature } = Envelope::of(problem, &pair)?;
        let newton = -slope.re / curvature.re;
        let step = match curvature.re < 0.0 && newton.abs() <= reach {
            true => newton,
            false => reach.copysign(slope.re),
        };
        let k = (pair.k + step).clamp(from, to);
        if k == pair.k {
            return Ok((pair, slope.re != 0.0 && (k == from || k == to)));
        }
        let next = spectrum::follow(problem, k, &pair)?;
        // A step too far.
        if next.c.re < pair.c.re - 1e-12 * pair.scale {
            reach = 0.3 * step.abs();
            continue;
        }
        let settled = step.abs() <= 1e-10 * k;
        pair = next;
        if settled {
            return Ok((pair, false));
        }
    }
    Err(Error::computation("the extremum over k was not found"))
}
