//! Hills of growth over a parameter x and the wavenumber k: an island of instability may be narrower than the steps of
//! the search in both.
//!
//! At each place (x, k) of the search every growth rate has its slopes along x and k. A concave hill lies below its
//! tangent planes. One whose top is nearer to this place than to its neighbours, and above zero, therefore shows as
//!
//! Re c + |Re ∂c/∂x| d_x + |Re ∂c/∂k| d_k > 0,  d half the gap to the neighbour that the slope points to.
//!
//! No top lies in between if the same mode still rises in that direction at the neighbour. From the other places the
//! top is climbed to by Newton's method on the gradient.

use super::LEADS;
use super::first::Sites;
use super::survey::{Branch, continues};
use crate::error::Result;
use crate::model::C64;
use crate::problem::Problem;
use crate::spectrum::{self, EigenPair};
use crate::wavevector::WaveVector;
use crate::weakly::{self, Selection};
use rayon::prelude::*;
use std::sync::Arc;

/// Step of the difference quotients of slopes, as a part of the gap.
const NUDGE: f64 = 1e-5;
/// The same of curvatures.
const SPREAD: f64 = 1e-2;
/// Hills that are climbed.
const MOST_HILLS: usize = 24;
/// Steps of one climb.
const MOST_STEPS: usize = 14;
/// Times that a step is halved.
const MOST_HALVES: usize = 5;
/// A climb has ended when a step is a smaller part of the gaps.
const SETTLED: f64 = 1e-4;

/// A value of the parameter and a wavenumber.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub x: f64,
    pub k: f64,
}

/// All eigenvalues at one place, with their slopes along x and along k.
struct Node {
    modes: Vec<Slopes>,
    unit: f64,
}

#[derive(Clone, Copy)]
struct Slopes {
    c: C64,
    along_x: C64,
    along_k: C64,
}

/// A place from which a hill may rise above zero.
struct Foot {
    place: Place,
    c: C64,
    /// The height of the tangent plane half a gap on.
    bound: f64,
    /// Gaps to the neighbours uphill.
    gaps: Place,
    /// The unit of rates.
    unit: f64,
}

/// A grid of places, in increasing order of both.
pub(super) struct Hills<'s> {
    sites: &'s Sites<'s>,
    x: Vec<f64>,
    k: Vec<f64>,
}

impl<'s> Hills<'s> {
    /// The grid of some values of the parameter and wavenumbers.
    pub fn new(sites: &'s Sites<'s>, x: &[f64], k: &[f64]) -> Self {
        let sorted = |values: &[f64]| {
            let mut values = values.to_vec();
            values.sort_by(f64::total_cmp);
            values.dedup();
            values
        };
        Hills {
            sites,
            x: sorted(x),
            k: sorted(k),
        }
    }

    /// A place at which a mode grows: on the hill whose tangent plane reaches highest, of those that rise above zero.
    /// Nothing where none does.
    ///
    /// # Errors
    /// A spectrum that cannot be computed at a place of the grid.
    pub fn growing(&self) -> Result<Option<Place>> {
        self.make_sites()?;
        let places: Vec<(usize, usize)> = (0..self.x.len())
            .flat_map(|i| (0..self.k.len()).map(move |j| (i, j)))
            .collect();
        let nodes: Vec<Node> = places
            .par_iter()
            .map(|&(i, j)| self.node(i, j))
            .collect::<Result<_>>()?;
        let mut feet: Vec<Foot> = places
            .iter()
            .flat_map(|&(i, j)| self.feet(&nodes, i, j))
            .collect();
        feet.sort_by(|a, b| b.bound.total_cmp(&a.bound));
        feet.truncate(MOST_HILLS);
        Ok(feet.iter().find_map(|foot| self.climb(foot)))
    }

    /// Makes the collocations of the grid and of the steps beside it, each from the one before.
    fn make_sites(&self) -> Result<()> {
        let mut near: Option<Arc<Problem>> = None;
        for (i, &x) in self.x.iter().enumerate() {
            let here = self.sites.beside(x, near.as_deref())?;
            // Where none is found beside, there are no slopes.
            let _ = self.sites.beside(x + NUDGE * step(&self.x, i), Some(&here));
            near = Some(here);
        }
        Ok(())
    }

