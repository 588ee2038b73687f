//! The base state: in closed form, or by Newton's method on the emitted residual.

mod adjust;
mod check;
mod collocated;
mod continuation;
mod state;

pub use adjust::automatic_conditions;
pub use state::BaseState;

use crate::error::{Error, Result};
use crate::model::Model;
use crate::parameters::Parameters;
use crate::space::Matrices;
use check::spec_line;
use collocated::Trouble;
use std::cell::Cell;
use std::sync::Arc;

/// Degrees tried until the Chebyshev coefficients have died out.
const DEGREES: [usize; 7] = [36, 54, 80, 120, 180, 270, 400];
/// How good a state has to be.
#[derive(Clone, Copy)]
struct Accuracy {
    /// Size of the last coefficients relative to the largest at which a profile is resolved.
    tail: f64,
    /// Relative change at which an automatic parameter is settled.
    change: f64,
}

const FULL: Accuracy = Accuracy {
    tail: 1e-13,
    change: 1e-11,
};
/// For states that are only on the way to another.
const ROUGH: Accuracy = Accuracy {
    tail: 1e-7,
    change: 1e-3,
};
/// Beyond this fraction at the highest degree the profile counts as unresolved.
const UNRESOLVED: f64 = 1e-9;
/// Degree at which an unresolved profile is looked at for a layer.
const STRETCHED_FROM: usize = 120;
/// Consecutive degrees at which the iteration may fail.
const MOST_FAILURES: usize = 2;

/// What one base state is worth, in cubes of unknowns: some twenty seconds of one core.
const WORTH: f64 = 3e11;

/// A model, and what may still be spent on its base state: an answer that cannot be had should not take minutes.
struct Effort {
    model: Arc<dyn Model>,
    matrices: Arc<Matrices>,
    left: Cell<f64>,
}

impl Effort {
    fn new(model: &Arc<dyn Model>, matrices: &Arc<Matrices>) -> Self {
        Effort {
            model: model.clone(),
            matrices: matrices.clone(),
            left: Cell::new(WORTH),
        }
    }

    /// A solution of a system, or its assembly: either counts as the cube of its unknowns.
    fn spend(&self, size: usize) -> std::result::Result<(), Trouble> {
        let left = self.left.get() - (size as f64).powi(3);
        self.left.set(left);
        if left < 0.0 {
            return Err(Trouble::Spent);
        }
        Ok(())
    }
}

/// The base state at the given parameters, those set to `auto` determined on the way; from a neighbouring state where
/// there is one.
///
/// # Errors
/// Says which computation failed and where, and what to try.
pub fn solve(
    model: &Arc<dyn Model>,
    parameters: &Parameters,
    matrices: &Arc<Matrices>,
    near: Option<&BaseState>,
) -> Result<BaseState> {
    let effort = Effort::new(model, matrices);
    let solved = if parameters.automatic.contains(&true) {
        adjust::determine(&effort, parameters, near)
    } else {
        fixed(&effort, parameters, near, FULL)
    };
    // Spent on the way, it says nothing about the place where it ran out.
    if solved.is_err() && effort.left.get() < 0.0 {
        let place = "for want of work allowed to it";
        return Err(describe(model.as_ref(), parameters, &Trouble::Spent, place));
    }
    solved
}

/// The state where every parameter has a value.
fn fixed(
    effort: &Effort,
    parameters: &Parameters,
    near: Option<&BaseState>,
    accuracy: Accuracy,
) -> Result<BaseState> {
    let model = &effort.model;
    let structure = model.structure();
    let space = state::space(model.as_ref(), parameters, &effort.matrices)?;
    if structure.base.solved.is_empty() {
        return BaseState::closed(model, parameters, space).checked();
    }
    let start = near.filter(|state| state.case == parameters.case(structure));
    let state = match refine(effort, parameters, start, accuracy.tail) {
        Ok(state) => state,
        Err(_) => {
            let rough = continuation::to(effort, parameters, start)?;
            let refined = refine(effort, parameters, Some(&rough), accuracy.tail);
            let place = "at the end of the continuation";
            refined.map_err(|trouble| describe(model.as_ref(), parameters, &trouble, place))?
        }
    };
    let tail = state.tail();
    if tail > UNRESOLVED.max(accuracy.tail) {
        let spec = spec_line(model.as_ref(), structure.lines.base);
        return Err(Error::computation(format!(
            "{spec}: the base state is not resolved with {} Chebyshev polynomials (relative tail {tail:.1e}); \
             try a smaller interval or milder parameters",
            state.degree
        )));
    }
    state.check_ranges(tail)?;
    state.checked()
}

