//! What is asked of a model: the same calls as the command line's, and its JSON.

use crate::model::Core;
use crate::watch::watched;
use landau_report::data::table;
use landau_report::library::column;
use landau_solver::error::{Error, Result};
use landau_solver::file::Overwrite;
use landau_solver::model::{C64, Model};
use landau_solver::study::accuracy::Converged;
use landau_solver::study::amplitudes::{AmplitudesReport, ModeChoice};
use landau_solver::study::critical::{CriticalReport, Quantity, Question, Request, Tracking};
use landau_solver::study::modes::Modes;
use landau_solver::study::point::PointReport;
use landau_solver::study::profiles::BaseReport;
use landau_solver::study::row::Row;
use landau_solver::study::shard::{Share, merge};
use landau_solver::study::spectrum::SpectrumReport;
use landau_solver::study::sweep::{Range, RowMode, Sweep};
use landau_solver::study::verify::Certificate;
use landau_solver::study::{Axis, Setup, Silent, check_wavenumber};
use landau_solver::weakly::{Selection, Window, pattern};
use landau_solver::words;
use pyo3::prelude::*;
use serde_json::{Value, json};
use std::path::PathBuf;
use std::sync::Arc;

/// Re and Im of an eigenvalue that a mode is near to.
type Near = Option<(f64, f64)>;

fn setup(model: Arc<dyn Model>, set: &[String], resolution: usize) -> Result<Setup> {
    if !(4..=1000).contains(&resolution) {
        return Err(Error::input(format!(
            "M = {resolution} is out of range: it accepts 4 to 1000"
        )));
    }
    let mut setup = Setup::new(model, resolution);
    setup.set(set)?;
    Ok(setup)
}

fn selection(near: Near) -> Selection<'static> {
    near.map_or(Selection::Leading, |(re, im)| {
        Selection::Near(C64::new(re, im))
    })
}

/// A sweep over named axes.
fn swept<'s>(
    setup: &'s Setup,
    axes: Vec<(String, Vec<f64>)>,
    k: Option<f64>,
    mode: RowMode,
    columns: &[String],
) -> Result<Sweep<'s>> {
    let ranges = axes
        .into_iter()
        .map(|(name, values)| {
            let axis = Axis::named(setup.model.as_ref(), &name)?;
            Ok(Range { name, axis, values })
        })
        .collect::<Result<_>>()?;
    let derived = columns
        .iter()
        .map(|text| column(setup.model.as_ref(), text))
        .collect::<Result<_>>()?;
    Sweep::new(setup, ranges, k, mode, derived)
}

/// The mode that rows hold: `near` names one, `follow` keeps to it along the first axis.
fn row_mode(near: Near, follow: bool) -> RowMode {
    let near = near.map(|(re, im)| C64::new(re, im));
    match near {
        near if follow => RowMode::Followed(near),
        Some(target) => RowMode::Nearest(target),
        None => RowMode::Leading,
    }
}

fn row(row: &Row) -> Value {
    json!({
        "place": row.coordinates,
        "c0": row.c0,
        "c0_error": row.c0_error,
        "c2": row.c2,
        "c2_error": row.c2_error,
        "amplitude": row.amplitude,
        "bifurcation": row.bifurcation,
        "mean_flow": row.mean_flow,
        "second_harmonic": row.second_harmonic,
        "leading_re": row.leading,
        "status": row.status,
        "derived": row.derived,
    })
}

/// An answer's JSON with its words, which Python shows.
fn with_text(mut json: Value, text: &impl std::fmt::Display) -> String {
    json["text"] = text.to_string().into();
    json.to_string()
}

fn quantity(of: &str) -> Result<Quantity> {
    match of {
        "growth" => Ok(Quantity::Growth),
        "c2" => Ok(Quantity::C2),
        "resonance" => Ok(Quantity::Resonance),
        _ => Err(Error::input(format!(
            "of = `{of}`: it accepts growth, c2, resonance"
        ))),
    }
}

fn modes(found: &Modes) -> Value {
    let parts =
        |values: &[C64]| -> Vec<Value> { values.iter().map(|v| words::complex(*v)).collect() };
    let profiles = found.profiles.iter().map(|profile| {
        let own = profile.parts.iter().zip(&profile.values);
        let own: Vec<(&String, Vec<Value>)> = own.map(|(p, v)| (p, parts(v))).collect();
        json!([profile.name, own])
    });
    json!({
        "parameters": found.parameters,
        "k": found.k,
        "y": found.heights,
        "modes": profiles.collect::<Vec<_>>(),
    })
}

