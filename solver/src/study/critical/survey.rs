//! All growth rates along an axis at chosen places, with their slopes, and where between two places a mode may pass
//! through zero unseen.

use super::{LEADS, ROUNDING};
use crate::error::{Error, Result};
use crate::model::C64;
use crate::pencil::Spectrum;
use rayon::prelude::*;

/// Step of the difference quotients in x, relative to the axis.
const NUDGE: f64 = 1e-6;
/// Rounds in which places are added.
const MOST_ROUNDS: usize = 40;
/// Places that are looked at.
const MOST_PLACES: usize = 600;
/// The smallest gap between two places, relative to the axis.
const SMALLEST_GAP: f64 = 1e-6;
/// A crest may rise above what a cubic between two places says by this part of its rise.
const DOUBT: f64 = 0.5;
/// Part of a gap by which a place keeps off its ends.
const MARGIN: f64 = 0.02;

/// An eigenvalue at one place, and its derivative along the axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Branch {
    pub c: C64,
    pub slope: C64,
}

/// All modes at one place, by decreasing growth rate; at least one.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub x: f64,
    pub branches: Vec<Branch>,
    /// The unit of rates: the slow eigenvalues, or the terms of the slowest balance.
    pub scale: f64,
    has_slopes: bool,
}

impl Node {
    /// The eigenvalue of the leading mode.
    pub fn leading(&self) -> C64 {
        self.branches[0].c
    }

    /// The largest growth rate.
    pub fn growth(&self) -> f64 {
        self.leading().re
    }

    /// Whether the leading mode neither grows nor decays, to rounding.
    pub fn is_neutral(&self) -> bool {
        self.growth().abs() <= ROUNDING * self.scale
    }
}

/// What a survey looks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sought {
    /// Whether a mode grows anywhere.
    Growth,
    /// Every place where the largest growth rate passes through zero.
    Crossings,
}

/// The spectra along an axis.
pub(super) struct Survey<'s> {
    /// The spectrum at a place, and the unit of rates there.
    pub spectra: &'s (dyn Fn(f64) -> Result<(Spectrum, f64)> + Sync),
    /// Ends of the axis, in order.
    pub ends: (f64, f64),
    pub sought: Sought,
}

/// Evenly spaced numbers, both ends exact.
pub(super) fn evenly(from: f64, to: f64, count: usize) -> Vec<f64> {
    let last = count - 1;
    let at = |i: usize| match i == last {
        true => to,
        false => from + (to - from) * i as f64 / last as f64,
    };
    (0..count).map(at).collect()
}

