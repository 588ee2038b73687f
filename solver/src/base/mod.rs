//! The base state: in closed form, or by Newton's method on the emitted residual.

mod newton;
mod state;

pub use state::BaseState;

use crate::error::{Error, Result};
use crate::model::{KernelId, Model, evaluate};
use crate::parameters::Parameters;
use newton::{Failure, Newton};
use std::cell::Cell;

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
/// Relative Newton step of an automatic parameter that says that its condition is flat.
const BLIND: f64 = 1e3;
/// Newton steps for the automatic parameters.
const MOST_ADJUSTMENTS: usize = 25;
/// Smallest step of the continuation in parameters, as a fraction of the way.
const SMALLEST_STEP: f64 = 1.0 / 256.0;

/// What one base state is worth, in cubes of unknowns: some twenty seconds of one core.
const WORTH: f64 = 3e11;

/// A model, and what may still be spent on its base state: an answer that cannot be had should not take minutes.
struct Effort<'m> {
    model: &'m dyn Model,
    left: Cell<f64>,
}

impl<'m> Effort<'m> {
    fn new(model: &'m dyn Model) -> Self {
        Effort {
            model,
            left: Cell::new(WORTH),
        }
    }
}

/// The base state at the given parameters, those set to `auto` determined on the way.
///
/// # Errors
/// Says which computation failed and where, and what to try.
pub fn solve(model: &dyn Model, parameters: &Parameters) -> Result<BaseState> {
    solve_near(model, parameters, None)
}