    fn node(&self, i: usize, j: usize) -> Result<Node> {
        let (x, k) = (self.x[i], self.k[j]);
        let [dx, dk] = [step(&self.x, i), step(&self.k, j)].map(|gap| NUDGE * gap);
        let (here, unit) = self.sites.rates(x, k)?;
        // A spectrum beside that cannot be had gives no slopes, so that nothing is climbed from here.
        let beside_x = self.sites.rates(x + dx, k).map(|rates| rates.0.values);
        let beside_k = self.sites.rates(x, k + dk).map(|rates| rates.0.values);
        let slope = |c: C64, beside: &Result<Vec<C64>>, step: f64| {
            let distance = |a: &C64| (a - c).norm();
            let values = beside.as_ref().ok()?.iter();
            let nearest = values.min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
            Some((nearest - c) / step)
        };
        let modes = here.values.iter().filter_map(|&c| {
            Some(Slopes {
                c,
                along_x: slope(c, &beside_x, dx)?,
                along_k: slope(c, &beside_k, dk)?,
            })
        });
        Ok(Node {
            modes: modes.collect(),
            unit,
        })
    }

    /// Modes at a place from which a hill may rise above zero nearby.
    fn feet(&self, nodes: &[Node], i: usize, j: usize) -> Vec<Foot> {
        let node = |i: usize, j: usize| &nodes[i * self.k.len() + j];
        let Node { modes, unit } = node(i, j);
        let foot = |mode: &Slopes| {
            let next_x = uphill(&self.x, i, mode.along_x.re);
            let next_k = uphill(&self.k, j, mode.along_k.re);
            let gaps = Place {
                x: next_x.map_or(0.0, |next| (self.x[next] - self.x[i]).abs()),
                k: next_k.map_or(0.0, |next| (self.k[next] - self.k[j]).abs()),
            };
            let rise = 0.5 * (mode.along_x.re.abs() * gaps.x + mode.along_k.re.abs() * gaps.k);
            let bound = mode.c.re + rise;
            let rises_on_x = next_x.is_some_and(|next| {
                let gap = self.x[next] - self.x[i];
                rises_on(mode, &node(next, j).modes, |mode| mode.along_x, gap)
            });
            let rises_on_k = next_k.is_some_and(|next| {
                let gap = self.k[next] - self.k[j];
                rises_on(mode, &node(i, next).modes, |mode| mode.along_k, gap)
            });
            let candidate = bound > LEADS * unit && !rises_on_x && !rises_on_k;
            candidate.then_some(Foot {
                place: Place {
                    x: self.x[i],
                    k: self.k[j],
                },
                c: mode.c,
                bound,
                gaps,
                unit: *unit,
            })
        };
        modes.iter().filter_map(foot).collect()
    }

    /// The first place on the way up a hill at which its mode grows; nothing where the top is below zero.
    fn climb(&self, foot: &Foot) -> Option<Place> {
        let bounds = |values: &[f64], at: f64, gap: f64| {
            let (first, last) = (values[0], values[values.len() - 1]);
            ((at - gap).max(first), (at + gap).min(last))
        };
        let within_x = bounds(&self.x, foot.place.x, foot.gaps.x);
        let within_k = bounds(&self.k, foot.place.k, foot.gaps.k);
        let problem = self.sites.at(foot.place.x).ok()?;
        let q = WaveVector::along_x(foot.place.k);
        let mut pair = weakly::select(&problem, q, Selection::Near(foot.c)).ok()?;
        let mut at = foot.place;
        for _ in 0..MOST_STEPS {
            if pair.c.re > LEADS * foot.unit {
                return Some(at);
            }
            let step = self.step(at, &pair, foot)?;
            let mut part = 1.0;
            let higher = (0..MOST_HALVES).find_map(|_| {
                let next = Place {
                    x: (at.x + part * step.x).clamp(within_x.0, within_x.1),
                    k: (at.k + part * step.k).clamp(within_k.0, within_k.1),
                };
                part *= 0.5;
                let there = self.followed(foot, next, &pair)?;
                (there.c.re > pair.c.re).then_some((next, there))
            });
            let (next, there) = higher?;
            let moved =
                ((next.x - at.x) / foot.gaps.x).abs() + ((next.k - at.k) / foot.gaps.k).abs();
            (at, pair) = (next, there);
            if moved <= SETTLED {
                break;
            }
        }
        (pair.c.re > LEADS * foot.unit).then_some(at)
    }

