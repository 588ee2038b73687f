//! Pictures of answers, and what is stored beside them; the table of a sweep.

use crate::arguments::{Files, OfMode};
use crate::asked::asked;
use crate::outputs;
use landau_report::data::plane::{attributes, modes as dataset};
use landau_report::data::{Dataset, Facts};
use landau_report::figure;
use landau_report::figure::{Drawing, Panel, Style, atlas, panels};
use landau_solver::error::{Error, Result};
use landau_solver::file::Overwrite;
use landau_solver::study::Setup;
use landau_solver::study::modes::Modes;
use landau_solver::study::row::{Column, Row, column};
use landau_solver::study::sweep::Sweep;
use landau_solver::words;
use landau_solver::words::shown_path;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Writes a picture where one is asked for.
///
/// # Errors
/// A path that cannot be written; an answer that has nothing to draw.
pub fn drawn(path: Option<&Path>, draw: impl FnOnce() -> Option<Drawing>) -> Result<()> {
    let Some(path) = path else { return Ok(()) };
    let drawn = draw().ok_or_else(|| {
        Error::input(format!(
            "--plot {}: there is no profile to draw, for the model has no cross-stream coordinate",
            shown_path(path)
        ))
    })?;
    drawn.write(path)
}

/// Refuses what cannot be written, or must not be replaced, before anything is computed.
///
/// # Errors
/// A picture that is no .svg or .png, data that are no .npz or .nc; see [`outputs::check`].
pub fn check(files: &Files) -> Result<()> {
    outputs::check_picture(files.plot.as_deref())?;
    outputs::check_data(&files.out, &outputs::LINE_FORMATS)?;
    let paths = files.plot.iter().chain(&files.out).map(PathBuf::as_path);
    outputs::check(paths, Overwrite::forced(files.force))
}

/// Stores data, with what they were computed from, wherever that is asked for.
///
/// # Errors
/// A file that cannot be written.
pub fn stored(
    setup: &Setup,
    parameters: &Value,
    k: Option<f64>,
    out: &[PathBuf],
    data: impl Fn(Facts) -> Dataset,
) -> Result<()> {
    let data = data(attributes(setup, parameters, k, None));
    out.iter().try_for_each(|path| data.write(path))
}

/// The modes at a wavenumber, drawn and stored where that is asked for.
///
/// # Errors
/// As [`drawn`] and [`check`].
pub fn modes(setup: &Setup, k: Option<f64>, files: &Files, of_mode: &OfMode) -> Result<()> {
    check(files)?;
    if files.plot.is_none() && files.out.is_empty() {
        return Ok(());
    }
    let (k, selection) = asked(setup, k, of_mode.near)?;
    let profiles = Modes::compute(setup, k, selection)?;
    let structure = setup.model.structure();
    drawn(files.plot.as_deref(), || {
        figure::modes(structure, &profiles)
    })?;
    stored(setup, &profiles.parameters, Some(k), &files.out, |facts| {
        dataset(setup, &profiles, facts)
    })
}

/// Rows shown of a long table.
const SHOWN: usize = 24;

/// The table, thinned to a screenful.
pub fn table(sweep: &Sweep, rows: &[Row]) {
    let names = sweep.ranges().iter().map(|r| format!("{:>12}", r.name));
    let columns = ["a0", "a2", "A_e"].iter().map(|n| format!("{n:>16}"));
    say!("{}", names.chain(columns).collect::<String>());
    let stride = rows.len().div_ceil(SHOWN).max(1);
    for row in rows.iter().step_by(stride) {
        let place = row
            .coordinates
            .iter()
            .map(|x| format!("{:>12}", words::short(*x)));
        let number = |v: Option<f64>| v.map_or(format!("{:>16}", "-"), |v| format!("{v:>16.6e}"));
        let values = [row.c0.map(|c| c[0]), row.c2.map(|c| c[0]), row.amplitude].map(number);
        say!("{}", place.chain(values).collect::<String>());
    }
}

/// Growth rate, c2 and amplitude over one axis, lines in the plane over two, drawn.
pub fn sweep(setup: &Setup, sweep: &Sweep, rows: &[Row]) -> Option<Drawing> {
    let title = &setup.model.structure().title;
    if let [first, second] = sweep.ranges() {
        let names = [first, second].map(|r| r.name.as_str());
        return atlas(title, names, [&first.values, &second.values], rows);
    }
    let axis = sweep.ranges()[0].name.as_str();
    let mut growth = Panel::new("growth rate", axis, "a0");
    let mut landau = Panel::new("first Landau coefficient", axis, "a2");
    let mut amplitude = Panel::new("equilibrium amplitude", axis, "A_e");
    for line in rows.chunk_by(|a, b| a.coordinates[1..] == b.coordinates[1..]) {
        let fixed = sweep.ranges()[1..].iter().zip(&line[0].coordinates[1..]);
        let label: Vec<String> = fixed.map(|(r, x)| format!("{} = {x:.4}", r.name)).collect();
        let label = label.join(", ");
        growth.curve(&label, Style::Line, column(line, Column::A0));
        landau.curve_with_poles(&label, Style::Line, column(line, Column::A2));
        amplitude.curve_with_poles(&label, Style::Line, column(line, Column::Amplitude));
        // The unstable branch of a subcritical bifurcation.
        let threshold = column(line, Column::Threshold);
        if threshold.iter().any(|p| p.1.is_finite()) {
            let label = format!("{label} threshold").trim().to_owned();
            amplitude.curve_with_poles(&label, Style::Dashed, threshold);
        }
    }
    panels(title, &[growth, landau, amplitude])
}
