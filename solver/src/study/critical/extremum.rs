//! The extremum over k of a neutral curve: the place at which the largest growth rate, over a range of k and over all
//! modes, passes through zero. There growth = 0 and dc0/dk = 0 (real parts), by Newton's method in k and the parameter.
//! A root is an answer only if no mode grows at any k of the range there.

use super::super::{Progress, Setup};
use super::crest::{Crest, climb, highest};
use super::first::{SCAN, WAVENUMBERS};
use super::grid::{Beside, Grid};
use super::newton::{Root, SMALL, polish};
use super::sampler::{NEUTRAL, unit_of};
use super::summit::{Growth, Summit};
use super::{Critical, LEADS, Question, TOLERANCE, Tracking, UNRESOLVED, Wavenumber};
use crate::error::{Error, Result};
use crate::numerics::brent;
use crate::spectrum;
use crate::wavevector::WaveVector;
use crate::weakly::{self, Selection};

/// Values of the parameter that are scanned for a mode that is followed, and every so many of them are looked at for it.
const FOLLOWED_SCAN: usize = 13;
const STRIDE: usize = 6;
/// Wavenumbers at which all modes are looked at to verify a root.
const FINE_WAVENUMBERS: usize = 20;
/// Times that another mode may grow at what seemed an extremum.
const MOST_CRESTS: usize = 60;

/// An extremum with what it rests on.
#[derive(Clone)]
pub struct Extremal {
    /// The answer.
    pub critical: Critical,
    /// The root with its mode.
    pub(in crate::study) root: Root,
    /// The same root on other grids.
    pub(in crate::study) beside: Vec<RootOn>,
}

/// A root on another grid, and the factor by which a difference from it counts as an error.
#[derive(Clone)]
pub(in crate::study) struct RootOn {
    pub factor: f64,
    pub root: Result<Root>,
}

/// The critical point at which the largest growth rate over a range of k passes through zero: the one next to the end
/// of the interval that is stable, or next to its beginning.
///
/// # Errors
/// A question without a range of k; an interval in which the largest growth rate does not change sign; a largest growth
/// rate at an end of the range; a root that is not converged.
pub fn minimise(setup: &Setup, question: &Question, progress: &dyn Progress) -> Result<Extremal> {
    let Wavenumber::Range(low, high) = question.wavenumber() else {
        return Err(Error::input(
            "an extremum over k needs a range of k: give it with --minimize k=A:B",
        ));
    };
    progress.begin(SCAN);
    let search = Search {
        setup,
        question,
        range: (low, high),
    };
    let root = match question.tracking() {
        Tracking::Leading => search.leading(progress),
        Tracking::Fastest | Tracking::Near(_) => search.followed(progress),
    }?;
    let answer = search.answer(root)?;
    search.check_interval(&answer.critical)?;
    progress.end();
    Ok(answer)
}

/// A search for an extremum.
pub(super) struct Search<'s> {
    pub(super) setup: &'s Setup,
    pub(super) question: &'s Question,
    pub(super) range: (f64, f64),
}

/// Where a crest of growth over k passes through zero.
enum Neutral {
    /// Inside the range of k.
    Inside(Box<Root>),
    /// At an end of it.
    AtEnd { x: f64, k: f64 },
}

impl Neutral {
    fn place(&self) -> (f64, f64) {
        match self {
            Neutral::Inside(root) => (root.x, root.pair.k.k()),
            Neutral::AtEnd { x, k } => (*x, *k),
        }
    }
}

