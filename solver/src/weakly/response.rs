//! What a forcing makes of the linear problem: [σ M0 − L_q] X = G, bordered where the wavenumber is that of a mode
//! with an amplitude of its own, closed where it is zero.

use super::mode::Mode;
use crate::error::{Error, Result};
use crate::model::{C64, ClosureKind, FieldId};
use crate::numerics::dense::{Scalar, bordered, norm, scalars};
use crate::problem::{Border, Known, Problem, Profile, Solver, Turned};
use crate::series::Arithmetic;
use crate::space::Block;
use crate::wavevector::WaveVector;

/// The multiplier of a closure of a mean mode.
#[derive(Clone, Debug)]
pub struct Multiplier {
    /// What is closed, in words.
    pub closure: String,
    /// Degree in the amplitudes.
    pub order: usize,
    /// The largest part of a balance that it makes up.
    pub size: f64,
    /// Its size in the balances over that of the terms that it stands beside, before these cancel; for one that need
    /// not vanish over that of the forcing.
    pub relative: f64,
    /// Whether it has to vanish.
    pub vanishes: bool,
}

/// The part of the terms beside it that a multiplier has to stay below where it has to vanish.
pub const LEFT_OVER: f64 = 1e-6;

/// The error that multipliers amount to: that of the largest one that has to vanish and is neither below
/// [`LEFT_OVER`] nor within `uncertainty`, the relative error of what it belongs to.
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
    /// Of the balances and the boundary conditions: G.
    pub equations: Turned,
    /// Of the closures at k = 0, one a border of the problem; empty where all densities are linear.
    pub closures: Vec<C64>,
}

impl RightSide {
    /// Refuses products that overflow, which would be lost beside each other.
    ///
    /// # Errors
    /// A right-hand side whose size is out of the range of double precision.
    pub fn check_range(&self) -> Result<()> {
        if norm(&self.equations).is_finite() && norm(&self.closures).is_finite() {
            return Ok(());
        }
        Err(out_of_range())
    }
}

/// What to say of products that overflow.
pub fn out_of_range() -> Error {
    Error::computation(
        "products of the mode are out of the range of double precision: choose other units or parameters",
    )
}

/// A linear problem with its forcing, in the solver's basis.
pub struct Question<'a> {
    /// Its wavenumber.
    pub q: WaveVector,
    /// σ
    pub shift: C64,
    /// G with the boundary data.
    pub forcing: RightSide,
    /// How the modes with amplitudes are kept.
    pub arithmetic: Arithmetic,
    /// Of which order in the amplitudes.
    pub order: usize,
    /// Whether it is the coefficient of a product of |z_j|²: its own conjugate.
    pub is_real: bool,
    /// Column M0 φ and row M0ᴴ ψ of every mode whose amplitude equation takes part.
    pub borders: &'a [(Turned, Turned)],
    /// G with weights that let nothing cancel: asked for where a multiplier looks large.
    pub uncancelled: &'a dyn Fn() -> Option<Turned>,
}

/// The answer.
pub struct Response {
    /// X with the rate σ X and what drifts.
    pub mode: Mode,
    /// One coefficient a border.
    pub coefficients: Vec<C64>,
    /// Of the closures that are no unknowns of the model.
    pub multipliers: Vec<Multiplier>,
    solver: AnySolver,
}

/// A factorised problem in either arithmetic.
enum AnySolver {
    Real(Solver<f64>),
    Complex(Solver<C64>),
}

/// Scalars whose factorised problems can be kept side by side.
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

/// In a model with the mirror symmetry every mode of a steady pattern, its own mirror image, is a real vector of the
/// solver's basis. A wave is not, and drives a mean flow along x.
pub fn arithmetic(problem: &Problem, rates: &[C64]) -> Arithmetic {
    if problem.is_real() && rates.iter().all(|c| c.im == 0.0) {
        Arithmetic::Real
    } else {
        Arithmetic::Complex
    }
}

/// Which part of the problem at k = 0 is solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum MeanSymmetry {
    /// The even part: the mean of a steady pattern, which is its own mirror image, has no odd one.
    Even,
    /// All of it: what is no mean, or is driven by a wave.
    Full,
}

