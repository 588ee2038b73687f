//! The largest growth rate over a range of k at one value of a parameter.
//!
//! A glance looks at spectra on a coarser collocation, and gauges them by full ones where growth is largest and at the
//! ends of the range. It says that modes grow only if the full spectrum does, and that all decay only if they would also
//! with the differences that the gauges show. Full spectra everywhere answer otherwise, and wherever an answer rests on
//! them.

use super::super::{Axis, Setup};
use super::LEADS;
use super::extremum::Search;
use super::grid::{Grid, Site};
use super::sampler::unit;
use super::survey::{Node, Sought, Survey, evenly};
use crate::base::BaseState;
use crate::error::{Error, Result};
use crate::model::C64;
use crate::pencil::Spectrum;
use crate::problem::Problem;
use crate::spectrum::{self, Scout};
use crate::wavevector::WaveVector;

/// A wider range of k, as a ratio, is looked at in geometric steps too.
const WIDE: f64 = 6.0;
/// Allowance for what the gauges do not see: part of the largest difference, and of the spread of the differences.
const PART: f64 = 0.1;
const SPREAD: f64 = 3.0;

/// The mode that grows fastest at the wavenumbers that were looked at, for one value of the parameter.
#[derive(Clone)]
pub(super) struct Summit {
    pub x: f64,
    pub k: f64,
    pub c: C64,
    /// The unit of rates there.
    pub unit: f64,
    pub site: Site,
}

/// What the largest growth rate does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Side {
    Decays,
    Neutral,
    Grows,
}

/// A value of the parameter and a growth rate there.
#[derive(Clone, Copy)]
pub(super) struct Growth {
    pub x: f64,
    pub rate: f64,
}

impl Summit {
    pub fn side(&self) -> Side {
        let neutral = LEADS * self.unit;
        match self.c.re {
            growth if growth > neutral => Side::Grows,
            growth if growth < -neutral => Side::Decays,
            _ => Side::Neutral,
        }
    }

    pub fn growth(&self) -> Growth {
        Growth {
            x: self.x,
            rate: self.c.re,
        }
    }
}

/// All eigenvalues of a problem at a wavenumber, and the unit of rates.
pub(super) fn rates(problem: &Problem, k: f64) -> Result<(Spectrum, f64)> {
    let k = WaveVector::along_x(k);
    let spectrum = spectrum::eigenvalues(problem, k)?;
    let unit = unit(problem, k, spectrum.scale());
    Ok((spectrum, unit))
}

/// A coarser collocation of a site; nothing where a full spectrum is cheap.
pub(super) fn coarse(setup: &Setup, site: &Site) -> Option<Problem> {
    let resolution = setup.effective_resolution()?;
    let coarse = Scout::resolution(resolution, site.problem.direct.layout.size)?;
    Problem::new(&site.base, Some(coarse)).ok()
}

impl Search<'_> {
    pub(super) fn axis(&self) -> Axis {
        self.question.axis()
    }

    /// The problem at a value of the parameter, its base state from that of a neighbour where one is given.
    pub(super) fn site(&self, x: f64, near: Option<&BaseState>) -> Result<Site> {
        let moved = self.setup.moved(self.axis(), x)?;
        let grid = Grid::of(self.setup);
        grid.site(&moved, near).or_else(|error| match near {
            Some(_) => grid.site(&moved, None),
            None => Err(error),
        })
    }

    /// Wavenumbers of the range, evenly spaced; in a wide one also in geometric steps.
    pub(super) fn wavenumbers(&self, count: usize) -> Vec<f64> {
        let (low, high) = self.range;
        let mut all = evenly(low, high, count);
        if high > WIDE * low {
            let steps = evenly(low.ln(), high.ln(), count);
            all.extend(steps[1..count - 1].iter().map(|k| k.exp()));
        }
        all
    }

    /// The mode of largest growth rate in the range of k, by full spectra. Where a mode grows the search for a faster
    /// one stops.
    pub(super) fn summit(
        &self,
        x: f64,
        near: Option<&BaseState>,
        wavenumbers: &[f64],
    ) -> Result<Summit> {
        let site = self.site(x, near)?;
        self.summit_of(x, site, wavenumbers)
    }

    fn summit_of(&self, x: f64, site: Site, wavenumbers: &[f64]) -> Result<Summit> {
        let nodes = self.survey(&site.problem, wavenumbers)?;
        let node = highest(&nodes)?;
        Ok(Summit {
            x,
            k: node.x,
            c: node.leading(),
            unit: node.scale,
            site,
        })
    }

    /// A mode that tells on which side of zero the largest growth rate lies, and about how large it is.
    pub(super) fn glance(
        &self,
        x: f64,
        near: Option<&BaseState>,
        wavenumbers: &[f64],
    ) -> Result<Summit> {
        let site = self.site(x, near)?;
        let scouted = coarse(self.setup, &site)
            .and_then(|coarse| self.scouted(x, &site, &coarse, wavenumbers).ok()?);
        match scouted {
            Some(summit) => Ok(summit),
            None => self.summit_of(x, site, wavenumbers),
        }
    }

    fn survey(&self, problem: &Problem, wavenumbers: &[f64]) -> Result<Vec<Node>> {
        let survey = Survey {
            spectra: &|k| rates(problem, k),
            ends: self.range,
            sought: Sought::Growth,
        };
        survey.run(wavenumbers, &|| {})
    }

    /// What coarse spectra and their gauges say; nothing where these leave a doubt.
    fn scouted(
        &self,
        x: f64,
        site: &Site,
        coarse: &Problem,
        wavenumbers: &[f64],
    ) -> Result<Option<Summit>> {
        let nodes = self.survey(coarse, wavenumbers)?;
        let node = highest(&nodes)?;
        let (spectrum, unit) = rates(&site.problem, node.x)?;
        let Some(&c) = spectrum.values.first() else {
            return Ok(None);
        };
        let summit = Summit {
            x,
            k: node.x,
            c,
            unit,
            site: site.clone(),
        };
        if summit.side() == Side::Grows {
            return Ok(Some(summit));
        }
        let mut differences = vec![c.re - node.growth()];
        for end in [nodes.first(), nodes.last()].into_iter().flatten() {
            let (spectrum, _) = rates(&site.problem, end.x)?;
            let growth = spectrum.values.first().map_or(f64::INFINITY, |c| c.re);
            differences.push(growth - end.growth());
        }
        let largest = differences.iter().copied().fold(0.0, f64::max);
        let smallest = differences.iter().copied().fold(f64::INFINITY, f64::min);
        let allowance = (1.0 + PART) * largest + SPREAD * (largest - smallest);
        let decays = node.growth() + allowance < -LEADS * unit && summit.side() == Side::Decays;
        Ok(decays.then_some(summit))
    }
}

fn highest(nodes: &[Node]) -> Result<&Node> {
    let highest = nodes
        .iter()
        .max_by(|a, b| a.growth().total_cmp(&b.growth()));
    highest.ok_or_else(|| Error::computation("no mode was found in the range of k"))
}
