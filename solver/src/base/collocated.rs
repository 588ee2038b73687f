//! The base state at one degree N, as a system for Newton's method.
//!
//! Unknowns are the values x of the solved fields at Chebyshev points, then unknown numbers. Equations are, for the base
//! state X⁰ that x stands for,
//!
//! R(X⁰) = 0 at the points of each balance,  W(X⁰) = 0 at each end,  ∫ D(X⁰) dy = given value.
//!
//! The offsets of the base problem say how many values a field and how many points a balance has beyond N, so that there
//! are as many equations as unknowns. Where a profile has an interior layer, the polynomials are in a stretched coordinate.

use super::Effort;
use super::state::BaseState;
use crate::model::layout::{read_base_conditions, read_base_row, read_integral};
use crate::model::{BaseJet, BaseRowId, End, Id, KernelId, Model, SolvedId, Structure, evaluate};
use crate::numerics::{Failure, Linearised, Newton, System};
use crate::parameters::Parameters;
use crate::space::{Derivative, Layout, Place, Points, Quadrature, Space};
use crate::wavevector::WaveVector;
use faer::Mat;
use faer::linalg::solvers::Solve;
use std::collections::HashMap;
use std::fmt;

/// Newton's method ends after a step below this part of the largest value: convergence is quadratic, and the error after
/// that step is about its square.
const CONVERGED: f64 = 1e-10;
/// How far a field may leave its declared range, in its units, during the iteration: at too low a degree a profile that
/// decays to the end of its range oscillates about it.
const SLACK: f64 = 1e-6;
/// Values that are smaller than this part of those at the start are zero.
const ZERO: f64 = 1e-14;
const METHOD: Newton = Newton {
    most_steps: 40,
    least_part: 1e-3,
};

/// Why there is no state at some degree.
pub(super) enum Trouble {
    /// Newton's method has failed.
    Newton(Failure),
    /// The work that is allowed for a base state is spent.
    Spent,
}

impl From<Failure> for Trouble {
    fn from(failure: Failure) -> Self {
        Trouble::Newton(failure)
    }
}

impl fmt::Display for Trouble {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Trouble::Newton(failure) => write!(f, "{failure}"),
            Trouble::Spent => f.write_str(
                "some twenty seconds of it: its layers may be too thin, or there may be none",
            ),
        }
    }
}

/// The discretised problem at one degree.
pub(super) struct Collocated<'a> {
    effort: &'a Effort,
    parameters: &'a Parameters,
    space: Space,
    degree: usize,
    layout: Layout<BaseRowId, SolvedId>,
    /// Families of balances that share their points, with these points.
    groups: Vec<(Vec<Place>, Vec<BaseRowId>)>,
    integral: Quadrature,
    /// The largest value at the start.
    start: f64,
    /// ∂y^order of a field at a family of points, computed when first needed.
    derivatives: HashMap<(SolvedId, Points, usize), Derivative>,
}

/// The state at one degree, from `start` or else from the guesses of the spec.
///
/// # Errors
/// Newton's method fails, or the work that is allowed is spent.
pub(super) fn solve(
    effort: &Effort,
    parameters: &Parameters,
    start: Option<&BaseState>,
    degree: usize,
    space: Space,
) -> Result<BaseState, Trouble> {
    let structure = effort.model.structure();
    let base = &structure.base;
    let numbers = base.solved.len() - base.offsets.columns.len();
    let layout = Layout::extremal(&base.offsets, degree, numbers);
    let groups = layout.groups().into_iter();
    let mut system = Collocated {
        effort,
        parameters,
        groups: groups
            .map(|(points, rows)| (space.places(points), rows))
            .collect(),
        integral: space.quadrature(degree + 1),
        derivatives: HashMap::new(),
        start: 0.0,
        layout,
        degree,
        space,
    };
    let initial = system.initial(start);
    system.start = largest(&initial);
    let (mut values, at) = METHOD.solve(&mut system, initial)?;
    if largest(&values) <= ZERO * system.start {
        values.fill(0.0);
    }
    Ok(system.state(&values, at.size()))
}

fn largest(values: &[f64]) -> f64 {
    values
        .iter()
        .fold(0.0, |largest, value| largest.max(value.abs()))
}

