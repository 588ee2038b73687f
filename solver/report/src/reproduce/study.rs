//! A study file: which models, parameters and sweeps make which figure, and what was printed.

use landau_solver::error::{Error, Result};
use landau_solver::study::row::Column;
use serde::{Deserialize, Deserializer, Serialize};
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
    /// M
    #[serde(default = "fifty")]
    pub resolution: usize,
    /// The first paragraph.
    #[serde(default)]
    pub introduction: String,
    /// A file of printed formulas to compare with the derivation, relative to the study file.
    pub errata: Option<String>,
    /// Its sections.
    pub figure: Vec<Figure>,
}

fn fifty() -> usize {
    50
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
    pub task: Vec<Task>,
}

/// One model at one set of parameters.
#[derive(Clone, Debug, Deserialize, Serialize)]
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
}

/// A printed number with its digits: in the file a number, or a text where the last digits are zeros.
#[derive(Clone, Debug, Serialize, PartialEq)]
pub struct Printed {
    pub value: f64,
    pub text: String,
}

impl Printed {
    /// The number that a text prints; NaN where it prints none.
    pub fn of(text: &str) -> Self {
        Printed {
            value: text.trim().parse().unwrap_or(f64::NAN),
            text: text.trim().to_owned(),
        }
    }

    /// One in the last printed place.
    pub fn last_digit(&self) -> f64 {
        let (mantissa, exponent) = self
            .text
            .split_once(['e', 'E'])
            .unwrap_or((&self.text, "0"));
        let decimals = mantissa.split_once('.').map_or(0, |(_, d)| d.len() as i32);
        10_f64.powi(exponent.parse::<i32>().unwrap_or(0) - decimals)
    }
}

impl<'d> Deserialize<'d> for Printed {
    fn deserialize<D: Deserializer<'d>>(input: D) -> std::result::Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged)]
        enum Written {
            Number(f64),
            Text(String),
            Kept { text: String },
        }
        let printed = match Written::deserialize(input)? {
            Written::Number(value) => Printed::of(&value.to_string()),
            Written::Text(text) | Written::Kept { text, .. } => Printed::of(&text),
        };
        match printed.value.is_finite() {
            true => Ok(printed),
            false => Err(serde::de::Error::custom(format!(
                "`{}` is no number; a printed value is a number, or a text with its digits such as \"0.1790\"",
                printed.text
            ))),
        }
    }
}

/// What decides a statement.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Where the critical point lies.
    Place,
    A0,
    A2,
    /// A_e
    Amplitude,
}

/// A statement of the source, and what decides it in each case.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Statement {
    pub says: String,
    /// What the number is called.
    pub name: String,
    pub quantity: Quantity,
    /// At a critical point; at the wavenumber of the case otherwise.
    pub at: Option<Asked>,
    pub above: Option<f64>,
    pub below: Option<f64>,
    /// Within this part of the first case's value.
    pub as_first_within: Option<f64>,
}

/// `label: quantity`
pub fn named(case: &Case, quantity: &str) -> String {
    if case.label.is_empty() {
        quantity.to_owned()
    } else {
        format!("{}: {quantity}", case.label)
    }
}

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
}

fn growth() -> Of {
    Of::Growth
}

