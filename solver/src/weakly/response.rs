//! What a forcing makes of the linear problem: [σ M0 − L_q] X = G, bordered where the wavenumber is that of a mode
//! with an amplitude of its own, closed where it is zero.

use super::mode::Mode;
use crate::model::{C64, ClosureKind, FieldId};
use crate::numerics::dense::{Scalar, bordered, norm, scalars};
use crate::problem::{Known, Problem, Profile, Solver, Turned};
use crate::series::Arithmetic;

/// The multiplier of a closure of a mean mode.
#[derive(Clone, Debug)]
pub struct Multiplier {
    /// What is closed, in words.
    pub closure: String,
    /// Degree in the amplitudes.
    pub order: usize,
    /// The largest part of a balance that it makes up.
    pub size: f64,
    /// Its size in the balances over that of the forcing.
    pub relative: f64,
    /// Whether it has to vanish.
    pub vanishes: bool,
}

/// A linear problem with its forcing, in the solver's basis.
pub struct Question<'a> {
    /// Its wavenumber.
    pub q: f64,
    /// σ
    pub shift: C64,
    /// G with the boundary data.
    pub forcing: Turned,
    /// How the modes with amplitudes are kept.
    pub arithmetic: Arithmetic,
    /// Of which order in the amplitudes.
    pub order: usize,
    /// Whether it is the coefficient of a product of |z_j|²: its own conjugate.
    pub is_real: bool,
    /// Column M0 φ and row M0ᴴ ψ of every mode whose amplitude equation takes part.
    pub borders: &'a [(Turned, Turned)],
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
        let plain_mean = self.q == 0.0 && self.is_real && !problem.is_real();
        match plain_mean {
            true => Arithmetic::Real,
            false => self.arithmetic,
        }
    }

    fn mean_symmetry(&self) -> MeanSymmetry {
        let steady = self.arithmetic == Arithmetic::Real;
        match self.q == 0.0 && self.is_real && steady {
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
        let mut right: Vec<T> = scalars(&self.forcing);
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
        let mut known = Known::forcing(problem, &self.forcing);
        for ((column, _), value) in self.borders.iter().zip(&solution[closed..]) {
            known.add(problem, column, value.size());
        }
        let mut multipliers = Vec::new();
        let size = norm(&self.forcing);
        let mut drift: Option<Profile> = None;
        let mut numbers: Vec<(FieldId, C64)> = Vec::new();
        for (border, value) in problem.borders.iter().zip(&solution[n..closed]) {
            known.add(problem, &border.column, value.size());
            let share = norm(&border.column) * value.size();
            let relative = if share == 0.0 { 0.0 } else { share / size };
            if border.kind != ClosureKind::Unknown {
                let largest = border.column.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
                multipliers.push(Multiplier {
                    closure: border.name.clone(),
                    order: self.order,
                    size: largest * value.size(),
                    relative,
                    vanishes: border.kind != ClosureKind::Drift,
                });
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

impl Response {
    /// How far the problem is from singularity: the distance of σ from the spectrum of L_q.
    pub fn distance(&self, problem: &Problem) -> f64 {
        match &self.solver {
            AnySolver::Real(solver) => solver.distance(&problem.direct.mass(self.mode.q)),
            AnySolver::Complex(solver) => solver.distance(&problem.direct.mass(self.mode.q)),
        }
    }
}