#[pymethods]
impl Core {
    /// The base state at `points` heights.
    fn base(
        &self,
        py: Python<'_>,
        set: Vec<String>,
        resolution: usize,
        points: usize,
    ) -> PyResult<String> {
        let model = self.model.clone();
        watched(py, move |_| {
            let found = BaseReport::compute(&setup(model, &set, resolution)?, points)?;
            Ok(found.json().to_string())
        })
    }

    fn spectrum(
        &self,
        py: Python<'_>,
        set: Vec<String>,
        resolution: usize,
        k: f64,
    ) -> PyResult<String> {
        let model = self.model.clone();
        watched(py, move |_| {
            let found = SpectrumReport::compute(&setup(model, &set, resolution)?, k)?;
            Ok(with_text(found.json(), &found))
        })
    }

    fn point(
        &self,
        py: Python<'_>,
        set: Vec<String>,
        resolution: usize,
        k: f64,
        near: Near,
        order: usize,
    ) -> PyResult<String> {
        let model = self.model.clone();
        watched(py, move |_| {
            let setup = setup(model, &set, resolution)?;
            let found = PointReport::compute(&setup, k, selection(near), order)?;
            Ok(with_text(found.json(), &found))
        })
    }

    /// The modes of the expansion and the adjoint mode as profiles.
    fn modes(
        &self,
        py: Python<'_>,
        set: Vec<String>,
        resolution: usize,
        k: f64,
        near: Near,
    ) -> PyResult<String> {
        let model = self.model.clone();
        watched(py, move |_| {
            let setup = setup(model, &set, resolution)?;
            Ok(modes(&Modes::compute(&setup, k, selection(near))?).to_string())
        })
    }

    /// Wavenumber and nearby eigenvalue of each mode.
    fn amplitudes(
        &self,
        py: Python<'_>,
        set: Vec<String>,
        resolution: usize,
        modes: Vec<(f64, Near)>,
        order: usize,
    ) -> PyResult<String> {
        let model = self.model.clone();
        watched(py, move |_| {
            let setup = setup(model, &set, resolution)?;
            let choices = modes.iter().map(|(k, near)| ModeChoice {
                k: *k,
                near: near.map(|(re, im)| C64::new(re, im)),
            });
            let choices: Vec<ModeChoice> = choices.collect();
            let found = AmplitudesReport::compute(&setup, &choices, order, &Silent)?;
            Ok(with_text(found.json(), &found))
        })
    }

    #[allow(clippy::too_many_arguments, reason = "the options of the command")]
    fn critical(
        &self,
        py: Python<'_>,
        set: Vec<String>,
        resolution: usize,
        vary: String,
        between: (f64, f64),
        of: String,
        k: Option<f64>,
        minimize: Option<(f64, f64)>,
        near: Near,
        follow: bool,
    ) -> PyResult<String> {
        let model = self.model.clone();
        watched(py, move |watch| {
            let setup = setup(model, &set, resolution)?;
            let request = Request {
                vary: &vary,
                between: between.into(),
                of: quantity(&of)?,
                k,
                minimize: minimize.map(Into::into),
                tracking: match (near, follow) {
                    (Some((re, im)), _) => Tracking::Near(C64::new(re, im)),
                    (None, true) => Tracking::Fastest,
                    (None, false) => Tracking::Leading,
                },
            };
            let question = Question::new(&setup, &request)?;
            let found = CriticalReport::compute(&setup, &question, watch)?;
            let points = found.found.iter().map(|point| found.json(point));
            Ok(points.collect::<Value>().to_string())
        })
    }

    /// Rows over the product of axes, the first varying fastest; into a CSV file with a journal where `out` is given.
    #[allow(clippy::too_many_arguments, reason = "the options of the command")]
    fn sweep(
        &self,
        py: Python<'_>,
        set: Vec<String>,
        resolution: usize,
        axes: Vec<(String, Vec<f64>)>,
        k: Option<f64>,
        near: Near,
        follow: bool,
        columns: Vec<String>,
        out: Option<PathBuf>,
        force: bool,
    ) -> PyResult<String> {
        let model = self.model.clone();
        watched(py, move |watch| {
            let setup = setup(model, &set, resolution)?;
            let sweep = swept(&setup, axes, k, row_mode(near, follow), &columns)?;
            let rows = match out {
                Some(path) => {
                    let overwrite = Overwrite::forced(force);
                    table::sweep_into(&path, &sweep, overwrite, watch, |_| {})?
                }
                None => sweep.run(watch),
            };
            Ok(rows.iter().map(row).collect::<Value>().to_string())
        })
    }

