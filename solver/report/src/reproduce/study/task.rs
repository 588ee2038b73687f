//! What a figure asks for.

use super::statement::Statement;
use super::{Axis, Case};
use landau_solver::study::row::Column;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

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
        /// Whether one mode is followed by its shape along the axis; otherwise a row holds the leading mode.
        #[serde(default)]
        follow: bool,
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
