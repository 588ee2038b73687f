//! A base state: Chebyshev series of the solved fields, closed forms of the remaining ones.

use super::check::spec_line;
use crate::error::{Error, Result};
use crate::model::{
    CaseId, End, FieldId, KernelId, Model, PointState, SolvedId, Structure, Table, evaluate,
};
use crate::parameters::Parameters;
use crate::space::{Matrices, Place, Series, Space};
use crate::wavevector::WaveVector;
use std::fmt;
use std::sync::Arc;

/// X⁰(y), evaluated to any derivative that kernels ask for.
#[derive(Clone)]
pub struct BaseState {
    /// The model that it is a base state of.
    pub model: Arc<dyn Model>,
    /// Values of the parameters, automatic ones determined.
    pub parameters: Parameters,
    /// The conditions that the switches select.
    pub case: CaseId,
    /// The interval, with the coordinate of the series.
    pub space: Space,
    /// Degree of the series (0 where the base is in closed form).
    pub degree: usize,
    /// Chebyshev series of each solved field; for an unknown number, its value.
    pub series: Table<SolvedId, Series>,
    /// Largest residual of the discretised base problem, relative to its terms.
    pub residual: f64,
    /// Balances and conditions that it meets to a few digits only, each as a note in words.
    pub notes: Vec<String>,
}

impl fmt::Debug for BaseState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = &self.structure().name;
        write!(f, "base state of {name}, degree {}", self.degree)
    }
}

/// The interval at the given parameters, or the point of a model without a cross-stream coordinate.
///
/// # Errors
/// The interval is empty.
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
    let spec = spec_line(model, structure.lines.coordinate);
    Err(Error::input(format!(
        "{spec}: the interval {lower}..{upper} is empty: its upper end must lie above its lower end"
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
            notes: Vec::new(),
        }
    }

    /// Whether the spec gives all of it in closed form, so that nothing was solved for.
    pub fn is_closed(&self) -> bool {
        self.series.is_empty()
    }

    /// The names, fields, balances and terms that the kernels' outputs stand for.
    pub fn structure(&self) -> &Structure {
        self.model.structure()
    }

    /// The point state that kernels read at a place: a vector with the layout of [`Structure::state`]. `q` is read by the
    /// block `amplitude` alone.
    pub fn at(&self, place: Place, q: WaveVector) -> Vec<f64> {
        let structure = self.structure();
        let (y, values) = (self.space.y(place), &self.parameters.values);
        let mut point = PointState::new(structure.state(), y, q.k(), values);
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
        self.at(self.space.end(end), WaveVector::MEAN)
    }

    /// A field at a place.
    pub fn value(&self, field: FieldId, place: Place) -> f64 {
        self.structure()
            .base_value(&self.at(place, WaveVector::MEAN), field, 0)
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

    /// Fields must stay in the ranges that the spec declares, but for the truncation error.
    pub(super) fn check_ranges(&self, truncation: f64) -> Result<()> {
        let structure = self.structure();
        for place in self.space.evenly(65) {
            let point = self.at(place, WaveVector::MEAN);
            for (field, info) in structure.fields.pairs() {
                let value = structure.base_value(&point, field, 0);
                let slack = (1e-9 + 100.0 * truncation) * (1.0 + value.abs());
                if !(value >= info.lower - slack && value <= info.upper + slack) {
                    let spec = spec_line(self.model.as_ref(), structure.lines.fields[field]);
                    return Err(Error::computation(format!(
                        "{spec}: the base state leaves the range of `{}`: {value:.6e} at {} = {}; try milder \
                         parameters, or widen the range in `fields`",
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
