//! The kinds of tasks, each with its keys.

use super::check::{Checked, Spot};
use super::task::{Asked, Mark, PanelOf, Reference, Tail, Together};
use super::{Axis, Case, Statement};
use serde::{Deserialize, Deserializer, Serialize};
use std::collections::BTreeMap;

/// What a study says of a task of any kind, before any model is asked.
pub(in crate::reproduce) trait Kind {
    /// The word by which a file asks for it.
    fn name(&self) -> &'static str;
    /// Its cases.
    fn cases(&self) -> &[Case];
    /// Its cases, to be labelled.
    fn cases_mut(&mut self) -> &mut Vec<Case>;
    /// Points of others that it shows, in files relative to the study.
    fn references(&self) -> &[Reference] {
        &[]
    }
    /// Refuses what cannot be meant.
    fn check(&self, spot: &Spot) -> Checked;
}

/// What is computed for a figure.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Task {
    Profiles(Profiles),
    Law(Law),
    Convergence(Convergence),
    Spectrum(Spectrum),
    Sweep(Sweep),
    Resonance(Resonance),
    Orders(Orders),
    SecondHarmonic(SecondHarmonic),
    Critical(Critical),
    Claims(Claims),
    Values(Values),
    PowerLaw(PowerLaw),
    Pattern(Pattern),
    Circulation(Circulation),
}

/// The same for the task of any kind.
macro_rules! of_any_kind {
    ($task:expr, $kind:ident => $value:expr) => {
        match $task {
            $crate::reproduce::study::Task::Profiles($kind) => $value,
            $crate::reproduce::study::Task::Law($kind) => $value,
            $crate::reproduce::study::Task::Convergence($kind) => $value,
            $crate::reproduce::study::Task::Spectrum($kind) => $value,
            $crate::reproduce::study::Task::Sweep($kind) => $value,
            $crate::reproduce::study::Task::Resonance($kind) => $value,
            $crate::reproduce::study::Task::Orders($kind) => $value,
            $crate::reproduce::study::Task::SecondHarmonic($kind) => $value,
            $crate::reproduce::study::Task::Critical($kind) => $value,
            $crate::reproduce::study::Task::Claims($kind) => $value,
            $crate::reproduce::study::Task::Values($kind) => $value,
            $crate::reproduce::study::Task::PowerLaw($kind) => $value,
            $crate::reproduce::study::Task::Pattern($kind) => $value,
            $crate::reproduce::study::Task::Circulation($kind) => $value,
        }
    };
}
pub(in crate::reproduce) use of_any_kind;

impl Task {
    /// The words by which a file asks for tasks.
    pub(super) const KINDS: [&str; 14] = [
        "profiles",
        "law",
        "convergence",
        "spectrum",
        "sweep",
        "resonance",
        "orders",
        "second_harmonic",
        "critical",
        "claims",
        "values",
        "power_law",
        "pattern",
        "circulation",
    ];

    /// The task of a kind, without the key `kind`; nothing where there is no such kind.
    pub(super) fn read<'d, D: Deserializer<'d>>(
        kind: &str,
        keys: D,
    ) -> Option<Result<Self, D::Error>> {
        Some(match kind {
            "profiles" => Profiles::deserialize(keys).map(Task::Profiles),
            "law" => Law::deserialize(keys).map(Task::Law),
            "convergence" => Convergence::deserialize(keys).map(Task::Convergence),
            "spectrum" => Spectrum::deserialize(keys).map(Task::Spectrum),
            "sweep" => Sweep::deserialize(keys).map(Task::Sweep),
            "resonance" => Resonance::deserialize(keys).map(Task::Resonance),
            "orders" => Orders::deserialize(keys).map(Task::Orders),
            "second_harmonic" => SecondHarmonic::deserialize(keys).map(Task::SecondHarmonic),
            "critical" => Critical::deserialize(keys).map(Task::Critical),
            "claims" => Claims::deserialize(keys).map(Task::Claims),
            "values" => Values::deserialize(keys).map(Task::Values),
            "power_law" => PowerLaw::deserialize(keys).map(Task::PowerLaw),
            "pattern" => Pattern::deserialize(keys).map(Task::Pattern),
            "circulation" => Circulation::deserialize(keys).map(Task::Circulation),
            _ => return None,
        })
    }

    /// What the study says of it.
    pub(in crate::reproduce) fn kind(&self) -> &dyn Kind {
        of_any_kind!(self, kind => kind)
    }

