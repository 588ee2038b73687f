//! Which mode the rows of a sweep hold.
//!
//! By default each row holds the leading mode of its place, as a single point does: a row does not depend on the range, the number
//! of rows or their direction. One mode can be followed instead. The growth rate of the leading mode stands in every row.

use super::station::{Collocations, Station};
use super::{CHUNK, Sweep};
use crate::error::{Error, Result};
use crate::model::C64;
use crate::spectrum::{self, EigenPair, Leader, Scout};
use crate::study::Progress;
use crate::study::row::Row;
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::sync::Arc;

/// Places of a chunk at which the scout is gauged by a full spectrum, the ends among them.
const GAUGES: usize = 4;

/// The mode of a row.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum RowMode {
    /// At each place the one of largest growth rate.
    #[default]
    Leading,
    /// At each place the one whose eigenvalue is nearest to this.
    Nearest(C64),
    /// One mode, followed by its shape along the first axis. It starts where the leading growth rate is largest on the axis, or, if an
    /// eigenvalue is given, where one comes nearest to it.
    Followed(Option<C64>),
}

impl fmt::Display for RowMode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            RowMode::Leading => write!(f, "leading"),
            RowMode::Nearest(c) => write!(f, "nearest to {},{}", c.re, c.im),
            RowMode::Followed(None) => write!(f, "followed"),
            RowMode::Followed(Some(c)) => write!(f, "followed from {},{}", c.re, c.im),
        }
    }
}

/// One line of a sweep along its first axis, for a mode that is followed.
pub(super) struct Trace {
    /// Leading growth rate at each place, in units of 1/time.
    leading: Vec<Option<f64>>,
    /// Where each chunk takes the mode over; `None` where it was lost before.
    starts: Vec<Option<Start>>,
    /// Why there is no mode at all.
    trouble: Option<Error>,
}

/// A mode at a place of a line.
#[derive(Clone)]
struct Start {
    index: usize,
    pair: EigenPair,
}

/// A chosen mode at one place, with the growth rate of the leading one.
struct Choice {
    station: Station,
    leading: f64,
    pair: Result<EigenPair>,
}

