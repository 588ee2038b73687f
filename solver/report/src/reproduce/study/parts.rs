//! What tasks of every kind have.

use super::{Axis, Case, Task, named};

/// Every case at every M.
pub fn at_each(cases: &[Case], resolutions: &[usize]) -> Vec<Case> {
    let at = |case: &Case, resolution: usize| Case {
        label: named(case, &format!("M = {resolution}")),
        resolution: Some(resolution),
        ..case.clone()
    };
    let each = |case| resolutions.iter().map(move |&m| at(case, m));
    cases.iter().flat_map(each).collect()
}

impl Task {
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
        match self {
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
    }
}
