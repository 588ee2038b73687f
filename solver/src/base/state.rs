//! A base state: Chebyshev series of the solved fields, closed forms of the others.

use crate::error::{Error, Result};
use crate::model::{
    CaseId, End, FieldId, KernelId, Model, PointState, ResidualId, SolvedId, Structure, Table,
    WithRounding, evaluate,
};
use crate::parameters::Parameters;
use crate::space::{Matrices, Place, Series, Space};
use std::fmt;
use std::sync::Arc;

/// Places at which a closed base state is checked against its balances.
const CHECKS: usize = 7;

/// What a closed form leaves of a balance or a condition, relative to the terms it is made of.
const TOLERANCE: f64 = 1e-9;

/// The worst residual met.
#[derive(Default)]
struct Leftover {
    /// Size over what is allowed.
    excess: f64,
    value: f64,
    of: String,
    place: f64,
}

impl Leftover {
    fn add(&mut self, residual: WithRounding, of: impl Fn() -> String, place: f64) {
        let allowed = TOLERANCE * residual.size;
        let excess = match residual.value == 0.0 {
            true => 0.0,
            false => residual.value.abs() / allowed,
        };
        // What is no number is worse than any.
        let excess = if excess.is_nan() {
            f64::INFINITY
        } else {
            excess
        };
        if excess > self.excess {
            *self = Leftover {
                excess,
                value: residual.value,
                of: of(),
                place,
            };
        }
    }
}

/// The unexpanded residuals at the base state, whose jets are as large as `sizes` somewhere.
fn residual(model: &dyn Model, id: ResidualId, point: &[f64], sizes: &[f64]) -> Vec<WithRounding> {
    let structure = model.structure();
    let jets = structure.residual_jets.iter().zip(sizes);
    let jets: Vec<WithRounding> = jets
        .map(|(jet, &size)| {
            let value = structure.base_jet(*jet, point);
            let size = size.max(value.abs());
            WithRounding { value, size }
        })
        .collect();
    let kernel = model.residual(id);
    kernel.map_or_else(Vec::new, |kernel| kernel.evaluate(point, &jets))
}

/// X⁰(y), evaluated to any derivative that kernels ask for.
#[derive(Clone)]
pub struct BaseState {
    /// What it is a state of.
    pub model: Arc<dyn Model>,
    /// Values of the parameters, automatic ones determined.
    pub parameters: Parameters,
    /// The conditions that the switches select.
    pub case: CaseId,
    /// The interval, with the coordinate of the series.
    pub space: Space,
    /// Degree of the series (0 where the base is in closed form).
    pub degree: usize,
    /// Of each solved field; of a number its value.
    pub series: Table<SolvedId, Series>,
    /// Largest residual of the discretised base problem, relative to its terms.
    pub residual: f64,
}

impl fmt::Debug for BaseState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = &self.structure().name;
        write!(f, "base state of {name}, degree {}", self.degree)
    }
}

/// The interval at these parameters.
///
/// # Errors
/// One that is empty.
pub(super) fn space(
    model: &dyn Model,
    parameters: &Parameters,
    matrices: &Arc<Matrices>,
) -> Result<Space> {
    let structure = model.structure();
    if structure.coordinate.is_none() {
        return Ok(Space::new(None, matrices.clone()));
    }
    let point = PointState::new(structure.state(), 0.0, 0.0, &parameters.values);
    let ends = evaluate(model, KernelId::Interval, point.values());
    let (lower, upper) = (ends[0], ends[1]);
    if lower.is_finite() && upper.is_finite() && upper > lower {
        return Ok(Space::new(Some([lower, upper]), matrices.clone()));
    }
    Err(Error::input(format!(
        "the interval {lower}..{upper} is empty: its upper end must lie above its lower end"
    )))
}

impl BaseState {
    /// A base that is given in closed form.
    pub(super) fn closed(model: &Arc<dyn Model>, parameters: &Parameters, space: Space) -> Self {
        BaseState {
            model: model.clone(),
            case: parameters.case(model.structure()),
            parameters: parameters.clone(),
            space,
            degree: 0,
            series: Table::default(),
            residual: 0.0,
        }
    }

    /// What the kernels are about.
    pub fn structure(&self) -> &Structure {
        self.model.structure()
    }

