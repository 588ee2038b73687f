//! Sweeps: Landau points over one or several axes, in parallel, resumable.
//!
//! Rows are computed in chunks of fixed length, so the file does not depend on the number of threads or on where an
//! earlier run was interrupted.

mod mode;
mod station;

pub use mode::RowMode;

use super::derived::Derived;
use super::identity::SweepIdentity;
use super::journal::Journal;
use super::row::{COLUMNS, Row, Table, table};
use super::{Axis, Progress, Setup};
use crate::base::BaseState;
use crate::error::{Error, Result};
use crate::file::{Overwrite, destination};
use mode::Trace;
use rayon::prelude::*;
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Arc, OnceLock};

use crate::wavevector::WaveVector;
use station::Collocations;

/// Places of the first axis that one worker computes at a time.
const CHUNK: usize = 40;
/// Most rows of a sweep, and of one run of it, which keeps them all in memory.
const MOST_ROWS: usize = 1_000_000_000;
const MOST_ROWS_OF_A_RUN: usize = 20_000_000;

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
    pub(super) setup: &'s Setup,
    /// The first varies fastest.
    pub(super) ranges: Vec<Range>,
    /// Which mode a row holds.
    pub(super) mode: RowMode,
    /// The wavenumber, where no range varies it.
    pub(super) k: Option<f64>,
    /// Columns besides those of every point.
    pub(super) derived: Vec<Derived>,
}

/// What a run of a sweep found beside its output.
#[derive(Clone, Copy, Debug, Default)]
pub struct Resumed {
    /// Rows taken from an interrupted run.
    pub taken: usize,
    /// Lines of its journal that did not fit.
    pub damaged: usize,
}

impl<'s> Sweep<'s> {
    /// A sweep over `ranges`, with the wavenumber `k` where none of them varies it.
    ///
    /// # Errors
    /// No range, an empty one, two of one name, one that `k` or the setup fixes, a value that its parameter does not accept,
    /// a missing wavenumber.
    pub fn new(
        setup: &'s Setup,
        ranges: Vec<Range>,
        k: Option<f64>,
        mode: RowMode,
        derived: Vec<Derived>,
    ) -> Result<Self> {
        if ranges.is_empty() {
            return Err(Error::input("a sweep needs an axis"));
        }
        for (index, range) in ranges.iter().enumerate() {
            let name = &range.name;
            if range.values.is_empty() {
                return Err(Error::input(format!("the axis `{name}` has no values")));
            }
            if ranges[..index].iter().any(|r| r.axis == range.axis) {
                return Err(Error::input(format!("`{name}` varies twice")));
            }
            setup.check_free(range.axis, k)?;
            for &value in &range.values {
                match range.axis {
                    Axis::Wavenumber => {
                        WaveVector::wave(value)?;
                    }
                    axis => setup.accepts(axis, value)?,
                }
            }
        }
        let mut lengths = ranges.iter().map(|range| range.values.len());
        let rows = lengths.try_fold(1_usize, |rows, n| rows.checked_mul(n));
        if rows.is_none_or(|rows| rows > MOST_ROWS) {
            return Err(Error::input(format!(
                "the axes make more than {MOST_ROWS} rows: give them fewer values"
            )));
        }
        if !ranges.iter().any(|r| r.axis == Axis::Wavenumber) {
            let k = k.ok_or_else(|| Error::input("no axis is k: give the wavenumber, with --k"))?;
            WaveVector::wave(k)?;
        }
        Ok(Sweep {
            setup,
            ranges,
            mode,
            k,
            derived,
        })
    }
}

impl Sweep<'_> {
    /// Its axes; the first varies fastest.
    pub fn ranges(&self) -> &[Range] {
        &self.ranges
    }

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
        let rows = part.len() * CHUNK.min(self.ranges[0].values.len());
        if rows > MOST_ROWS_OF_A_RUN {
            return Err(Error::input(format!(
                "one run computes at most {MOST_ROWS_OF_A_RUN} rows: compute shares of the sweep, with --shard I/N"
            )));
        }
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
        // Chunks of one line along k share its base state, made by whichever comes first.
        let lines = self.chunk_count() / self.chunks_per_line();
        let bases: Vec<OnceLock<Result<Arc<BaseState>>>> =
            (0..lines).map(|_| OnceLock::new()).collect();
        let collocations = |line: usize| self.collocations(line, &bases[line]);
        progress.begin(part.clone().map(|chunk| self.places(chunk).len()).sum());
        let missing: Vec<usize> = part
            .clone()
            .filter(|chunk| !known.contains_key(chunk))
            .collect();
        let traces = self.traces(&missing, &collocations, progress);
        let chunks: BTreeMap<usize, Vec<Row>> = part
            .into_par_iter()
            .map(|chunk| {
                if let Some(rows) = known.get(&chunk) {
                    progress.advance(rows.len());
                    return (chunk, rows.clone());
                }
                // Whoever wants to stop can do so here.
                progress.advance(0);
                let line = chunk / self.chunks_per_line();
                let rows = self.chunk(chunk, collocations(line), traces.get(&line), progress);
                record(chunk, &rows);
                (chunk, rows)
            })
            .collect();
        progress.end();
        chunks
    }

    /// The collocations that a line along k shares; `None` along a parameter.
    fn collocations(
        &self,
        line: usize,
        base: &OnceLock<Result<Arc<BaseState>>>,
    ) -> Option<Result<Arc<Collocations>>> {
        if self.ranges[0].axis != Axis::Wavenumber {
            return None;
        }
        let place = &self.places(line * self.chunks_per_line())[0];
        Some(self.at(place).and_then(|(setup, _)| {
            let base = base.get_or_init(|| setup.base(None));
            let base = base.as_ref().map_err(Clone::clone)?;
            Collocations::new(&setup, base).map(Arc::new)
        }))
    }

    fn chunk(
        &self,
        chunk: usize,
        collocations: Option<Result<Arc<Collocations>>>,
        trace: Option<&Trace>,
        progress: &dyn Progress,
    ) -> Vec<Row> {
        let places = self.places(chunk);
        let trace = trace.map(|trace| (trace, chunk));
        match collocations.transpose() {
            Ok(line) => self.rows_of(&places, line.as_ref(), trace, progress),
            Err(error) => {
                progress.advance(places.len());
                let failed = |place| Row::failed(place, &error, self.derived.len());
                places.into_iter().map(failed).collect()
            }
        }
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