    /// Cases of one label are told apart by their position: numbers are told from one another by the label.
    pub fn label_apart(&mut self) {
        let cases = of_any_kind!(self, kind => kind.cases_mut());
        for index in 1..cases.len() {
            let (earlier, later) = cases.split_at_mut(index);
            let taken = |label: &str| earlier.iter().any(|case| case.label == label);
            let case = &mut later[0];
            if taken(&case.label) {
                let words = if case.label.is_empty() {
                    "case".to_owned()
                } else {
                    case.label.clone()
                };
                let mut number = index + 1;
                while taken(&format!("{words} {number}")) {
                    number += 1;
                }
                case.label = format!("{words} {number}");
            }
        }
    }
}

/// Every case at every M.
pub fn at_each(cases: &[Case], resolutions: &[usize]) -> Vec<Case> {
    let at = |case: &Case, resolution: usize| Case {
        resolution: Some(resolution),
        ..case.moved(&format!("M = {resolution}"))
    };
    let each = |case| resolutions.iter().map(move |&m| at(case, m));
    cases.iter().flat_map(each).collect()
}

/// Fields of the base state, or expressions in it, over the cross-stream coordinate.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Profiles {
    pub case: Vec<Case>,
    pub fields: Vec<String>,
    #[serde(default)]
    pub logarithmic: bool,
    /// Of the first field.
    pub tail: Option<Tail>,
    #[serde(default)]
    pub panel: PanelOf,
    #[serde(default)]
    pub mark: Vec<Mark>,
}

/// Expressions in the state over the value of one field, the others held.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Law {
    pub case: Vec<Case>,
    pub expressions: Vec<String>,
    pub over: Axis,
    #[serde(default)]
    pub at: BTreeMap<String, f64>,
}

/// a0 and a2 over k at several M, and how far each is from the finest.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Convergence {
    pub case: Vec<Case>,
    pub over: Axis,
    /// The last is what the others are compared with.
    pub resolutions: Vec<usize>,
}

/// Leading eigenvalue of L and of L† over k, at several resolutions.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Spectrum {
    pub case: Vec<Case>,
    pub over: Axis,
    pub resolutions: Vec<usize>,
}

/// Landau coefficients along an axis, one curve a case.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Sweep {
    pub case: Vec<Case>,
    pub over: Axis,
    pub columns: Vec<Together>,
    /// Critical points of the first case, drawn as verticals; an amplitude ends on them.
    #[serde(default)]
    pub mark: Vec<Asked>,
    /// Whether one mode is followed by its shape along the axis; otherwise a row holds the leading mode.
    #[serde(default)]
    pub follow: bool,
    /// Whether each axis is.
    #[serde(default)]
    pub logarithmic: [bool; 2],
    /// What others have, drawn as points.
    #[serde(default)]
    pub reference: Vec<Reference>,
}

/// a0(k) beside a0(2k)/2: they meet at the 2:1 resonance.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Resonance {
    pub case: Vec<Case>,
    pub over: Axis,
    /// As of a sweep.
    #[serde(default)]
    pub mark: Vec<Asked>,
}

/// A_e over k at every order and of the Padé approximant.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Orders {
    pub case: Vec<Case>,
    pub over: Axis,
    /// An odd number from 5 on.
    pub highest: usize,
    /// Wavenumber and amplitude of states that were found without an expansion.
    #[serde(default)]
    pub reference: Vec<[f64; 2]>,
}

/// A mode at k with the one at 2k: coefficients and equilibria of the pair.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct SecondHarmonic {
    pub case: Vec<Case>,
    pub over: Axis,
}

/// Critical points, one row a case; a curve where `against` is a parameter of the cases.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Critical {
    pub case: Vec<Case>,
    pub asked: Vec<Asked>,
    pub against: Option<Axis>,
}

/// Statements of the source, decided by numbers.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Claims {
    pub case: Vec<Case>,
    pub claim: Vec<Statement>,
}

/// a0, a2, A_e and derived columns at single places.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Values {
    pub case: Vec<Case>,
    #[serde(default)]
    pub columns: Vec<String>,
}

/// A_e against the distance from a critical point, and the fitted exponent.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct PowerLaw {
    pub case: Vec<Case>,
    pub critical: Asked,
    /// Relative distances, from and to; the sign is the side.
    pub distances: [f64; 2],
    pub count: usize,
}

/// Fields over the plane.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Pattern {
    pub case: Vec<Case>,
    pub shade: String,
    pub arrows: Option<[String; 2]>,
    #[serde(default = "two")]
    pub wavelengths: f64,
}

/// ∮ u·dl around the vortex centre, and where the centre lies.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Circulation {
    pub case: Vec<Case>,
    pub over: Axis,
    pub k: f64,
    pub arrows: [String; 2],
    /// Side of the square in wavelengths.
    pub side: f64,
    /// The field whose maximum is located.
    pub shade: String,
}

fn two() -> f64 {
    2.0
}
