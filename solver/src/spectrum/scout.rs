//! The leading mode at many neighbouring places, without a full spectrum at each of them.
//!
//! Eigenvalues on a coarser collocation cost a tenth of those at M. Order both spectra by growth rate. The j-th of M exceeds the j-th
//! of the coarser collocation by e_j, a continuous function of the place. The scout measures e_j at a few places, its gauges, where it
//! computes both spectra. Between two gauges it refines the coarse leading eigenvalue at M and accepts the result c only if
//!
//! Re c_2(coarse) + E_2 < Re c, with E_j = max e_j + 3 |e_j − e_j'| + e_j/10 over the two gauges.
//!
//! The second growth rate at M then lies below Re c, and so do all that follow it. The third is tested too: it tells of modes that
//! turn up between gauges.
//! Otherwise the full spectrum at M decides.

use super::iteration::{continued, refine};
use super::{EigenPair, confirm, eigenvalues, no_modes};
use crate::error::Result;
use crate::model::C64;
use crate::numerics::{arbitrary, beside};
use crate::pencil::Spectrum;
use crate::problem::{Problem, Turned};
use crate::wavevector::WaveVector;

/// Eigenvalues, by decreasing growth rate, whose excess is measured.
const RANKS: usize = 4;
/// Those below the first that are tested.
const TESTED: usize = 2;
/// Factor of e_j in the allowance E_j that is added to its larger value.
const PART: f64 = 0.1;
/// Factor of |e_j − e_j'| in the allowance E_j: between two gauges e_j may leave their interval by three times its length.
const CHANGE: f64 = 3.0;
/// The least allowance, relative to the scale of the slow eigenvalues. Two modes that are closer are told apart by the full
/// spectrum.
const LEAST: f64 = 1e-6;
/// M over the resolution of the scout: a spectrum costs the cube, a third of M then a twenty-seventh.
const COARSER: usize = 3;
/// Unknowns up to which a full spectrum costs no more than scouting does.
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

/// What one gauge shows.
#[derive(Clone, Debug)]
struct Gauge {
    /// Its number along the places.
    index: usize,
    /// e_j, in units of eigenvalues.
    excess: Vec<f64>,
}

/// Finds leading modes between the places where it was gauged.
#[derive(Clone, Debug, Default)]
pub struct Scout {
    /// By increasing index.
    gauges: Vec<Gauge>,
}

impl Scout {
    /// The resolution to scout with, for a problem of `size` unknowns at resolution M.
    pub fn resolution(m: usize, size: usize) -> Option<usize> {
        (size > SMALL).then_some(m / COARSER)
    }

    /// The leading mode of the `index`-th place by its full spectrum, as [`super::leading`] computes it. Places are gauged in order.
    ///
    /// # Errors
    /// A spectrum that cannot be computed.
    pub fn gauge(&mut self, ground: Ground, k: WaveVector, index: usize) -> Result<Leader> {
        let spectrum = eigenvalues(ground.fine, k)?;
        if let Some(Ok(coarse)) = ground.coarse.map(|coarse| eigenvalues(coarse, k)) {
            self.learn(index, &spectrum, &coarse);
        }
        leader(ground.fine, k, &spectrum)
    }

    /// Records by how much each rank of the fine spectrum exceeds that of the coarse one.
    fn learn(&mut self, index: usize, fine: &Spectrum, coarse: &Spectrum) {
        let pairs = fine.values.iter().zip(&coarse.values).take(RANKS);
        let excess = pairs.map(|(f, c)| (f.re - c.re).max(0.0)).collect();
        self.gauges.push(Gauge { index, excess });
    }

    /// E_j at a place: infinite outside of the gauges.
    fn allowance(&self, index: usize, rank: usize) -> f64 {
        let after = self.gauges.partition_point(|gauge| gauge.index < index);
        let around = [after.checked_sub(1), Some(after)].map(|i| self.gauges.get(i?));
        let [Some(before), Some(after)] = around else {
            return f64::INFINITY;
        };
        let [a, b] =
            [before, after].map(|gauge| gauge.excess.get(rank).copied().unwrap_or(f64::INFINITY));
        (1.0 + PART) * a.max(b) + CHANGE * (a - b).abs()
    }

