//! The amplitude expansion, order by order.
//!
//! X' = Σ_m A^m { X[0;m] + Σ_k (X[k;m] e^{ikθ} + c.c.) },  dA/dt = a0 A + a2 A³ + …,
//! dθ/dt = b0 + b2 A² + …, P (3.13)–(3.16). For every (k, m)
//! [(m a0 + i k b0) M0 − L_k] X[k;m] = G[k;m] − c_{m−1} δ_{k1} M0 X[1;1], P (3.18).

use super::mode::{JetTable, Jets, Mode};
use crate::collocation::GridKind;
use crate::dense::{Factorised, Scalar, norm, scalars};
use crate::error::{Error, Result};
use crate::model::{C64, ClosureKind, End, Jet};
use crate::problem::{Problem, Solver, quarter_turn};
use crate::spectrum::EigenPair;
use std::collections::{BTreeMap, HashMap};

/// Harmonic k ≥ 0 and order m.
pub type Key = (usize, usize);

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

/// The multiplier of a closure of a mean mode.
#[derive(Clone, Debug)]
pub struct Multiplier {
    /// What is closed, in words.
    pub closure: String,
    pub order: usize,
    /// Its size in the balances over that of the forcing.
    pub relative: f64,
    /// Whether it has to vanish.
    pub vanishes: bool,
}

/// The modes and coefficients found so far.
pub struct Expansion<'p, 'm> {
    pub problem: &'p Problem<'m>,
    pub k: f64,
    pub pair: EigenPair,
    pub modes: BTreeMap<Key, Mode>,
    /// c0, c2, … as a0 + i b0, a2 + i b2, …
    pub landau: Vec<C64>,
    /// Multipliers of the closures at k = 0.
    pub multipliers: Vec<Multiplier>,
    /// The factorised problems of modes that were solved for.
    solvers: BTreeMap<Key, AnySolver>,
    /// Jets of a mode on the grids of the rows, made when first needed.
    jets: HashMap<(Key, GridKind), Jets>,
}

impl<'p, 'm> Expansion<'p, 'm> {
    /// Starts from the normalised fundamental.
    ///
    /// # Errors
    /// A mode that the spec's normalisation does not fit.
    pub fn new(problem: &'p Problem<'m>, pair: EigenPair) -> Result<Self> {
        let values = problem.physical(&pair.right);
        let factor = super::normalise(problem, pair.k, &values)?;
        let values: Vec<C64> = values.into_iter().map(|v| v * factor).collect();
        let rate = values.iter().map(|v| v * pair.c).collect();
        let mut modes = BTreeMap::new();
        modes.insert(
            (1, 1),
            Mode {
                harmonic: 1,
                values,
                rate,
                drift: Vec::new(),
                uniform: Vec::new(),
            },
        );
        let (k, landau) = (pair.k, vec![pair.c]);
        Ok(Expansion {
            problem,
            k,
            pair,
            modes,
            landau,
            multipliers: Vec::new(),
            solvers: BTreeMap::new(),
            jets: HashMap::new(),
        })
    }

    /// How far the problem that was solved for X[k;m] is from singularity.
    pub fn distance(&self, key: Key) -> Option<f64> {
        let k = key.0 as f64 * self.k;
        Some(match self.solvers.get(&key)? {
            AnySolver::Real(solver) => solver.distance(&self.problem.mass(k)),
            AnySolver::Complex(solver) => solver.distance(&self.problem.mass(k)),
        })
    }

    /// m a0 + i k b0
    pub fn shift(&self, (k, m): Key) -> C64 {
        C64::new(m as f64 * self.landau[0].re, k as f64 * self.landau[0].im)
    }

    /// Solves for X[k;m], k ≠ 1, all modes of lower order being known.
    ///
    /// # Errors
    /// A singular problem: resonance.
    pub fn solve(&mut self, key: Key) -> Result<()> {
        // Without the mirror a mean mode is real in the basis of the fields themselves.
        let plain_mean = key.0 == 0 && !self.problem.is_real();
        let mode = if self.is_real() || plain_mean {
            self.solve_as::<f64>(key)?
        } else {
            self.solve_as::<C64>(key)?
        };
        self.modes.insert(key, mode);
        Ok(())
    }

    /// Whether every mode is a real vector of the solver's basis: in a model with the mirror symmetry, those of
    /// a steady pattern, which is its own mirror image. A wave is not, and drives a mean flow along x.
    fn is_real(&self) -> bool {
        self.problem.is_real() && self.landau.iter().all(|c| c.im == 0.0)
    }

