//! Sweeps: Landau points over one or several axes, in parallel, resumable.
//!
//! The first axis is cut into chunks of fixed length. A chunk finds its mode from full spectra at its
//! two ends (the more unstable one leads) and follows it by shape, so a row does not depend on how
//! many threads there are, or on where an earlier run was interrupted.

use super::{Axis, Carried, Setup};
use crate::error::{Error, Result};
use crate::figure::bulk;
use crate::model::C64;
use crate::problem::Problem;
use crate::spectrum::EigenPair;
use crate::weakly::{self, Selection};
use indicatif::ProgressBar;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::fs::{self, File, OpenOptions};
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// Points of the first axis that one worker follows.
const CHUNK: usize = 40;

/// Evenly spaced values along one axis.
#[derive(Clone, Debug)]
pub struct Range {
    pub name: String,
    pub axis: Axis,
    pub values: Vec<f64>,
}

/// One row of the table.
#[derive(Clone, Debug, Serialize, Deserialize, PartialEq)]
pub struct Row {
    pub coordinates: Vec<f64>,
    pub c0: Option<[f64; 2]>,
    pub c2: Option<[f64; 2]>,
    pub amplitude: Option<f64>,
    pub bifurcation: String,
    /// `ok`, or why there is no number.
    pub status: String,
}

/// A column of the table that can be drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Column {
    A0,
    A2,
    /// A_e of an unstable mode.
    Amplitude,
}

/// One column over the first axis; NaN where there is no value, or at the pole of a column with poles.
pub fn column(rows: &[Row], column: Column) -> Vec<(f64, f64)> {
    let value = |row: &Row| match column {
        Column::A0 => row.c0.map(|c| c[0]),
        Column::A2 => row.c2.map(|c| c[0]),
        Column::Amplitude => row.amplitude.filter(|_| row.c0.is_some_and(|c| c[0] > 0.0)),
    };
    let values: Vec<f64> = rows.iter().map(|r| value(r).unwrap_or(f64::NAN)).collect();
    let most = match column {
        Column::A0 => f64::INFINITY,
        _ => bulk(values.iter().copied()),
    };
    let kept = |v: f64| if v.abs() <= most { v } else { f64::NAN };
    let places = rows.iter().map(|r| r.coordinates[0]);
    places.zip(values.into_iter().map(kept)).collect()
}

#[derive(Serialize, Deserialize)]
struct Finished {
    chunk: usize,
    rows: Vec<Row>,
}

/// A sweep over the product of its ranges, the first varying fastest.
pub struct Sweep<'s, 'm> {
    pub setup: &'s Setup<'m>,
    pub ranges: Vec<Range>,
    pub near: Option<C64>,
    /// The wavenumber, where no range varies it.
    pub k: Option<f64>,
}

