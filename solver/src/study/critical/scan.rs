//! A quantity along an axis, of the leading mode at every place or of one mode by its shape, and where it passes
//! through zero.

use super::super::{Progress, Setup};
use super::grid::Grid;
use super::sampler::{NEUTRAL, Sample, Sampler, value};
use super::survey::{Node, Sought, Survey};
use super::{Critical, LEADS, Quantity, Question, Tracking};
use crate::error::{Error, Result};
use crate::model::C64;
use crate::spectrum;
use crate::weakly::Selection;
use rayon::prelude::*;

/// Places along an axis at which a mode is followed, or c2 of the leading one is looked at.
const SCAN: usize = 61;
/// Places at which all growth rates are looked at, with their slopes.
const SURVEY: usize = 25;
/// Every so many of them are looked at for the mode that grows fastest on the axis.
const STRIDE: usize = 6;
/// Times that another mode may grow at what seemed a neutral place.
const MOST_LEADERS: usize = 60;
/// A value of a curve is drawn if its error is below this part of it, or of the middle size of the curve.
const DRAWN: f64 = 0.05;

/// A quantity along an interval, and where it changes sign.
#[derive(Clone, Debug)]
pub struct Scan {
    /// In order; places at which the mode has no value are left out.
    pub curve: Vec<Place>,
    /// In order from `from` to `to`.
    pub found: Vec<Critical>,
}

/// A point of a curve.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// Where on the axis.
    pub x: f64,
    /// The quantity.
    pub value: f64,
    /// The eigenvalue of its mode.
    pub c0: C64,
}

impl Place {
    fn of(sample: &Sample) -> Self {
        Place {
            x: sample.x,
            value: sample.value,
            c0: sample.pair.c,
        }
    }
}