    /// The point state that kernels read at a place; `k` enters the amplitude alone.
    pub fn at(&self, place: Place, k: f64) -> Vec<f64> {
        let structure = self.structure();
        let (y, values) = (self.space.y(place), &self.parameters.values);
        let mut point = PointState::new(structure.state(), y, k, values);
        let closed = evaluate(self.model.as_ref(), KernelId::Closed, point.values());
        point.set_closed(&closed);
        for (&field, series) in structure.base.solved.iter().zip(&self.series) {
            let derivatives = self.space.evaluate(series, place, structure.base_order);
            for (order, value) in derivatives.into_iter().enumerate() {
                point.set_base(field, order, value);
            }
        }
        point.into_values()
    }

    /// The point state at an end.
    pub fn at_end(&self, end: End) -> Vec<f64> {
        self.at(self.space.end(end), 0.0)
    }

    /// A field at a place.
    pub fn value(&self, field: FieldId, place: Place) -> f64 {
        self.structure().base_value(&self.at(place, 0.0), field, 0)
    }

    /// Size of the last Chebyshev coefficients, relative to the largest, of the worst field.
    pub fn tail(&self) -> f64 {
        let tail = |series: &Series| {
            let series = series.coefficients();
            let largest = series.iter().fold(0.0_f64, |m, c| m.max(c.abs()));
            let last = series
                .iter()
                .rev()
                .take(3)
                .fold(0.0_f64, |m, c| m.max(c.abs()));
            if largest > 0.0 && series.len() > 3 {
                last / largest
            } else {
                0.0
            }
        };
        self.series.iter().map(tail).fold(0.0, f64::max)
    }

    /// The space in a coordinate that widens the steepest interior layer of a solved profile.
    pub(super) fn widened(&self) -> Space {
        self.space.widened(self.series.iter())
    }

    /// A base in closed form has to satisfy the balances, and what is given of it its wall conditions.
    ///
    /// # Errors
    /// Names what is left of the worst of them, and where.
    pub(super) fn check_closed(&self) -> Result<()> {
        let (model, structure) = (self.model.as_ref(), self.structure());
        let mut worst = Leftover::default();
        let place = |check: usize| Place::at((check as f64 + 0.5) / CHECKS as f64);
        let points: Vec<_> = (0..CHECKS)
            .map(|check| self.at(place(check), 0.0))
            .collect();
        let y = structure.state().coordinate();
        // What a closed form cancels does not show in its value: each jet is as uncertain as at its largest.
        let sizes: Vec<f64> = structure
            .residual_jets
            .iter()
            .map(|jet| {
                let values = points.iter().map(|p| structure.base_jet(*jet, p).abs());
                values.fold(0.0, f64::max)
            })
            .collect();
        if structure.base.solved.is_empty() {
            for point in &points {
                let values = residual(model, ResidualId::Balances, point, &sizes);
                for (name, value) in structure.balances.iter().zip(values) {
                    worst.add(value, || format!("the balance `{name}`"), point[y]);
                }
            }
        }
        let checks = &structure.cases[self.case].base_checks;
        for end in End::BOTH.into_iter().filter(|end| checks.contains(end)) {
            let point = self.at_end(end);
            let values = residual(model, ResidualId::BaseChecks(self.case), &point, &sizes);
            for (value, _) in values.into_iter().zip(checks).filter(|(_, at)| **at == end) {
                worst.add(value, || "its own condition".to_owned(), point[y]);
            }
        }
        if worst.excess <= 1.0 {
            return Ok(());
        }
        let place = structure.coordinate.as_ref();
        let place = place.map_or(String::new(), |name| {
            format!(" at {name} = {}", worst.place)
        });
        Err(Error::computation(match worst.value.is_finite() {
            true => format!(
                "the base state does not satisfy {}: residual {:.3e}{place}",
                worst.of, worst.value
            ),
            false => format!("the base state has no value in {}{place}", worst.of),
        }))
    }

    /// Fields must stay in the ranges that the spec declares, but for the truncation error.
    pub(super) fn check_ranges(&self, truncation: f64) -> Result<()> {
        let structure = self.structure();
        for place in self.space.evenly(65) {
            let point = self.at(place, 0.0);
            for (field, info) in structure.fields.pairs() {
                let value = structure.base_value(&point, field, 0);
                let slack = (1e-9 + 100.0 * truncation) * (1.0 + value.abs());
                if !(value >= info.lower - slack && value <= info.upper + slack) {
                    return Err(Error::computation(format!(
                        "the base state leaves the range of `{}`: {value:.6e} at {} = {}",
                        info.name,
                        structure.coordinate.as_deref().unwrap_or("y"),
                        self.space.y(place)
                    )));
                }
            }
        }
        Ok(())
    }
}