/// Like [`solve`], starting from a neighbouring state where there is one.
pub fn solve_near(
    model: &dyn Model,
    parameters: &Parameters,
    near: Option<&BaseState>,
) -> Result<BaseState> {
    let effort = Effort::new(model);
    let solved = if parameters.automatic.iter().any(|a| *a) {
        determine(&effort, parameters, near)
    } else {
        fixed(&effort, parameters, near, FULL)
    };
    // Spent on the way, it says nothing about the place where it ran out.
    if solved.is_err() && effort.left.get() < 0.0 {
        let place = "for want of work allowed to it";
        return Err(describe(model, parameters, &Failure::Spent, place));
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
    let model = effort.model;
    check_interval(model, parameters)?;
    let structure = model.structure();
    if structure.base.solved.is_empty() {
        let state = BaseState::closed(model, parameters);
        state.check_closed(model)?;
        return Ok(state);
    }
    let start = near.filter(|state| state.case == parameters.case(structure));
    let newton = Newton {
        model,
        parameters,
        resolved: accuracy.tail,
        left: &effort.left,
    };
    let state = match newton.refine(start, &DEGREES) {
        Ok(state) => state,
        Err(_) => {
            let rough = continuation(effort, parameters, start)?;
            let refined = newton.refine(Some(&rough), &DEGREES);
            let place = "at the end of the continuation";
            refined.map_err(|failure| describe(model, parameters, &failure, place))?
        }
    };
    let tail = state.tail();
    if tail > UNRESOLVED.max(accuracy.tail) {
        return Err(Error::computation(format!(
            "the base state is not resolved with {} Chebyshev polynomials (relative tail {tail:.1e}); \
             try a smaller interval or milder parameters",
            state.degree
        )));
    }
    state.check_ranges(model, tail)?;
    state.check_closed(model)?;
    Ok(state)
}

impl BaseState {
    /// The same state at the next degree, which truncates and rounds differently; nothing for a closed form,
    /// or where the degree cannot rise.
    pub fn refined(&self, model: &dyn Model) -> Option<BaseState> {
        let next = DEGREES.iter().position(|&degree| degree > self.degree)?;
        let solved = !self.series.is_empty() && model.structure().coordinate.is_some();
        let effort = Effort::new(model);
        let newton = Newton {
            model,
            parameters: &self.parameters,
            resolved: FULL.tail,
            left: &effort.left,
        };
        let degree = solved.then(|| DEGREES[next])?;
        newton.solve(Some(self), degree, self.stretch).ok()
    }
}

impl BaseState {
    /// The state at parameters next to its own, none of them automatic, at the same degree where that will do.
    ///
    /// # Errors
    /// As [`solve_near`].
    pub fn moved(&self, model: &dyn Model, parameters: &Parameters) -> Result<BaseState> {
        let effort = Effort::new(model);
        let newton = Newton {
            model,
            parameters,
            resolved: FULL.tail,
            left: &effort.left,
        };
        let solved = !self.series.is_empty() && self.case == parameters.case(model.structure());
        if solved && let Ok(state) = newton.solve(Some(self), self.degree, self.stretch) {
            return Ok(state);
        }
        fixed(&effort, parameters, Some(self), FULL)
    }
}

/// What is left of the conditions that determine the given parameters.
pub fn automatic_conditions(
    model: &dyn Model,
    state: &BaseState,
    unknown: &[usize],
) -> nalgebra::DVector<f64> {
    let automatic = &model.structure().base.automatic;
    let values = unknown.iter().map(|&index| {
        let position = automatic.iter().position(|a| a.parameter == index);
        position.map_or(0.0, |position| {
            let end = automatic[position].end;
            evaluate(model, KernelId::Automatic, &state.at_end(model, end))[position]
        })
    });
    nalgebra::DVector::from_iterator(unknown.len(), values)
}

fn check_interval(model: &dyn Model, parameters: &Parameters) -> Result<()> {
    let (lower, upper) = state::interval(model, parameters);
    if lower.is_finite() && upper.is_finite() && upper > lower {
        return Ok(());
    }
    Err(Error::input(format!(
        "the interval {lower}..{upper} is empty: its upper end must lie above its lower end"
    )))
}

/// From a state that can be found to roughly the one that is asked for, in steps that adapt.
fn continuation(
    effort: &Effort,
    target: &Parameters,
    near: Option<&BaseState>,
) -> Result<BaseState> {
    let model = effort.model;
    let start = match near {
        Some(state) => state.clone(),
        None => at_defaults(effort, target)?,
    };
    let step = |parameters: &Parameters, from: &BaseState| {
        let newton = Newton {
            model,
            parameters,
            resolved: ROUGH.tail,
            left: &effort.left,
        };
        newton.refine(Some(from), &DEGREES).map_err(|failure| {
            let place = "on the way from the default parameters";
            describe(model, parameters, &failure, place)
        })
    };
    walk(target, start, step)
}

/// The state at the defaults, the switches set as in `target`: there is nothing between two choices.
fn at_defaults(effort: &Effort, target: &Parameters) -> Result<BaseState> {
    let model = effort.model;
    let structure = model.structure();
    let mut parameters = Parameters::defaults(structure);
    for (index, info) in structure.parameters.iter().enumerate() {
        if !info.choices.is_empty() {
            parameters.values[index] = target.values[index];
        }
    }
    Newton {
        model,
        parameters: &parameters,
        resolved: FULL.tail,
        left: &effort.left,
    }
    .refine(None, &DEGREES)
    .map_err(|failure| describe(model, &parameters, &failure, "at the default parameters"))
}

/// Follows a state from its parameters to `target`.
fn walk(
    target: &Parameters,
    start: BaseState,
    solve: impl Fn(&Parameters, &BaseState) -> Result<BaseState>,
) -> Result<BaseState> {
    let from = start.parameters.clone();
    let mut state = start;
    let (mut done, mut step) = (0.0, 0.25_f64);
    while done < 1.0 {
        let fraction = (done + step).min(1.0);
        match solve(&between(&from, target, fraction), &state) {
            Ok(next) => {
                state = next;
                done = fraction;
                step *= 1.7;
            }
            Err(error) => {
                step *= 0.4;
                if step < SMALLEST_STEP {
                    return Err(error);
                }
            }
        }
    }
    Ok(state)
}

/// Parameters at a fraction of the way; positive ones move by ratio, so that a decade is one stretch.
fn between(from: &Parameters, to: &Parameters, fraction: f64) -> Parameters {
    let mut parameters = to.clone();
    for (value, (from, to)) in parameters
        .values
        .iter_mut()
        .zip(from.values.iter().zip(&to.values))
    {
        *value = if fraction == 1.0 {
            *to
        } else if *from > 0.0 && *to > 0.0 {
            from * (to / from).powf(fraction)
        } else {
            from + fraction * (to - from)
        };
    }
    parameters
}

fn describe(model: &dyn Model, parameters: &Parameters, failure: &Failure, place: &str) -> Error {
    let structure = model.structure();
    let values: Vec<String> = (0..structure.parameters.len())
        .map(|i| {
            let (name, value) = (
                &structure.parameters[i].name,
                parameters.shown(structure, i),
            );
            match parameters.automatic[i] {
                true => format!("{name} = auto (tried from {value})"),
                false => format!("{name} = {value}"),
            }
        })
        .collect();
    Error::computation(format!(
        "Newton's method for the base state failed {place} ({failure}) at {}; \
         try parameters nearer the defaults, or another `guess`",
        values.join(", ")
    ))
}

/// The state whose automatic parameters meet their conditions.
fn determine(
    effort: &Effort,
    parameters: &Parameters,
    near: Option<&BaseState>,
) -> Result<BaseState> {
    if let Ok(state) = adjust(effort, parameters, near, FULL) {
        return Ok(state);
    }
    // The automatic parameters adjusted at every step: their defaults may suit no other values.
    let start = match near {
        Some(state) => state.clone(),
        None => {
            let mut defaults = at_defaults(effort, parameters)?.parameters;
            defaults.automatic.clone_from(&parameters.automatic);
            adjust(effort, &defaults, None, ROUGH)?
        }
    };
    let rough = walk(parameters, start, |at, from| {
        adjust(effort, at, Some(from), ROUGH)
    })?;
    adjust(effort, parameters, Some(&rough), FULL)
}

/// Newton's method on the automatic parameters, their derivative by differences.
fn adjust(
    effort: &Effort,
    parameters: &Parameters,
    near: Option<&BaseState>,
    accuracy: Accuracy,
) -> Result<BaseState> {
    let model = effort.model;
    let structure = model.structure();
    let unknown: Vec<usize> = (0..parameters.values.len())
        .filter(|&i| parameters.automatic[i])
        .collect();
    let mut current = parameters.clone();
    current.automatic.fill(false);
    if let Some(state) = near {
        for &index in &unknown {
            current.values[index] = state.parameters.values[index];
        }
    }
    let conditions = |state: &BaseState| automatic_conditions(model, state, &unknown);
    let mut state = fixed(effort, &current, near, accuracy)?;
    let mut residual = conditions(&state);
    for _ in 0..MOST_ADJUSTMENTS {
        let n = unknown.len();
        let mut jacobian = nalgebra::DMatrix::zeros(n, n);
        for (column, &index) in unknown.iter().enumerate() {
            let mut moved = current.clone();
            let step = 1e-6 * moved.values[index].abs().max(1e-3);
            moved.values[index] += step;
            let shifted = conditions(&fixed(effort, &moved, Some(&state), accuracy)?);
            jacobian.set_column(column, &((shifted - &residual) / step));
        }
        let Some(step) = jacobian.lu().solve(&(-&residual)) else {
            break;
        };
        let mut largest = 0.0_f64;
        for (&index, &change) in unknown.iter().zip(step.iter()) {
            let value = current.values[index];
            let bound = 0.2 * value.abs().max(1e-3);
            current.values[index] = value + change.clamp(-bound, bound);
            largest = largest.max((change / value.abs().max(1e-300)).abs());
        }
        // The condition does not feel the parameter here.
        if largest.is_nan() || largest > BLIND {
            break;
        }
        state = fixed(effort, &current, Some(&state), accuracy)?;
        residual = conditions(&state);
        if largest < accuracy.change {
            return Ok(state);
        }
    }
    let names: Vec<&str> = unknown
        .iter()
        .map(|&i| structure.parameters[i].name.as_str())
        .collect();
    Err(Error::computation(format!(
        "the condition that determines {} was not met; give a value instead of auto",
        names.join(", ")
    )))
}
