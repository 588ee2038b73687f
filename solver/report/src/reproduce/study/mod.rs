//! A study file: which models, parameters and sweeps make which figure, and what was printed.

mod axis;
mod check;
pub(in crate::reproduce) mod kinds;
mod place;
mod printed;
mod read;
mod statement;
mod task;
mod words;

pub use axis::{Axis, Spacing};
pub use kinds::{Task, at_each};
pub use printed::Printed;
pub use statement::{Quantity, Statement, Threshold, Trend, percent};
pub use task::{Asked, Drawn, Of, PanelOf, Reference, Tail, Together};

pub(in crate::reproduce) use check::Spot;
pub(in crate::reproduce) use place::{Fault, fault_of};
pub(in crate::reproduce) use words::check as words_can_be_shown;

use landau_solver::error::{Error, Result};
use landau_solver::file::{TEXT_LIMIT, read_text};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

/// The whole file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Study {
    /// Of the report.
    pub title: String,
    /// What is reproduced: a citation.
    pub source: String,
    /// A built model, or a path relative to the study file.
    pub model: String,
    /// Whether it is worked through where none of several is named.
    #[serde(default)]
    pub default: bool,
    /// M
    #[serde(default = "fifty")]
    pub resolution: usize,
    /// The first paragraph.
    #[serde(default)]
    pub introduction: String,
    /// A file of printed formulas to compare with the derivation, relative to the study file.
    pub errata: Option<String>,
    /// How names are written in pictures and on the page.
    #[serde(default)]
    pub symbol: BTreeMap<String, Symbol>,
    /// Its sections.
    pub figure: Vec<Figure>,
    /// The text of the file, and where it was read from.
    #[serde(skip)]
    pub read_from: Source,
}

/// The file that a study was read from.
#[derive(Clone, Debug, Default)]
pub struct Source {
    /// As it was named.
    pub path: std::path::PathBuf,
    /// All of it.
    pub text: String,
}

fn fifty() -> usize {
    50
}

/// How a name is written.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Symbol {
    /// In pictures.
    pub text: String,
    /// On the page, in LaTeX.
    pub latex: String,
}

/// One section of the report.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Figure {
    pub id: String,
    pub title: String,
    /// What the source says, and where we differ.
    #[serde(default)]
    pub text: String,
    #[serde(skip_deserializing)]
    pub task: Vec<Task>,
}

/// One model at one set of parameters.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Case {
    #[serde(default)]
    pub label: String,
    pub model: Option<String>,
    #[serde(default)]
    pub set: Vec<String>,
    pub k: Option<f64>,
    pub resolution: Option<usize>,
    /// Printed values by the name of the quantity.
    #[serde(default)]
    pub printed: BTreeMap<String, Printed>,
    /// An honest sentence beside the numbers of this case.
    #[serde(default)]
    pub note: String,
    /// The label in the study, where the case is one of several places of it.
    #[serde(skip)]
    pub origin: Option<String>,
}

impl Case {
    /// The case at one place of several, labelled by it.
    pub fn moved(&self, place: &str) -> Self {
        Case {
            label: named(self, place),
            origin: Some(self.label.clone()),
            ..self.clone()
        }
    }
}

/// `label: quantity`
pub fn named(case: &Case, quantity: &str) -> String {
    if case.label.is_empty() {
        quantity.to_owned()
    } else {
        format!("{}: {quantity}", case.label)
    }
}

impl Study {
    /// Reads a study file and refuses what cannot be meant, before anything is computed.
    ///
    /// # Errors
    /// A file that is missing, or says what a study file does not (with line and column).
    pub fn read(path: &Path) -> Result<Self> {
        let text = read_text(path, TEXT_LIMIT)?;
        let wrong = |fault: Fault| Error::input(fault.pointed(path, &text));
        words::check(&text).map_err(wrong)?;
        let mut study = read::study(&text).map_err(wrong)?;
        check::check(&study).map_err(|mistake| wrong(mistake.fault(&text)))?;
        let tasks = study.figure.iter_mut().flat_map(|figure| &mut figure.task);
        tasks.for_each(Task::label_apart);
        study.read_from = Source {
            path: path.to_owned(),
            text,
        };
        Ok(study)
    }
}
