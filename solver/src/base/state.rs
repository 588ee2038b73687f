//! A base state: Chebyshev series of the solved fields, closed forms of the others.

use crate::collocation::{Series, Stretch};
use crate::error::{Error, Result};
use crate::model::{End, KernelId, Model, PointState, ResidualId, WithRounding, evaluate};
use crate::parameters::Parameters;

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
#[derive(Clone, Debug)]
pub struct BaseState {
    /// Values of the parameters, automatic ones determined.
    pub parameters: Parameters,
    /// Position of the case among those of the structure.
    pub case: usize,
    /// y of the lower end.
    pub lower: f64,
    /// y of the upper end.
    pub upper: f64,
    /// Degree of the series (0 where the base is in closed form).
    pub degree: usize,
    /// The coordinate of the series.
    pub stretch: Stretch,
    /// Chebyshev coefficients of each solved field, in the order of `solved`; one for a number.
    pub series: Vec<Series>,
    /// Largest residual of the discretised base problem, relative to its terms.
    pub residual: f64,
}

/// The ends of the interval at these parameters.
pub(super) fn interval(model: &dyn Model, parameters: &Parameters) -> (f64, f64) {
    let point = PointState::new(model.structure().state(), 0.0, 0.0, &parameters.values);
    let ends = evaluate(model, KernelId::Interval, point.values());
    (ends[0], ends[1])
}

/// Places at which the steepest layer is looked for.
const LAYER_SAMPLES: usize = 2000;
/// A layer wider than this part of the half-interval needs no coordinate of its own.
const WIDE: f64 = 0.5;

impl BaseState {
    /// A base that is given in closed form.
    pub(super) fn closed(model: &dyn Model, parameters: &Parameters) -> Self {
        let (lower, upper) = interval(model, parameters);
        let case = parameters.case(model.structure());
        let parameters = parameters.clone();
        BaseState {
            parameters,
            case,
            lower,
            upper,
            degree: 0,
            stretch: Stretch::None,
            series: Vec::new(),
            residual: 0.0,
        }
    }

    /// y of a point ξ in [−1, 1].
    pub fn y(&self, xi: f64) -> f64 {
        // Exact at the ends.
        0.5 * ((1.0 - xi) * self.lower + (1.0 + xi) * self.upper)
    }

    /// dξ/dy
    pub fn scale(&self) -> f64 {
        2.0 / (self.upper - self.lower)
    }

    /// The point state at ξ; see [`KernelId`] for its layout. `k` enters the amplitude alone.
    pub fn point(&self, model: &dyn Model, xi: f64, k: f64) -> Vec<f64> {
        let structure = model.structure();
        let mut point = PointState::new(structure.state(), self.y(xi), k, &self.parameters.values);
        let closed = evaluate(model, KernelId::Closed, point.values());
        point.set_closed(&closed);
        let eta = self.stretch.eta(xi);
        for (&field, series) in structure.base.solved.iter().zip(&self.series) {
            let mut scale = 1.0;
            let derivatives = series.values(eta, structure.base_order);
            let derivatives = self.stretch.compose(xi, &derivatives);
            for (order, value) in derivatives.into_iter().enumerate() {
                point.set_base(field, order, value * scale);
                scale *= self.scale();
            }
        }
        point.into_values()
    }

    /// The point state at an end.
    pub fn at_end(&self, model: &dyn Model, end: End) -> Vec<f64> {
        let xi = if end == End::Lower { -1.0 } else { 1.0 };
        self.point(model, xi, 0.0)
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

    /// A coordinate that widens the steepest interior layer of a solved profile.
    pub(super) fn widened(&self) -> Stretch {
        let mut thinnest = (WIDE, Stretch::None);
        let places = (1..LAYER_SAMPLES).map(|i| -1.0 + 2.0 * i as f64 / LAYER_SAMPLES as f64);
        let places: Vec<f64> = places.collect();
        for series in self.series.iter().filter(|s| s.coefficients().len() > 1) {
            let values = places.iter().map(|&eta| series.values(eta, 0)[0]);
            let (least, most) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| {
                (a.min(v), b.max(v))
            });
            for &eta in &places {
                let xi = self.stretch.xi(eta);
                let derivatives = series.values(eta, 1);
                let slope = self.stretch.compose(xi, &derivatives)[1].abs();
                // Chebyshev points resolve a layer at an end by themselves.
                let width = (most - least) / slope;
                let seen = width / (1.0 - xi * xi + width).sqrt();
                if seen < thinnest.0 {
                    thinnest = (seen, Stretch::Layer { centre: xi, width });
                }
            }
        }
        thinnest.1
    }

    /// A base in closed form has to satisfy the balances, and what is given of it its wall conditions.
    ///
    /// # Errors
    /// Names what is left of the worst of them, and where.
    pub(super) fn check_closed(&self, model: &dyn Model) -> Result<()> {
        let structure = model.structure();
        let mut worst = Leftover::default();
        let place = |check: usize| -1.0 + 2.0 * (check as f64 + 0.5) / CHECKS as f64;
        let points: Vec<_> = (0..CHECKS)
            .map(|check| self.point(model, place(check), 0.0))
            .collect();
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
                    worst.add(value, || format!("the balance `{name}`"), point[0]);
                }
            }
        }
        let checks = &structure.cases[self.case].base_checks;
        for end in End::BOTH.into_iter().filter(|end| checks.contains(end)) {
            let point = self.at_end(model, end);
            let values = residual(model, ResidualId::BaseChecks(self.case), &point, &sizes);
            for (value, _) in values.into_iter().zip(checks).filter(|(_, at)| **at == end) {
                worst.add(value, || "its own condition".to_owned(), point[0]);
            }
        }
        if worst.excess <= 1.0 {
            return Ok(());
        }
        Err(Error::computation(format!(
            "the base state does not satisfy {}: residual {:.3e} at {} = {}",
            worst.of,
            worst.value,
            structure.coordinate.as_deref().unwrap_or("y"),
            worst.place
        )))
    }

    /// Fields must stay in the ranges that the spec declares, but for the truncation error.
    pub(super) fn check_ranges(&self, model: &dyn Model, truncation: f64) -> Result<()> {
        let structure = model.structure();
        for step in 0..=64 {
            let point = self.point(model, -1.0 + step as f64 / 32.0, 0.0);
            for (field, info) in structure.fields.iter().enumerate() {
                let value = point[structure.base_position(field, 0)];
                let slack = (1e-9 + 100.0 * truncation) * (1.0 + value.abs());
                if !(value >= info.lower - slack && value <= info.upper + slack) {
                    return Err(Error::computation(format!(
                        "the base state leaves the range of `{}`: {value:.6e} at {} = {}",
                        info.name,
                        structure.coordinate.as_deref().unwrap_or("y"),
                        point[0]
                    )));
                }
            }
        }
        Ok(())
    }
}
