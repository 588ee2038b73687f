//! Sweeps: Landau points over one or several axes, in parallel, resumable.
//!
//! The first axis is cut into chunks of fixed length. A chunk finds its mode from full spectra at its
//! ends and between them (the most unstable one leads) and follows it by shape, so a row does not depend on how
//! many threads there are, or on where an earlier run was interrupted.

use super::accuracy::{landau_error, stands};
use super::derived::Derived;
use super::identity::SweepIdentity;
use super::journal::Journal;
use super::row::{COLUMNS, Row, Table, table};
use super::{Axis, Carried, Progress, Setup};
use crate::base::BaseState;
use crate::error::Result;
use crate::file::{Overwrite, destination};
use crate::model::C64;
use crate::problem::Problem;
use crate::spectrum::{self, EigenPair};
use crate::weakly::{self, Bifurcation, LandauPoint, Selection, equilibrium};
use rayon::prelude::*;
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Arc, OnceLock};

/// Points of the first axis that one worker follows.
const CHUNK: usize = 40;
/// Points of a chunk at which all modes are looked at, its ends among them: between two stable ends a mode may grow.
const SEEDS: usize = 4;
/// A second-order problem nearer to singularity than this, relative to the slow rates, makes a row no `ok`.
const RESONANT: f64 = 1e-3;
/// Evenly spaced values along one axis.
#[derive(Clone, Debug)]
pub struct Range {
    /// As it was asked for.
    pub name: String,
    /// What varies.
    pub axis: Axis,
    /// In order.
    pub values: Vec<f64>,
}

/// A sweep over the product of its ranges, the first varying fastest.
pub struct Sweep<'s> {
    /// What is swept.
    pub setup: &'s Setup,
    /// The first varies fastest.
    pub ranges: Vec<Range>,
    /// The mode at the start; the leading one otherwise.
    pub near: Option<C64>,
    /// The wavenumber, where no range varies it.
    pub k: Option<f64>,
    /// Columns besides those of every point.
    pub derived: Vec<Derived>,
}

/// What a run of a sweep found beside its output.
#[derive(Clone, Copy, Debug, Default)]
pub struct Resumed {
    /// Rows taken from an interrupted run.
    pub taken: usize,
    /// Lines of its journal that did not fit.
    pub damaged: usize,
}