/// One equation F_i(x) = 0 at a state.
struct Row {
    /// F_i
    value: f64,
    /// ∂F_i/∂x_j, by unknown.
    slopes: Vec<f64>,
}

impl Collocated<'_> {
    fn model(&self) -> &dyn Model {
        self.effort.model.as_ref()
    }

    fn structure(&self) -> &Structure {
        self.model().structure()
    }

    /// Values of the unknowns to start from: those of a state, or the guesses of the spec.
    fn initial(&self, start: Option<&BaseState>) -> Vec<f64> {
        let template = self.state(&vec![0.0; self.layout.size], 0.0);
        let mut values = Vec::with_capacity(self.layout.size);
        for (solved, column) in self.layout.columns.pairs() {
            let field = self.structure().base.solved[solved];
            for place in self.space.places(column.points) {
                values.push(match start {
                    Some(state) => state.value(field, place),
                    None => {
                        let point = template.at(place, WaveVector::MEAN);
                        let guesses = evaluate(self.model(), KernelId::Guess, &point);
                        guesses[solved.index()]
                    }
                });
            }
        }
        values
    }

    /// The state that values of the unknowns stand for.
    fn state(&self, values: &[f64], residual: f64) -> BaseState {
        // Newton's method itself reads a first derivative.
        let order = self.structure().base_order.max(1);
        let series = |column: &crate::space::Block| self.space.series(column.of(values), order);
        BaseState {
            model: self.effort.model.clone(),
            parameters: self.parameters.clone(),
            case: self.parameters.case(self.structure()),
            space: self.space.clone(),
            degree: self.degree,
            series: self.layout.columns.map(series),
            residual,
            notes: Vec::new(),
        }
    }

    /// All equations: balances, conditions at the ends, integral conditions.
    fn rows(&mut self, values: &[f64]) -> Vec<Row> {
        let state = self.state(values, 0.0);
        let mut rows: Vec<Row> = Vec::with_capacity(self.layout.size);
        self.balances(&state, &mut rows);
        self.conditions(&state, &mut rows);
        self.integrals(&state, &mut rows);
        rows
    }

    /// R(X⁰) = 0 at the points of each balance.
    fn balances(&mut self, state: &BaseState, rows: &mut Vec<Row>) {
        let model = self.effort.model.clone();
        let structure = model.structure();
        // One run of the kernel at a point gives all balances there.
        let mut group_of: HashMap<BaseRowId, usize> = HashMap::new();
        let mut outputs: Vec<Vec<Vec<f64>>> = Vec::new();
        for (places, balances) in &self.groups {
            let at = |&place: &Place| {
                evaluate(
                    model.as_ref(),
                    KernelId::Base,
                    &state.at(place, WaveVector::MEAN),
                )
            };
            group_of.extend(balances.iter().map(|&row| (row, outputs.len())));
            outputs.push(places.iter().map(at).collect());
        }
        for (row, info) in structure.base.rows.pairs() {
            let points = self.layout.rows[row].points;
            for (i, out) in outputs[group_of[&row]].iter().enumerate() {
                let read = read_base_row(&structure.base.rows, row, out);
                rows.push(Row {
                    value: read.value,
                    slopes: self.by_unknowns(structure, &info.jets, &read.slopes, points, i),
                });
            }
        }
    }

    /// W(X⁰) = 0 at each end.
    fn conditions(&mut self, state: &BaseState, rows: &mut Vec<Row>) {
        let model = self.effort.model.clone();
        let structure = model.structure();
        let case = &structure.cases[state.case];
        for end in End::BOTH {
            let point = state.at_end(end);
            let out = evaluate(model.as_ref(), KernelId::BaseConditions(state.case), &point);
            for (jets, read) in read_base_conditions(case, end, &out) {
                rows.push(Row {
                    value: read.value,
                    slopes: self.by_unknowns(structure, jets, &read.slopes, Points::end(end), 0),
                });
            }
        }
    }

    /// ∫ D(X⁰) dy − given value = 0, by quadrature.
    fn integrals(&mut self, state: &BaseState, rows: &mut Vec<Row>) {
        let model = self.effort.model.clone();
        let structure = model.structure();
        let integrals = &structure.base.integrals;
        if integrals.is_empty() {
            return;
        }
        let Quadrature { points, nodes } = self.integral.clone();
        let kernel = |(place, _): &(Place, f64)| {
            evaluate(
                model.as_ref(),
                KernelId::BaseIntegrals,
                &state.at(*place, WaveVector::MEAN),
            )
        };
        let outputs: Vec<Vec<f64>> = nodes.iter().map(kernel).collect();
        for (index, jets) in integrals.iter().enumerate() {
            let mut row = Row {
                value: 0.0,
                slopes: vec![0.0; self.layout.size],
            };
            for (i, ((_, weight), out)) in nodes.iter().zip(&outputs).enumerate() {
                let (read, prescribed) = read_integral(integrals, index, out);
                row.value += weight * read.value;
                // The given value is an output of the kernel, the same at every node.
                if i == 0 {
                    row.value -= prescribed;
                }
                let at_node = self.by_unknowns(structure, jets, &read.slopes, points, i);
                for (entry, slope) in row.slopes.iter_mut().zip(at_node) {
                    *entry += weight * slope;
                }
            }
            rows.push(row);
        }
    }

    /// ∂F/∂x_j = Σ_jets ∂F/∂jet · D_ij: slopes by base jets at the `point`-th of some points as slopes by the unknowns.
    fn by_unknowns(
        &mut self,
        structure: &Structure,
        jets: &[BaseJet],
        slopes: &[f64],
        points: Points,
        point: usize,
    ) -> Vec<f64> {
        let mut row = vec![0.0; self.layout.size];
        for (jet, &slope) in jets.iter().zip(slopes) {
            let Some(solved) = structure.base.solved.position(|f| *f == jet.field) else {
                continue;
            };
            let column = &self.layout.columns[solved];
            let (space, from) = (&self.space, column.points);
            let derivative = self
                .derivatives
                .entry((solved, points, jet.order))
                .or_insert_with(|| space.derivative(from, points, jet.order));
            derivative.add_row(point, slope, &mut row[column.range()]);
        }
        row
    }
}

