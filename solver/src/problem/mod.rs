//! The collocated linear problems of a model around one base state: direct and adjoint.
//!
//! Coefficients are evaluated once a base state; a matrix for any wavenumber is then a sum of scaled
//! differentiation matrices. Where the model has the mirror symmetry x → −x, unknowns are kept in
//! the basis in which every matrix is real (odd fields divided by i).

mod basis;
mod block;
mod claim;
mod closure;
mod conditions;
mod disturbed;
mod linear;
mod mirror;
mod presence;

pub use basis::{Profile, Turn, Turned};
pub use block::Blocks;
pub use closure::Border;
pub use linear::{Adjoint, Combination, Direct, LinearProblem, WallRow, symbol};
pub use mirror::Solver;
pub use presence::Sources;

use crate::base::BaseState;
use crate::error::{Error, Result};
use crate::model::layout::read_measure;
use crate::model::{
    BalanceId, C64, ClosureKind, FieldId, Id, Jet, KernelId, Measure, Model, Structure, Table,
    TermInfo, evaluate,
};
use crate::numerics::Noise;
use crate::numerics::dense::Scalar;
use crate::space::{Layout, Place, Points, Space};
use crate::wavevector::WaveVector;
use faer::Mat;
use linear::{CollocatedTerm, bordered_by, with_borders};
use std::sync::{Arc, OnceLock};

/// Everything about one base state that does not depend on the wavenumber.
pub struct Problem {
    /// What the perturbation is a perturbation of.
    pub base: Arc<BaseState>,
    /// M; nothing without a cross-stream coordinate.
    pub resolution: Option<usize>,
    /// L, M0 and the boundary conditions.
    pub direct: Direct,
    /// The separately discretised adjoint, made when first asked for.
    adjoint: OnceLock<Result<Adjoint>>,
    /// Bordering of the direct problem at k = 0.
    pub borders: Vec<Border>,
    /// Coefficients of N2, N3 at the points of each row: `[row][point][coefficient]`; shared by rows of the same points.
    pub nonlinear: Table<BalanceId, Arc<Vec<Vec<f64>>>>,
    /// Quadratic form of the normalisation, by weighted field: Dᵀ diag(weights) D on its unknowns.
    pub gram: Vec<Mat<f64>>,
    /// What its data are multiplied by, to show the effect of rounding.
    pub(crate) noise: Option<Noise>,
}

/// Point states of a base state at the points of families, computed once for each family.
struct States<'b> {
    base: &'b BaseState,
    space: &'b Space,
    /// Families that have been computed, each with its point states, `[point][element]`.
    computed: Vec<(Points, Vec<Vec<f64>>)>,
}

impl<'b> States<'b> {
    fn new(base: &'b BaseState, space: &'b Space) -> Self {
        States {
            base,
            space,
            computed: Vec::new(),
        }
    }

    /// Point states at a family, `[point][element]`.
    fn at(&mut self, points: Points) -> &[Vec<f64>] {
        let position = self
            .computed
            .iter()
            .position(|(family, _)| *family == points);
        let position = position.unwrap_or_else(|| {
            let places = self.space.places(points).into_iter();
            let states = places
                .map(|place| self.base.at(place, WaveVector::MEAN))
                .collect();
            self.computed.push((points, states));
            self.computed.len() - 1
        });
        &self.computed[position].1
    }

    /// A kernel at all points of a family, `[point][output]`.
    fn run(&mut self, kernel: KernelId, points: Points) -> Vec<Vec<f64>> {
        let model = self.base.model.clone();
        let states = self.at(points).iter();
        states
            .map(|p| evaluate(model.as_ref(), kernel, p))
            .collect()
    }
}

impl Problem {
    /// Collocates the operators around `base` with M = `resolution`, where there is a cross-stream coordinate.
    ///
    /// # Errors
    /// A coefficient that is not finite at some point.
    pub fn new(base: &Arc<BaseState>, resolution: Option<usize>) -> Result<Self> {
        let space = base.space.plain();
        let resolution = resolution.filter(|_| !space.is_point());
        let mut states = States::new(base, &space);
        let direct = linear(&mut states, resolution)?;
        let borders = closure::direct(base, &space, &direct.layout);
        let mut nonlinear = direct.layout.rows.map(|_| Arc::default());
        for (points, rows) in direct.layout.groups() {
            let coefficients = Arc::new(states.run(KernelId::Nonlinear, points));
            rows.iter()
                .for_each(|&row| nonlinear[row] = coefficients.clone());
        }
        let mut problem = Problem {
            gram: gram(base, &space, &direct.layout, resolution),
            base: base.clone(),
            resolution,
            direct,
            adjoint: OnceLock::new(),
            borders,
            nonlinear,
            noise: None,
        };
        let ids = problem.direct.layout.rows.ids();
        let size = |row| {
            median(
                problem
                    .direct
                    .term_sizes(row, WaveVector::MEAN, |jet| jet.t == 0),
            )
        };
        let sizes: Table<BalanceId, f64> = ids.map(size).collect();
        for border in &mut problem.borders {
            border.balance(&problem.direct.layout, &sizes);
        }
        problem.recognise_claims()?;
        Ok(problem)
    }

