//! One row of a sweep's table, and the columns that can be drawn.

use super::identity::SweepIdentity;
use crate::error::{Error, Result};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// Columns of numbers after the axes.
pub const NUMBERS: [&str; 10] = [
    "c0_re",
    "c0_im",
    "c0_error",
    "c2_re",
    "c2_im",
    "c2_error",
    "amplitude",
    "mean_flow",
    "second_harmonic",
    "leading_re",
];

/// What a column of a sweep's table is.
pub fn meaning(name: &str) -> Option<&'static str> {
    Some(match name {
        "c0_re" => "growth rate, Re c0",
        "c0_im" => "frequency, Im c0",
        "c0_error" => "absolute error of c0, from a coarser collocation",
        "c2_re" => "Re c2, the first Landau coefficient",
        "c2_im" => "Im c2",
        "c2_error" => "absolute error of c2",
        "amplitude" => "equilibrium amplitude at cubic order, in the model's normalisation",
        "bifurcation" => "supercritical, subcritical or degenerate; pitchfork or Hopf",
        "mean_flow" => "distance of the problem for X[0;2] from singularity",
        "second_harmonic" => "distance of the problem for X[2;2] from singularity",
        "leading_re" => "growth rate of the leading mode, whichever mode the row holds",
        "status" => "ok, or why there is no number, or what is near",
        _ => return None,
    })
}

/// Columns after the axes, as they stand in a table.
pub(super) const COLUMNS: [&str; 12] = [
    NUMBERS[0],
    NUMBERS[1],
    NUMBERS[2],
    NUMBERS[3],
    NUMBERS[4],
    NUMBERS[5],
    NUMBERS[6],
    "bifurcation",
    NUMBERS[7],
    NUMBERS[8],
    NUMBERS[9],
    "status",
];

/// One row of the table; what has no answer is missing, and `status` says why.
#[derive(Clone, Debug, Default, Serialize, Deserialize, PartialEq)]
pub struct Row {
    /// Place on each axis.
    pub coordinates: Vec<f64>,
    /// Real and imaginary part.
    pub c0: Option<[f64; 2]>,
    /// Absolute error of c0, from a coarser collocation.
    pub c0_error: Option<f64>,
    /// Real and imaginary part.
    pub c2: Option<[f64; 2]>,
    /// Absolute error of c2.
    pub c2_error: Option<f64>,
    /// A_e
    pub amplitude: Option<f64>,
    /// Side and kind, in words.
    pub bifurcation: String,
    /// Distances of the problems for X[0;2] and X[2;2] from singularity.
    pub mean_flow: Option<f64>,
    /// Of the problem at 2k.
    pub second_harmonic: Option<f64>,
    /// Growth rate of the leading mode, in units of 1/time.
    pub leading: Option<f64>,
    /// `ok`, or why there is no number, or what is near.
    pub status: String,
    /// The columns that were asked for besides.
    #[serde(default)]
    pub derived: Vec<Option<f64>>,
}

/// A column of the table that can be drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Column {
    /// Growth rate.
    A0,
    /// Re c2
    A2,
    /// A_e of an unstable mode.
    Amplitude,
    /// A_e of a stable one: a threshold.
    Threshold,
}

/// The table of a sweep, and what stands beside it.
#[derive(Clone, Debug)]
pub struct Table {
    /// What it was computed from, for machines: by it the table is recognised.
    pub sweep: SweepIdentity,
    /// Names of the columns.
    pub header: Vec<String>,
    /// What it was computed from, for readers.
    pub facts: Map<String, Value>,
    /// The bytes of the CSV file.
    pub csv: Vec<u8>,
}

/// A table as CSV.
pub(super) fn table<'h>(header: impl Iterator<Item = &'h str>, rows: &[Row]) -> Result<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let failure = |e: csv::Error| Error::computation(format!("the table cannot be written: {e}"));
    writer.write_record(header).map_err(failure)?;
    for row in rows {
        writer.write_record(row.record()).map_err(failure)?;
    }
    writer
        .into_inner()
        .map_err(|e| Error::computation(e.to_string()))
}

/// One column over the first axis; NaN where there is no value.
pub fn column(rows: &[Row], column: Column) -> Vec<(f64, f64)> {
    let value = |row: &Row| match column {
        Column::A0 => row.c0.map(|c| c[0]),
        Column::A2 => row.c2.map(|c| c[0]),
        Column::Amplitude => row.amplitude.filter(|_| row.c0.is_some_and(|c| c[0] > 0.0)),
        Column::Threshold => row.amplitude.filter(|_| row.c0.is_some_and(|c| c[0] < 0.0)),
    };
    let point = |row: &Row| (row.coordinates[0], value(row).unwrap_or(f64::NAN));
    rows.iter().map(point).collect()
}

impl Row {
    /// The row of a point without an answer.
    pub(super) fn failed(coordinates: Vec<f64>, error: &Error, derived: usize) -> Self {
        Row {
            coordinates,
            derived: vec![None; derived],
            status: error.to_string(),
            ..Row::default()
        }
    }

    /// Its numbers, in the order of [`NUMBERS`].
    pub fn numbers(&self) -> [Option<f64>; 10] {
        let part = |c: Option<[f64; 2]>, i: usize| c.map(|c| c[i]);
        [
            part(self.c0, 0),
            part(self.c0, 1),
            self.c0_error,
            part(self.c2, 0),
            part(self.c2, 1),
            self.c2_error,
            self.amplitude,
            self.mean_flow,
            self.second_harmonic,
            self.leading,
        ]
    }

    /// Its cells: the coordinates, [`COLUMNS`], derived columns; what is missing is empty.
    fn record(&self) -> Vec<String> {
        let number = |value: &Option<f64>| value.map_or(String::new(), |v| format!("{v:e}"));
        let numbers: Vec<String> = self.numbers().iter().map(number).collect();
        let mut record: Vec<String> = self.coordinates.iter().map(f64::to_string).collect();
        record.extend_from_slice(&numbers[..7]);
        record.push(self.bifurcation.clone());
        record.extend_from_slice(&numbers[7..]);
        record.push(self.status.clone());
        record.extend(self.derived.iter().map(number));
        record
    }
}