impl Sweep<'_, '_> {
    /// Number of points.
    pub fn len(&self) -> usize {
        self.ranges.iter().map(|r| r.values.len()).product()
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    fn chunks_per_line(&self) -> usize {
        self.ranges[0].values.len().div_ceil(CHUNK)
    }

    fn chunk_count(&self) -> usize {
        let lines: usize = self.ranges[1..].iter().map(|r| r.values.len()).product();
        lines * self.chunks_per_line()
    }

    /// Computes every row.
    pub fn run(&self, progress: &ProgressBar) -> Vec<Row> {
        self.run_chunks(&HashMap::new(), progress, &|_, _| {})
    }

    /// Computes the rows into a CSV file, whole or not at all; an interrupted run leaves a journal
    /// beside it, from which the next one goes on.
    ///
    /// # Errors
    /// Files that cannot be written.
    pub fn run_to(&self, out: &Path, progress: &ProgressBar) -> Result<Vec<Row>> {
        let journal = Journal::open(out, &self.fingerprint())?;
        let rows = self.run_chunks(&journal.known, progress, &|chunk, rows| {
            journal.record(chunk, rows)
        });
        write_whole(out, &self.csv(&rows)?)?;
        journal.remove();
        Ok(rows)
    }

    fn run_chunks(
        &self,
        known: &HashMap<usize, Vec<Row>>,
        progress: &ProgressBar,
        record: &(dyn Fn(usize, &[Row]) + Sync),
    ) -> Vec<Row> {
        progress.set_length(self.len() as u64);
        let chunks: Vec<Vec<Row>> = (0..self.chunk_count())
            .into_par_iter()
            .map(|chunk| {
                if let Some(rows) = known.get(&chunk) {
                    progress.inc(rows.len() as u64);
                    return rows.clone();
                }
                let rows = self.chunk(chunk, progress);
                record(chunk, &rows);
                rows
            })
            .collect();
        progress.finish_and_clear();
        chunks.into_iter().flatten().collect()
    }

    fn chunk(&self, chunk: usize, progress: &ProgressBar) -> Vec<Row> {
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
        let coordinates = |x: f64| {
            std::iter::once(x)
                .chain(others.iter().copied())
                .collect::<Vec<f64>>()
        };
        let places: Vec<Vec<f64>> = points.iter().map(|&x| coordinates(x)).collect();
        if self.ranges[0].axis != Axis::Wavenumber {
            let step = |place: &[f64], near: Option<&Carried>| self.evaluate(place, near);
            return follow(
                &places,
                |carried: &Carried| carried.pair.c.re,
                step,
                progress,
            );
        }
        // One base state and one set of coefficients serve the whole line.
        let line = self.at(&places[0]).and_then(|(setup, _)| {
            let base = setup.base(None)?;
            setup.with_problem(&base, |problem| {
                let step = |place: &[f64], near: Option<&EigenPair>| {
                    self.row(problem, place, place[0], near)
                };
                Ok(follow(
                    &places,
                    |pair: &EigenPair| pair.c.re,
                    step,
                    progress,
                ))
            })
        });
        line.unwrap_or_else(|error| {
            progress.inc(places.len() as u64);
            places
                .into_iter()
                .map(|place| failed(place, &error))
                .collect()
        })
    }

    /// The setup and the wavenumber of a place.
    fn at(&self, place: &[f64]) -> Result<(Setup<'_>, f64)> {
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
        let base = setup.base(near.map(|c| &c.base))?;
        let (row, pair) = setup.with_problem(&base, |problem| {
            self.row(problem, place, k, near.map(|c| &c.pair))
        })?;
        Ok((row, Carried { base, pair }))
    }

    fn row(
        &self,
        problem: &Problem,
        place: &[f64],
        k: f64,
        near: Option<&EigenPair>,
    ) -> Result<(Row, EigenPair)> {
        let selection = match (near, self.near) {
            (Some(pair), _) => Selection::Like(pair),
            (None, Some(target)) => Selection::Near(target),
            (None, None) => Selection::Leading,
        };
        let point = weakly::point(problem, k, selection)?;
        let row = Row {
            coordinates: place.to_vec(),
            c0: Some([point.c0.re, point.c0.im]),
            c2: Some([point.c2.re, point.c2.im]),
            amplitude: point.amplitude(),
            bifurcation: point.bifurcation(),
            status: "ok".into(),
        };
        Ok((row, point.expansion.pair))
    }

    /// The table as CSV.
    ///
    /// # Errors
    /// Rows that do not serialise.
    pub fn csv(&self, rows: &[Row]) -> Result<Vec<u8>> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let mut header: Vec<&str> = self.ranges.iter().map(|r| r.name.as_str()).collect();
        header.extend([
            "c0_re",
            "c0_im",
            "c2_re",
            "c2_im",
            "amplitude",
            "bifurcation",
            "status",
        ]);
        let failure =
            |e: csv::Error| Error::computation(format!("the table cannot be written: {e}"));
        writer.write_record(&header).map_err(failure)?;
        let number = |value: Option<f64>| value.map_or(String::new(), |v| format!("{v:e}"));
        for row in rows {
            let mut record: Vec<String> = row.coordinates.iter().map(f64::to_string).collect();
            for pair in [row.c0, row.c2] {
                record.push(number(pair.map(|p| p[0])));
                record.push(number(pair.map(|p| p[1])));
            }
            record.push(number(row.amplitude));
            record.push(row.bifurcation.clone());
            record.push(row.status.clone());
            writer.write_record(&record).map_err(failure)?;
        }
        writer
            .into_inner()
            .map_err(|e| Error::computation(e.to_string()))
    }