    /// L, M0 and the boundary conditions alone.
    ///
    /// # Errors
    /// As [`Problem::new`].
    pub fn linear(base: &BaseState, resolution: Option<usize>) -> Result<Direct> {
        let space = base.space.plain();
        let resolution = resolution.filter(|_| !space.is_point());
        linear(&mut States::new(base, &space), resolution)
    }

    /// The adjoint problem, discretised from L† itself and not by transposing the direct one.
    ///
    /// # Errors
    /// The model has no adjoint boundary conditions; the message says why.
    pub fn adjoint(&self) -> Result<&Adjoint> {
        let made = self.adjoint.get_or_init(|| self.discretised_adjoint());
        made.as_ref().map_err(Clone::clone)
    }

    fn discretised_adjoint(&self) -> Result<Adjoint> {
        let structure = self.structure();
        let space = self.space().clone();
        let walls = conditions::adjoint(&self.base).map_err(Error::Computation)?;
        let layout = Layout::staggered(&structure.adjoint_offsets, self.resolution)?;
        let (row_turns, column_turns) = turns(structure);
        let mut states = States::new(&self.base, &space);
        let name = |row: FieldId| format!("{}†", structure.fields[row].name);
        Ok(LinearProblem {
            terms: terms(
                &mut states,
                &layout,
                &structure.adjoint,
                KernelId::Adjoint,
                name,
            )?,
            walls,
            column_turns,
            row_turns,
            layout,
            space,
        })
    }

    /// The model, whose kernels compute all coefficients.
    pub fn model(&self) -> &dyn Model {
        self.base.model.as_ref()
    }

    /// The names, fields, balances and terms that the kernels' outputs stand for.
    pub fn structure(&self) -> &Structure {
        self.base.structure()
    }

    /// The interval, or point, on which it is collocated.
    pub fn space(&self) -> &Space {
        &self.direct.space
    }

    /// Whether the model has the mirror symmetry: σ M0 − L is then real in the solver's basis for every real σ.
    pub fn is_real(&self) -> bool {
        self.structure().parity.is_some()
    }

    /// A quadrature that is exact for products of two profiles, with the point states at its places.
    pub fn quadrature(&self) -> crate::space::Quadrature {
        let m = self.resolution.unwrap_or(0);
        self.space().quadrature(4 * m + 1)
    }

    /// σ M0 − L, the boundary conditions being rows of L without mass; bordered at k = 0.
    pub fn shifted<T: Scalar>(&self, k: WaveVector, shift: C64) -> Mat<T> {
        let matrix = self.direct.matrix(k, Combination::shifted(shift));
        if k.is_mean() {
            bordered_by(matrix, &self.borders, Border::corner)
        } else {
            matrix
        }
    }

    /// L and M0 at k = 0 with the borders of the closures.
    pub fn bordered_pencil<T: Scalar>(&self) -> (Mat<T>, Mat<T>) {
        with_borders(self.direct.pencil::<T>(WaveVector::MEAN), &self.borders)
    }

    /// L† and M0† at k = 0 with the borders of the closures.
    ///
    /// # Errors
    /// The model has no adjoint boundary conditions, or its closures have no adjoint.
    pub fn bordered_adjoint_pencil<T: Scalar>(&self) -> Result<(Mat<T>, Mat<T>)> {
        let adjoint = self.adjoint()?;
        let kept: Vec<usize> = self.borders.iter().map(|b| b.closure).collect();
        let borders = closure::adjoint(&self.base, &adjoint.space, &adjoint.layout, &kept)?;
        let mut pencil = with_borders(adjoint.pencil(WaveVector::MEAN), &borders);
        // The corner of the direct problem, transposed, in the units of these borders.
        let n = adjoint.layout.size;
        for (j, of) in self.borders.iter().enumerate() {
            for (i, row) in self.borders.iter().enumerate() {
                let entry = of.corner(row) / row.unit;
                pencil.0[(n + i, n + j)] = T::from_complex(C64::new(-entry, 0.0));
            }
        }
        Ok(pencil)
    }

    /// Whether a mean is conserved, declared or not: an envelope then has a second equation.
    pub fn conserves_a_mean(&self) -> bool {
        let conserved =
            |b: &Border| matches!(b.kind, ClosureKind::Conserved | ClosureKind::Claimed);
        self.borders.iter().any(conserved) || !self.undeclared().is_empty()
    }

    /// Conserved integrals that the spec's block `mean` does not declare, as it would name them.
    pub fn undeclared(&self) -> Vec<String> {
        self.model().undeclared(self.base.case)
    }

    /// The rate at which the slowest balance changes its field, in units of eigenvalues: Σ |coefficient| |k|^a (2/h)^d over
    /// the coefficient of the time derivative, the median over the points.
    pub fn rate(&self, k: WaveVector) -> f64 {
        // Only terms in fields whose time derivative the balance holds: the ratio is then a rate whatever the units.
        let rate = self.slowest(k, |row, jet| self.direct.has_mass(row, jet.of));
        if rate.is_finite() {
            rate
        } else {
            self.slowest(k, |_, _| true)
        }
    }

