//! The base state: in closed form, or by Newton's method on the residual that the model's kernels compute.

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

/// Degrees of the Chebyshev series, tried until the coefficients have died out; each is about 3/2 of the one before.
const DEGREES: [usize; 7] = [36, 54, 80, 120, 180, 270, 400];

/// How accurate a state has to be.
#[derive(Clone, Copy)]
struct Accuracy {
    /// A profile is resolved when its last Chebyshev coefficients are below this part of the largest.
    tail: f64,
    /// An automatic parameter is settled when a step changes it by less than this part.
    change: f64,
}

/// For states that are results: the tail is some 450 times the machine's precision, which derivatives amplify.
const FULL: Accuracy = Accuracy {
    tail: 1e-13,
    change: 1e-11,
};
/// For states on the way to another one, which serve as starts of Newton's method.
const ROUGH: Accuracy = Accuracy {
    tail: 1e-7,
    change: 1e-3,
};
/// A profile whose tail is larger than this at the highest degree is an error. Between [`FULL`] and this the state is kept,
/// and its truncation shows in the errors of what follows from it.
const UNRESOLVED: f64 = 1e-9;
/// Degree from which on an unresolved profile is given a stretched coordinate, which widens its layer.
const STRETCHED_FROM: usize = 120;
/// Number of degrees at which Newton's method may fail before the next degree is no longer tried.
const MOST_FAILURES: usize = 2;

/// Work allowed for one base state, as a sum of cubes of the number of unknowns: some twenty seconds of one core.
const ALLOWED_WORK: f64 = 3e11;

/// A model, and the work that may still be spent on its base state. Where there is no base state, the search then ends
/// within seconds.
struct Effort {
    model: Arc<dyn Model>,
    matrices: Arc<Matrices>,
    /// Work that is left, in cubes of unknowns.
    left: Cell<f64>,
}

impl Effort {
    fn new(model: &Arc<dyn Model>, matrices: &Arc<Matrices>) -> Self {
        Effort {
            model: model.clone(),
            matrices: matrices.clone(),
            left: Cell::new(ALLOWED_WORK),
        }
    }

    /// Counts the assembly or the solution of a system as the cube of its `size`.
    ///
    /// # Errors
    /// The work that is allowed is spent.
    fn spend(&self, size: usize) -> std::result::Result<(), Trouble> {
        let left = self.left.get() - (size as f64).powi(3);
        self.left.set(left);
        if left < 0.0 {
            return Err(Trouble::Spent);
        }
        Ok(())
    }
}

/// The base state at the given parameters. Those set to `auto` are determined with it. `near` is a neighbouring state, from
/// which the computation starts.
///
/// # Errors
/// There is no base state, or it is not resolved; the message says what failed where, and what to try.
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
    // Where the work was spent on the way, the place where it ran out says nothing.
    if solved.is_err() && effort.left.get() < 0.0 {
        let place = "for want of work allowed to it";
        return Err(describe(model.as_ref(), parameters, &Trouble::Spent, place));
    }
    solved
}

/// The state at parameters none of which is automatic.
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

/// The state at the lowest degree at which its Chebyshev coefficients have died out to `resolved`, or the best one that the
/// degrees give.
///
/// # Errors
/// Newton's method fails at two degrees, or the work that is allowed is spent.
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
    // Start from the degree of the neighbour; one lower where it has a layer, which may widen along the way.
    let first = start.map_or(0, |s| {
        let same = degrees.iter().position(|&d| d >= s.degree).unwrap_or(0);
        same.saturating_sub(usize::from(s.degree > STRETCHED_FROM))
    });
    // Keep the stretched coordinate of a neighbour that was hard to resolve.
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
    /// The same state at the next degree, whose truncation and rounding errors differ; `None` for a closed form, at the
    /// highest degree, or where Newton's method fails there.
    pub fn refined(&self) -> Option<BaseState> {
        let next = DEGREES.iter().find(|&&degree| degree > self.degree)?;
        let solved = !self.series.is_empty() && !self.space.is_point();
        let effort = Effort::new(&self.model, self.space.matrices());
        let degree = solved.then_some(*next)?;
        let space = self.space.clone();
        collocated::solve(&effort, &self.parameters, Some(self), degree, space).ok()
    }

    /// The state at parameters that differ little from those of this one, none of them automatic. It has the same degree
    /// where Newton's method converges at that degree.
    ///
    /// # Errors
    /// As [`solve`].
    pub fn moved(&self, parameters: &Parameters) -> Result<BaseState> {
        let effort = Effort::new(&self.model, self.space.matrices());
        let continues = !self.series.is_empty() && self.case == parameters.case(self.structure());
        if continues {
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

/// The error of a base state that cannot be computed, with the parameters and the place of the failure.
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