impl Sweep<'_> {
    /// Number of points.
    pub fn len(&self) -> usize {
        self.ranges.iter().map(|r| r.values.len()).product()
    }

    /// Whether an earlier run has left nothing.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    fn chunks_per_line(&self) -> usize {
        self.ranges[0].values.len().div_ceil(CHUNK)
    }

    pub(super) fn chunk_count(&self) -> usize {
        let lines: usize = self.ranges[1..].iter().map(|r| r.values.len()).product();
        lines * self.chunks_per_line()
    }

    /// Computes every row.
    pub fn run(&self, progress: &dyn Progress) -> Vec<Row> {
        let all = 0..self.chunk_count();
        let rows = self.run_chunks(all, &BTreeMap::new(), progress, &|_, _| {});
        rows.into_values().flatten().collect()
    }

    /// Computes the rows of a table, which `store` writes to the file that it is given; an interrupted run leaves a
    /// journal beside the table, from which the next one goes on. `resumed` is told what stood there.
    ///
    /// # Errors
    /// Files that cannot be written, or that `overwrite` does not allow to replace; another run with the same output.
    pub fn run_to(
        &self,
        out: &Path,
        overwrite: Overwrite,
        progress: &dyn Progress,
        resumed: impl FnOnce(Resumed),
        store: impl FnOnce(&Path, &Table) -> Result<()>,
    ) -> Result<Vec<Row>> {
        let target = destination(out)?;
        let all = 0..self.chunk_count();
        let (rows, journal) = self.journalled(&target, overwrite, all, progress, resumed)?;
        let rows: Vec<Row> = rows.into_values().flatten().collect();
        let table = Table {
            sweep: self.identity(),
            header: self.header().map(str::to_owned).collect(),
            facts: self.facts(),
            csv: table(self.header(), &rows)?,
        };
        store(&target, &table)?;
        journal.remove();
        Ok(rows)
    }

    /// Some chunks, with a journal beside `target` that is still open.
    pub(super) fn journalled(
        &self,
        target: &Path,
        overwrite: Overwrite,
        part: std::ops::Range<usize>,
        progress: &dyn Progress,
        resumed: impl FnOnce(Resumed),
    ) -> Result<(BTreeMap<usize, Vec<Row>>, Journal)> {
        let journal = Journal::open(target, &self.identity(), overwrite, |chunk, rows| {
            part.contains(&chunk)
                && rows
                    .iter()
                    .map(|r| &r.coordinates)
                    .eq(self.places(chunk).iter())
        })?;
        resumed(Resumed {
            taken: journal.finished.values().map(Vec::len).sum(),
            damaged: journal.damaged,
        });
        let rows = self.run_chunks(part, &journal.finished, progress, &|chunk, rows| {
            journal.record(chunk, rows)
        });
        Ok((rows, journal))
    }

    fn run_chunks(
        &self,
        part: std::ops::Range<usize>,
        known: &BTreeMap<usize, Vec<Row>>,
        progress: &dyn Progress,
        record: &(dyn Fn(usize, &[Row]) + Sync),
    ) -> BTreeMap<usize, Vec<Row>> {
        // Chunks of one line share its base state, made by whichever comes first.
        let lines = self.chunk_count() / self.chunks_per_line();
        let bases: Vec<OnceLock<Result<Arc<BaseState>>>> =
            (0..lines).map(|_| OnceLock::new()).collect();
        progress.begin(part.clone().map(|chunk| self.places(chunk).len()).sum());
        let chunks: BTreeMap<usize, Vec<Row>> = part
            .into_par_iter()
            .map(|chunk| {
                if let Some(rows) = known.get(&chunk) {
                    progress.advance(rows.len());
                    return (chunk, rows.clone());
                }
                // Whoever wants to stop can do so here.
                progress.advance(0);
                let base = &bases[chunk / self.chunks_per_line()];
                let rows = self.chunk(chunk, base, progress);
                record(chunk, &rows);
                (chunk, rows)
            })
            .collect();
        progress.end();
        chunks
    }

    /// The places of a chunk.
    fn places(&self, chunk: usize) -> Vec<Vec<f64>> {
        let per_line = self.chunks_per_line();
        let mut line = chunk / per_line;
        let first = (chunk % per_line) * CHUNK;
        let values = &self.ranges[0].values;
        let points = &values[first..(first + CHUNK).min(values.len())];
        let mut others = Vec::new();
        for range in &self.ranges[1..] {
            others.push(range.values[line % range.values.len()]);
            line /= range.values.len();
        }
        points
            .iter()
            .map(|&x| std::iter::once(x).chain(others.iter().copied()).collect())
            .collect()
    }

    fn chunk(
        &self,
        chunk: usize,
        base: &OnceLock<Result<Arc<BaseState>>>,
        progress: &dyn Progress,
    ) -> Vec<Row> {
        let places = self.places(chunk);
        if self.ranges[0].axis != Axis::Wavenumber {
            let look = |place: &[f64]| {
                let (setup, k) = self.at(place)?;
                let base = setup.base(None)?;
                let pair = weakly::select(&*setup.problem(&base)?, k, self.selection(None))?;
                Ok((pair.c.re, Carried { base, pair }))
            };
            let step = |place: &[f64], near: Option<&Carried>| self.evaluate(place, near);
            return follow(&places, look, step, self.derived.len(), progress);
        }
        // One base state and one set of coefficients serve the whole line.
        let line = self.at(&places[0]).and_then(|(setup, _)| {
            let base = base.get_or_init(|| setup.base(None));
            let base = base.as_ref().map_err(Clone::clone)?;
            let pairs = Collocations::new(&setup, base)?;
            let look = |place: &[f64]| {
                let pair = weakly::select(&pairs.own, place[0], self.selection(None))?;
                Ok((pair.c.re, pair))
            };
            let step =
                |place: &[f64], near: Option<&EigenPair>| self.row(&pairs, place, place[0], near);
            Ok(follow(&places, look, step, self.derived.len(), progress))
        });
        line.unwrap_or_else(|error| {
            progress.advance(places.len());
            places
                .into_iter()
                .map(|place| Row::failed(place, &error, self.derived.len()))
                .collect()
        })
    }

    /// The mode that continues `near`, or the one that is asked for.
    fn selection<'p>(&self, near: Option<&'p EigenPair>) -> Selection<'p> {
        match (near, self.near) {
            (Some(pair), _) => Selection::Like(pair),
            (None, Some(target)) => Selection::Near(target),
            (None, None) => Selection::Leading,
        }
    }

    /// The setup and the wavenumber of a place.
    fn at(&self, place: &[f64]) -> Result<(Setup, f64)> {
        let mut setup = self.setup.clone();
        let mut k = self.k.unwrap_or(0.0);
        for (range, &value) in self.ranges.iter().zip(place) {
            match range.axis {
                Axis::Wavenumber => k = value,
                axis => setup = setup.moved(axis, value)?,
            }
        }
        Ok((setup, k))
    }

    /// A point whose base state is its own.
    fn evaluate(&self, place: &[f64], near: Option<&Carried>) -> Result<(Row, Carried)> {
        let (setup, k) = self.at(place)?;
        let base = setup.base(near.map(|c| c.base.as_ref()))?;
        let (row, pair) = self.row(
            &Collocations::new(&setup, &base)?,
            place,
            k,
            near.map(|c| &c.pair),
        )?;
        Ok((row, Carried { base, pair }))
    }

    fn row(
        &self,
        collocations: &Collocations,
        place: &[f64],
        k: f64,
        near: Option<&EigenPair>,
    ) -> Result<(Row, EigenPair)> {
        let pair = weakly::select(&collocations.own, k, self.selection(near))?;
        // Where c2 has no answer, the mode is still there to be followed.
        let row = match weakly::from_pair(&collocations.own, pair.clone()) {
            Ok(point) => {
                let row = row(collocations, place, &point)?;
                let value = |column: &Derived| column.value(&point, row.amplitude);
                Row {
                    derived: self.derived.iter().map(value).collect(),
                    ..row
                }
            }
            Err(error) => Row {
                c0: Some([pair.c.re, pair.c.im]),
                ..Row::failed(place.to_vec(), &error, self.derived.len())
            },
        };
        Ok((row, pair))
    }

    /// What its table was computed from, by name: what stands beside it.
    pub fn facts(&self) -> Map<String, Value> {
        let (setup, structure) = (self.setup, self.setup.model.structure());
        let swept = |name: &str| self.ranges.iter().any(|range| range.name == name);
        let parameters = structure.parameters.pairs();
        let parameters: Vec<String> = parameters
            .filter(|(_, info)| !swept(&info.name))
            .map(|(id, info)| format!("{}={}", info.name, setup.parameters.shown(structure, id)))
            .collect();
        let mut facts = Map::new();
        for (name, text) in [
            ("title", structure.title.as_str()),
            ("model", &structure.name),
            ("model_hash", &setup.hash()),
            ("parameters", &parameters.join(" ")),
            ("normalization", &structure.amplitude.description),
            ("version", env!("CARGO_PKG_VERSION")),
        ] {
            facts.insert(name.to_owned(), text.into());
        }
        facts.insert("resolution".to_owned(), setup.resolution.into());
        facts.extend(self.k.map(|k| ("k".to_owned(), k.into())));
        facts
    }

    /// Names of the columns: the axes, those of every row, derived ones.
    pub fn header(&self) -> impl Iterator<Item = &str> {
        let axes = self.ranges.iter().map(|r| r.name.as_str());
        let derived = self.derived.iter().map(|column| column.name.as_str());
        axes.chain(COLUMNS).chain(derived)
    }

    /// What its files were computed from.
    pub fn identity(&self) -> SweepIdentity {
        SweepIdentity::new(self)
    }
}

