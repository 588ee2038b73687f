//! Solves [σ M0 − L_q] X = G for one coefficient of the expansion. The system is bordered where q carries a mode with
//! an amplitude, and closed by the model's block `mean` where q = 0.

use super::mode::Mode;
use crate::error::{Error, Result};
use crate::model::{C64, ClosureKind, FieldId};
use crate::numerics::dense::{Scalar, bordered, norm, scalars};
use crate::problem::{Border, Problem, Profile, Solver, Sources, Turned};
use crate::series::Arithmetic;
use crate::space::Block;
use crate::wavevector::WaveVector;
use faer::Mat;

/// The multiplier of a closure at q = 0: how far the balances are from keeping what the closure says.
#[derive(Clone, Debug)]
pub struct Multiplier {
    /// What is closed: `conserved n`, `gauge p`.
    pub closure: String,
    /// Degree in the amplitudes of the mode that it closes.
    pub order: usize,
    /// Its largest contribution to a collocated balance, in the units of that balance.
    pub size: f64,
    /// Its contribution to the balances over the size of the terms beside it, these taken before they cancel. For a
    /// multiplier that need not vanish, over the size of the forcing.
    pub relative: f64,
    /// Whether it has to vanish; the rate of a gauge that drifts need not.
    pub vanishes: bool,
}

/// Bound of [`Multiplier::relative`] for a multiplier that has to vanish. Relative to the terms of the balances beside
/// it, taken before they cancel. Rounding leaves far less, and a mean that is not conserved far more.
pub const LEFT_OVER: f64 = 1e-6;

/// The error of the largest multiplier that has to vanish and does not. It counts as zero below [`LEFT_OVER`], and below
/// `uncertainty`, the relative error of the coefficient that the mode belongs to. `None` where all vanish.
pub fn multiplier_error(multipliers: &[Multiplier], uncertainty: f64) -> Option<Error> {
    let bound = LEFT_OVER.max(uncertainty);
    let standing = multipliers
        .iter()
        .filter(|m| m.vanishes && (m.relative > bound || m.relative.is_nan()));
    let worst = standing.max_by(|a, b| a.relative.total_cmp(&b.relative))?;
    Some(Error::NotKept {
        closure: worst.closure.clone(),
        order: worst.order,
        relative: worst.relative,
    })
}

/// Right-hand sides of one problem, in the solver's basis.
#[derive(Clone, Debug)]
pub struct RightSide {
    /// G: values in the balances at their points, then in the boundary conditions.
    pub equations: Turned,
    /// Values in the closures at k = 0, one for each border of the problem; empty where all densities are linear.
    pub closures: Vec<C64>,
}

impl RightSide {
    /// A right-hand side of balances and boundary conditions; that of the closures is zero.
    pub fn of_balances(equations: Turned) -> Self {
        RightSide {
            equations,
            closures: Vec::new(),
        }
    }

    /// Refuses a right-hand side that is infinite or NaN.
    ///
    /// # Errors
    /// Its size is out of the range of double precision.
    pub fn check_range(&self) -> Result<()> {
        if norm(&self.equations).is_finite() && norm(&self.closures).is_finite() {
            return Ok(());
        }
        Err(out_of_range())
    }
}

/// The error of products that overflow.
pub fn out_of_range() -> Error {
    Error::computation(
        "products of the mode are out of the range of double precision: choose other units or parameters",
    )
}

/// [σ M0 − L_q] X = G, for one coefficient X of the expansion, in the solver's basis.
///
/// Where q is the wavenumber of resonant modes j, the problem is bordered. Unknowns are then X and the coefficients g_j of
/// their amplitude equations:
///
/// [σ M0 − L_q] X + Σ_j g_j M0 φ_j = G,  ⟨ψ_j, M0 X⟩ = 0
///
/// At q = 0 the closures of the model add a row and a multiplier each, see [`Border`].
pub struct ForcedProblem<'a> {
    /// Wavenumber of X.
    pub q: WaveVector,
    /// σ, in units of c0: the rate at which the amplitudes beside X grow and turn.
    pub sigma: C64,
    /// G with the data of the boundary conditions and of the closures.
    pub forcing: RightSide,
    /// Whether the modes with amplitudes are real vectors of the solver's basis.
    pub arithmetic: Arithmetic,
    /// Order of X in the amplitudes.
    pub order: usize,
    /// Whether X is the coefficient of a product of |z_j|², and so equals its conjugate.
    pub is_real: bool,
    /// Column M0 φ_j and row M0ᴴ ψ_j of every resonant mode.
    pub borders: &'a [(Turned, Turned)],
    /// G with weights on all jets, which keep its terms from cancelling; asked for where a multiplier looks large.
    pub uncancelled: &'a dyn Fn() -> Option<Turned>,
}

