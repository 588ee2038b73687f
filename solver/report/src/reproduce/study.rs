//! A study file: which models, parameters and sweeps make which figure, and what was printed.

use landau_solver::error::{Error, Result};
use landau_solver::study::row::Column;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

/// The whole file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Study {
    pub title: String,
    /// What is reproduced: a citation.
    pub source: String,
    /// A built model, or a path relative to the study file.
    pub model: String,
    #[serde(default = "fifty")]
    pub resolution: usize,
    #[serde(default)]
    pub introduction: String,
    /// A file of printed formulas to compare with the derivation, relative to the study file.
    pub errata: Option<String>,
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
    pub printed: BTreeMap<String, f64>,
    /// An honest sentence beside the numbers of this case.
    #[serde(default)]
    pub note: String,
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
    /// Fields of the base state over the cross-stream coordinate.
    Profiles {
        case: Vec<Case>,
        fields: Vec<String>,
        #[serde(default)]
        logarithmic: bool,
        /// Fit exp(−y/h) to the first field between these fractions of the interval.
        tail: Option<[f64; 2]>,
        /// h by the model: this field at the upper end times this parameter.
        scale_height: Option<[String; 2]>,
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
        columns: Vec<Column>,
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
        let steps = self.count.max(2) - 1;
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
        toml::from_str(&text).map_err(|e| Error::input(format!("{}: {e}", path.display())))
    }
}