impl Survey<'_> {
    /// The modes at some places, in order, and at further ones until nothing is hidden between them. Slopes are known
    /// only where they were needed: not where a mode grows, if growth is all that is sought.
    ///
    /// # Errors
    /// Spectra that can be had nowhere.
    pub fn run(&self, places: &[f64], advance: &(dyn Fn() + Sync)) -> Result<Vec<Node>> {
        let look = |x: &f64| {
            let node = self.node(*x);
            advance();
            node
        };
        let seen: Vec<Result<Node>> = places.par_iter().map(look).collect();
        let (seen, failed): (Vec<_>, Vec<_>) = seen.into_iter().partition(Result::is_ok);
        let mut nodes: Vec<Node> = seen.into_iter().flatten().collect();
        if nodes.is_empty() {
            let failure = failed.into_iter().find_map(Result::err);
            return Err(failure.unwrap_or_else(|| Error::computation("the interval is empty")));
        }
        for _ in 0..MOST_ROUNDS {
            nodes.sort_by(|a, b| a.x.total_cmp(&b.x));
            let grows = nodes.iter().any(|node| node.growth() > LEADS * node.scale);
            if self.sought == Sought::Growth && grows || nodes.len() > MOST_PLACES {
                break;
            }
            nodes.par_iter_mut().for_each(|node| self.find_slopes(node));
            let hidden = nodes
                .windows(2)
                .filter_map(|pair| self.hidden(&pair[0], &pair[1]));
            let hidden: Vec<f64> = hidden.collect();
            let fresh: Vec<Result<Node>> = hidden.par_iter().map(|x| self.node(*x)).collect();
            let before = nodes.len();
            nodes.extend(fresh.into_iter().flatten());
            if nodes.len() == before {
                break;
            }
        }
        nodes.sort_by(|a, b| a.x.total_cmp(&b.x));
        Ok(nodes)
    }

    /// All modes at one place, without slopes.
    fn node(&self, x: f64) -> Result<Node> {
        let (spectrum, scale) = (self.spectra)(x)?;
        if spectrum.values.is_empty() {
            return Err(Error::computation(
                "the linear problem has no finite eigenvalue",
            ));
        }
        let level = |&c: &C64| Branch {
            c,
            slope: C64::new(0.0, 0.0),
        };
        Ok(Node {
            x,
            scale,
            branches: spectrum.values.iter().map(level).collect(),
            has_slopes: false,
        })
    }

    /// Slopes as difference quotients to the nearest eigenvalues beside; none where there is no spectrum.
    fn find_slopes(&self, node: &mut Node) {
        let (low, high) = self.ends;
        let step = NUDGE * node.x.abs().max(high - low);
        let step = if node.x + step > high { -step } else { step };
        if std::mem::replace(&mut node.has_slopes, true) {
            return;
        }
        let Ok((beside, _)) = (self.spectra)(node.x + step) else {
            return;
        };
        let distance = |a: &C64, c: C64| (a - c).norm();
        for branch in &mut node.branches {
            let values = beside.values.iter();
            let nearest =
                values.min_by(|a, b| distance(a, branch.c).total_cmp(&distance(b, branch.c)));
            branch.slope = nearest.map_or(C64::new(0.0, 0.0), |c| (c - branch.c) / step);
        }
    }

    /// The place between two neighbours at which the sign of the largest growth rate may be another.
    fn hidden(&self, a: &Node, b: &Node) -> Option<f64> {
        let (low, high) = self.ends;
        if b.x - a.x <= SMALLEST_GAP * (high - low) || a.is_neutral() && b.is_neutral() {
            return None;
        }
        let part = match (a.growth() > 0.0, b.growth() > 0.0) {
            (false, false) => crest(a, b),
            (true, true) if self.sought == Sought::Crossings => dip(a, b),
            _ => None,
        };
        part.map(|part| a.x + (b.x - a.x) * part.clamp(MARGIN, 1.0 - MARGIN))
    }
}

/// Where a mode may grow between two places at which all decay, as a part of the gap: at the crest of a cubic through
/// the growth rates and slopes of a mode here and its likely continuation there.
fn crest(a: &Node, b: &Node) -> Option<f64> {
    let gap = b.x - a.x;
    let floor = ROUNDING * a.scale.max(b.scale);
    let mut highest: Option<(f64, f64)> = None;
    for here in &a.branches {
        for there in &b.branches {
            let ends = here.c.re.max(there.c.re);
            let [rises, falls] = [here.slope.re.max(0.0), (-there.slope.re).max(0.0)];
            // The crest of a cubic lies no higher than this above its ends.
            if ends + gap * (rises + falls) <= 0.0 || !continues(here, there, gap) {
                continue;
            }
            let cubic = Cubic::new(
                [here.c.re, there.c.re],
                [gap * here.slope.re, gap * there.slope.re],
            );
            let Some((part, value)) = cubic.crest() else {
                continue;
            };
            let rise = value - ends;
            let bound = ends + (1.0 + DOUBT) * rise;
            if bound > floor && rise > floor && highest.is_none_or(|(_, other)| bound > other) {
                highest = Some((part, bound));
            }
        }
    }
    highest.map(|(part, _)| part)
}

/// Whether an eigenvalue may be the continuation of another, by their slopes.
pub(super) fn continues(here: &Branch, there: &Branch, gap: f64) -> bool {
    let mean = 0.5 * gap * (here.slope + there.slope);
    let reach = 0.5 * gap.abs() * (here.slope.norm() + there.slope.norm());
    (there.c - here.c - mean).norm() <= reach
}

/// Where all modes may decay between two places at which one grows, if the tangents of the leading growth rates meet
/// below zero.
fn dip(a: &Node, b: &Node) -> Option<f64> {
    let gap = b.x - a.x;
    let (here, there) = (&a.branches[0], &b.branches[0]);
    let [falls, rises] = [gap * here.slope.re, gap * there.slope.re];
    if !(falls < 0.0 && rises > 0.0) {
        return None;
    }
    let part = (there.c.re - here.c.re - rises) / (falls - rises);
    let lowest = here.c.re + falls * part;
    if !(lowest < 0.0 && part > 0.0 && part < 1.0) {
        return None;
    }
    let cubic = Cubic::new([-here.c.re, -there.c.re], [-falls, -rises]);
    Some(cubic.crest().map_or(part, |(lowest, _)| lowest))
}