impl Search<'_> {
    /// Refuses a root that lies outside of the interval by more than its error.
    fn check_interval(&self, critical: &Critical) -> Result<()> {
        let Critical { value, error, .. } = *critical;
        let [from, to] = self.question.between();
        let [low, high] = [from.min(to), from.max(to)];
        if (low - error..=high + error).contains(&value) {
            return Ok(());
        }
        Err(Error::NoCriticalPoint(format!(
            "the largest growth rate over k passes through zero at {value}, outside of the interval {low}..{high}: try \
             another interval"
        )))
    }

    pub(super) fn no_change(&self, [first, last]: [Growth; 2]) -> Error {
        let [from, to] = self.question.between();
        let (low, high) = self.range;
        Error::NoCriticalPoint(format!(
            "the largest growth rate over k in {low}..{high} does not change sign between {from} and {to}: \
             {:.4e} at {:.6}, {:.4e} at {:.6}; try another interval",
            first.rate, first.x, last.rate, last.x
        ))
    }

    /// The place between two values of the parameter at which the largest growth rate is zero: a growing crest is
    /// followed to where it is neutral, and so is the highest one that still grows there.
    pub(super) fn settle(&self, stable: &Summit, mut unstable: Summit) -> Result<Root> {
        let mut stable = stable.growth();
        let fine = self.wavenumbers(FINE_WAVENUMBERS);
        for _ in 0..MOST_CRESTS {
            let neutral = self
                .crest(&unstable)
                .and_then(|crest| self.neutral(stable, &crest));
            let mut wavenumbers = fine.clone();
            let x = match &neutral {
                Ok(neutral) => {
                    let (x, k) = neutral.place();
                    wavenumbers.push(k);
                    x
                }
                Err(_) => 0.5 * (stable.x + unstable.x),
            };
            let summit = self.summit(x, Some(&unstable.site.base), &wavenumbers)?;
            if summit.c.re <= LEADS * summit.unit
                && let Ok(neutral) = neutral
            {
                return self.inside(neutral);
            }
            if (x - stable.x).abs().min((x - unstable.x).abs()) <= TOLERANCE * self.size(x) {
                break;
            }
            if summit.c.re > 0.0 {
                unstable = summit;
            } else {
                stable = summit.growth();
            }
        }
        Err(Error::computation(format!(
            "the largest growth rate over k passes through zero between {} and {}, but its mode could not be followed to \
             there; try a smaller range of k, or --near to name a mode",
            stable.x, unstable.x
        )))
    }

    /// The size of a value of the parameter: no less than a part of the interval, so that zero is a value like others.
    fn size(&self, x: f64) -> f64 {
        let [from, to] = self.question.between();
        x.abs().max(SMALL * (to - from).abs())
    }

    /// The root, if it lies inside the range of k.
    fn inside(&self, neutral: Neutral) -> Result<Root> {
        match neutral {
            Neutral::Inside(root) => Ok(*root),
            Neutral::AtEnd { x, k } => Err(Error::computation(format!(
                "the largest growth rate passes through zero near {x:.6}, but at the end k = {k} of the range: try a \
                 wider range of k"
            ))),
        }
    }

    /// The crest of growth over k beside a summit.
    fn crest(&self, summit: &Summit) -> Result<Crest> {
        let pair = {
            let k = WaveVector::along_x(summit.k);
            weakly::select(&summit.site.problem, k, Selection::Near(summit.c))?
        };
        climb(summit.x, summit.site.clone(), &pair, self.range)
    }

    /// A crest followed to another value of the parameter.
    fn moved(&self, x: f64, crest: &Crest) -> Result<Crest> {
        let site = self.site(x, Some(&crest.site.base))?;
        climb(x, site, &crest.pair, self.range)
    }

    /// Where a growing crest is neutral, on the way to a value of the parameter at which all modes decay: by Newton's
    /// method, or by Brent's along the crest.
    fn neutral(&self, stable: Growth, crest: &Crest) -> Result<Neutral> {
        let growth = crest.pair.c.re;
        if !crest.at_end {
            let part = growth / (growth - stable.rate);
            let x = crest.x + part * (stable.x - crest.x);
            let bracket = (stable.x, crest.x);
            if let Ok(root) = self.polished(x, crest, bracket) {
                return Ok(Neutral::Inside(Box::new(root)));
            }
        }
        let mut last = crest.clone();
        let end = self.moved(stable.x, crest)?;
        let span = TOLERANCE * self.size(stable.x).max(self.size(crest.x));
        let follow = |x: f64| {
            let nearest = match (x - last.x).abs() < (x - end.x).abs() {
                true => &last,
                false => &end,
            };
            last = self.moved(x, nearest)?;
            Ok(last.pair.c.re)
        };
        if end.pair.c.re >= 0.0 {
            return Err(Error::computation("the crest grows on either side"));
        }
        let (x, _) = brent(follow, (crest.x, growth), (end.x, end.pair.c.re), span)?;
        let root = self.moved(x, &last)?;
        if root.at_end {
            return Ok(Neutral::AtEnd {
                x,
                k: root.pair.k.k(),
            });
        }
        let root = self.polished(x, &root, (stable.x, crest.x))?;
        Ok(Neutral::Inside(Box::new(root)))
    }

    /// A root by Newton's method from x and the wavenumber of a crest, inside the range of k and a bracket.
    fn polished(&self, x: f64, crest: &Crest, bracket: (f64, f64)) -> Result<Root> {
        let grid = Grid::of(self.setup);
        let start = (x, &crest.pair, &crest.site.base);
        polish(self.setup, self.axis(), grid, start, (bracket, self.range))
    }

    /// The extremum of the neutral curve of one mode, followed by its shape.
    fn followed(&self, progress: &dyn Progress) -> Result<Root> {
        let places = self.question.places(FOLLOWED_SCAN);
        let (start, seed) = self.seed(&places)?;
        let walk = |indices: &mut dyn Iterator<Item = usize>| {
            let mut crests: Vec<Crest> = Vec::new();
            for index in indices {
                progress.advance(1);
                match self.moved(places[index], crests.last().unwrap_or(&seed)) {
                    Ok(crest) => crests.push(crest),
                    Err(_) => break,
                }
            }
            crests
        };
        let mut crests = walk(&mut (0..start).rev());
        crests.reverse();
        crests.push(seed.clone());
        crests.extend(walk(&mut (start + 1..places.len())));
        let grows = |crest: &Crest| crest.pair.c.re > 0.0;
        let ends = [&crests[0], &crests[crests.len() - 1]].map(Crest::growth);
        if grows(&crests[0]) && !grows(&crests[crests.len() - 1]) {
            crests.reverse();
        }
        let neutral = match crests
            .windows(2)
            .find(|pair| grows(&pair[0]) != grows(&pair[1]))
        {
            Some([a, b]) if grows(a) => self.neutral(b.growth(), a),
            Some([a, b]) => self.neutral(a.growth(), b),
            _ => Err(self.no_change(ends)),
        };
        self.inside(neutral?)
    }

    /// The mode that is followed, where it grows fastest over k.
    fn seed(&self, places: &[f64]) -> Result<(usize, Crest)> {
        let selection = match self.question.tracking() {
            Tracking::Near(target) => Selection::Near(target),
            Tracking::Leading | Tracking::Fastest => Selection::Leading,
        };
        let wavenumbers = self.wavenumbers(WAVENUMBERS);
        let mut best: Option<(usize, Crest)> = None;
        let mut failure = None;
        for index in (0..places.len()).step_by(STRIDE) {
            let crest = self.site(places[index], None).and_then(|site| {
                let pair = highest(&site.problem, selection, &wavenumbers)?;
                climb(places[index], site, &pair, self.range)
            });
            match crest {
                Ok(crest) => {
                    if best
                        .as_ref()
                        .is_none_or(|(_, b)| crest.pair.c.re > b.pair.c.re)
                    {
                        best = Some((index, crest));
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

    /// The answer with its errors: how far the root lies from those on other grids.
    fn answer(&self, root: Root) -> Result<Extremal> {
        let (x, k, c0) = (root.x, root.pair.k.k(), root.pair.c);
        let unit = unit_of(&root.site.problem, &root.pair);
        let rounding = 0.1 * NEUTRAL * unit;
        // What rounding and the search leave of growth and of its slope over k.
        let [growth, slope] = [c0.re, k * root.envelope.slope.re].map(|part| part.abs() + rounding);
        let leftover = growth / root.slope.abs();
        let mut critical = Critical {
            value: x,
            error: leftover.max(TOLERANCE * x.abs()),
            k,
            k_error: (slope / k / root.envelope.curvature.re.abs()).max(TOLERANCE * k),
            c0,
            c0_error: growth,
            leading_growth: c0.re,
            scale: unit,
        };
        let mut beside = Vec::new();
        for Beside { grid, factor } in Grid::beside(self.setup, &root.site.base) {
            let moved = root.on(self.setup, self.axis(), grid);
            let far = f64::INFINITY;
            let [dx, dk, dc] = moved.as_ref().map_or([far; 3], |moved| {
                let c = (moved.pair.c - c0).norm();
                [(moved.x - x).abs(), (moved.pair.k.k() - k).abs(), c]
            });
            critical.error = critical.error.max(factor * dx);
            critical.k_error = critical.k_error.max(factor * dk);
            critical.c0_error = critical.c0_error.max(factor * dc);
            beside.push(RootOn {
                factor,
                root: moved,
            });
        }
        let [low, high] = [self.range.0, self.range.1];
        let lost = critical.k_error.is_nan() || critical.k_error >= high - low;
        let bound = (UNRESOLVED * self.size(x)).max(leftover);
        if lost || critical.error.is_nan() || critical.error > bound {
            return Err(Error::unresolved(
                format!("the critical point near {x}"),
                self.setup.effective_resolution(),
                format!("another M moves it by {:.1e}", critical.error),
            ));
        }
        let leading = spectrum::eigenvalues(&root.site.problem, root.pair.k)?;
        let leading = leading.values.first().map_or(c0.re, |c| c.re);
        critical.leading_growth = leading.max(c0.re);
        Ok(Extremal {
            critical,
            root,
            beside,
        })
    }
}