    /// Newton's step to the top, −H⁻¹ g, where the hill is concave; uphill by a part of the gaps where it is not.
    fn step(&self, at: Place, pair: &EigenPair, foot: &Foot) -> Option<Place> {
        let [dx, dk] = [SPREAD * foot.gaps.x, SPREAD * foot.gaps.k];
        let growth = |i: f64, j: f64| {
            let place = Place {
                x: at.x + i * dx,
                k: at.k + j * dk,
            };
            self.followed(foot, place, pair).map(|pair| pair.c.re)
        };
        let here = pair.c.re;
        let [right, left] = [growth(1.0, 0.0)?, growth(-1.0, 0.0)?];
        let [above, below] = [growth(0.0, 1.0)?, growth(0.0, -1.0)?];
        let corner = growth(1.0, 1.0)?;
        // In units of the steps.
        let [gx, gk] = [0.5 * (right - left), 0.5 * (above - below)];
        let [hxx, hkk] = [right - 2.0 * here + left, above - 2.0 * here + below];
        let hxk = corner - right - above + here;
        let determinant = hxx * hkk - hxk * hxk;
        let newton = Place {
            x: dx * (hxk * gk - hkk * gx) / determinant,
            k: dk * (hxk * gx - hxx * gk) / determinant,
        };
        let uphill = Place {
            x: 0.5 * foot.gaps.x * gx.signum(),
            k: 0.5 * foot.gaps.k * gk.signum(),
        };
        let is_concave = hxx < 0.0 && hkk < 0.0 && determinant > 0.0;
        Some(if is_concave { newton } else { uphill })
    }

    /// A mode at a place near a foot.
    fn followed(&self, foot: &Foot, place: Place, pair: &EigenPair) -> Option<EigenPair> {
        let near = self.sites.at(foot.place.x).ok()?;
        let problem = self.sites.beside(place.x, Some(&near)).ok()?;
        spectrum::follow(&problem, WaveVector::along_x(place.k), pair).ok()
    }
}

/// The gap to the next value, or to the one before the last with a minus: a step along it stays inside.
fn step(values: &[f64], index: usize) -> f64 {
    match (index.checked_sub(1), values.get(index + 1)) {
        (_, Some(next)) => next - values[index],
        (Some(before), None) => values[before] - values[index],
        (None, None) => values[index].abs().max(1.0),
    }
}

/// The neighbour that a slope rises to; nothing beyond the ends.
fn uphill(values: &[f64], index: usize, slope: f64) -> Option<usize> {
    if slope > 0.0 {
        Some(index + 1).filter(|&next| next < values.len())
    } else {
        index.checked_sub(1)
    }
}

/// Whether a mode still rises at a neighbour a signed gap away, at its likeliest continuation there.
fn rises_on(mode: &Slopes, neighbours: &[Slopes], of: fn(&Slopes) -> C64, gap: f64) -> bool {
    let branch = |mode: &Slopes| Branch {
        c: mode.c,
        slope: of(mode),
    };
    let here = branch(mode);
    let miss = |there: &Branch| (there.c - here.c - 0.5 * gap * (here.slope + there.slope)).norm();
    let continuations = neighbours
        .iter()
        .map(branch)
        .filter(|there| continues(&here, there, gap));
    let likeliest = continuations.min_by(|a, b| miss(a).total_cmp(&miss(b)));
    likeliest.is_some_and(|there| there.slope.re * gap > 0.0)
}