/// The state at rising degree until its coefficients have died out.
fn refine(
    effort: &Effort,
    parameters: &Parameters,
    start: Option<&BaseState>,
    resolved: f64,
) -> std::result::Result<BaseState, Trouble> {
    let model = effort.model.as_ref();
    let Ok(plain) = state::space(model, parameters, &effort.matrices) else {
        return Err(Trouble::Newton(crate::numerics::Failure::Start));
    };
    // Without a cross-stream coordinate a profile is a number.
    let degrees: &[usize] = if plain.is_point() { &[0] } else { &DEGREES };
    let mut previous = start.cloned();
    let (mut best, mut last, mut failures) = (None, None, 0);
    // A layer that is followed may ask for less than the state before did.
    let first = start.map_or(0, |s| {
        let same = degrees.iter().position(|&d| d >= s.degree).unwrap_or(0);
        same.saturating_sub(usize::from(s.degree > STRETCHED_FROM))
    });
    // The layer of the state before, where it was hard to resolve.
    let mut space = match start {
        Some(state) if state.degree >= STRETCHED_FROM => plain.like(&state.widened()),
        _ => plain.clone(),
    };
    for &degree in &degrees[first.min(degrees.len() - 1)..] {
        match collocated::solve(effort, parameters, previous.as_ref(), degree, space.clone()) {
            Ok(state) => {
                let is_resolved = state.tail() < resolved;
                // Rounding sets a floor to the tail; beyond it more polynomials do not help.
                let stalled = best
                    .as_ref()
                    .is_some_and(|b: &BaseState| b.tail() < 1e-10 && state.tail() > 0.3 * b.tail());
                if stalled {
                    break;
                }
                if !is_resolved && degree >= STRETCHED_FROM {
                    space = state.widened();
                }
                previous = Some(state.clone());
                best = Some(state);
                if is_resolved {
                    break;
                }
            }
            Err(trouble) => {
                last = Some(trouble);
                failures += 1;
                if failures == MOST_FAILURES {
                    break;
                }
            }
        }
    }
    best.ok_or_else(|| last.unwrap_or(Trouble::Newton(crate::numerics::Failure::Start)))
}

impl BaseState {
    /// The same state at the next degree, which truncates and rounds differently; nothing for a closed form,
    /// or where the degree cannot rise.
    pub fn refined(&self) -> Option<BaseState> {
        let next = DEGREES.iter().find(|&&degree| degree > self.degree)?;
        let solved = !self.series.is_empty() && !self.space.is_point();
        let effort = Effort::new(&self.model, self.space.matrices());
        let degree = solved.then_some(*next)?;
        let space = self.space.clone();
        collocated::solve(&effort, &self.parameters, Some(self), degree, space).ok()
    }

    /// The state at parameters next to its own, none of them automatic, at the same degree where that will do.
    ///
    /// # Errors
    /// As [`solve`].
    pub fn moved(&self, parameters: &Parameters) -> Result<BaseState> {
        let effort = Effort::new(&self.model, self.space.matrices());
        let own = !self.series.is_empty() && self.case == parameters.case(self.structure());
        if own {
            let plain = state::space(self.model.as_ref(), parameters, &effort.matrices)?;
            let space = plain.like(&self.space);
            let degree = self.degree;
            let near = collocated::solve(&effort, parameters, Some(self), degree, space);
            if let Ok(state) = near {
                return Ok(state);
            }
        }
        fixed(&effort, parameters, Some(self), FULL)
    }
}

/// What to say of a state that was not found.
fn describe(model: &dyn Model, parameters: &Parameters, trouble: &Trouble, place: &str) -> Error {
    let structure = model.structure();
    let values: Vec<String> = structure
        .parameters
        .pairs()
        .map(|(id, info)| {
            let (name, value) = (&info.name, parameters.shown(structure, id));
            if parameters.automatic[id] {
                let start = parameters.values[id];
                format!("{name} = {value} (tried from {start})")
            } else {
                format!("{name} = {value}")
            }
        })
        .collect();
    Error::BaseState {
        spec: spec_line(model, structure.lines.base),
        trouble: format!("{place} ({trouble})"),
        parameters: values.join(", "),
    }
}
