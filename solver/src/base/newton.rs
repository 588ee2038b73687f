//! Damped Newton iteration for the base state, collocated on Chebyshev points.
//!
//! Fields and balances have values and Gauss points by the offsets of the base problem, the widest field
//! being a polynomial of degree N; wall and integral conditions make up the difference. Where a layer
//! inside asks for it, the polynomials are in a stretched coordinate η.

use super::state::{BaseState, interval};
use crate::collocation::{Grid, GridKind, Series, Stretch, clenshaw_curtis, coefficients};
use crate::model::layout::{read_base_conditions, read_base_row, read_integral};
use crate::model::{BaseJet, End, KernelId, Linearised, Model, evaluate};
use crate::parameters::Parameters;
use faer::Mat;
use faer::linalg::solvers::Solve;
use std::cell::Cell;
use std::fmt;

const MOST_ITERATIONS: usize = 40;
const SMALLEST_DAMPING: f64 = 1e-3;
/// Consecutive degrees at which the iteration may fail.
const MOST_FAILURES: usize = 2;
const CONVERGED: f64 = 1e-10;
/// Degree at which an unresolved profile is looked at for a layer.
const STRETCHED_FROM: usize = 120;

/// Why an iteration gave up.
pub(super) enum Failure {
    Damping {
        residual: f64,
    },
    Iterations {
        residual: f64,
    },
    NotFinite,
    /// The work that a base state is worth is spent.
    Spent,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Failure::Damping { residual } => {
                write!(f, "no step reduces the residual {residual:.1e}")
            }
            Failure::Iterations { residual } => {
                write!(
                    f,
                    "residual {residual:.1e} after {MOST_ITERATIONS} iterations"
                )
            }
            Failure::NotFinite => f.write_str("a law has no value at the starting point"),
            Failure::Spent => f.write_str(
                "some twenty seconds of it: its layers may be too thin, or there may be none",
            ),
        }
    }
}

pub(super) struct Newton<'a> {
    pub model: &'a dyn Model,
    pub parameters: &'a Parameters,
    /// Relative size of the last coefficients at which a profile counts as resolved.
    pub resolved: f64,
    /// What may still be spent, in cubes of unknowns.
    pub left: &'a Cell<f64>,
}

/// The discretised problem at one degree.
struct Discrete<'a> {
    newton: &'a Newton<'a>,
    degree: usize,
    stretch: Stretch,
    lower: f64,
    upper: f64,
    case: usize,
    /// The unknowns of each solved field.
    columns: Vec<Column>,
    size: usize,
    /// The points of each row.
    rows: Vec<Grid>,
}

/// The unknowns of a solved field, and what takes them to derivatives elsewhere.
struct Column {
    /// The first of them.
    first: usize,
    /// Extrema; one point for a number.
    grid: Grid,
    /// At the points of each row, at the ends, and at the extrema of degree N.
    rows: Vec<Matrices>,
    ends: [Matrices; 2],
    all: Matrices,
}

/// d^order/dξ^order for orders 0 to 2.
type Matrices = Vec<Mat<f64>>;

/// Derivatives by ξ of polynomials in η, at points given in η.
fn stretched(from: &Grid, to: &Grid, stretch: Stretch) -> Matrices {
    let by_eta: Matrices = (0..=2).map(|order| from.derivative_on(to, order)).collect();
    if stretch == Stretch::None {
        return by_eta;
    }
    let rates: Vec<Vec<f64>> = to
        .nodes
        .iter()
        .map(|&eta| stretch.taylor(stretch.xi(eta), 2))
        .collect();
    // d/dξ = η' d/dη, d²/dξ² = η'² d²/dη² + η'' d/dη
    let first = Mat::from_fn(to.len(), from.len(), |i, j| rates[i][0] * by_eta[1][(i, j)]);
    let second = Mat::from_fn(to.len(), from.len(), |i, j| {
        rates[i][0].powi(2) * by_eta[2][(i, j)] + 2.0 * rates[i][1] * by_eta[1][(i, j)]
    });
    let values = by_eta.into_iter().next().into_iter();
    values.chain([first, second]).collect()
}