impl Sampler<'_> {
    /// The mode that grows fastest at some places of the axis, or the one that was named.
    fn seed(&self, places: &[f64], progress: &dyn Progress) -> Result<(usize, Sample)> {
        let selection = match self.question.tracking() {
            Tracking::Near(target) => Selection::Near(target),
            Tracking::Leading | Tracking::Fastest => Selection::Leading,
        };
        let mut best: Option<(usize, Sample)> = None;
        let mut failure = None;
        for index in (0..places.len()).step_by(STRIDE) {
            progress.advance(1);
            match self.sample(places[index], selection) {
                Ok(sample) => {
                    if best
                        .as_ref()
                        .is_none_or(|(_, b)| sample.pair.c.re > b.pair.c.re)
                    {
                        best = Some((index, sample));
                    }
                }
                Err(error) => failure = Some(error),
            }
            if matches!(selection, Selection::Near(_)) && best.is_some() {
                break;
            }
        }
        best.ok_or_else(|| failure.unwrap_or_else(|| Error::computation("the interval is empty")))
    }

    /// Samples on both sides of the seed as far as the mode can be followed.
    fn followed(&self, places: &[f64], progress: &dyn Progress) -> Result<Vec<Sample>> {
        let (start, seed) = self.seed(places, progress)?;
        let walk = |indices: &mut dyn Iterator<Item = usize>| {
            let mut samples: Vec<Sample> = Vec::new();
            for index in indices {
                progress.advance(1);
                match self.like(places[index], samples.last().unwrap_or(&seed)) {
                    Ok(sample) => samples.push(sample),
                    Err(_) => break,
                }
            }
            samples
        };
        let mut samples = walk(&mut (0..start).rev());
        samples.reverse();
        samples.push(seed.clone());
        samples.extend(walk(&mut (start + 1..places.len())));
        Ok(samples)
    }

    /// The roots of one mode.
    fn roots_of_mode(&self, samples: &[Sample]) -> Result<Vec<Critical>> {
        let mut found = Vec::new();
        let last = samples.len().saturating_sub(2);
        for (index, pair) in samples.windows(2).enumerate() {
            let [a, b] = [pair[0].value, pair[1].value];
            if (a == 0.0 || a * b < 0.0 || (index == last && b == 0.0))
                && let Some(root) = self.root(&pair[0], &pair[1])?
            {
                found.push(self.answer(&root)?);
            }
        }
        Ok(found)
    }

    /// The leading modes at some places; nothing where it has no quantity.
    fn leaders(&self, places: &[f64], progress: &dyn Progress) -> Result<Vec<Option<Sample>>> {
        let lead = |x: &f64| {
            let sample = self.sample(*x, Selection::Leading);
            progress.advance(1);
            sample
        };
        let samples: Vec<Result<Sample>> = places.par_iter().map(lead).collect();
        if let Some(Err(error)) = samples.iter().find(|s| s.is_err())
            && samples.iter().all(Result::is_err)
        {
            return Err(error.clone());
        }
        Ok(samples.into_iter().map(Result::ok).collect())
    }

    /// The roots of c2 or 1/c2 at which its mode leads. Where another mode takes over between two places, c2 of the
    /// leading mode jumps, which is no root: either mode is followed through the gap.
    fn roots_of_leaders(&self, samples: &[Option<Sample>]) -> Result<Vec<Critical>> {
        let mut found: Vec<Critical> = Vec::new();
        for pair in samples.windows(2) {
            let [Some(a), Some(b)] = pair else {
                continue;
            };
            let mut windows = Vec::new();
            let near = LEADS.sqrt() * a.pair.scale.max(b.pair.scale);
            match (self.like(b.x, a), self.like(a.x, b)) {
                (Ok(there), _) if (there.pair.c - b.pair.c).norm() <= near => {
                    windows.push((a.clone(), b.clone()));
                }
                (there, here) => {
                    windows.extend(there.ok().map(|there| (a.clone(), there)));
                    windows.extend(here.ok().map(|here| (here, b.clone())));
                }
            }
            for (a, b) in windows {
                if (a.value * b.value < 0.0 || a.value == 0.0)
                    && let Some(root) = self.root(&a, &b)?
                {
                    let critical = self.answer(&root)?;
                    let again =
                        |c: &Critical| (c.value - critical.value).abs() <= c.error + critical.error;
                    if !critical.is_overtaken() && !found.iter().any(again) {
                        found.push(critical);
                    }
                }
            }
        }
        Ok(found)
    }

    /// Where the largest growth rate passes through zero, in order.
    fn neutral_places(&self, nodes: &[Node]) -> Result<Vec<Critical>> {
        let mut found = Vec::new();
        let mut last: Option<&Node> = None;
        for node in nodes {
            if self.is_neutral(node) {
                let root = self.sample(node.x, Selection::Near(node.leading()))?;
                if last.is_some_and(|last| !self.is_neutral(last)) || last.is_none() {
                    found.push(self.answer(&root)?);
                }
            } else if let Some(last) = last.filter(|last| !self.is_neutral(last))
                && last.growth() * node.growth() < 0.0
            {
                found.push(self.neutral_place(last, node)?);
            }
            last = Some(node);
        }
        Ok(found)
    }

    /// Whether the leading mode at a place is neutral to rounding; its eigenvalue is refined where that is in question.
    fn is_neutral(&self, node: &Node) -> bool {
        let small = |c: C64, part: f64| c.re.abs() <= part * node.scale.max(c.norm());
        small(node.leading(), LEADS)
            && self
                .sample(node.x, Selection::Near(node.leading()))
                .is_ok_and(|sample| small(sample.pair.c, NEUTRAL))
    }

    /// The place between two others at which the largest growth rate passes through zero: a growing mode is followed to
    /// where it is neutral, and so is any that grows there.
    fn neutral_place(&self, a: &Node, b: &Node) -> Result<Critical> {
        let here = |node: &Node| (node.x, node.leading());
        let (mut stable, mut unstable) = match a.growth() < 0.0 {
            true => (a.x, here(b)),
            false => (b.x, here(a)),
        };
        for _ in 0..MOST_LEADERS {
            let start = self.sample(unstable.0, Selection::Near(unstable.1));
            let root = start.ok().and_then(|start| {
                let end = self.like(stable, &start).ok()?;
                let crosses = start.value * end.value < 0.0;
                crosses
                    .then(|| self.root(&start, &end).ok().flatten())
                    .flatten()
            });
            let x = root
                .as_ref()
                .map_or(0.5 * (stable + unstable.0), |root| root.x);
            let (spectrum, unit) = self.spectrum(x)?;
            let Some(&leading) = spectrum.values.first() else {
                break;
            };
            if let Some(root) =
                root.filter(|root| leading.re <= root.pair.c.re.max(0.0) + LEADS * unit)
            {
                return self.answer(&root);
            }
            if leading.re > 0.0 {
                unstable = (x, leading);
            } else {
                stable = x;
            }
        }
        Err(Error::computation(format!(
            "the largest growth rate passes through zero between {stable} and {}, but no mode could be followed to there; \
             name one with --near",
            unstable.0
        )))
    }

    /// All modes along the axis.
    fn nodes(&self, places: &[f64], progress: &dyn Progress) -> Result<Vec<Node>> {
        let [from, to] = self.question.between();
        let survey = Survey {
            spectra: &|x| self.spectrum(x),
            ends: (from.min(to), from.max(to)),
            sought: Sought::Crossings,
        };
        let mut nodes = survey.run(places, &|| progress.advance(1))?;
        if from > to {
            nodes.reverse();
        }
        Ok(nodes)
    }
}