    fn solve_as<T: Kept>(&mut self, key: Key) -> Result<Mode> {
        let harmonic = key.0;
        let right = self.forcing(key);
        let k = harmonic as f64 * self.k;
        let shift = self.shift(key);
        let mut system: Vec<T> = scalars(&right);
        let matrix = self.problem.shifted::<T>(k, shift);
        system.resize(matrix.nrows(), T::zero_impl());
        let even = self.problem.even_part();
        let solver = match even.filter(|_| harmonic == 0 && self.is_real()) {
            Some(even) => Solver::even(&matrix, even),
            None => Solver::whole(matrix),
        };
        let solution = solver.solve(&system).ok_or_else(|| self.singular(key))?;
        self.solvers.insert(key, T::kept(solver));
        if harmonic == 0 {
            let n = self.problem.direct.layout.size;
            self.record_multipliers(key.1, &solution[n..], norm(&right));
        }
        Ok(self.mode(key, &solution))
    }

    fn singular(&self, (harmonic, order): Key) -> Error {
        let advice = if harmonic == 0 {
            "a mean is left open: the block `mean` accepts `gauge` for a field that is determined up \
             to a constant and `conserved` for an integral that does not change"
                .to_owned()
        } else {
            format!("a resonance at k = {}: try a wavenumber beside it", self.k)
        };
        Error::computation(format!(
            "the problem for X[{harmonic};{order}] is singular, {advice}"
        ))
    }

    /// X[1;3] and c2 together: the bordered problem, closed by ⟨left vector, M0 X[1;3]⟩ = 0.
    ///
    /// # Errors
    /// A singular problem.
    pub fn solve_fundamental(&mut self, order: usize) -> Result<()> {
        let key = (1, order);
        let (mode, coefficient) = if self.is_real() {
            self.bordered::<f64>(key)?
        } else {
            self.bordered::<C64>(key)?
        };
        self.landau.push(coefficient);
        self.modes.insert(key, mode);
        // The rate of X[1;m] gains the new coefficient times the fundamental.
        let fundamental = self.modes[&(1, 1)].values.clone();
        if let Some(mode) = self.modes.get_mut(&key) {
            for (rate, value) in mode.rate.iter_mut().zip(&fundamental) {
                *rate += coefficient * value;
            }
        }
        Ok(())
    }

    fn bordered<T: Scalar>(&mut self, key: Key) -> Result<(Mode, C64)> {
        let n = self.problem.direct.layout.size;
        let right = self.forcing(key);
        let matrix = self.problem.shifted::<T>(self.k, self.shift(key));
        let mass = self.problem.mass::<T>(self.k);
        let fundamental: Vec<T> = scalars(&self.solver_basis(&self.modes[&(1, 1)].values));
        let left: Vec<T> = scalars(&self.pair.left);
        let border = (mass.apply(&fundamental), mass.apply_adjoint(&left));
        let bordered = crate::dense::bordered(&matrix, &[border]);
        let mut system: Vec<T> = scalars(&right);
        system.push(T::from_complex(C64::new(0.0, 0.0)));
        let solution = Factorised::new(bordered).solve_regular(&system);
        let solution = solution
            .ok_or_else(|| Error::computation("the bordered problem for c2 is singular"))?;
        Ok((self.mode(key, &solution[..n]), solution[n].complex()))
    }

    /// The multipliers of closures that are no unknowns of the model.
    fn record_multipliers<T: Scalar>(&mut self, order: usize, values: &[T], forcing: f64) {
        for (border, value) in self.problem.borders.iter().zip(values) {
            let size = norm(&border.column) * value.size();
            let relative = if size == 0.0 { 0.0 } else { size / forcing };
            if border.kind != ClosureKind::Unknown {
                self.multipliers.push(Multiplier {
                    closure: border.name.clone(),
                    order,
                    relative,
                    vanishes: border.kind != ClosureKind::Drift,
                });
            }
        }
    }