    /// What a journal must have been made for.
    fn fingerprint(&self) -> String {
        let structure = self.setup.model.structure();
        format!(
            "{} {:?} {:?} M={} k={:?} near={:?} {:?} v{} {}",
            structure.name,
            self.setup.parameters.values,
            self.setup.parameters.automatic,
            self.setup.resolution,
            self.k,
            self.near,
            self.ranges,
            env!("CARGO_PKG_VERSION"),
            self.setup.hash()
        )
    }
}

/// Rows of a chunk: the mode of the more unstable end, followed to the other.
fn follow<C>(
    places: &[Vec<f64>],
    growth: impl Fn(&C) -> f64,
    step: impl Fn(&[f64], Option<&C>) -> Result<(Row, C)>,
    progress: &ProgressBar,
) -> Vec<Row> {
    let last = places.len() - 1;
    let ends = [0, last].map(|i| step(&places[i], None));
    let [first_growth, last_growth] =
        [&ends[0], &ends[1]].map(|end| end.as_ref().map_or(f64::NEG_INFINITY, |(_, c)| growth(c)));
    let [first, second] = ends;
    let backwards = last_growth > first_growth;
    let mut order: Vec<usize> = (0..places.len()).collect();
    if backwards {
        order.reverse();
    }
    let mut seed = Some(if backwards { second } else { first });
    let mut rows: Vec<Option<Row>> = vec![None; places.len()];
    let mut carried: Option<C> = None;
    for index in order {
        let outcome = seed
            .take()
            .unwrap_or_else(|| step(&places[index], carried.as_ref()));
        rows[index] = Some(match outcome {
            Ok((row, next)) => {
                carried = Some(next);
                row
            }
            Err(error) => failed(places[index].clone(), &error),
        });
        progress.inc(1);
    }
    rows.into_iter().flatten().collect()
}

fn failed(coordinates: Vec<f64>, error: &Error) -> Row {
    Row {
        coordinates,
        c0: None,
        c2: None,
        amplitude: None,
        bifurcation: String::new(),
        status: error.to_string(),
    }
}

/// Finished chunks beside the output, one JSON object a line.
struct Journal {
    path: PathBuf,
    file: Mutex<File>,
    known: HashMap<usize, Vec<Row>>,
}

impl Journal {
    fn open(out: &Path, fingerprint: &str) -> Result<Self> {
        let mut name = out.file_name().unwrap_or_default().to_os_string();
        name.push(".journal");
        let path = out.with_file_name(name);
        let failure =
            |e: std::io::Error| Error::input(format!("{} cannot be written: {e}", path.display()));
        let mut known = HashMap::new();
        let header = serde_json::to_string(fingerprint).unwrap_or_default();
        let mut valid = false;
        if let Ok(file) = File::open(&path) {
            let mut lines = BufReader::new(file)
                .lines()
                .map_while(std::result::Result::ok);
            valid = lines.next().as_deref() == Some(&header);
            if valid {
                // A line cut off by an interruption does not parse, and is computed again.
                known = lines
                    .filter_map(|line| serde_json::from_str::<Finished>(&line).ok())
                    .map(|finished| (finished.chunk, finished.rows))
                    .collect();
            }
        }
        let mut options = OpenOptions::new();
        let mut file = if valid {
            options.append(true).open(&path).map_err(failure)?
        } else {
            options
                .write(true)
                .create(true)
                .truncate(true)
                .open(&path)
                .map_err(failure)?
        };
        if valid {
            writeln!(file).map_err(failure)?;
        } else {
            writeln!(file, "{header}").map_err(failure)?;
        }
        Ok(Journal {
            path,
            file: Mutex::new(file),
            known,
        })
    }

    fn record(&self, chunk: usize, rows: &[Row]) {
        let finished = Finished {
            chunk,
            rows: rows.to_vec(),
        };
        if let (Ok(line), Ok(mut file)) = (serde_json::to_string(&finished), self.file.lock()) {
            // A journal that cannot be written costs the resumption, not the result.
            let _ = writeln!(file, "{line}").and_then(|()| file.flush());
        }
    }

    fn remove(&self) {
        let _ = fs::remove_file(&self.path);
    }
}

/// Writes a file whole or not at all.
///
/// # Errors
/// Folders that do not exist, permissions.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<()> {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(".part");
    let part = path.with_file_name(name);
    fs::write(&part, bytes)
        .and_then(|()| fs::rename(&part, path))
        .map_err(|e| Error::input(format!("{} cannot be written: {e}", path.display())))
}