/// The solution of a [`ForcedProblem`].
pub struct Response {
    /// X, with its time derivative σ X and what drifts.
    pub mode: Mode,
    /// g_j, one for each resonant mode.
    pub coefficients: Vec<C64>,
    /// Multipliers of the closures at q = 0; those of unknown numbers stand in the mode.
    pub multipliers: Vec<Multiplier>,
    solver: AnySolver,
}

/// A factorised problem in real or in complex arithmetic.
enum AnySolver {
    Real(Solver<f64>),
    Complex(Solver<C64>),
}

/// Scalars for which [`AnySolver`] has a variant.
trait Kept: Scalar {
    fn kept(solver: Solver<Self>) -> AnySolver;
}

impl Kept for f64 {
    fn kept(solver: Solver<f64>) -> AnySolver {
        AnySolver::Real(solver)
    }
}

impl Kept for C64 {
    fn kept(solver: Solver<C64>) -> AnySolver {
        AnySolver::Complex(solver)
    }
}

/// The arithmetic of an expansion whose modes have these eigenvalues.
///
/// In a model with the mirror symmetry every mode of a steady pattern is its mirror image, and is a real vector of the
/// solver's basis. A wave is not its mirror image, and drives a mean flow along x.
pub fn arithmetic(problem: &Problem, rates: &[C64]) -> Arithmetic {
    if problem.is_real() && rates.iter().all(|c| c.im == 0.0) {
        Arithmetic::Real
    } else {
        Arithmetic::Complex
    }
}

/// Multipliers, drifts and unknown numbers among the unknowns of a problem at q = 0.
#[derive(Default)]
struct Closed {
    multipliers: Vec<Multiplier>,
    drift: Option<Profile>,
    numbers: Vec<(FieldId, C64)>,
}