impl Sweep<'_> {
    /// The rows of a chunk. `trace` is given where a mode is followed.
    pub(super) fn rows_of(
        &self,
        places: &[Vec<f64>],
        line: Option<&Arc<Collocations>>,
        trace: Option<(&Trace, usize)>,
        progress: &dyn Progress,
    ) -> Vec<Row> {
        if let Some((trace, chunk)) = trace {
            return self.followed(places, line, (trace, chunk), progress);
        }
        self.choices(places, line, |index, choice| {
            progress.advance(1);
            match choice {
                Ok(choice) => self.row_of(&choice.station, choice.pair, Some(choice.leading)),
                Err(error) => Row::failed(places[index].clone(), &error, self.derived.len()),
            }
        })
    }

    /// The mode of each place, handed to `with` one by one.
    fn choices<R>(
        &self,
        places: &[Vec<f64>],
        line: Option<&Arc<Collocations>>,
        with: impl Fn(usize, Result<Choice>) -> R,
    ) -> Vec<R> {
        let target = match self.mode {
            RowMode::Nearest(target) | RowMode::Followed(Some(target)) => Some(target),
            RowMode::Leading | RowMode::Followed(None) => None,
        };
        if let Some(target) = target {
            let mut neighbour = None;
            let mut results = Vec::with_capacity(places.len());
            for (index, place) in places.iter().enumerate() {
                let choice = self.nearest(place, line, neighbour.as_ref(), target);
                neighbour = match &choice {
                    Ok(choice) => Some(choice.station.again()),
                    Err(_) => neighbour,
                };
                results.push(with(index, choice));
            }
            return results;
        }
        self.leaders(places, line, with)
    }

    /// The leading mode of each place: by full spectra at the gauges, by the scout between them.
    fn leaders<R>(
        &self,
        places: &[Vec<f64>],
        line: Option<&Arc<Collocations>>,
        with: impl Fn(usize, Result<Choice>) -> R,
    ) -> Vec<R> {
        let mut scout = Scout::default();
        let mut gauged: BTreeMap<usize, Result<(Station, Leader)>> = BTreeMap::new();
        for index in gauges(places.len()) {
            let station = self.station(&places[index], line, None);
            let gauge = station.and_then(|station| {
                let leader = scout.gauge(station.collocations.ground(), station.k, index)?;
                Ok((station, leader))
            });
            gauged.insert(index, gauge);
        }
        let mut near: Option<(Station, EigenPair)> = None;
        let mut results = Vec::with_capacity(places.len());
        for (index, place) in places.iter().enumerate() {
            let found = gauged.remove(&index).unwrap_or_else(|| {
                let station = self.station(place, line, near.as_ref().map(|n| &n.0))?;
                let neighbour = near.as_ref().map(|n| &n.1);
                let ground = station.collocations.ground();
                let leader = scout.leading(ground, station.k, index, neighbour)?;
                Ok((station, leader))
            });
            let choice = found.map(|(station, leader)| {
                if let Ok(pair) = &leader.pair {
                    near = Some((station.again(), pair.clone()));
                }
                Choice {
                    station,
                    leading: leader.value.re,
                    pair: leader.pair,
                }
            });
            results.push(with(index, choice));
        }
        results
    }

    /// The mode nearest to an eigenvalue.
    fn nearest(
        &self,
        place: &[f64],
        line: Option<&Arc<Collocations>>,
        neighbour: Option<&Station>,
        target: C64,
    ) -> Result<Choice> {
        let station = self.station(place, line, neighbour)?;
        let problem = &station.collocations.problem;
        let spectrum = spectrum::eigenvalues(problem, station.k)?;
        let leading = spectrum.values.first().map_or(f64::NAN, |c| c.re);
        Ok(Choice {
            pair: spectrum::nearest_in(problem, station.k, &spectrum, target),
            leading,
            station,
        })
    }

    /// The traces of the lines that some chunks belong to.
    pub(super) fn traces(
        &self,
        chunks: &[usize],
        collocations: &(dyn Fn(usize) -> Option<Result<Arc<Collocations>>> + Sync),
        progress: &dyn Progress,
    ) -> BTreeMap<usize, Trace> {
        if !matches!(self.mode, RowMode::Followed(_)) {
            return BTreeMap::new();
        }
        let lines: BTreeSet<usize> = chunks
            .iter()
            .map(|chunk| chunk / self.chunks_per_line())
            .collect();
        lines
            .into_par_iter()
            .map(|line| match collocations(line).transpose() {
                Ok(shared) => (line, self.trace(line, shared.as_ref(), progress)),
                Err(error) => (line, Trace::none(error)),
            })
            .collect()
    }

    /// One line: where its mode starts, and where each chunk takes it over.
    fn trace(
        &self,
        line: usize,
        shared: Option<&Arc<Collocations>>,
        progress: &dyn Progress,
    ) -> Trace {
        let per_line = self.chunks_per_line();
        let chunks = line * per_line..(line + 1) * per_line;
        let seen: Vec<Vec<(Option<f64>, Result<EigenPair>)>> = chunks
            .clone()
            .into_par_iter()
            .map(|chunk| {
                progress.advance(0);
                self.choices(&self.places(chunk), shared, |_, choice| match choice {
                    Ok(choice) => (Some(choice.leading), choice.pair),
                    Err(error) => (None, Err(error)),
                })
            })
            .collect();
        let seen: Vec<(Option<f64>, Result<EigenPair>)> = seen.into_iter().flatten().collect();
        let leading = seen.iter().map(|s| s.0).collect();
        let Some(seed) = self.seed(&seen) else {
            let trouble = seen.into_iter().find_map(|(_, pair)| pair.err());
            return Trace::none(trouble.unwrap_or_else(|| Error::input("the axis has no values")));
        };
        let places: Vec<Vec<f64>> = chunks.flat_map(|chunk| self.places(chunk)).collect();
        let mut starts = vec![None; per_line];
        starts[seed.index / CHUNK] = Some(seed.clone());
        let upwards = self.walk(&places, shared, &seed, seed.index + 1..places.len());
        let downwards = self.walk(&places, shared, &seed, (0..seed.index).rev());
        for start in upwards.into_iter().chain(downwards) {
            starts[start.index / CHUNK].get_or_insert(start);
        }
        Trace {
            leading,
            starts,
            trouble: None,
        }
    }

    /// The mode to start from: the fastest of all places, or the one nearest to the eigenvalue that was asked for.
    fn seed(&self, seen: &[(Option<f64>, Result<EigenPair>)]) -> Option<Start> {
        let merit = |pair: &EigenPair| match self.mode {
            RowMode::Followed(Some(target)) => -(pair.c - target).norm(),
            _ => pair.c.re,
        };
        let modes = seen
            .iter()
            .enumerate()
            .filter_map(|(index, (_, pair))| Some((index, pair.as_ref().ok()?)));
        // The first of equal ones.
        let best = modes.reduce(|best, next| {
            if merit(next.1) > merit(best.1) {
                next
            } else {
                best
            }
        });
        best.map(|(index, pair)| Start {
            index,
            pair: pair.clone(),
        })
    }

    /// The mode followed over some places: the first that is reached in each chunk.
    fn walk(
        &self,
        places: &[Vec<f64>],
        line: Option<&Arc<Collocations>>,
        seed: &Start,
        way: impl Iterator<Item = usize>,
    ) -> Vec<Start> {
        let (mut near, mut chunk) = (seed.pair.clone(), seed.index / CHUNK);
        let mut neighbour: Option<Station> = None;
        let mut starts = Vec::new();
        for index in way {
            let Ok(station) = self.station(&places[index], line, neighbour.as_ref()) else {
                continue;
            };
            let pair = spectrum::follow(&station.collocations.problem, station.k, &near);
            neighbour = Some(station);
            let Ok(pair) = pair else { continue };
            near = pair;
            if index / CHUNK != chunk {
                chunk = index / CHUNK;
                starts.push(Start {
                    index,
                    pair: near.clone(),
                });
            }
        }
        starts
    }

    /// The rows of a chunk with the mode of a trace.
    fn followed(
        &self,
        places: &[Vec<f64>],
        line: Option<&Arc<Collocations>>,
        (trace, chunk): (&Trace, usize),
        progress: &dyn Progress,
    ) -> Vec<Row> {
        let first = (chunk % self.chunks_per_line()) * CHUNK;
        let start = trace.starts.get(first / CHUNK).and_then(Option::as_ref);
        let mut rows: Vec<Option<Row>> = vec![None; places.len()];
        let at = start.map_or(0, |start| start.index - first);
        let upwards: &mut dyn Iterator<Item = usize> = &mut (at..places.len());
        let downwards: &mut dyn Iterator<Item = usize> = &mut (0..at).rev();
        for way in [upwards, downwards] {
            let mut near = start.map(|start| start.pair.clone());
            let mut neighbour: Option<Station> = None;
            for index in way {
                let leading = trace.leading.get(first + index).copied().flatten();
                rows[index] = Some(
                    match self.station(&places[index], line, neighbour.as_ref()) {
                        Ok(station) => {
                            let pair = trace.follow(&station, near.as_ref());
                            near = pair.as_ref().ok().cloned().or(near);
                            let row = self.row_of(&station, pair, leading);
                            neighbour = Some(station);
                            row
                        }
                        Err(error) => {
                            Row::failed(places[index].clone(), &error, self.derived.len())
                        }
                    },
                );
                progress.advance(1);
            }
        }
        rows.into_iter().flatten().collect()
    }
}

impl Trace {
    /// A line without a mode.
    fn none(trouble: Error) -> Self {
        Trace {
            leading: Vec::new(),
            starts: Vec::new(),
            trouble: Some(trouble),
        }
    }

    /// The mode at a station that continues `near`.
    fn follow(&self, station: &Station, near: Option<&EigenPair>) -> Result<EigenPair> {
        match near {
            Some(near) => spectrum::follow(&station.collocations.problem, station.k, near),
            None => Err(self
                .trouble
                .clone()
                .unwrap_or_else(|| Error::computation("the mode was lost before this place"))),
        }
    }
}

/// Evenly spaced places of a chunk, its ends among them.
fn gauges(count: usize) -> BTreeSet<usize> {
    let last = count.saturating_sub(1);
    (0..GAUGES).map(|i| i * last / (GAUGES - 1)).collect()
}