    fn mode<T: Scalar>(&mut self, key: Key, solution: &[T]) -> Mode {
        let (harmonic, order) = key;
        let values = self.problem.physical(solution);
        let mut rate: Vec<C64> = values.iter().map(|v| v * self.shift(key)).collect();
        // ∂t (A^q e^{ikθ}) reaches order m through a_{m−q}, b_{m−q}.
        for (&(k, q), lower) in &self.modes {
            let step = order.saturating_sub(q);
            if k == harmonic
                && step > 0
                && step % 2 == 0
                && let Some(c) = self.landau.get(step / 2)
            {
                let factor = C64::new(q as f64 * c.re, k as f64 * c.im);
                rate.iter_mut()
                    .zip(&lower.values)
                    .for_each(|(r, v)| *r += factor * v);
            }
        }
        let n = self.problem.direct.layout.size;
        let profiles = self.problem.direct.layout.columns.len();
        let mut drift = Vec::new();
        let mut uniform =
            vec![C64::new(0.0, 0.0); self.problem.structure().fields.len() - profiles];
        if harmonic == 0 {
            for (border, value) in self.problem.borders.iter().zip(&solution[n..]) {
                let Some(field) = border.field else { continue };
                let turn = quarter_turn(self.problem.direct.column_turn(field));
                let value = value.complex() * turn * border.unit;
                match border.kind {
                    ClosureKind::Unknown => uniform[field - profiles] = value,
                    ClosureKind::Drift => {
                        let block = &self.problem.direct.layout.columns[field];
                        drift.resize(n, C64::new(0.0, 0.0));
                        drift[block.offset..][..block.len].fill(value);
                    }
                    ClosureKind::Conserved | ClosureKind::Claimed | ClosureKind::Gauge => {}
                }
            }
        }
        rate.iter_mut().zip(&drift).for_each(|(r, d)| *r += d);
        Mode {
            harmonic: harmonic as i32,
            values,
            rate,
            drift,
            uniform,
        }
    }

    /// Physical values in the solver's basis.
    pub(super) fn solver_basis(&self, values: &[C64]) -> Vec<C64> {
        let ones = vec![C64::new(1.0, 0.0); values.len()];
        let turns = self.problem.physical(&ones);
        values.iter().zip(turns).map(|(v, t)| v / t).collect()
    }

    /// G[k;m] with the boundary data, in the solver's basis: everything that modes of lower order
    /// force, except what c_{m−1} multiplies.
    pub fn forcing(&mut self, key: Key) -> Vec<C64> {
        let mut right = vec![C64::new(0.0, 0.0); self.problem.direct.layout.size];
        // Lower orders of the same harmonic through the time derivative: −(q a + i k b) M0 X[k;q].
        self.time_terms(key, &mut right);
        for part in self.products_forcing(key) {
            right.iter_mut().zip(part).for_each(|(r, p)| *r += p);
        }
        right
    }

    /// The part of G[k;m] that products of modes force, one vector a product.
    pub fn products_forcing(&mut self, key: Key) -> Vec<Vec<C64>> {
        let mut parts = Vec::new();
        for degree in 2..=self.problem.structure().order {
            for (factors, multiplicity) in products(&self.modes, key, degree) {
                let mut part = vec![C64::new(0.0, 0.0); self.problem.direct.layout.size];
                self.add_product(degree, &factors, multiplicity, &mut part);
                parts.push(part);
            }
        }
        parts
    }

    fn time_terms(&self, (k, m): Key, right: &mut [C64]) {
        for (&(harmonic, q), mode) in &self.modes {
            // q = 1, k = 1 goes with the unknown c_{m−1}.
            if harmonic != k || q >= m || (m - q) % 2 == 1 || (k, q) == (1, 1) {
                continue;
            }
            let Some(c) = self.landau.get((m - q) / 2) else {
                continue;
            };
            let factor = C64::new(q as f64 * c.re, k as f64 * c.im);
            let mass = self.problem.mass::<C64>(k as f64 * self.k);
            let values = self.solver_basis(&mode.values);
            let product = mass.apply(&values);
            right
                .iter_mut()
                .zip(product)
                .for_each(|(r, p)| *r -= factor * p);
        }
    }

