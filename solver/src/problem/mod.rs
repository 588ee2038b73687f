//! The collocated linear problems of a model around one base state: direct and adjoint.
//!
//! Coefficients are evaluated once a base state; a matrix for any wavenumber is then a sum of scaled
//! differentiation matrices. Where the model has the mirror symmetry x → −x, unknowns are kept in
//! the basis in which every matrix is real (odd fields divided by i).

mod assemble;
mod block;
mod claim;
mod closure;
mod conditions;
mod mirror;

pub use assemble::Combination;
pub use block::Blocks;
pub use closure::Border;
pub use conditions::WallRow;
pub use mirror::Solver;

use crate::base::BaseState;
use crate::collocation::{Discretisation, Grid, GridKind, Layout, clenshaw_curtis};
use crate::error::{Error, Result};
use crate::model::layout::read_measure;
use crate::model::{C64, Jet, KernelId, Measure, Model, OffsetsInfo, Structure, evaluate};
use faer::Mat;
use std::sync::OnceLock;

/// Direct or adjoint linear problem: terms with coefficients at their rows' points.
pub struct LinearProblem {
    /// Where unknowns and equations stand.
    pub layout: Layout,
    /// Row, jet (field = column) and coefficient at each point of the row.
    terms: Vec<(usize, Jet, Vec<f64>)>,
    /// The boundary conditions.
    pub walls: Vec<WallRow>,
    /// Quarter turns of columns and rows that make matrices real; zeros without the symmetry.
    column_turns: Vec<usize>,
    row_turns: Vec<usize>,
}

/// Everything about one base state that does not depend on the wavenumber.
pub struct Problem<'m> {
    /// The kernels.
    pub model: &'m dyn Model,
    /// What the perturbation is a perturbation of.
    pub base: &'m BaseState,
    /// M; 0 without a cross-stream coordinate.
    pub resolution: usize,
    /// Differentiation matrices.
    pub discretisation: &'m Discretisation,
    /// L, M0 and the boundary conditions.
    pub direct: LinearProblem,
    /// The separately discretised adjoint, made when first asked for.
    adjoint: OnceLock<Result<LinearProblem>>,
    /// Bordering of the direct problem at k = 0.
    pub borders: Vec<Border>,
    /// Coefficients of N2, N3 at the points of each row: `[row][point][coefficient]`.
    pub nonlinear: Vec<Vec<Vec<f64>>>,
    /// Quadratic form of the normalisation, by weighted field: Dᵀ diag(weights) D on its unknowns.
    pub gram: Vec<Mat<f64>>,
}

/// Point states at the nodes of a grid, computed once a grid.
struct Points<'m> {
    model: &'m dyn Model,
    base: &'m BaseState,
    known: Vec<(GridKind, Vec<Vec<f64>>)>,
}

impl Points<'_> {
    fn at(&mut self, grid: GridKind) -> &[Vec<f64>] {
        let position = match self.known.iter().position(|(kind, _)| *kind == grid) {
            Some(position) => position,
            None => {
                let nodes = Grid::new(grid).nodes;
                let states = nodes
                    .iter()
                    .map(|&xi| self.base.point(self.model, xi, 0.0))
                    .collect();
                self.known.push((grid, states));
                self.known.len() - 1
            }
        };
        &self.known[position].1
    }
}

impl<'m> Problem<'m> {
    /// Collocates the operators around `base` with M = `resolution`.
    ///
    /// # Errors
    /// A coefficient that is not finite at some point.
    pub fn new(
        model: &'m dyn Model,
        base: &'m BaseState,
        discretisation: &'m Discretisation,
        resolution: usize,
    ) -> Result<Self> {
        let mut points = Points {
            model,
            base,
            known: Vec::new(),
        };
        let direct = Self::direct(&mut points, resolution)?;
        let borders = closure::direct(model, base, &direct.layout, discretisation);
        let mut nonlinear: Vec<Vec<Vec<f64>>> = Vec::new();
        for (row, block) in direct.layout.rows.iter().enumerate() {
            let twin = direct.layout.rows[..row]
                .iter()
                .position(|b| b.grid == block.grid);
            nonlinear.push(match twin {
                Some(twin) => nonlinear[twin].clone(),
                None => {
                    let states = points.at(block.grid).iter();
                    states
                        .map(|p| evaluate(model, KernelId::Nonlinear, p))
                        .collect()
                }
            });
        }
        let gram = gram(model, base, &direct.layout, discretisation, resolution);
        let adjoint = OnceLock::new();
        let mut problem = Problem {
            model,
            base,
            resolution,
            discretisation,
            direct,
            adjoint,
            borders,
            nonlinear,
            gram,
        };
        let sizes: Vec<f64> = (0..problem.direct.layout.rows.len())
            .map(|row| median(problem.term_sizes(row, 0.0, |jet| jet.t == 0)))
            .collect();
        for border in &mut problem.borders {
            border.balance(&problem.direct.layout, &sizes);
        }
        problem.recognise_claims();
        Ok(problem)
    }