    /// Refuses to replace a file that is no table of this sweep, before anything is computed.
    #[allow(clippy::too_many_arguments, reason = "the options of the command")]
    fn check_table(
        &self,
        py: Python<'_>,
        set: Vec<String>,
        resolution: usize,
        axes: Vec<(String, Vec<f64>)>,
        k: Option<f64>,
        near: Near,
        follow: bool,
        columns: Vec<String>,
        out: PathBuf,
        force: bool,
    ) -> PyResult<()> {
        let model = self.model.clone();
        watched(py, move |_| {
            let setup = setup(model, &set, resolution)?;
            let sweep = swept(&setup, axes, k, row_mode(near, follow), &columns)?;
            table::check(&out, &sweep.identity(), Overwrite::forced(force)).map(|_| ())
        })
    }

    /// One share of the same, into a file of its own.
    #[allow(clippy::too_many_arguments, reason = "the options of the command")]
    fn sweep_share(
        &self,
        py: Python<'_>,
        set: Vec<String>,
        resolution: usize,
        axes: Vec<(String, Vec<f64>)>,
        k: Option<f64>,
        near: Near,
        follow: bool,
        columns: Vec<String>,
        share: (usize, usize),
        out: PathBuf,
    ) -> PyResult<()> {
        let model = self.model.clone();
        watched(py, move |watch| {
            let setup = setup(model, &set, resolution)?;
            let share = Share::parse(&format!("{}/{}", share.0, share.1))?;
            let sweep = swept(&setup, axes, k, row_mode(near, follow), &columns)?;
            sweep.run_share(share, &out, Overwrite::Recognised, watch, |_| {})
        })
    }

    /// Puts the files of all shares together.
    #[staticmethod]
    #[pyo3(signature = (shards, out, force=false))]
    fn merge(py: Python<'_>, shards: Vec<PathBuf>, out: PathBuf, force: bool) -> PyResult<()> {
        watched(py, move |_| {
            table::write_merged(&out, &merge(&shards)?, Overwrite::forced(force))
        })
    }

    fn verify(
        &self,
        py: Python<'_>,
        set: Vec<String>,
        resolution: usize,
        k: f64,
        near: Near,
        order: usize,
    ) -> PyResult<String> {
        let model = self.model.clone();
        watched(py, move |_| {
            let setup = setup(model, &set, resolution)?;
            Ok(Certificate::compute(&setup, k, selection(near), order)?
                .json()
                .to_string())
        })
    }

    /// Fields over the plane: base, fundamental alone, through third order.
    #[allow(clippy::too_many_arguments, reason = "the options of the command")]
    fn pattern(
        &self,
        py: Python<'_>,
        set: Vec<String>,
        resolution: usize,
        k: f64,
        near: Near,
        amplitude: Option<f64>,
        points: (usize, usize),
        wavelengths: f64,
    ) -> PyResult<String> {
        let model = self.model.clone();
        watched(py, move |_| {
            let setup = setup(model, &set, resolution)?;
            check_wavenumber(k)?;
            let (columns, rows) = points;
            let window = Window {
                columns: columns.clamp(2, 4000),
                rows: rows.clamp(2, 4000),
                wavelengths,
            };
            let base = setup.base(None)?;
            let converged = Converged::new(&setup, &base, k, selection(near))?;
            let amplitude = match amplitude {
                Some(given) => given,
                None => {
                    let missing =
                        |reason| Error::computation(format!("{reason}; give an amplitude"));
                    converged.amplitude().map_err(missing)?.value
                }
            };
            let found = pattern(&converged.point, amplitude, window, &[])?;
            let fields = found.fields.iter().map(|field| {
                let value = json!({
                    "base": field.base,
                    "linear": field.linear,
                    "nonlinear": field.nonlinear,
                });
                json!([field.name, value])
            });
            let object = json!({
                "parameters": base.parameters.json(base.structure()),
                "k": k,
                "amplitude": amplitude,
                "x": found.x,
                "y": found.y,
                "fields": fields.collect::<Vec<_>>(),
            });
            Ok(object.to_string())
        })
    }
}