    fn add_product(
        &mut self,
        degree: usize,
        factors: &[(Key, bool)],
        multiplicity: f64,
        right: &mut [C64],
    ) {
        let problem = self.problem;
        let structure = problem.structure();
        for row in 0..structure.balances.len() {
            if !structure.forms[degree - 2][row] {
                continue;
            }
            let block = &problem.direct.layout.rows[row];
            for (key, _) in factors {
                self.prepare(*key, block.grid);
            }
            let tables: Vec<&JetTable> = factors
                .iter()
                .map(|(key, conjugate)| self.jets[&(*key, block.grid)].of(*conjugate))
                .collect();
            let turn = problem.direct.row_factor(row) * multiplicity;
            for (i, c) in problem.nonlinear[row].iter().enumerate() {
                let arguments: [&[C64]; 4] =
                    std::array::from_fn(|a| tables.get(a).map_or(&[][..], |t| t.at(i)));
                let value = problem.model.form(degree, row, c, &arguments[..degree]);
                right[block.offset + i] += turn * value;
            }
        }
        for (index, wall) in problem.direct.walls.iter().enumerate() {
            let terms: Vec<_> = wall
                .nonlinear
                .iter()
                .filter(|(m, _)| m.len() == degree)
                .collect();
            if terms.is_empty() {
                continue;
            }
            let end = if wall.end == End::Lower {
                GridKind::Lower
            } else {
                GridKind::Upper
            };
            let modes: Vec<Mode> = factors.iter().map(|f| self.factor(*f)).collect();
            let mut total = C64::new(0.0, 0.0);
            for (monomial, coefficient) in terms {
                let value = symmetric_product(problem, self.k, &modes, monomial, end);
                total += value * *coefficient;
            }
            let position = problem.direct.layout.walls + index;
            // 0 = W x + N(x): a row of L, and its data beside those of the balances.
            right[position] += problem.direct.wall_factor(wall) * total * multiplicity;
        }
    }

    fn factor(&self, ((k, m), conjugate): (Key, bool)) -> Mode {
        let mode = &self.modes[&(k, m)];
        if conjugate {
            mode.conjugate()
        } else {
            mode.clone()
        }
    }

    /// Jets of one mode on one grid.
    fn prepare(&mut self, key: Key, grid: GridKind) {
        let (problem, k, mode) = (self.problem, self.k, &self.modes[&key]);
        self.jets.entry((key, grid)).or_insert_with(|| {
            let jets = &problem.structure().form_jets;
            Jets::new(mode.jets(problem, k, jets, grid))
        });
    }
}

/// 1/d! Σ over permutations of Π jets at one end.
fn symmetric_product(
    problem: &Problem,
    k: f64,
    modes: &[Mode],
    monomial: &[Jet],
    end: GridKind,
) -> C64 {
    fn sum(values: &[Vec<C64>], position: usize, used: u32) -> C64 {
        if position == values.len() {
            return C64::new(1.0, 0.0);
        }
        let open = (0..values.len()).filter(|i| used >> i & 1 == 0);
        open.map(|i| values[position][i] * sum(values, position + 1, used | 1 << i))
            .sum()
    }
    let values: Vec<Vec<C64>> = monomial
        .iter()
        .map(|&jet| {
            modes
                .iter()
                .map(|mode| mode.jet(problem, k, jet, end)[0])
                .collect()
        })
        .collect();
    let factorial: f64 = (1..=modes.len()).map(|i| i as f64).product();
    sum(&values, 0, 0) / factorial
}

/// All products of `degree` modes that force (k, m): each multiset once, with the number of its
/// orderings.
fn products(
    modes: &BTreeMap<Key, Mode>,
    (k, m): Key,
    degree: usize,
) -> Vec<(Vec<(Key, bool)>, f64)> {
    let mut candidates: Vec<(Key, bool)> = Vec::new();
    for &key in modes.keys() {
        candidates.push((key, false));
        if key.0 > 0 {
            candidates.push((key, true));
        }
    }
    let mut found = Vec::new();
    let mut open = vec![(Vec::<usize>::new(), 0_i64, 0_usize)];
    while let Some((chosen, harmonic, order)) = open.pop() {
        if chosen.len() == degree {
            if harmonic == k as i64 && order == m {
                let factorial = |n: usize| (1..=n).map(|i| i as f64).product::<f64>();
                let mut orderings = factorial(degree);
                for index in 0..candidates.len() {
                    orderings /= factorial(chosen.iter().filter(|&&c| c == index).count());
                }
                found.push((chosen.iter().map(|&i| candidates[i]).collect(), orderings));
            }
            continue;
        }
        let first = chosen.last().copied().unwrap_or(0);
        for (index, ((harmonic_of, order_of), conjugate)) in
            candidates.iter().enumerate().skip(first)
        {
            if order + order_of > m {
                continue;
            }
            let sign = if *conjugate { -1 } else { 1 };
            let mut longer = chosen.clone();
            longer.push(index);
            open.push((
                longer,
                harmonic + sign * *harmonic_of as i64,
                order + order_of,
            ));
        }
    }
    found
}