    /// The leading mode at a place, from that of a neighbouring place where there is one.
    ///
    /// # Errors
    /// A spectrum that cannot be computed.
    pub fn leading(
        &self,
        ground: Ground,
        k: WaveVector,
        index: usize,
        near: Option<&EigenPair>,
    ) -> Result<Leader> {
        if let Some(pair) = self.scouted(ground, k, index, near) {
            return Ok(Leader {
                value: pair.c,
                pair: Ok(pair),
            });
        }
        leader(ground.fine, k, &eigenvalues(ground.fine, k)?)
    }

    /// The leading mode, if the coarse spectrum leaves no doubt about it.
    fn scouted(
        &self,
        ground: Ground,
        k: WaveVector,
        index: usize,
        near: Option<&EigenPair>,
    ) -> Option<EigenPair> {
        let coarse = ground.coarse.filter(|_| self.gauges.len() > 1)?;
        let spectrum = eigenvalues(coarse, k).ok()?;
        let top = *spectrum.values.first()?;
        if !self.leads(top, &spectrum, index) {
            return None;
        }
        let near = near.filter(|n| n.right.len() == ground.fine.direct.layout.size);
        let follows = near.and_then(|near| continued(ground.fine, k, near));
        let accepted = |pair: &EigenPair| {
            let oriented = !ground.fine.is_real() || pair.c.im >= 0.0;
            oriented && self.leads(pair.c, &spectrum, index)
        };
        follows.filter(accepted).or_else(|| {
            let scale = match near {
                Some(near) => near.scale,
                None => spectrum.scale(),
            };
            let start = Turned(arbitrary(ground.fine.direct.layout.size));
            let shift = beside(top, scale);
            refine(ground.fine, k, shift, scale, &start, &start).filter(accepted)
        })
    }

    /// Whether an eigenvalue at M that belongs to the first one of a coarse spectrum must be the leading one at M.
    fn leads(&self, c: C64, coarse: &Spectrum, index: usize) -> bool {
        let top = coarse.values[0];
        let least = (c - top).norm().max(LEAST * coarse.scale());
        // Its complex conjugate grows at the same rate.
        let has_conjugate = c.im != 0.0 && coarse.values.get(1) == Some(&top.conj());
        let ranks = coarse.values.iter().enumerate();
        ranks
            .skip(if has_conjugate { 2 } else { 1 })
            .take(TESTED)
            .all(|(rank, v)| v.re + least.max(self.allowance(index, rank)) < c.re)
    }
}

/// The first eigenvalue of a full spectrum, with its mode.
fn leader(problem: &Problem, k: WaveVector, spectrum: &Spectrum) -> Result<Leader> {
    let value = *spectrum.values.first().ok_or_else(no_modes)?;
    let start = Turned(arbitrary(problem.direct.layout.size));
    let pair = confirm(problem, k, spectrum, (value, start));
    Ok(Leader {
        // Inverse iteration knows the eigenvalue better than the full spectrum does.
        value: pair.as_ref().map_or(value, |pair| pair.c),
        pair,
    })
}

#[cfg(test)]
mod tests {
    use super::{C64, Scout, Spectrum};

    fn spectrum(values: &[f64]) -> Spectrum {
        Spectrum::new(values.iter().map(|&re| C64::new(re, 0.0)).collect())
    }

    /// A second mode that the coarse collocation damps too much by 0.3 at one gauge and by 0.4 at the next leaves a doubt while it
    /// is less than 0.44 + 0.3 below the first.
    #[test]
    fn an_excess_that_was_seen_is_allowed_for() {
        let mut scout = Scout::default();
        scout.learn(
            0,
            &spectrum(&[1.0, -0.2, -2.0]),
            &spectrum(&[1.0, -0.5, -2.0]),
        );
        scout.learn(
            9,
            &spectrum(&[1.0, -0.1, -2.0]),
            &spectrum(&[1.0, -0.5, -2.0]),
        );
        let c = |re: f64| C64::new(re, 0.0);
        assert!(scout.leads(c(0.25), &spectrum(&[0.25, -0.5, -2.0]), 4));
        assert!(!scout.leads(c(0.2), &spectrum(&[0.2, -0.5, -2.0]), 4));
        // The shift of the first mode between the two collocations counts too, and nothing is accepted outside of the gauges.
        assert!(!scout.leads(c(0.25), &spectrum(&[1.1, -0.5, -2.0]), 4));
        assert!(!scout.leads(c(0.25), &spectrum(&[0.25, -0.5, -2.0]), 10));
    }
}