impl Newton<'_> {
    /// The state at rising degree until its coefficients have died out.
    pub fn refine(
        &self,
        start: Option<&BaseState>,
        degrees: &[usize],
    ) -> Result<BaseState, Failure> {
        // Without a cross-stream coordinate a profile is a number.
        let degrees = if self.model.structure().coordinate.is_none() {
            &[0]
        } else {
            degrees
        };
        let mut previous = start.cloned();
        let (mut best, mut last, mut failures) = (None, Failure::NotFinite, 0);
        // A layer that is followed may ask for less than the state before did.
        let first = start.map_or(0, |s| {
            let same = degrees.iter().position(|&d| d >= s.degree).unwrap_or(0);
            same.saturating_sub(usize::from(s.degree > STRETCHED_FROM))
        });
        // The layer of the state before, where it was hard to resolve.
        let mut stretch = match start {
            Some(state) if state.degree >= STRETCHED_FROM => state.widened(),
            _ => Stretch::None,
        };
        for &degree in &degrees[first.min(degrees.len() - 1)..] {
            match self.solve(previous.as_ref(), degree, stretch) {
                Ok(state) => {
                    let resolved = state.tail() < self.resolved;
                    if degree >= STRETCHED_FROM {
                        stretch = state.widened();
                    }
                    // Rounding sets a floor to the tail; beyond it more polynomials do not help.
                    let stalled = best.as_ref().is_some_and(|b: &BaseState| {
                        b.tail() < 1e-10 && state.tail() > 0.3 * b.tail()
                    });
                    if stalled {
                        break;
                    }
                    previous = Some(state.clone());
                    best = Some(state);
                    if resolved {
                        break;
                    }
                }
                Err(failure) => {
                    last = failure;
                    failures += 1;
                    if failures == MOST_FAILURES {
                        break;
                    }
                }
            }
        }
        best.ok_or(last)
    }

    /// The state at one degree.
    pub fn solve(
        &self,
        start: Option<&BaseState>,
        degree: usize,
        stretch: Stretch,
    ) -> Result<BaseState, Failure> {
        let structure = self.model.structure();
        let (lower, upper) = interval(self.model, self.parameters);
        let offsets = &structure.base.offsets;
        let widest = offsets.columns.iter().copied().max().unwrap_or(0);
        let rows: Vec<Grid> = offsets
            .rows
            .iter()
            .map(|c| Grid::new(GridKind::Gauss(degree + 1 - widest + c)))
            .collect();
        let case = self.parameters.case(structure);
        let all = Grid::new(GridKind::Lobatto(degree + 1));
        let ends = [GridKind::Lower, GridKind::Upper].map(Grid::new);
        let mut columns: Vec<Column> = Vec::new();
        let mut size = 0;
        for (index, &field) in structure.base.solved.iter().enumerate() {
            let count = match offsets.columns.get(index) {
                Some(t) if !structure.fields[field].uniform => degree + 1 - widest + t,
                _ => 1,
            };
            let grid = Grid::new(GridKind::Lobatto(count));
            let to = |points: &Grid| stretched(&grid, points, stretch);
            columns.push(Column {
                first: size,
                rows: rows.iter().map(to).collect(),
                ends: [to(&ends[0]), to(&ends[1])],
                all: to(&all),
                grid,
            });
            size += count;
        }
        let discrete = Discrete {
            newton: self,
            degree,
            stretch,
            lower,
            upper,
            case,
            columns,
            size,
            rows,
        };
        discrete.iterate(discrete.initial(start))
    }
}