/// The problem at M, and a coarser one beside which its errors show.
struct Collocations {
    own: Arc<Problem>,
    coarser: Option<Arc<Problem>>,
}

impl Collocations {
    fn new(setup: &Setup, base: &Arc<BaseState>) -> Result<Self> {
        let coarser = setup.effective_resolution().map(|m| m - m.div_ceil(6));
        let coarser = coarser.map(|m| Problem::new(base, Some(m)).map(Arc::new));
        Ok(Collocations {
            own: setup.problem(base)?,
            coarser: coarser.transpose()?,
        })
    }

    /// Absolute errors of c0 and c2.
    fn errors(&self, point: &LandauPoint) -> [f64; 2] {
        let floor = point.rounding();
        let Some(coarser) = &self.coarser else {
            return floor;
        };
        let beside = spectrum::transferred(&self.own, &point.pair, coarser)
            .and_then(|pair| weakly::from_pair(coarser, pair));
        match beside {
            Ok(other) => [
                floor[0].max((other.c0 - point.c0).norm()),
                floor[1].max((other.c2 - point.c2).norm()),
            ],
            Err(_) => [f64::INFINITY; 2],
        }
    }
}

/// The row of a point with its errors and distances.
fn row(collocations: &Collocations, place: &[f64], point: &LandauPoint) -> Result<Row> {
    let [error0, error2] = collocations.errors(point);
    let scale = point.pair.scale.max(point.c0.norm());
    let [mean_flow, second_harmonic] = point.distances().map(|d| Some(d).filter(|d| d.is_finite()));
    let standing = landau_error(point, error2);
    let (good0, good2) = (stands(error0, point.c0.norm(), scale), standing.is_some());
    let error2 = standing.unwrap_or(error2);
    let near = |d: Option<f64>| d.is_some_and(|d| d <= RESONANT * scale);
    let not_kept = point.multiplier_error(error2);
    let status = if !good0 {
        "c0 is not converged: a larger M".to_owned()
    } else if !good2 {
        "c2 is not converged: a larger M".to_owned()
    } else if let Some(error) = &not_kept {
        error.to_string()
    } else if near(second_harmonic) {
        "near a 2:1 resonance".to_owned()
    } else if near(mean_flow) {
        "near a mean-flow resonance".to_owned()
    } else {
        "ok".to_owned()
    };
    let pair = |c: C64| [c.re, c.im];
    let finite = |error: f64| Some(error).filter(|e| e.is_finite());
    let known = good0 && good2 && not_kept.is_none();
    let (c0, c2) = ((point.c0, error0), (point.c2, error2));
    Ok(Row {
        coordinates: place.to_vec(),
        c0: good0.then(|| pair(point.c0)),
        c0_error: finite(error0),
        c2: known.then(|| pair(point.c2)),
        c2_error: finite(error2),
        amplitude: equilibrium(c0, c2).filter(|_| known),
        derived: Vec::new(),
        bifurcation: match known {
            true => Bifurcation::new(c0, c2).to_string(),
            false => String::new(),
        },
        mean_flow,
        second_harmonic,
        status,
    })
}