/// What is computed for a figure.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Task {
    /// Fields of the base state, or expressions in it, over the cross-stream coordinate.
    Profiles {
        case: Vec<Case>,
        fields: Vec<String>,
        #[serde(default)]
        logarithmic: bool,
        /// Of the first field.
        tail: Option<Tail>,
    },
    /// Leading eigenvalue of L and of L† over k, at several resolutions.
    Spectrum {
        case: Vec<Case>,
        over: Axis,
        resolutions: Vec<usize>,
    },
    /// Landau coefficients along an axis, one curve a case.
    Sweep {
        case: Vec<Case>,
        over: Axis,
        columns: Vec<Drawn>,
    },
    /// a0(k) beside a0(2k)/2: they meet at the 2:1 resonance.
    Resonance { case: Vec<Case>, over: Axis },
    /// A_e over k at every order and of the Padé approximant.
    Orders {
        case: Vec<Case>,
        over: Axis,
        /// An odd number from 5 on.
        highest: usize,
        /// Wavenumber and amplitude of states that were found without an expansion.
        #[serde(default)]
        reference: Vec<[f64; 2]>,
    },
    /// A mode at k with the one at 2k: coefficients and equilibria of the pair.
    SecondHarmonic { case: Vec<Case>, over: Axis },
    /// Critical points, one row a case; a curve where `against` is a parameter of the cases.
    Critical {
        case: Vec<Case>,
        asked: Vec<Asked>,
        against: Option<Axis>,
    },
    /// Statements of the source, decided by numbers.
    Claims {
        case: Vec<Case>,
        claim: Vec<Statement>,
    },
    /// A_e at single places.
    Values { case: Vec<Case> },
    /// A_e against the distance from a critical point, and the fitted exponent.
    PowerLaw {
        case: Vec<Case>,
        critical: Asked,
        /// Relative distances, from and to; the sign is the side.
        distances: [f64; 2],
        count: usize,
    },
    /// Fields over the plane.
    Pattern {
        case: Vec<Case>,
        shade: String,
        arrows: Option<[String; 2]>,
        #[serde(default = "two")]
        wavelengths: f64,
    },
    /// ∮ u·dl around the vortex centre, and where the centre lies.
    Circulation {
        case: Vec<Case>,
        over: Axis,
        k: f64,
        arrows: [String; 2],
        /// Side of the square in wavelengths.
        side: f64,
        /// The field whose maximum is located.
        shade: String,
    },
}

impl Task {
    /// What varies, where something does.
    fn axis(&self) -> Option<&Axis> {
        match self {
            Task::Spectrum { over, .. }
            | Task::Sweep { over, .. }
            | Task::Resonance { over, .. }
            | Task::Orders { over, .. }
            | Task::SecondHarmonic { over, .. }
            | Task::Circulation { over, .. } => Some(over),
            Task::Critical { against, .. } => against.as_ref(),
            Task::Profiles { .. }
            | Task::Claims { .. }
            | Task::Values { .. }
            | Task::PowerLaw { .. }
            | Task::Pattern { .. } => None,
        }
    }
}

fn two() -> f64 {
    2.0
}

/// Evenly spaced values of k or of a parameter.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Axis {
    pub name: String,
    pub from: f64,
    pub to: f64,
    pub count: usize,
}

impl Axis {
    pub fn values(&self) -> Vec<f64> {
        let steps = self.count - 1;
        (0..=steps)
            .map(|i| self.from + (self.to - self.from) * i as f64 / steps as f64)
            .collect()
    }
}

impl Study {
    /// Reads a study file.
    ///
    /// # Errors
    /// A file that is missing, or says what a study file does not (with line and column).
    pub fn read(path: &Path) -> Result<Self> {
        let text = std::fs::read_to_string(path)
            .map_err(|e| Error::input(format!("{} cannot be read: {e}", path.display())))?;
        let study: Study =
            toml::from_str(&text).map_err(|e| Error::input(format!("{}: {e}", path.display())))?;
        study
            .check()
            .map_err(|e| Error::input(format!("{}: {e}", path.display())))?;
        Ok(study)
    }

    /// What is well written but cannot be meant.
    fn check(&self) -> Result<()> {
        let mut known: Vec<&str> = Vec::new();
        for figure in &self.figure {
            if known.contains(&figure.id.as_str()) {
                return Err(Error::input(format!(
                    "two figures have the id `{}`: the files of one would replace those of the other",
                    figure.id
                )));
            }
            known.push(&figure.id);
            for axis in figure.task.iter().filter_map(Task::axis) {
                if axis.count < 2 {
                    return Err(Error::input(format!(
                        "figure {}: count = {} along `{}`: it accepts whole numbers from 2 on",
                        figure.id, axis.count, axis.name
                    )));
                }
            }
        }
        Ok(())
    }
}