    /// The least rate over the balances, of the terms that are chosen; infinite where no balance has one.
    fn slowest(&self, k: WaveVector, chosen: impl Fn(BalanceId, &Jet) -> bool) -> f64 {
        let rates = self.direct.layout.rows.ids().map(|row| {
            let terms = self
                .direct
                .term_sizes(row, k, |jet| jet.t == 0 && chosen(row, jet));
            let mass = self.direct.term_sizes(row, k, |jet| jet.t > 0);
            let rates = terms.iter().zip(mass).map(|(t, m)| t / m);
            median(rates.filter(|rate| rate.is_finite()).collect())
        });
        rates.filter(|r| *r > 0.0).fold(f64::INFINITY, f64::min)
    }
}

/// L, M0 and the boundary conditions around the base state of `states`.
fn linear(states: &mut States, resolution: Option<usize>) -> Result<Direct> {
    let (base, space) = (states.base, states.space.clone());
    let structure = base.structure();
    let layout = Layout::staggered(&structure.offsets, resolution)?;
    let (column_turns, row_turns) = turns(structure);
    Ok(LinearProblem {
        walls: conditions::direct(base),
        terms: terms(
            states,
            &layout,
            &structure.linear,
            KernelId::Linear,
            |row| structure.balances[row].clone(),
        )?,
        column_turns,
        row_turns,
        space,
        layout,
    })
}

/// The middle one of some values; zero where there is none.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

/// Odd fields are i times real numbers, odd rows give i times real numbers.
fn turns(structure: &Structure) -> (Table<FieldId, Turn>, Table<BalanceId, Turn>) {
    match &structure.parity {
        None => (
            structure.fields.map(|_| Turn::default()),
            structure.balances.map(|_| Turn::default()),
        ),
        Some(parity) => (
            parity.fields.map(|&odd| Turn::of(odd)),
            parity.rows.map(|&odd| Turn::of(odd)),
        ),
    }
}

/// The terms of an operator with their coefficients at the points of their rows; `name` says what a row is.
fn terms<Row: Id, Column: Id>(
    states: &mut States,
    layout: &Layout<Row, Column>,
    infos: &[TermInfo<Row, Column>],
    kernel: KernelId,
    name: impl Fn(Row) -> String,
) -> Result<Vec<CollocatedTerm<Row, Column>>> {
    let mut terms: Vec<CollocatedTerm<Row, Column>> = infos
        .iter()
        .map(|info| CollocatedTerm {
            row: info.row,
            jet: info.jet,
            coefficients: Vec::new(),
            largest: 0.0,
        })
        .collect();
    for (points, rows) in layout.groups() {
        let values = states.run(kernel, points);
        let terms = terms.iter_mut().enumerate();
        for (index, term) in terms.filter(|(_, term)| rows.contains(&term.row)) {
            term.coefficients = values.iter().map(|v| v[index]).collect();
            let sizes = term.coefficients.iter().map(|c| c.abs());
            term.largest = sizes.fold(0.0, f64::max);
            if let Some(bad) = term.coefficients.iter().position(|c| !c.is_finite()) {
                let place: Place = states.space.places(points)[bad];
                let coordinate = states.base.structure().coordinate.as_deref();
                return Err(Error::Singular {
                    balance: name(term.row),
                    coordinate: coordinate.unwrap_or("y").to_owned(),
                    place: states.space.y(place),
                });
            }
        }
    }
    Ok(terms)
}

/// ∫ w|q|² dy of each weighted field as a quadratic form, exact for polynomial weights up to M.
fn gram(
    base: &BaseState,
    space: &Space,
    layout: &Layout<BalanceId, FieldId>,
    resolution: Option<usize>,
) -> Vec<Mat<f64>> {
    let amplitude = &base.structure().amplitude;
    if amplitude.weighted.is_empty() {
        return Vec::new();
    }
    let quadrature = space.quadrature(3 * resolution.unwrap_or(0) + 1);
    let weights = |&(place, measure): &(Place, f64)| {
        let out = evaluate(
            base.model.as_ref(),
            KernelId::Amplitude,
            &base.at(place, WaveVector::MEAN),
        );
        match read_measure(amplitude, &out) {
            Measure::Integral { weights, .. } => weights.iter().map(|w| measure * w).collect(),
            Measure::Point { .. } => Vec::new(),
        }
    };
    let weights: Vec<Vec<f64>> = quadrature.nodes.iter().map(weights).collect();
    let form = |(position, &field): (usize, &FieldId)| {
        let column = &layout.columns[field];
        let values = space.derivative(column.points, quadrature.points, 0);
        let values = values.matrix(column.len);
        let weighted = Mat::from_fn(values.nrows(), values.ncols(), |i, j| {
            values[(i, j)] * weights[i][position]
        });
        values.transpose() * &weighted
    };
    amplitude.weighted.iter().enumerate().map(form).collect()
}
