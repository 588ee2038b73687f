//! Continuation in the parameters, from a base state that Newton's method reaches to the one that is asked for.

use super::{BaseState, Effort, FULL, ROUGH, describe, refine};
use crate::error::Result;
use crate::parameters::Parameters;

/// Smallest step, as a fraction of the way. The first is a quarter; where eight halvings do not help, the state has ended.
const SMALLEST_STEP: f64 = 1.0 / 256.0;

/// The state at `target` to [`ROUGH`] accuracy, from a neighbour with the same switches or else from the defaults.
pub(super) fn to(
    effort: &Effort,
    target: &Parameters,
    near: Option<&BaseState>,
) -> Result<BaseState> {
    let structure = effort.model.structure();
    let steps = || {
        structure
            .parameters
            .pairs()
            .filter(|(_, info)| !info.is_continuous())
    };
    let is_connected = |state: &&BaseState| {
        steps().all(|(id, _)| state.parameters.values[id] == target.values[id])
    };
    let start = match near.filter(is_connected) {
        Some(state) => state.clone(),
        None => at_defaults(effort, target)?,
    };
    let step = |parameters: &Parameters, from: &BaseState| {
        refine(effort, parameters, Some(from), ROUGH.tail).map_err(|trouble| {
            let place = "on the way from the default parameters";
            describe(effort.model.as_ref(), parameters, &trouble, place)
        })
    };
    walk(target, start, step)
}

/// The state at the defaults, switches and whole numbers set as in `target`: there is nothing between two of their
/// values.
pub(super) fn at_defaults(effort: &Effort, target: &Parameters) -> Result<BaseState> {
    let structure = effort.model.structure();
    let mut parameters = Parameters::defaults(structure);
    for (id, info) in structure.parameters.pairs() {
        if !info.is_continuous() {
            parameters.values[id] = target.values[id];
        }
    }
    refine(effort, &parameters, None, FULL.tail).map_err(|trouble| {
        let place = "at the default parameters";
        describe(effort.model.as_ref(), &parameters, &trouble, place)
    })
}

/// Follows a state from its parameters to `target`. Steps grow by 1.7 after a success and shrink to 0.4 after a failure.
pub(super) fn walk(
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
    let ends = from.values.iter().zip(to.values.iter());
    for (value, (from, to)) in parameters.values.iter_mut().zip(ends) {
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
