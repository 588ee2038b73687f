//! The first value of a parameter, from the stable end of an interval, at which the largest growth rate over k passes
//! through zero. The interval is looked at in equal steps. Between values at which all modes decay, an island of growth
//! may be narrower than a step: there the slopes of all growth rates along the parameter tell where one may rise above
//! zero.

use super::super::Progress;
use super::LEADS;
use super::extremum::Search;
use super::hills::{Hills, Place};
use super::newton::Root;
use super::summit::{Side, Summit, coarse, rates};
use super::survey::{Node, Sought, Survey};
use crate::error::Result;
use crate::pencil::Spectrum;
use crate::problem::Problem;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Values of the parameter that are scanned.
pub(super) const SCAN: usize = 9;
/// Wavenumbers at which all modes are looked at for every value of the parameter.
pub(super) const WAVENUMBERS: usize = 13;

impl Search<'_> {
    /// The extremum of the neutral curve of whatever mode leads.
    pub(super) fn leading(&self, progress: &dyn Progress) -> Result<Root> {
        let wavenumbers = self.wavenumbers(WAVENUMBERS);
        let mut places = self.question.places(SCAN);
        let mut ends = [places[0], places[SCAN - 1]].map(|x| self.glance(x, None, &wavenumbers));
        let sides = ends
            .each_ref()
            .map(|end| end.as_ref().map(Summit::side).ok());
        // From the stable end, so that the first change of sign is the onset.
        if sides[0] == Some(Side::Grows) && sides[1].is_some_and(|side| side < Side::Grows) {
            places.reverse();
            ends.reverse();
        }
        let mut before: Option<Summit> = None;
        let mut failure = None;
        for (index, &x) in places.iter().enumerate() {
            progress.advance(1);
            let near = before.as_ref().map(|summit| summit.site.base.clone());
            let summit = match index {
                0 => ends[0].clone(),
                _ if index == SCAN - 1 => ends[1].clone(),
                _ => self.glance(x, near.as_deref(), &wavenumbers),
            };
            let summit = match summit {
                Ok(summit) => summit,
                Err(error) => {
                    failure = Some(error);
                    continue;
                }
            };
            match before.replace(summit.clone()) {
                Some(before) if before.side() > summit.side() => {
                    return self.settle(&summit, before);
                }
                Some(before) if before.side() < summit.side() => {
                    let root = self.settle(&before, summit);
                    let mut decaying = places[..index].to_vec();
                    decaying.extend(root.as_ref().map(|root| root.x));
                    let island = self.island(&decaying, &wavenumbers, progress)?;
                    return island.map_or(root, Ok);
                }
                _ => {}
            }
        }
        if before.is_some_and(|summit| summit.side() == Side::Decays)
            && let Some(root) = self.island(&places, &wavenumbers, progress)?
        {
            return Ok(root);
        }
        let [begin, end] = ends;
        match (failure, begin, end) {
            (None, Ok(begin), Ok(end)) => Err(self.no_change([begin.growth(), end.growth()])),
            (Some(error), ..) | (_, Err(error), _) | (.., Err(error)) => Err(error),
        }
    }

    /// The beginning of an island of growth between values of the parameter at which all modes decay. The values run
    /// from the stable end.
    fn island(
        &self,
        places: &[f64],
        wavenumbers: &[f64],
        progress: &dyn Progress,
    ) -> Result<Option<Root>> {
        let sites = Sites {
            search: self,
            all: Mutex::default(),
        };
        progress.advance(0);
        let hills = Hills::new(&sites, places, wavenumbers);
        let growing = match hills.growing() {
            Ok(Some(place)) => Some(place),
            _ => wavenumbers.iter().find_map(|&k| {
                progress.advance(0);
                sites.growing(places, k).map(|x| Place { x, k })
            }),
        };
        let Some(Place { x, k }) = growing else {
            return Ok(None);
        };
        let mut wavenumbers = wavenumbers.to_vec();
        wavenumbers.push(k);
        let grows = self.summit(x, None, &wavenumbers)?;
        if grows.side() != Side::Grows {
            return Ok(None);
        }
        let is_before = |place: &&f64| (x - **place) * (x - places[0]) > 0.0;
        let before = places.iter().rfind(is_before).unwrap_or(&places[0]);
        let decays = self.summit(*before, None, &wavenumbers)?;
        self.settle(&decays, grows).map(Some)
    }
}

/// Collocations along the parameter, kept for all wavenumbers.
pub(super) struct Sites<'s> {
    search: &'s Search<'s>,
    /// By the bits of the value.
    all: Mutex<BTreeMap<u64, Arc<Problem>>>,
}

impl Sites<'_> {
    /// A value of the parameter at which a mode of this wavenumber grows, between values at which all decay; nothing
    /// where the slopes of the growth rates give no reason to expect one.
    fn growing(&self, places: &[f64], k: f64) -> Option<f64> {
        let low = places.iter().copied().fold(f64::INFINITY, f64::min);
        let high = places.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let survey = Survey {
            spectra: &|x| self.rates(x, k),
            ends: (low, high),
            sought: Sought::Growth,
        };
        let nodes = survey.run(places, &|| {}).ok()?;
        let grows = |node: &&Node| node.growth() > LEADS * node.scale;
        nodes.iter().find(grows).map(|node| node.x)
    }

    /// All eigenvalues at a value of the parameter and a wavenumber, and the unit of rates.
    pub fn rates(&self, x: f64, k: f64) -> Result<(Spectrum, f64)> {
        rates(self.at(x)?.as_ref(), k)
    }

    /// The collocation that spectra are looked at on.
    pub fn at(&self, x: f64) -> Result<Arc<Problem>> {
        self.beside(x, None)
    }

    /// The same, its base state from that of a neighbour where one is given.
    pub fn beside(&self, x: f64, near: Option<&Problem>) -> Result<Arc<Problem>> {
        let kept = || self.all.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(problem) = kept().get(&x.to_bits()) {
            return Ok(problem.clone());
        }
        let site = self.search.site(x, near.map(|near| near.base.as_ref()))?;
        let coarse = coarse(self.search.setup, &site).map(Arc::new);
        let problem = coarse.unwrap_or(site.problem);
        kept().insert(x.to_bits(), problem.clone());
        Ok(problem)
    }
}