    /// The adjoint problem, discretised on its own.
    ///
    /// # Errors
    /// Why the model has no adjoint boundary conditions.
    pub fn adjoint(&self) -> Result<&LinearProblem> {
        let made = self.adjoint.get_or_init(|| {
            let mut points = Points {
                model: self.model,
                base: self.base,
                known: Vec::new(),
            };
            Self::adjoint_problem(&mut points, self.resolution)
        });
        made.as_ref().map_err(Clone::clone)
    }

    fn direct(points: &mut Points, resolution: usize) -> Result<LinearProblem> {
        let (model, base) = (points.model, points.base);
        let structure = model.structure();
        let walls = conditions::direct(model, base);
        let layout = layout(structure, &structure.offsets, resolution)?;
        let (column_turns, row_turns) = turns(structure);
        let terms = terms(points, &layout, KernelId::Linear)?;
        Ok(LinearProblem::new(
            layout,
            terms,
            walls,
            column_turns,
            row_turns,
        ))
    }

    fn adjoint_problem(points: &mut Points, resolution: usize) -> Result<LinearProblem> {
        let (model, base) = (points.model, points.base);
        let structure = model.structure();
        let walls = conditions::adjoint(model, base).map_err(Error::Computation)?;
        let layout = layout(structure, &structure.adjoint_offsets, resolution)?;
        let (column_turns, row_turns) = turns(structure);
        let terms = terms(points, &layout, KernelId::Adjoint)?;
        Ok(LinearProblem::new(
            layout,
            terms,
            walls,
            row_turns,
            column_turns,
        ))
    }

    /// What the kernels are about.
    pub fn structure(&self) -> &Structure {
        self.model.structure()
    }

    /// Whether matrices are real wherever the shift is.
    pub fn is_real(&self) -> bool {
        self.structure().parity.is_some()
    }

    /// Physical values of the unknowns from those in the solver's basis.
    pub fn physical<T: crate::dense::Scalar>(&self, x: &[T]) -> Vec<C64> {
        let mut values = vec![C64::new(0.0, 0.0); self.direct.layout.size];
        for (block, &turn) in self
            .direct
            .layout
            .columns
            .iter()
            .zip(&self.direct.column_turns)
        {
            for i in block.offset..block.offset + block.len {
                values[i] = x[i].complex() * quarter_turn(turn);
            }
        }
        values
    }

    /// Physical values in the solver's basis.
    pub fn solver_basis(&self, values: &[C64]) -> Vec<C64> {
        let mut turned = values.to_vec();
        let turns = self.direct.column_turns.iter();
        for (block, &turn) in self.direct.layout.columns.iter().zip(turns) {
            for value in &mut turned[block.offset..block.offset + block.len] {
                *value *= quarter_turn(4 - turn);
            }
        }
        turned
    }

    /// The rate at which the balance of slowest terms changes its field: Σ |coefficient| |k|^a (2/h)^d over the
    /// mass, a median over the points.
    pub fn rate(&self, k: f64) -> f64 {
        let rates = (0..self.direct.layout.rows.len()).map(|row| {
            // Terms of the fields whose time derivative the balance holds: others have units of their own.
            let own = |jet: Jet| {
                let mut mass = self.direct.terms.iter().filter(|(r, ..)| *r == row);
                mass.any(|(_, other, _)| other.t > 0 && other.field == jet.field)
            };
            let terms = self.term_sizes(row, k, |jet| jet.t == 0 && own(jet));
            let mass = self.term_sizes(row, k, |jet| jet.t > 0);
            let rates = terms.iter().zip(mass).map(|(t, m)| t / m);
            median(rates.filter(|rate| rate.is_finite()).collect())
        });
        rates.filter(|r| *r > 0.0).fold(f64::INFINITY, f64::min)
    }

    /// Σ |coefficient| |k|^a (2/h)^d over the chosen terms of a row, at each of its points.
    fn term_sizes(&self, row: usize, k: f64, chosen: impl Fn(Jet) -> bool) -> Vec<f64> {
        let mut sums = vec![0.0; self.direct.layout.rows[row].len];
        let own = self.direct.terms.iter().filter(|(r, ..)| *r == row);
        for (_, jet, coefficients) in own.filter(|(_, jet, _)| chosen(*jet)) {
            let size =
                k.abs().powi(i32::from(jet.x + jet.absx)) * self.scale().powi(i32::from(jet.y));
            for (sum, c) in sums.iter_mut().zip(coefficients) {
                *sum += c.abs() * size;
            }
        }
        sums
    }