impl Question<'_> {
    /// The numbers in which it is solved.
    fn arithmetic(&self, problem: &Problem) -> Arithmetic {
        // Without the mirror a mean that is its own conjugate is real in the basis of the fields themselves.
        let plain_mean = self.q.is_mean() && self.is_real && !problem.is_real();
        match plain_mean {
            true => Arithmetic::Real,
            false => self.arithmetic,
        }
    }

    fn mean_symmetry(&self) -> MeanSymmetry {
        let steady = self.arithmetic == Arithmetic::Real;
        match self.q.is_mean() && self.is_real && steady {
            true => MeanSymmetry::Even,
            false => MeanSymmetry::Full,
        }
    }

    /// Solves the problem; nothing where it is singular.
    pub fn answer(self, problem: &Problem) -> Option<Response> {
        match self.arithmetic(problem) {
            Arithmetic::Real => self.answer_as::<f64>(problem),
            Arithmetic::Complex => self.answer_as::<C64>(problem),
        }
    }

    fn answer_as<T: Kept>(self, problem: &Problem) -> Option<Response> {
        let n = problem.direct.layout.size;
        let matrix = problem.shifted::<T>(self.q, self.shift);
        let closed = matrix.nrows();
        let mut right: Vec<T> = scalars(&self.forcing.equations);
        if closed > n {
            right.extend(scalars::<T>(&self.forcing.closures));
        }
        right.resize(closed + self.borders.len(), T::zero_impl());
        let even = self.mean_symmetry() == MeanSymmetry::Even;
        let solver = match problem.even_part().filter(|_| even) {
            Some(part) => Solver::even(&matrix, part),
            None if self.borders.is_empty() => Solver::whole(matrix),
            None => {
                let scalar = |x: &Turned| -> Vec<T> {
                    let mut x: Vec<T> = scalars(x);
                    x.resize(closed, T::zero_impl());
                    x
                };
                let borders = self.borders.iter();
                let borders: Vec<_> = borders.map(|(c, r)| (scalar(c), scalar(r))).collect();
                Solver::whole(bordered(&matrix, &borders))
            }
        };
        let solution = solver.solve(&right)?;
        let RightSide {
            equations,
            closures,
        } = &self.forcing;
        let mut known = Known::forcing(problem, equations, closures);
        for ((column, _), value) in self.borders.iter().zip(&solution[closed..]) {
            known.add(problem, column, value.size());
        }
        let mut multipliers = Vec::new();
        let mut drift: Option<Profile> = None;
        let mut numbers: Vec<(FieldId, C64)> = Vec::new();
        for (border, value) in problem.borders.iter().zip(&solution[n..closed]) {
            known.add_border(problem, border, value.size());
            if border.kind != ClosureKind::Unknown {
                multipliers.push(self.multiplier(problem, border, value.size(), &solution[..n]));
            }
            let Some(field) = border.field else { continue };
            let value = value.complex() * problem.direct.column_factor(field) * border.unit;
            match border.kind {
                ClosureKind::Unknown => numbers.push((field, value)),
                ClosureKind::Drift => {
                    let block = &problem.direct.layout.columns[field];
                    let drift = drift.get_or_insert_with(|| Profile::zero(n));
                    drift[block.range()].fill(value);
                }
                ClosureKind::Conserved | ClosureKind::Claimed | ClosureKind::Gauge => {}
            }
        }
        let mut values = Turned(solution[..n].to_vec()).complex();
        problem.clear_absent(self.q, self.shift, &mut values, known);
        let values = problem.direct.physical(&values);
        let mut rate = values.times(self.shift);
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
}

impl Question<'_> {
    /// The multiplier of a border, beside the terms of the solution `x`.
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
                // Terms that cancel leave rounding: what they are before they do is what counts.
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

    /// What the fields of the solution add at most to each balance of σ M0 − L.
    fn terms<T: Scalar>(&self, problem: &Problem, x: &[T]) -> Vec<f64> {
        let size = |block: &Block| block.of(x).iter().map(|v| v.size()).fold(0.0, f64::max);
        let sizes = problem.direct.layout.columns.map(size);
        let shares = problem.direct.shares(self.q, self.shift, &sizes);
        shares.iter().map(|row| row.iter().sum()).collect()
    }
}

/// How large a multiplier is beside what it balances: the largest part that it makes up of a balance with its forcing
/// and terms, and its part of the forcing of all balances. The lesser of the two counts: a balance may hold nothing but
/// rounding, and the balances have units of their own.
fn share(problem: &Problem, border: &Border, value: f64, forcing: &Turned, terms: &[f64]) -> f64 {
    let largest = |values: &[f64]| values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let rows = problem.direct.layout.rows.iter().zip(terms);
    let shares = rows.map(|(block, terms)| {
        let own = value * largest(block.of(&border.column));
        let forced = block.of(forcing).iter().map(|v| v.norm());
        let beside = forced.fold(0.0, f64::max) + terms;
        if own == 0.0 { 0.0 } else { own / beside }
    });
    let of_all = norm(&border.column) * value / norm(forcing);
    shares.fold(0.0, f64::max).min(of_all)
}

impl Response {
    /// How far the problem is from singularity: the distance of σ from the spectrum of L_q.
    pub fn distance(&self, problem: &Problem) -> f64 {
        match &self.solver {
            AnySolver::Real(solver) => solver.distance(&problem.direct.mass(self.mode.q)),
            AnySolver::Complex(solver) => solver.distance(&problem.direct.mass(self.mode.q)),
        }
    }
}
