//! The leading mode at many neighbouring places, without a full spectrum at each of them.
//!
//! Eigenvalues on a coarser collocation cost a tenth of those at M. Ordered by growth rate, the j-th of M exceeds the j-th of the
//! coarser collocation by some amount e_j. The scout measures e_j at a few places, its gauges, where both spectra are computed.
//! Elsewhere it refines the coarse leading eigenvalue at M and accepts the result only if
//!
//! Re c_j(coarse) + 4 max(e_j, |c − c_1(coarse)|) < Re c
//!
//! for every other eigenvalue c_j. If a single one might be larger, the full spectrum at M decides.

use super::iteration::{continued, refine};
use super::{EigenPair, arbitrary, confirm, eigenvalues, no_modes};
use crate::error::Result;
use crate::model::C64;
use crate::numerics::beside;
use crate::pencil::Spectrum;
use crate::problem::Problem;

/// Eigenvalues, by decreasing growth rate, whose excess is measured one by one.
const RANKS: usize = 40;
/// Excess at a place over the largest excess at the gauges that is allowed for.
const SAFETY: f64 = 4.0;
/// The least excess, relative to the slow eigenvalues: two modes that are closer are told apart by the full spectrum.
const LEAST: f64 = 1e-6;
/// Unknowns below which a full spectrum costs no more than scouting does.
const SMALL: usize = 48;

/// The leading eigenvalue at one place.
pub struct Leader {
    /// The eigenvalue of largest growth rate.
    pub value: C64,
    /// Its mode, or why inverse iteration does not confirm it.
    pub pair: Result<EigenPair>,
}

/// The collocations of one place: that of the answer, and the coarser one that shows where to look.
#[derive(Clone, Copy)]
pub struct Ground<'p> {
    /// At M.
    pub fine: &'p Problem,
    /// At a smaller M; `None` where a full spectrum is cheap.
    pub coarse: Option<&'p Problem>,
}

/// Finds leading modes near the places where it was gauged.
#[derive(Clone, Debug, Default)]
pub struct Scout {
    /// e_j, in units of eigenvalues; empty before the first gauge.
    excess: Vec<f64>,
}

impl Scout {
    /// The resolution to scout with, for a problem of `size` unknowns at resolution M.
    pub fn resolution(m: usize, size: usize) -> Option<usize> {
        (size > SMALL).then_some(m / 2)
    }

    /// The leading mode by the full spectrum, as [`super::leading`] computes it; learns by how much it exceeds the coarse one.
    ///
    /// # Errors
    /// A spectrum that cannot be computed.
    pub fn gauge(&mut self, ground: Ground, k: f64) -> Result<Leader> {
        let spectrum = eigenvalues(ground.fine, k)?;
        if let Some(Ok(coarse)) = ground.coarse.map(|coarse| eigenvalues(coarse, k)) {
            self.learn(&spectrum, &coarse);
        }
        leader(ground.fine, k, &spectrum)
    }

    /// Raises the excess of every rank to what two spectra of one place show.
    fn learn(&mut self, fine: &Spectrum, coarse: &Spectrum) {
        self.excess.resize(RANKS, 0.0);
        let mut largest = 0.0_f64;
        let pairs = fine.values.iter().zip(&coarse.values);
        for (excess, (f, c)) in self.excess.iter_mut().zip(pairs) {
            // A high rank is resolved no better than a low one.
            largest = largest.max(f.re - c.re).max(*excess);
            *excess = largest;
        }
    }

    /// The leading mode at a place, from that of a neighbouring place where there is one.
    ///
    /// # Errors
    /// A spectrum that cannot be computed.
    pub fn leading(&self, ground: Ground, k: f64, near: Option<&EigenPair>) -> Result<Leader> {
        if let Some(pair) = self.scouted(ground, k, near) {
            return Ok(Leader {
                value: pair.c,
                pair: Ok(pair),
            });
        }
        leader(ground.fine, k, &eigenvalues(ground.fine, k)?)
    }

    /// The leading mode, if the coarse spectrum leaves no doubt about it.
    fn scouted(&self, ground: Ground, k: f64, near: Option<&EigenPair>) -> Option<EigenPair> {
        let coarse = ground.coarse.filter(|_| !self.excess.is_empty())?;
        let spectrum = eigenvalues(coarse, k).ok()?;
        let top = *spectrum.values.first()?;
        if !self.leads(top, &spectrum) {
            return None;
        }
        let near = near.filter(|n| n.right.len() == ground.fine.direct.layout.size);
        let follows = near.and_then(|near| continued(ground.fine, k, near));
        let accepted = |pair: &EigenPair| {
            let oriented = !ground.fine.is_real() || pair.c.im >= 0.0;
            oriented && self.leads(pair.c, &spectrum)
        };
        follows.filter(accepted).or_else(|| {
            let scale = match near {
                Some(near) => near.scale,
                None => spectrum.scale(),
            };
            let start = arbitrary(ground.fine.direct.layout.size);
            let shift = beside(top, scale);
            refine(ground.fine, k, shift, scale, &start, &start).filter(accepted)
        })
    }

    /// Whether an eigenvalue at M that belongs to the first one of a coarse spectrum must be the leading one at M.
    fn leads(&self, c: C64, coarse: &Spectrum) -> bool {
        let top = coarse.values[0];
        let shift = (c - top).norm();
        let least = LEAST * coarse.scale();
        let last = self.excess.last().copied().unwrap_or(f64::INFINITY);
        let others = coarse.values.iter().enumerate().skip(1);
        // Its complex conjugate grows at the same rate.
        let is_conjugate =
            |(rank, v): &(usize, &C64)| *rank == 1 && c.im != 0.0 && **v == top.conj();
        others
            .filter(|other| !is_conjugate(other))
            .all(|(rank, v)| {
                let excess = self.excess.get(rank).copied().unwrap_or(last);
                v.re + SAFETY * excess.max(shift).max(least) < c.re
            })
    }
}

/// The first eigenvalue of a full spectrum, with its mode.
fn leader(problem: &Problem, k: f64, spectrum: &Spectrum) -> Result<Leader> {
    let value = *spectrum.values.first().ok_or_else(no_modes)?;
    let start = arbitrary(problem.direct.layout.size);
    Ok(Leader {
        value,
        pair: confirm(problem, k, spectrum, (value, start)),
    })
}

#[cfg(test)]
mod tests {
    use super::{C64, Scout, Spectrum};

    fn spectrum(values: &[f64]) -> Spectrum {
        Spectrum::new(values.iter().map(|&re| C64::new(re, 0.0)).collect())
    }

    /// A second mode that a coarse collocation damps too much by 0.3 leaves a doubt while the distance is below four times that.
    #[test]
    fn an_excess_that_was_seen_is_allowed_for() {
        let mut scout = Scout::default();
        scout.learn(&spectrum(&[1.0, -0.2, -2.0]), &spectrum(&[1.0, -0.5, -2.0]));
        let c = |re: f64| C64::new(re, 0.0);
        assert!(scout.leads(c(1.0), &spectrum(&[1.0, -0.5, -2.0])));
        assert!(!scout.leads(c(0.5), &spectrum(&[0.5, -0.5, -2.0])));
        // Its own shift between the two collocations counts too.
        assert!(!scout.leads(c(0.6), &spectrum(&[1.0, -0.5, -2.0])));
    }
}