impl ForcedProblem<'_> {
    /// The arithmetic in which the problem is solved.
    fn arithmetic(&self, problem: &Problem) -> Arithmetic {
        // Without the mirror symmetry the solver's basis is physical, in which a mean of |z|² is real.
        if self.q.is_mean() && self.is_real && !problem.is_real() {
            Arithmetic::Real
        } else {
            self.arithmetic
        }
    }

    /// Whether X is the mean of a steady pattern. With the mirror symmetry it then has an even part alone.
    fn is_steady_mean(&self) -> bool {
        self.q.is_mean() && self.is_real && self.arithmetic == Arithmetic::Real
    }

    /// X and the g_j; `None` where the problem is singular.
    pub fn solve(self, problem: &Problem) -> Option<Response> {
        match self.arithmetic(problem) {
            Arithmetic::Real => self.solve_as::<f64>(problem),
            Arithmetic::Complex => self.solve_as::<C64>(problem),
        }
    }

    fn solve_as<T: Kept>(self, problem: &Problem) -> Option<Response> {
        // Unknowns: n values of X, then the multipliers of the closures to `closed`, then the g_j.
        let n = problem.direct.layout.size;
        let matrix = problem.shifted::<T>(self.q, self.sigma);
        let closed = matrix.nrows();
        let right = self.right_side::<T>(n, closed);
        let solver = self.factorised(problem, matrix);
        let solution = solver.solve(&right)?;

        // Fields that no row needs hold rounding noise alone, and are set to zero.
        let RightSide {
            equations,
            closures,
        } = &self.forcing;
        let mut sources = Sources::forcing(problem, equations, closures);
        for ((column, _), g) in self.borders.iter().zip(&solution[closed..]) {
            sources.add(problem, column, g.size());
        }
        for (border, value) in problem.borders.iter().zip(&solution[n..closed]) {
            sources.add_border(problem, border, value.size());
        }
        let mut values = Turned(solution[..n].to_vec()).complex();
        problem.clear_absent(self.q, self.sigma, &mut values, sources);

        // ∂t X = σ X + drift
        let Closed {
            multipliers,
            drift,
            numbers,
        } = self.closed(problem, &solution[..n], &solution[n..closed]);
        let values = problem.direct.physical(&values);
        let mut rate = values.times(self.sigma);
        if let Some(drift) = &drift {
            rate.add(C64::new(1.0, 0.0), drift);
        }
        Some(Response {
            mode: Mode {
                q: self.q,
                values,
                rate,
                drift,
                numbers,
            },
            coefficients: solution[closed..].iter().map(|c| c.complex()).collect(),
            multipliers,
            solver: T::kept(solver),
        })
    }

    /// G, then the right-hand sides of the closures, then ⟨ψ_j, M0 X⟩ = 0.
    fn right_side<T: Scalar>(&self, n: usize, closed: usize) -> Vec<T> {
        let mut right: Vec<T> = scalars(&self.forcing.equations);
        if closed > n {
            right.extend(scalars::<T>(&self.forcing.closures));
        }
        right.resize(closed + self.borders.len(), T::zero_impl());
        right
    }

    /// σ M0 − L with its closures, bordered by the resonant modes and factorised.
    fn factorised<T: Scalar>(&self, problem: &Problem, matrix: Mat<T>) -> Solver<T> {
        if let Some(part) = problem.even_part().filter(|_| self.is_steady_mean()) {
            return Solver::even(&matrix, part);
        }
        if self.borders.is_empty() {
            return Solver::whole(matrix);
        }
        // A resonant mode has no entry in the rows and columns of the closures.
        let extended = |x: &Turned| -> Vec<T> {
            let mut x: Vec<T> = scalars(x);
            x.resize(matrix.nrows(), T::zero_impl());
            x
        };
        let borders = self.borders.iter();
        let borders: Vec<_> = borders.map(|(c, r)| (extended(c), extended(r))).collect();
        Solver::whole(bordered(&matrix, &borders))
    }

    /// What the unknowns `multipliers` of the closures mean, beside the solution `x`.
    fn closed<T: Scalar>(&self, problem: &Problem, x: &[T], multipliers: &[T]) -> Closed {
        let mut closed = Closed::default();
        for (border, value) in problem.borders.iter().zip(multipliers) {
            if border.kind != ClosureKind::Unknown {
                let multiplier = self.multiplier(problem, border, value.size(), x);
                closed.multipliers.push(multiplier);
            }
            let Some(field) = border.field else { continue };
            let value = value.complex() * problem.direct.column_factor(field) * border.unit;
            match border.kind {
                ClosureKind::Unknown => closed.numbers.push((field, value)),
                ClosureKind::Drift => {
                    let block = &problem.direct.layout.columns[field];
                    let drift = closed.drift.get_or_insert_with(|| Profile::zero(x.len()));
                    drift[block.range()].fill(value);
                }
                ClosureKind::Conserved | ClosureKind::Claimed | ClosureKind::Gauge => {}
            }
        }
        closed
    }

    /// The multiplier of a border, `value` being the modulus of its unknown, measured by the terms of the solution `x`.
    fn multiplier<T: Scalar>(
        &self,
        problem: &Problem,
        border: &Border,
        value: f64,
        x: &[T],
    ) -> Multiplier {
        let largest = border.column.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
        let vanishes = border.kind != ClosureKind::Drift;
        let forcing = &self.forcing.equations;
        let relative = if value == 0.0 {
            0.0
        } else if vanishes {
            let terms = self.terms(problem, x);
            let beside = |forcing: &Turned| share(problem, border, value, forcing, &terms);
            let plain = beside(forcing);
            if plain <= LEFT_OVER {
                plain
            } else {
                // Where the terms of G cancel, G itself is rounding: compare with its terms before they cancel.
                (self.uncancelled)().map_or(plain, |forcing| plain.min(beside(&forcing)))
            }
        } else {
            norm(&border.column) * value / norm(forcing)
        };
        Multiplier {
            closure: border.name.clone(),
            order: self.order,
            size: largest * value,
            relative,
            vanishes,
        }
    }

    /// Σ over fields of the most that each contributes to a row of (σ M0 − L) x, by row.
    fn terms<T: Scalar>(&self, problem: &Problem, x: &[T]) -> Vec<f64> {
        let size = |block: &Block| block.of(x).iter().map(|v| v.size()).fold(0.0, f64::max);
        let sizes = problem.direct.layout.columns.map(size);
        let shares = problem.direct.shares(self.q, self.sigma, &sizes);
        shares.iter().map(|row| row.iter().sum()).collect()
    }
}

/// Size of a multiplier relative to what it balances: the lesser of two ratios. One is its largest ratio to forcing plus
/// terms in a single balance, for balances differ in their units. The other is its ratio to the forcing of all balances,
/// for a single balance may hold nothing but rounding.
fn share(problem: &Problem, border: &Border, value: f64, forcing: &Turned, terms: &[f64]) -> f64 {
    let largest = |values: &[f64]| values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let rows = problem.direct.layout.rows.iter().zip(terms);
    let shares = rows.map(|(block, terms)| {
        let contribution = value * largest(block.of(&border.column));
        let forced = block.of(forcing).iter().map(|v| v.norm());
        let beside = forced.fold(0.0, f64::max) + terms;
        if contribution == 0.0 {
            0.0
        } else {
            contribution / beside
        }
    });
    let of_all = norm(&border.column) * value / norm(forcing);
    shares.fold(0.0, f64::max).min(of_all)
}

impl Response {
    /// Distance of σ from the spectrum of L at q, in units of σ.
    pub fn distance(&self, problem: &Problem) -> f64 {
        match &self.solver {
            AnySolver::Real(solver) => solver.distance(&problem.direct.mass(self.mode.q)),
            AnySolver::Complex(solver) => solver.distance(&problem.direct.mass(self.mode.q)),
        }
    }
}