/// The quantity of a question along its interval.
///
/// # Errors
/// A mode that can be found nowhere, a root that is not converged.
pub fn scan(setup: &Setup, question: &Question, progress: &dyn Progress) -> Result<Scan> {
    let growth_of_leader = (Tracking::Leading, Quantity::Growth);
    let places = question.places(match (question.tracking(), question.quantity()) {
        asked if asked == growth_of_leader => SURVEY,
        _ => SCAN,
    });
    let sampler = Sampler::new(setup, question, &places)?;
    progress.begin(places.len());
    let scan = match (question.tracking(), question.quantity()) {
        (Tracking::Leading, Quantity::Growth) => {
            let nodes = sampler.nodes(&places, progress)?;
            let place = |node: &Node| Place {
                x: node.x,
                value: node.growth(),
                c0: node.leading(),
            };
            Scan {
                curve: nodes.iter().map(place).collect(),
                found: sampler.neutral_places(&nodes)?,
            }
        }
        (Tracking::Leading, _) => {
            let samples = sampler.leaders(&places, progress)?;
            Scan {
                curve: samples.iter().flatten().map(Place::of).collect(),
                found: sampler.roots_of_leaders(&samples)?,
            }
        }
        (Tracking::Fastest | Tracking::Near(_), _) => {
            let samples = sampler.followed(&places, progress)?;
            Scan {
                curve: samples.iter().map(Place::of).collect(),
                found: sampler.roots_of_mode(&samples)?,
            }
        }
    };
    progress.end();
    Ok(scan)
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
        let mode = match question.tracking() {
            Tracking::Leading => "the leading mode",
            _ => "the mode",
        };
        let what = match question.quantity() {
            Quantity::Growth => format!("the growth rate of {mode} does not change sign"),
            Quantity::C2 => format!("c2 of {mode} does not pass through zero"),
            Quantity::Resonance => format!("c2 of {mode} does not jump through infinity"),
        };
        let [from, to] = question.between();
        let advice = match question.tracking() {
            Tracking::Leading => "--near to name a mode, or --follow to follow one",
            Tracking::Fastest | Tracking::Near(_) => "or --near to name another mode",
        };
        Err(Error::NoCriticalPoint(format!(
            "{what} between {from} and {to}: {:.4e} at {:.6}, {:.4e} at {:.6}; try another interval, {advice}",
            first.value, first.x, last.value, last.x
        )))
    }

    /// Places and values to draw: not a number where 3M/2 moves the value by a good part of its size.
    ///
    /// # Errors
    /// Base states that can be had nowhere.
    pub fn drawn(&self, setup: &Setup, question: &Question) -> Result<Vec<(f64, f64)>> {
        let places = question.places(SCAN);
        let sampler = Sampler::new(setup, question, &places)?;
        let curve = match (question.tracking(), question.quantity()) {
            (Tracking::Leading, Quantity::Growth) => sampler.growth_rates(&places, &self.curve),
            _ => self.curve.clone(),
        };
        let Some(finer) = Grid::finer(setup) else {
            let plain = |place: &Place| (place.x, place.value);
            return Ok(curve.iter().map(plain).collect());
        };
        let mut sizes: Vec<f64> = curve.iter().map(|place| place.value.abs()).collect();
        sizes.sort_by(f64::total_cmp);
        let middle = sizes.get(sizes.len() / 2).copied().unwrap_or(0.0);
        let checked = |place: &Place| {
            let error = sampler.difference(finer, place).unwrap_or(f64::INFINITY);
            let stands = error <= DRAWN * place.value.abs().max(middle);
            (place.x, if stands { place.value } else { f64::NAN })
        };
        Ok(curve.par_iter().map(checked).collect())
    }
}

impl Sampler<'_> {
    /// The largest growth rates at some places beside those of a curve, in order.
    fn growth_rates(&self, places: &[f64], curve: &[Place]) -> Vec<Place> {
        let look = |x: &f64| {
            let (spectrum, _) = self.spectrum(*x).ok()?;
            let c0 = *spectrum.values.first()?;
            Some(Place {
                x: *x,
                value: c0.re,
                c0,
            })
        };
        let places: Vec<Option<Place>> = places.par_iter().map(look).collect();
        let mut all: Vec<Place> = places
            .into_iter()
            .flatten()
            .chain(curve.iter().copied())
            .collect();
        all.sort_by(|a, b| a.x.total_cmp(&b.x));
        all
    }

    /// How far the quantity of a mode is from that on another grid.
    fn difference(&self, grid: Grid, place: &Place) -> Result<f64> {
        let moved = self.setup.moved(self.question.axis(), place.x)?;
        let site = self.site(place.x)?;
        let beside = grid.site(&moved, Some(&site.base))?;
        let k = self.question.k(place.x);
        if self.question.quantity() == Quantity::Growth {
            return Ok(spectrum::eigenvalues(&beside.problem, k)?.distance(place.c0));
        }
        let pair = spectrum::nearest(&site.problem, k, place.c0)?;
        let pair = spectrum::transferred(&site.problem, &pair, &beside.problem)?;
        let other = value(self.question.quantity(), &beside.problem, &pair)?;
        Ok((other - place.value).abs())
    }
}
