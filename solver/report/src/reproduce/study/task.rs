//! What tasks ask for.

use landau_solver::study::row::Column;
use serde::{Deserialize, Serialize};

/// What a sweep draws.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq, Eq)]
#[serde(untagged)]
pub enum Drawn {
    /// A quantity of every Landau point.
    Point(Column),
    /// An output of the model, or an expression with its place.
    Derived(String),
}

impl Drawn {
    /// The text of a derived column.
    pub fn derived(&self) -> Option<String> {
        match self {
            Drawn::Point(_) => None,
            Drawn::Derived(text) => Some(text.clone()),
        }
    }
}

/// Columns of one panel: one, or several that share their axes.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(untagged)]
pub enum Together {
    One(Drawn),
    Several(Vec<Drawn>),
}

impl Together {
    pub fn drawn(&self) -> &[Drawn] {
        match self {
            Together::One(drawn) => std::slice::from_ref(drawn),
            Together::Several(drawn) => drawn,
        }
    }
}

/// What has a panel of its own.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum PanelOf {
    /// A field: one curve a case.
    #[default]
    Field,
    /// A case: one curve a field.
    Case,
}

/// A curve of somebody else's.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Reference {
    /// A CSV of two columns of numbers, with a header, relative to the study file.
    pub file: String,
    pub label: String,
    /// The panel that it belongs to, from 1.
    #[serde(default = "one")]
    pub panel: usize,
}

fn one() -> usize {
    1
}

/// A place along x with a name.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Mark {
    pub at: f64,
    pub name: String,
}

/// A fit of exp(−y/h) to a part of a profile.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Tail {
    /// Fractions of the interval.
    pub between: [f64; 2],
    /// What h ought to be, by an expression at the upper end.
    pub predicted: Option<String>,
}

/// What sort of critical point.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Of {
    Growth,
    C2,
    Resonance,
}

/// A critical point that is asked for.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Asked {
    pub name: String,
    pub vary: String,
    pub between: [f64; 2],
    #[serde(default = "growth")]
    pub of: Of,
    pub k: Option<f64>,
    /// Extremum over this range of k.
    pub minimize: Option<[f64; 2]>,
    /// Of one mode by its shape, that which grows fastest on the axis; of the leading mode otherwise.
    #[serde(default)]
    pub follow: bool,
}

fn growth() -> Of {
    Of::Growth
}