impl System for Collocated<'_> {
    type Jacobian = Mat<f64>;
    type Byproduct = ();
    type Error = Trouble;

    /// F and ∂F/∂x, each equation divided by its largest slope, so that the size of the residual does not depend on units.
    fn linearise(&mut self, values: &[f64]) -> Result<Option<Linearised<Self>>, Trouble> {
        let size = self.layout.size;
        self.effort.spend(size)?;
        let rows = self.rows(values);
        if rows.len() != size {
            return Ok(None);
        }
        let mut residual = Vec::with_capacity(size);
        let mut jacobian = Mat::<f64>::zeros(size, size);
        for (i, row) in rows.into_iter().enumerate() {
            let largest = row.slopes.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            if !largest.is_finite() || !row.value.is_finite() || largest == 0.0 {
                return Ok(None);
            }
            residual.push(row.value / largest);
            for (j, slope) in row.slopes.into_iter().enumerate() {
                jacobian[(i, j)] = slope / largest;
            }
        }
        Ok(Some(Linearised {
            residual,
            jacobian,
            byproduct: (),
        }))
    }

    /// Whether every field stays within its declared range at its points.
    fn admits(&self, values: &[f64]) -> bool {
        self.layout.columns.pairs().all(|(solved, column)| {
            let structure = self.structure();
            let info = &structure.fields[structure.base.solved[solved]];
            let inside = |v: &f64| *v > info.lower - SLACK && *v < info.upper + SLACK;
            column.of(values).iter().all(inside)
        })
    }

    fn step(&mut self, _: &[f64], at: &Linearised<Self>) -> Result<Option<Vec<f64>>, Trouble> {
        let size = self.layout.size;
        self.effort.spend(size)?;
        let right = Mat::from_fn(size, 1, |i, _| -at.residual[i]);
        let step = at.jacobian.partial_piv_lu().solve(&right);
        let step = step.col_as_slice(0).to_vec();
        Ok(step.iter().all(|s| s.is_finite()).then_some(step))
    }

    fn is_last(&self, values: &[f64], step: &[f64]) -> bool {
        let (values, step) = (largest(values), largest(step));
        // A state that is zero everywhere is reached to the rounding of the start.
        step <= CONVERGED * values || values + step <= ZERO * self.start
    }
}