impl Discrete<'_> {
    fn model(&self) -> &dyn Model {
        self.newton.model
    }

    fn initial(&self, start: Option<&BaseState>) -> Vec<f64> {
        let structure = self.model().structure();
        let template = self.state(&vec![0.0; self.size], 0.0);
        let mut values = Vec::with_capacity(self.size);
        for (s, (column, &field)) in self.columns.iter().zip(&structure.base.solved).enumerate() {
            for &eta in &column.grid.nodes {
                let xi = self.stretch.xi(eta);
                values.push(match start {
                    Some(state) => {
                        state.point(self.model(), xi, 0.0)[structure.base_position(field, 0)]
                    }
                    None => {
                        let point = template.point(self.model(), xi, 0.0);
                        evaluate(self.model(), KernelId::Guess, &point)[s]
                    }
                });
            }
        }
        values
    }

    fn state(&self, values: &[f64], residual: f64) -> BaseState {
        let own = |column: &Column| &values[column.first..][..column.grid.len()];
        // Newton's method itself reads a first derivative.
        let order = self.model().structure().base_order.max(1);
        BaseState {
            parameters: self.newton.parameters.clone(),
            case: self.case,
            lower: self.lower,
            upper: self.upper,
            degree: self.degree,
            stretch: self.stretch,
            series: self
                .columns
                .iter()
                .map(|c| Series::new(coefficients(own(c)), order))
                .collect(),
            residual,
        }
    }

    /// Residual and Jacobian, each row scaled by the size of its entries.
    fn system(&self, values: &[f64]) -> Option<(Vec<f64>, Mat<f64>)> {
        let model = self.model();
        let structure = model.structure();
        let state = self.state(values, 0.0);
        let mut rows: Vec<(f64, Vec<f64>)> = Vec::with_capacity(self.size);
        // One run of the kernel gives all rows: those of one grid share it.
        let mut outputs: Vec<(usize, Vec<Vec<f64>>)> = Vec::new();
        for grid in &self.rows {
            if !outputs.iter().any(|(points, _)| *points == grid.len()) {
                let at = |&eta: &f64| {
                    let point = state.point(model, self.stretch.xi(eta), 0.0);
                    evaluate(model, KernelId::Base, &point)
                };
                outputs.push((grid.len(), grid.nodes.iter().map(at).collect()));
            }
        }
        for (index, row) in structure.base.rows.iter().enumerate() {
            let points = self.rows[index].len();
            let own = outputs.iter().find(|(count, _)| *count == points);
            for (i, out) in own.into_iter().flat_map(|(_, out)| out).enumerate() {
                let Linearised { value, slopes } = read_base_row(&structure.base.rows, index, out);
                rows.push((
                    value,
                    self.jacobian_row(&row.jets, &slopes, |column| &column.rows[index], i),
                ));
            }
        }
        let case = &structure.cases[self.case];
        for end in End::BOTH {
            let side = usize::from(end == End::Upper);
            let point = state.at_end(model, end);
            let out = evaluate(model, KernelId::BaseConditions(self.case), &point);
            for (jets, Linearised { value, slopes }) in read_base_conditions(case, end, &out) {
                rows.push((
                    value,
                    self.jacobian_row(jets, &slopes, |column| &column.ends[side], 0),
                ));
            }
        }
        self.integral_rows(&state, &mut rows);
        if rows.len() != self.size {
            return None;
        }
        let mut residual = Vec::with_capacity(self.size);
        let mut jacobian = Mat::<f64>::zeros(self.size, self.size);
        for (i, (value, row)) in rows.into_iter().enumerate() {
            let size = row.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            if !size.is_finite() || !value.is_finite() || size == 0.0 {
                return None;
            }
            residual.push(value / size);
            for (j, entry) in row.into_iter().enumerate() {
                jacobian[(i, j)] = entry / size;
            }
        }
        Some((residual, jacobian))
    }

    fn integral_rows(&self, state: &BaseState, rows: &mut Vec<(f64, Vec<f64>)>) {
        let model = self.model();
        let structure = model.structure();
        let weights = clenshaw_curtis(self.degree + 1);
        let half = 0.5 * (self.upper - self.lower);
        let integrals = &structure.base.integrals;
        for (index, jets) in integrals.iter().enumerate() {
            let (mut total, mut row) = (0.0, vec![0.0; self.size]);
            let all = Grid::new(GridKind::Lobatto(self.degree + 1));
            for (i, &eta) in all.nodes.iter().enumerate() {
                let xi = self.stretch.xi(eta);
                let out = evaluate(model, KernelId::BaseIntegrals, &state.point(model, xi, 0.0));
                let (Linearised { value, slopes }, prescribed) =
                    read_integral(integrals, index, &out);
                let weight = weights[i] * half / self.stretch.taylor(xi, 1)[0];
                total += weight * value;
                if i == 0 {
                    total -= prescribed;
                }
                for (entry, slope) in
                    row.iter_mut()
                        .zip(self.jacobian_row(jets, &slopes, |column| &column.all, i))
                {
                    *entry += weight * slope;
                }
            }
            rows.push((total, row));
        }
    }

    fn jacobian_row(
        &self,
        jets: &[BaseJet],
        slopes: &[f64],
        matrices: impl Fn(&Column) -> &Matrices,
        i: usize,
    ) -> Vec<f64> {
        let structure = self.model().structure();
        let scale = 2.0 / (self.upper - self.lower);
        let mut row = vec![0.0; self.size];
        for (jet, &slope) in jets.iter().zip(slopes) {
            let Some(s) = structure.base.solved.iter().position(|&f| f == jet.field) else {
                continue;
            };
            let column = &self.columns[s];
            let Some(matrix) = matrices(column).get(jet.order) else {
                continue;
            };
            let factor = slope * scale.powi(jet.order as i32);
            for j in 0..column.grid.len() {
                row[column.first + j] += factor * matrix[(i, j)];
            }
        }
        row
    }

    /// Whether a trial keeps the declared ranges, by values at the nodes.
    fn admissible(&self, values: &[f64]) -> bool {
        let structure = self.model().structure();
        structure
            .base
            .solved
            .iter()
            .zip(&self.columns)
            .all(|(&field, column)| {
                let info = &structure.fields[field];
                // Too low a degree carries a profile that dies out a little below zero.
                let slack = 1e-6;
                values[column.first..][..column.grid.len()]
                    .iter()
                    .all(|&v| v > info.lower - slack && v < info.upper + slack)
            })
    }

    /// A solution of the system, or its assembly: either counts as the cube of its unknowns.
    fn spend(&self) -> Result<(), Failure> {
        let left = self.newton.left.get() - (self.size as f64).powi(3);
        self.newton.left.set(left);
        if left < 0.0 {
            return Err(Failure::Spent);
        }
        Ok(())
    }

    fn iterate(&self, mut values: Vec<f64>) -> Result<BaseState, Failure> {
        let (mut residual, mut jacobian) = self.system(&values).ok_or(Failure::NotFinite)?;
        let norm = |r: &[f64]| r.iter().map(|x| x * x).sum::<f64>().sqrt();
        let mut size = norm(&residual);
        for _ in 0..MOST_ITERATIONS {
            self.spend()?;
            let right = Mat::from_fn(self.size, 1, |i, _| -residual[i]);
            let step = jacobian.partial_piv_lu().solve(&right);
            let reach = (0..self.size)
                .map(|i| step[(i, 0)].abs())
                .fold(0.0, f64::max);
            let scale = values.iter().fold(1e-300_f64, |m, v| m.max(v.abs()));
            if !reach.is_finite() {
                return Err(Failure::NotFinite);
            }
            let mut damping = 1.0;
            loop {
                self.spend()?;
                let trial: Vec<f64> = values
                    .iter()
                    .enumerate()
                    .map(|(i, v)| v + damping * step[(i, 0)])
                    .collect();
                let outcome = if self.admissible(&trial) {
                    self.system(&trial)
                } else {
                    None
                };
                if let Some((new_residual, new_jacobian)) = outcome {
                    let new_size = norm(&new_residual);
                    // Near the solution rounding may keep the residual from falling.
                    let settled = reach < CONVERGED * scale;
                    if new_size <= (1.0 - 0.25 * damping) * size || settled {
                        (values, residual, jacobian, size) =
                            (trial, new_residual, new_jacobian, new_size);
                        if settled {
                            return Ok(self.state(&values, size));
                        }
                        break;
                    }
                }
                damping *= 0.5;
                if damping < SMALLEST_DAMPING {
                    return Err(Failure::Damping { residual: size });
                }
            }
        }
        Err(Failure::Iterations { residual: size })
    }
}
