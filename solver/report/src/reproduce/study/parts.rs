//! What tasks of every kind have.

use super::{Axis, Case, Reference, Task};

/// The cases of a task of any kind.
macro_rules! cases_of {
    ($task:expr) => {
        match $task {
            Task::Profiles { case, .. }
            | Task::Spectrum { case, .. }
            | Task::Law { case, .. }
            | Task::Convergence { case, .. }
            | Task::Sweep { case, .. }
            | Task::Resonance { case, .. }
            | Task::Orders { case, .. }
            | Task::SecondHarmonic { case, .. }
            | Task::Critical { case, .. }
            | Task::Claims { case, .. }
            | Task::Values { case, .. }
            | Task::PowerLaw { case, .. }
            | Task::Pattern { case, .. }
            | Task::Circulation { case, .. } => case,
        }
    };
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

impl Task {
    /// The word by which a file asks for it.
    pub fn kind(&self) -> &'static str {
        match self {
            Task::Profiles { .. } => "profiles",
            Task::Law { .. } => "law",
            Task::Convergence { .. } => "convergence",
            Task::Spectrum { .. } => "spectrum",
            Task::Sweep { .. } => "sweep",
            Task::Resonance { .. } => "resonance",
            Task::Orders { .. } => "orders",
            Task::SecondHarmonic { .. } => "second_harmonic",
            Task::Critical { .. } => "critical",
            Task::Claims { .. } => "claims",
            Task::Values { .. } => "values",
            Task::PowerLaw { .. } => "power_law",
            Task::Pattern { .. } => "pattern",
            Task::Circulation { .. } => "circulation",
        }
    }

    /// Files of references that it reads, relative to the study.
    pub fn references(&self) -> impl Iterator<Item = &str> {
        let list: &[Reference] = match self {
            Task::Sweep { reference, .. } => reference,
            _ => &[],
        };
        list.iter().map(|reference| reference.file.as_str())
    }

    /// What varies, where something does.
    pub fn axis(&self) -> Option<&Axis> {
        match self {
            Task::Spectrum { over, .. }
            | Task::Sweep { over, .. }
            | Task::Resonance { over, .. }
            | Task::Orders { over, .. }
            | Task::SecondHarmonic { over, .. }
            | Task::Convergence { over, .. }
            | Task::Law { over, .. }
            | Task::Circulation { over, .. } => Some(over),
            Task::Critical { against, .. } => against.as_ref(),
            Task::Profiles { .. }
            | Task::Claims { .. }
            | Task::Values { .. }
            | Task::PowerLaw { .. }
            | Task::Pattern { .. } => None,
        }
    }

    /// Its cases.
    pub fn cases(&self) -> &[Case] {
        cases_of!(self)
    }

    /// Cases of one label are told apart by their position: numbers are found by the label.
    pub fn label_apart(&mut self) {
        let cases: &mut Vec<Case> = cases_of!(self);
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
