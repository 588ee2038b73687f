//! A study file: which models, parameters and sweeps make which figure, and what was printed.

mod axis;
mod parts;
mod place;
mod printed;

pub use axis::{Axis, Spacing};
pub use parts::at_each;
pub use printed::Printed;

use landau_solver::error::{Error, Result};
use landau_solver::file::{TEXT_LIMIT, read_text};
use landau_solver::study::row::Column;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::ops::Range;
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
    /// The file itself and what it names, by name and text.
    #[serde(skip)]
    pub files: Vec<(String, String)>,
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

/// What decides a statement.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Where the critical point lies.
    Place,
    /// Where A_e is largest over an axis.
    LargestAmplitude,
    /// Where a0 is largest over an axis.
    LargestGrowth,
    /// A derived column: an output, or an expression in the base state.
    Column,
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
    /// What a largest value is looked for over.
    pub over: Option<Axis>,
    pub above: Option<f64>,
    pub below: Option<f64>,
    /// Within this part of the first case's value.
    pub as_first_within: Option<f64>,
    /// Farther than this part of the first case's value from it.
    pub apart_from_first: Option<f64>,
    /// What a column holds, as `sweep --column` takes it.
    pub column: Option<String>,
    /// From each case to the next.
    pub trend: Option<Trend>,
}

/// Which way numbers go from case to case.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Trend {
    Rising,
    Falling,
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
        #[serde(default)]
        panel: PanelOf,
        #[serde(default)]
        mark: Vec<Mark>,
    },
    /// Expressions in the state over the value of one field, the others held.
    Law {
        case: Vec<Case>,
        expressions: Vec<String>,
        over: Axis,
        #[serde(default)]
        at: BTreeMap<String, f64>,
    },
    /// a0 and a2 over k at several M, and how far each is from the finest.
    Convergence {
        case: Vec<Case>,
        over: Axis,
        /// The last is what the others are compared with.
        resolutions: Vec<usize>,
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
        columns: Vec<Together>,
        /// Critical points of the first case, drawn as verticals; an amplitude ends on them.
        #[serde(default)]
        mark: Vec<Asked>,
        /// Whether each axis is.
        #[serde(default)]
        logarithmic: [bool; 2],
        /// What others have, drawn as points.
        #[serde(default)]
        reference: Vec<Reference>,
    },
    /// a0(k) beside a0(2k)/2: they meet at the 2:1 resonance.
    Resonance {
        case: Vec<Case>,
        over: Axis,
        /// As of a sweep.
        #[serde(default)]
        mark: Vec<Asked>,
    },
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
    /// a0, a2, A_e and derived columns at single places.
    Values {
        case: Vec<Case>,
        #[serde(default)]
        columns: Vec<String>,
    },
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

impl Study {
    /// Reads a study file.
    ///
    /// # Errors
    /// A file that is missing, or says what a study file does not (with line and column).
    pub fn read(path: &Path) -> Result<Self> {
        let text = read_text(path, TEXT_LIMIT)?;
        let wrong = |what: String| Error::input(format!("{}: {what}", path.display()));
        let mut study: Study =
            toml::from_str(&text).map_err(|e| wrong(place::refined(&text, &e)))?;
        study.check(&text).map_err(wrong)?;
        let name = |path: &Path| {
            path.file_name()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned()
        };
        study.files.push((name(path), text));
        if let Some(errata) = &study.errata {
            let beside = path.parent().unwrap_or(Path::new("")).join(errata);
            if let Ok(text) = read_text(&beside, TEXT_LIMIT) {
                study.files.push((name(&beside), text));
            }
        }
        Ok(study)
    }

    /// What is well written but cannot be meant, with its place.
    fn check(&self, text: &str) -> std::result::Result<(), String> {
        let pointed = |place: Option<Range<usize>>, message: String| match place {
            Some(place) => Err(place::pointed(text, place, &message)),
            None => Err(message),
        };
        let mut known: Vec<&str> = Vec::new();
        for figure in &self.figure {
            let id = format!("id = \"{}\"", figure.id);
            if known.contains(&figure.id.as_str()) {
                let message = format!(
                    "two figures have the id `{}`: the files of one would replace those of the other",
                    figure.id
                );
                return pointed(place::occurrence(text, &id, 2), message);
            }
            known.push(&figure.id);
            let start = place::occurrence(text, &id, 1).map_or(0, |place| place.start);
            let end = text[start..]
                .find("[[figure]]")
                .map_or(text.len(), |at| start + at);
            for axis in figure.task.iter().filter_map(Task::axis) {
                let count = format!("count = {}", axis.count);
                let place = place::occurrence(&text[start..end], &count, 1);
                let place = place.map(|place| start + place.start..start + place.end);
                if axis.spacing == Spacing::Geometric && (axis.from <= 0.0 || axis.to <= 0.0) {
                    let message = format!(
                        "figure {}: `{}` by equal factors accepts numbers above zero",
                        figure.id, axis.name
                    );
                    return pointed(place, message);
                }
                if axis.count < 2 {
                    let message = format!(
                        "figure {}: count = {} along `{}`: it accepts whole numbers from 2 on",
                        figure.id, axis.count, axis.name
                    );
                    return pointed(place, message);
                }
            }
        }
        Ok(())
    }
}