/// A cubic polynomial on 0..1.
struct Cubic {
    /// By power.
    coefficients: [f64; 4],
}

impl Cubic {
    /// From values and slopes at both ends.
    fn new([f0, f1]: [f64; 2], [m0, m1]: [f64; 2]) -> Self {
        let rise = f1 - f0;
        Cubic {
            coefficients: [f0, m0, 3.0 * rise - 2.0 * m0 - m1, m0 + m1 - 2.0 * rise],
        }
    }

    /// The place of the maximum inside, and the value there.
    fn crest(&self) -> Option<(f64, f64)> {
        let [d, c, b, a] = self.coefficients;
        // 3a t² + 2b t + c = 0 where 6a t + 2b < 0: t = (−b − √(b² − 3ac))/(3a) = c/(−b + √(b² − 3ac))
        let root = b * b - 3.0 * a * c;
        if root < 0.0 {
            return None;
        }
        let root = root.sqrt();
        let t = match b < 0.0 {
            true => c / (root - b),
            false => (-b - root) / (3.0 * a),
        };
        (t > 0.0 && t < 1.0).then_some((t, d + t * (c + t * (b + t * a))))
    }
}

#[cfg(test)]
mod tests {
    use super::{Cubic, Sought, Survey, evenly};
    use crate::model::C64;
    use crate::pencil::Spectrum;

    #[test]
    fn crests_of_cubics() {
        // 1 − (t − 1/4)²
        let (t, value) = Cubic::new([0.9375, 0.4375], [0.5, -1.5])
            .crest()
            .expect("a crest");
        assert!((t - 0.25).abs() < 1e-15 && (value - 1.0).abs() < 1e-15);
        // t³ − t + …, its maximum left of 0; and t(1 − t)(2 − t), at 1 − 1/√3.
        assert!(Cubic::new([0.0, 0.0], [-1.0, 2.0]).crest().is_none());
        let (t, _) = Cubic::new([0.0, 0.0], [2.0, -1.0])
            .crest()
            .expect("a crest");
        assert!((t - (1.0 - 1.0 / 3_f64.sqrt())).abs() < 1e-15);
    }

    /// A band of growth narrower than a hundredth of the distance of places, among damped modes; and a gap in a band.
    #[test]
    fn what_lies_between_places() {
        for width in [1e-1, 1e-2, 1e-3] {
            for middle in [0.87, 1.503, 2.3] {
                let narrow = |k: f64| 1e-2 - (1e-1 * (k - middle) / width).powi(2);
                let spectra = |k: f64| {
                    let modes = [narrow(k), -0.5 - k * k, -0.7 - 0.1 * k, -3.0];
                    Ok((Spectrum::new(modes.map(|c| C64::new(c, 0.0)).to_vec()), 1.0))
                };
                let survey = |sought| Survey {
                    spectra: &spectra,
                    ends: (0.5, 3.0),
                    sought,
                };
                let nodes = survey(Sought::Growth)
                    .run(&evenly(0.5, 3.0, 17), &|| {})
                    .expect("nodes");
                assert!(
                    nodes.iter().any(|node| node.growth() > 0.0),
                    "{width} {middle}"
                );
                assert!(nodes.len() < 40, "{}", nodes.len());
                let turned = |k: f64| {
                    let modes = [-narrow(k), -3.0 - k].map(|c| C64::new(c, 0.0));
                    Ok((Spectrum::new(modes.to_vec()), 1.0))
                };
                let survey = Survey {
                    spectra: &turned,
                    ends: (0.5, 3.0),
                    sought: Sought::Crossings,
                };
                let nodes = survey.run(&evenly(0.5, 3.0, 17), &|| {}).expect("nodes");
                let changes = nodes
                    .windows(2)
                    .filter(|p| p[0].growth() * p[1].growth() < 0.0);
                assert_eq!(changes.count(), 2, "{width} {middle}");
            }
        }
    }
}