    /// dξ/dy, or 1 without a cross-stream coordinate.
    pub fn scale(&self) -> f64 {
        if self.resolution == 0 {
            1.0
        } else {
            self.base.scale()
        }
    }
}

/// The middle value, or zero of none.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

/// i^turns
pub fn quarter_turn(turns: usize) -> C64 {
    match turns % 4 {
        0 => C64::new(1.0, 0.0),
        1 => C64::new(0.0, 1.0),
        2 => C64::new(-1.0, 0.0),
        _ => C64::new(0.0, -1.0),
    }
}

fn layout(structure: &Structure, offsets: &OffsetsInfo, resolution: usize) -> Result<Layout> {
    let resolution = structure.coordinate.is_some().then_some(resolution);
    Layout::new(offsets, resolution)
}

/// Odd fields are i times real numbers, odd rows give i times real numbers.
fn turns(structure: &Structure) -> (Vec<usize>, Vec<usize>) {
    let profiles = structure.profiles();
    match &structure.parity {
        None => (vec![0; structure.fields.len()], vec![0; profiles]),
        Some(parity) => {
            let turns = |odd: &Vec<bool>| odd.iter().map(|&o| usize::from(o)).collect();
            (turns(&parity.fields), turns(&parity.rows))
        }
    }
}

fn terms(
    points: &mut Points,
    layout: &Layout,
    kernel: KernelId,
) -> Result<Vec<(usize, Jet, Vec<f64>)>> {
    let (model, base) = (points.model, points.base);
    let structure = model.structure();
    let infos = if kernel == KernelId::Linear {
        &structure.linear
    } else {
        &structure.adjoint
    };
    let mut terms: Vec<(usize, Jet, Vec<f64>)> =
        infos.iter().map(|t| (t.row, t.jet, Vec::new())).collect();
    let mut cache: Vec<(GridKind, Vec<Vec<f64>>)> = Vec::new();
    for (row, block) in layout.rows.iter().enumerate() {
        if !cache.iter().any(|(kind, _)| *kind == block.grid) {
            let states = points.at(block.grid).iter();
            let values: Vec<Vec<f64>> = states.map(|p| evaluate(model, kernel, p)).collect();
            cache.push((block.grid, values));
        }
        let Some((_, values)) = cache.iter().find(|(kind, _)| *kind == block.grid) else {
            continue;
        };
        for (index, term) in terms.iter_mut().enumerate().filter(|(_, t)| t.0 == row) {
            term.2 = values.iter().map(|v| v[index]).collect();
            if let Some(bad) = term.2.iter().position(|c| !c.is_finite()) {
                let xi = Grid::new(block.grid).nodes[bad];
                return Err(Error::computation(format!(
                    "a coefficient of the balance `{}` is not finite at {} = {}: a law is singular at the base state there",
                    structure.balances.get(row).map_or("", String::as_str),
                    structure.coordinate.as_deref().unwrap_or("y"),
                    base.y(xi)
                )));
            }
        }
    }
    Ok(terms)
}

/// ∫ w|q|² dy of each weighted field as a quadratic form, exact for polynomial weights up to M.
fn gram(
    model: &dyn Model,
    base: &BaseState,
    layout: &Layout,
    discretisation: &Discretisation,
    resolution: usize,
) -> Vec<Mat<f64>> {
    let amplitude = &model.structure().amplitude;
    let fields = &amplitude.weighted;
    let (grid, half) = match resolution {
        0 => (GridKind::Point, 0.5),
        m => (
            GridKind::Lobatto(3 * m + 1),
            0.5 * (base.upper - base.lower),
        ),
    };
    if fields.is_empty() {
        return Vec::new();
    }
    let nodes = Grid::new(grid).nodes;
    let quadrature = clenshaw_curtis(nodes.len());
    let weights: Vec<Vec<f64>> = nodes
        .iter()
        .map(|&xi| {
            let out = evaluate(model, KernelId::Amplitude, &base.point(model, xi, 0.0));
            match read_measure(amplitude, &out) {
                Measure::Integral { weights, .. } => weights,
                Measure::Point { .. } => Vec::new(),
            }
        })
        .collect();
    let form = |(position, &field): (usize, &usize)| {
        let values = discretisation.matrix(layout.columns[field].grid, grid, 0);
        let weighted = Mat::from_fn(values.nrows(), values.ncols(), |i, j| {
            values[(i, j)] * quadrature[i] * half * weights[i][position]
        });
        values.transpose() * &weighted
    };
    fields.iter().enumerate().map(form).collect()
}
