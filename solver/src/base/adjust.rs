//! Parameters set to `auto`: their values are those at which the base state meets a condition that the spec names.

use super::continuation::{at_defaults, walk};
use super::{Accuracy, BaseState, Effort, FULL, ROUGH, fixed};
use crate::error::{Error, Result};
use crate::model::{KernelId, ParameterId, evaluate};
use crate::numerics::{Failure, Linearised, Newton, System};
use crate::parameters::Parameters;
use nalgebra::{DMatrix, DVector};

/// A Newton step of more than this many times the parameter means that the condition does not depend on the parameter.
const BLIND: f64 = 1e3;
/// The largest change of a parameter in one step, relative to the parameter, so that the base state can be continued.
const BOUND: f64 = 0.2;
const METHOD: Newton = Newton {
    most_steps: 25,
    least_part: 1.0,
};

/// Residuals of the conditions that determine the automatic parameters `unknown`, one each.
pub fn automatic_conditions(state: &BaseState, unknown: &[ParameterId]) -> DVector<f64> {
    let automatic = &state.structure().base.automatic;
    let values = unknown.iter().map(|&parameter| {
        let position = automatic.iter().position(|a| a.parameter == parameter);
        position.map_or(0.0, |position| {
            let point = state.at_end(automatic[position].end);
            evaluate(state.model.as_ref(), KernelId::Automatic, &point)[position]
        })
    });
    DVector::from_iterator(unknown.len(), values)
}

/// The base state whose automatic parameters meet their conditions.
///
/// # Errors
/// A base state cannot be computed, or the conditions are not met.
pub(super) fn determine(
    effort: &Effort,
    parameters: &Parameters,
    near: Option<&BaseState>,
) -> Result<BaseState> {
    if let Ok(state) = adjust(effort, parameters, near, FULL) {
        return Ok(state);
    }
    // Go there in steps and adjust the automatic parameters at each: their defaults suit the default values alone.
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

/// The conditions as a system in the automatic parameters.
struct Conditions<'a> {
    effort: &'a Effort,
    parameters: Parameters,
    unknown: Vec<ParameterId>,
    accuracy: Accuracy,
    /// The latest state, from which the next one starts.
    last: Option<BaseState>,
}

/// An error of a base state, or a failure of the iteration.
enum Trouble {
    State(Error),
    Iteration,
}

impl From<Failure> for Trouble {
    fn from(_: Failure) -> Self {
        Trouble::Iteration
    }
}

impl Conditions<'_> {
    fn state(&self, values: &[f64], near: Option<&BaseState>) -> Result<BaseState> {
        let mut parameters = self.parameters.clone();
        for (&parameter, value) in self.unknown.iter().zip(values) {
            parameters.values[parameter] = *value;
        }
        fixed(self.effort, &parameters, near, self.accuracy)
    }
}

impl System for Conditions<'_> {
    /// Computed in `step`, by one base state for each parameter.
    type Jacobian = ();
    type Byproduct = BaseState;
    type Error = Trouble;

    fn linearise(
        &mut self,
        values: &[f64],
    ) -> std::result::Result<Option<Linearised<Self>>, Trouble> {
        let near = self.last.as_ref();
        let state = self.state(values, near).map_err(Trouble::State)?;
        self.last = Some(state.clone());
        let residual = automatic_conditions(&state, &self.unknown);
        Ok(Some(Linearised {
            residual: residual.iter().copied().collect(),
            jacobian: (),
            byproduct: state,
        }))
    }

    fn step(
        &mut self,
        values: &[f64],
        at: &Linearised<Self>,
    ) -> std::result::Result<Option<Vec<f64>>, Trouble> {
        let n = values.len();
        let residual = DVector::from_column_slice(&at.residual);
        let mut jacobian = DMatrix::zeros(n, n);
        for column in 0..n {
            let mut moved = values.to_vec();
            let step = 1e-6 * moved[column].abs().max(1e-3);
            moved[column] += step;
            let shifted = self
                .state(&moved, Some(&at.byproduct))
                .map_err(Trouble::State)?;
            let shifted = automatic_conditions(&shifted, &self.unknown);
            jacobian.set_column(column, &((shifted - &residual) / step));
        }
        let Some(step) = jacobian.lu().solve(&-residual) else {
            return Ok(None);
        };
        let changes = step.iter().zip(values);
        let largest = changes.map(|(s, v)| (s / v.abs().max(1e-300)).abs());
        let largest = largest.fold(0.0, f64::max);
        if largest.is_nan() || largest > BLIND {
            return Ok(None);
        }
        let bounded = step.iter().zip(values).map(|(step, value)| {
            let bound = BOUND * value.abs().max(1e-3);
            step.clamp(-bound, bound)
        });
        Ok(Some(bounded.collect()))
    }

    fn is_last(&self, values: &[f64], step: &[f64]) -> bool {
        let changes = step.iter().zip(values);
        let mut changes = changes.map(|(s, v)| (s / v.abs().max(1e-300)).abs());
        changes.all(|change| change < self.accuracy.change)
    }
}

/// Newton's method on the automatic parameters, from the values of the neighbour or else from those given.
fn adjust(
    effort: &Effort,
    parameters: &Parameters,
    near: Option<&BaseState>,
    accuracy: Accuracy,
) -> Result<BaseState> {
    let structure = effort.model.structure();
    let automatic = parameters.automatic.pairs().filter(|(_, set)| **set);
    let unknown: Vec<ParameterId> = automatic.map(|(id, _)| id).collect();
    let source = near.map_or(&parameters.values, |state| &state.parameters.values);
    let start = unknown.iter().map(|&id| source[id]).collect();
    let mut parameters = parameters.clone();
    parameters.automatic.fill(false);
    let names: Vec<&str> = unknown
        .iter()
        .map(|&id| structure.parameters[id].name.as_str())
        .collect();
    let mut conditions = Conditions {
        effort,
        parameters,
        unknown,
        accuracy,
        last: near.cloned(),
    };
    match METHOD.solve(&mut conditions, start) {
        Ok((_, at)) => Ok(at.byproduct),
        Err(Trouble::State(error)) => Err(error),
        Err(Trouble::Iteration) => Err(Error::computation(format!(
            "the condition that determines {} was not met; give a value instead of auto",
            names.join(", ")
        ))),
    }
}