/// Rows of a chunk: the mode that is most unstable at one of its seeds, which `look` finds, followed from there to both
/// ends by `step`.
fn follow<C: Clone>(
    places: &[Vec<f64>],
    look: impl Fn(&[f64]) -> Result<(f64, C)>,
    step: impl Fn(&[f64], Option<&C>) -> Result<(Row, C)>,
    derived: usize,
    progress: &dyn Progress,
) -> Vec<Row> {
    let last = places.len() - 1;
    let mut seeds: Vec<usize> = (0..SEEDS).map(|i| i * last / (SEEDS - 1)).collect();
    seeds.dedup();
    let found = seeds
        .into_iter()
        .filter_map(|i| Some((i, look(&places[i]).ok()?)));
    // Of equal ones the first.
    let best = found.reduce(|best, next| if next.1.0 > best.1.0 { next } else { best });
    let (start, seed) = best.map_or((0, None), |(start, (_, seed))| (start, Some(seed)));
    let mut rows: Vec<Option<Row>> = vec![None; places.len()];
    let upwards: &mut dyn Iterator<Item = usize> = &mut (start..places.len());
    let downwards: &mut dyn Iterator<Item = usize> = &mut (0..start).rev();
    for way in [upwards, downwards] {
        let mut near = seed.clone();
        for index in way {
            rows[index] = Some(match step(&places[index], near.as_ref()) {
                Ok((row, next)) => {
                    near = Some(next);
                    row
                }
                Err(error) => Row::failed(places[index].clone(), &error, derived),
            });
            progress.advance(1);
        }
    }
    rows.into_iter().flatten().collect()
}
