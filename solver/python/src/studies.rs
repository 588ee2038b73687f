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
use landau_solver::study::{Axis, Setup, Silent};
use landau_solver::wavevector::WaveVector;
use landau_solver::weakly::{Selection, Window, pattern};
use landau_solver::words;
use pyo3::prelude::*;
use serde_json::{Value, json};
use std::path::PathBuf;
use std::sync::Arc;

/// Re and Im of an eigenvalue that a mode is near to.
type Near = Option<(f64, f64)>;

fn setup(model: Arc<dyn Model>, set: &[String], resolution: usize) -> Result<Setup> {
    let mut setup = Setup::new(model, resolution)?;
    setup.set(set)?;
    Ok(setup)
}

fn selection(near: Near) -> Selection<'static> {
    near.map_or(Selection::Leading, |(re, im)| {
        Selection::Near(C64::new(re, im))
    })
}

/// What is swept: the items of a dictionary, which a task of a cluster gets as a whole.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Assignment {
    set: Vec<String>,
    resolution: usize,
    /// Names and values; the first varies fastest.
    axes: Vec<(String, Vec<f64>)>,
    k: Option<f64>,
    near: Near,
    follow: bool,
    columns: Vec<String>,
}

impl Assignment {
    fn setup(&self, model: Arc<dyn Model>) -> Result<Setup> {
        setup(model, &self.set, self.resolution)
    }

    fn sweep<'s>(&self, setup: &'s Setup) -> Result<Sweep<'s>> {
        let model = setup.model.as_ref();
        let range = |(name, values): &(String, Vec<f64>)| {
            Ok(Range {
                name: name.clone(),
                axis: Axis::named(model, name)?,
                values: values.clone(),
            })
        };
        let ranges = self.axes.iter().map(range).collect::<Result<_>>()?;
        let columns = self.columns.iter().map(|text| column(model, text));
        let columns = columns.collect::<Result<_>>()?;
        Sweep::new(setup, ranges, self.k, self.mode(), columns)
    }

    /// The mode that rows hold: `near` names one, `follow` keeps to it along the first axis.
    fn mode(&self) -> RowMode {
        match self.near.map(|(re, im)| C64::new(re, im)) {
            near if self.follow => RowMode::Followed(near),
            Some(target) => RowMode::Nearest(target),
            None => RowMode::Leading,
        }
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

fn modes(modes: &Modes) -> Value {
    let numbers =
        |values: &[C64]| -> Vec<Value> { values.iter().map(|v| words::complex(*v)).collect() };
    let profiles = modes.profiles.iter().map(|profile| {
        let parts = profile.parts.iter().zip(&profile.values);
        let parts: Vec<(&String, Vec<Value>)> = parts.map(|(p, v)| (p, numbers(v))).collect();
        json!([profile.name, parts])
    });
    json!({
        "parameters": modes.parameters,
        "k": modes.k,
        "y": modes.heights,
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
            let report = BaseReport::compute(&setup(model, &set, resolution)?, points)?;
            Ok(report.json().to_string())
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
            let report = SpectrumReport::compute(&setup(model, &set, resolution)?, k)?;
            Ok(with_text(report.json(), &report))
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
            let report = PointReport::compute(&setup, k, selection(near), order)?;
            Ok(with_text(report.json(), &report))
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
            let report = AmplitudesReport::compute(&setup, &choices, order, &Silent)?;
            Ok(with_text(report.json(), &report))
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
            let report = CriticalReport::compute(&setup, &question, watch)?;
            let points = report.found.iter().map(|point| report.json(point));
            Ok(points.collect::<Value>().to_string())
        })
    }

    /// Rows over the product of axes, the first varying fastest; into a CSV file with a journal where `out` is given.
    fn sweep(
        &self,
        py: Python<'_>,
        assignment: Assignment,
        out: Option<PathBuf>,
        force: bool,
    ) -> PyResult<String> {
        let model = self.model.clone();
        watched(py, move |watch| {
            let setup = assignment.setup(model)?;
            let sweep = assignment.sweep(&setup)?;
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
    fn check_table(
        &self,
        py: Python<'_>,
        assignment: Assignment,
        out: PathBuf,
        force: bool,
    ) -> PyResult<()> {
        let model = self.model.clone();
        watched(py, move |_| {
            let setup = assignment.setup(model)?;
            let identity = assignment.sweep(&setup)?.identity();
            table::check(&out, &identity, Overwrite::forced(force)).map(|_| ())
        })
    }

    /// One share of the same, into a file of its own.
    fn sweep_share(
        &self,
        py: Python<'_>,
        assignment: Assignment,
        share: (usize, usize),
        out: PathBuf,
    ) -> PyResult<()> {
        let model = self.model.clone();
        watched(py, move |watch| {
            let setup = assignment.setup(model)?;
            let share = Share::parse(&format!("{}/{}", share.0, share.1))?;
            let sweep = assignment.sweep(&setup)?;
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
            WaveVector::wave(k)?;
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
            let plane = pattern(&converged.point, amplitude, window, &[])?;
            let fields = plane.fields.iter().map(|field| {
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
                "x": plane.x,
                "y": plane.y,
                "fields": fields.collect::<Vec<_>>(),
            });
            Ok(object.to_string())
        })
    }
}
