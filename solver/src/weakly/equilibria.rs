//! Equilibria of amplitude equations up to phase: states that the symmetries of the equations alone move.
//!
//! A symmetry turns z_j by w_j θ; a row w belongs to one where every monomial of the equation of z_j turns like
//! z_j itself: Σ_i w_i (p_i − s_i) = w_j. At an equilibrium dz_j/dt = i Σ_a ν_a w_aj z_j.

use super::system::{AmplitudeSystem, power};
use crate::model::C64;
use crate::numerics::{Failure, Linearised, Newton, System};
use nalgebra::{DMatrix, DVector};

/// From one start.
const METHOD: Newton = Newton {
    most_steps: 60,
    least_part: 1.0,
};
/// Starts in all, at most.
const MOST_STARTS: usize = 3000;
/// Phases of each amplitude that are tried.
const PHASES: usize = 8;
/// What is left of the equations at a solution, relative to their terms.
const TOLERANCE: f64 = 1e-11;
/// Two solutions that differ by less, relative, are one.
const SAME: f64 = 1e-6;
/// A frequency below this part of the rates is zero.
const STILL: f64 = 1e-9;
/// What Newton's method brings below this part of the least start is on its way to zero.
const VANISHING: f64 = 1e-3;

/// A state that stands, drifts or oscillates with one frequency a mode.
#[derive(Clone, Debug)]
pub struct Equilibrium {
    /// The amplitudes, turned so that as many as possible are real and positive.
    pub z: Vec<C64>,
    /// What dz_j/dt is, over i z_j; zero where nothing moves.
    pub frequencies: Vec<f64>,
    /// Those of the linearised amplitude equations, phases that symmetries leave free set aside; nothing where the
    /// linearisation changes with time.
    pub eigenvalues: Option<Vec<C64>>,
}

impl Equilibrium {
    /// Whether every perturbation decays.
    pub fn stable(&self) -> Option<bool> {
        let values = self.eigenvalues.as_ref()?;
        Some(values.iter().all(|c| c.re < 0.0))
    }

    /// The speed of a pattern that travels as a whole: −frequency/q, where that is the same for all modes present.
    pub fn drift(&self, q: &[f64]) -> Option<f64> {
        let present = (0..q.len()).filter(|&j| self.z[j] != C64::new(0.0, 0.0));
        let speeds: Vec<f64> = present.map(|j| -self.frequencies[j] / q[j]).collect();
        let first = *speeds.first()?;
        let size = speeds.iter().fold(0.0, |m: f64, s| m.max(s.abs()));
        let same = speeds.iter().all(|s| (s - first).abs() <= 1e-6 * size);
        same.then_some(first)
    }
}

/// All equilibria but zero that Newton's method finds from a fixed set of starts, by the modes present, then by size.
pub fn equilibria(system: &AmplitudeSystem) -> Vec<Equilibrium> {
    let n = system.modes();
    let mut found: Vec<Equilibrium> = Vec::new();
    for mask in 1_u32..1 << n {
        let present: Vec<usize> = (0..n).filter(|j| mask >> j & 1 == 1).collect();
        if !is_invariant(system, &present) {
            continue;
        }
        let symmetries = symmetries(system, &present);
        let mut own: Vec<Equilibrium> = Vec::new();
        let starts = starts(system, &present);
        let sizes = starts
            .iter()
            .flatten()
            .map(|z| z.norm())
            .filter(|z| *z > 0.0);
        let least = VANISHING * sizes.fold(f64::INFINITY, f64::min);
        for start in starts {
            let Some((z, frequencies)) = newton(system, &present, &symmetries, start, least) else {
                continue;
            };
            let other = |e: &Equilibrium| same(system, &e.z, &z);
            if !own.iter().any(other) {
                let z = turned(z, &present, &symmetries);
                let eigenvalues = eigenvalues(system, &z, &frequencies);
                own.push(Equilibrium {
                    z,
                    frequencies,
                    eigenvalues,
                });
            }
        }
        let size = |e: &Equilibrium| e.z.iter().map(|z| z.norm_sqr()).sum::<f64>();
        own.sort_by(|a, b| size(a).total_cmp(&size(b)));
        found.extend(own);
    }
    found
}

/// Whether the amplitudes of the other modes stay zero.
fn is_invariant(system: &AmplitudeSystem, present: &[usize]) -> bool {
    let absent = (0..system.modes()).filter(|j| !present.contains(j));
    let mut terms = absent.flat_map(|j| &system.equations[j]);
    terms.all(|term| {
        let exponents = term.monomial.z.iter().zip(&term.monomial.conj).enumerate();
        let mut outside = exponents.filter(|(i, (p, s))| !present.contains(i) && **p + **s > 0);
        outside.next().is_some() || term.g.norm() == 0.0
    })
}

/// A basis of the symmetries of the equations of some modes, `[symmetry][mode]`, zero for the others.
fn symmetries(system: &AmplitudeSystem, present: &[usize]) -> Vec<Vec<f64>> {
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for &j in present {
        for term in &system.equations[j] {
            let exponents = term.monomial.z.iter().zip(&term.monomial.conj).enumerate();
            let inside = exponents
                .clone()
                .all(|(i, (p, s))| present.contains(&i) || p + s == 0);
            if term.g.norm() == 0.0 || !inside {
                continue;
            }
            let differences: Vec<f64> = term.monomial.differences().collect();
            let own = |&i: &usize| differences[i] - f64::from(u8::from(i == j));
            rows.push(present.iter().map(own).collect());
        }
    }
    let null = null_space(rows, present.len());
    let spread = |row: Vec<f64>| {
        let mut whole = vec![0.0; system.modes()];
        for (&j, w) in present.iter().zip(row) {
            whole[j] = w;
        }
        whole
    };
    null.into_iter().map(spread).collect()
}

/// A basis of the vectors that small whole-numbered rows take to zero, by Gauss's elimination.
fn null_space(mut rows: Vec<Vec<f64>>, n: usize) -> Vec<Vec<f64>> {
    let mut pivots: Vec<usize> = Vec::new();
    for column in 0..n {
        let rank = pivots.len();
        let Some(pivot) = (rank..rows.len()).find(|&r| rows[r][column].abs() > 1e-9) else {
            continue;
        };
        rows.swap(rank, pivot);
        let lead = rows[rank][column];
        rows[rank].iter_mut().for_each(|x| *x /= lead);
        let own = rows[rank].clone();
        for (r, row) in rows.iter_mut().enumerate().filter(|(r, _)| *r != rank) {
            let factor = row[column];
            debug_assert!(r != rank);
            row.iter_mut().zip(&own).for_each(|(x, o)| *x -= factor * o);
        }
        pivots.push(column);
    }
    let free = (0..n).filter(|column| !pivots.contains(column));
    let vector = |column: usize| {
        let mut vector = vec![0.0; n];
        vector[column] = 1.0;
        for (row, &pivot) in rows.iter().zip(&pivots) {
            vector[pivot] = -row[column];
        }
        vector
    };
    free.map(vector).collect()
}

/// Amplitudes at which terms of the equations balance, and a few about them, at several phases.
fn starts(system: &AmplitudeSystem, present: &[usize]) -> Vec<Vec<C64>> {
    let mut sizes: Vec<f64> = Vec::new();
    for &j in present {
        let terms = &system.equations[j];
        for (i, a) in terms.iter().enumerate() {
            for b in &terms[..i] {
                let step = a.monomial.degree() as f64 - b.monomial.degree() as f64;
                // The real parts alone may balance where frequencies are large.
                for ratio in [b.g.norm() / a.g.norm(), (b.g.re / a.g.re).abs()] {
                    let size = ratio.powf(1.0 / step);
                    if size.is_finite() && size > 0.0 && step > 0.0 {
                        sizes.push(size);
                    }
                }
            }
        }
    }
    let (least, most) = sizes
        .iter()
        .fold((f64::INFINITY, 0.0_f64), |(a, b), s| (a.min(*s), b.max(*s)));
    if !least.is_finite() {
        return Vec::new();
    }
    let count = present.len() as u32;
    let phases = if count == 1 { 1 } else { PHASES };
    let mut levels = 24_usize;
    while levels > 2 && levels.pow(count) * phases.pow(count - 1) > MOST_STARTS {
        levels -= 1;
    }
    let (first, last) = (0.1 * least, 3.0 * most);
    let level = |i: usize| first * (last / first).powf(i as f64 / (levels - 1) as f64);
    let total = levels.pow(count) * phases.pow(count - 1);
    let start = |mut index: usize| {
        let mut z = vec![C64::new(0.0, 0.0); system.modes()];
        for (position, &j) in present.iter().enumerate() {
            let size = level(index % levels);
            index /= levels;
            let mut turn = 0.0;
            if position > 0 {
                turn = (index % phases) as f64 / phases as f64;
                index /= phases;
            }
            z[j] = C64::from_polar(size, 2.0 * std::f64::consts::PI * turn);
        }
        z
    };
    (0..total).map(start).collect()
}

/// dz_j/dt = i Σ_a ν_a w_aj z_j for the modes present, in (Re z, Im z, …, ν).
struct Standing<'a> {
    system: &'a AmplitudeSystem,
    present: &'a [usize],
    symmetries: &'a [Vec<f64>],
    /// Between these sizes a state is looked for.
    sizes: std::ops::Range<f64>,
}

/// What is known at one point: rates with the terms that they are the sums of.
struct Rates {
    z: Vec<C64>,
    omega: Vec<f64>,
    /// Σ |terms| of each equation present.
    terms: Vec<f64>,
}

impl Standing<'_> {
    /// The amplitudes of all modes.
    fn amplitudes(&self, x: &[f64]) -> Vec<C64> {
        let mut z = vec![C64::new(0.0, 0.0); self.system.modes()];
        for (a, &j) in self.present.iter().enumerate() {
            z[j] = C64::new(x[2 * a], x[2 * a + 1]);
        }
        z
    }

    /// Σ_a ν_a w_aj of all modes.
    fn frequencies(&self, x: &[f64]) -> Vec<f64> {
        let nu = &x[2 * self.present.len()..];
        let own = |j: usize| nu.iter().zip(self.symmetries).map(|(n, w)| n * w[j]).sum();
        (0..self.system.modes()).map(own).collect()
    }
}

impl System for Standing<'_> {
    type Jacobian = DMatrix<f64>;
    type Known = Rates;
    type Error = Failure;

    fn linearise(&mut self, x: &[f64]) -> Result<Option<Linearised<Self>>, Failure> {
        let (system, m) = (self.system, self.present.len());
        let (z, omega) = (self.amplitudes(x), self.frequencies(x));
        let rates = system.rates(&z);
        let mut residual = Vec::with_capacity(2 * m);
        for &j in self.present {
            let left = rates[j] - C64::new(0.0, omega[j]) * z[j];
            residual.extend([left.re, left.im]);
        }
        let [slopes, conjugate] = system.slopes(&z);
        let mut jacobian = DMatrix::<f64>::zeros(2 * m, x.len());
        for (a, &i) in self.present.iter().enumerate() {
            for (b, &j) in self.present.iter().enumerate() {
                let own = slopes[i][j] - C64::new(0.0, if i == j { omega[i] } else { 0.0 });
                fill(&mut jacobian, (a, b), own, conjugate[i][j]);
            }
            for (s, symmetry) in self.symmetries.iter().enumerate() {
                let column = C64::new(0.0, -symmetry[i]) * z[i];
                jacobian[(2 * a, 2 * m + s)] = column.re;
                jacobian[(2 * a + 1, 2 * m + s)] = column.im;
            }
        }
        let terms = |&j: &usize| -> f64 {
            let terms = system.equations[j].iter();
            terms.map(|t| (t.g * power(&t.monomial, &z)).norm()).sum()
        };
        let terms = self.present.iter().map(terms).collect();
        Ok(Some(Linearised {
            residual,
            jacobian,
            known: Rates { z, omega, terms },
        }))
    }

    fn admits(&self, x: &[f64]) -> bool {
        let size = self
            .amplitudes(x)
            .iter()
            .map(|z| z.norm())
            .fold(0.0, f64::max);
        self.sizes.contains(&size)
    }

    /// Of least size: phases that are free stay where they are.
    fn step(&mut self, _: &[f64], at: &Linearised<Self>) -> Result<Option<Vec<f64>>, Failure> {
        let right = -DVector::from_column_slice(&at.residual);
        let solved = at.jacobian.clone().svd(true, true);
        let floor = 1e-12 * solved.singular_values.max();
        let step = solved.solve(&right, floor).ok();
        Ok(step.map(|step| step.iter().copied().collect()))
    }

    fn is_last(&self, _: &[f64], _: &[f64]) -> bool {
        false
    }

    fn is_solution(&self, _: &[f64], at: &Linearised<Self>) -> bool {
        let residuals = at.residual.chunks(2).zip(&at.known.terms);
        let small = |(r, terms): (&[f64], &f64)| r[0].hypot(r[1]) <= TOLERANCE * terms;
        residuals.into_iter().all(small)
    }
}

/// The state from a start, with its frequencies.
fn newton(
    system: &AmplitudeSystem,
    present: &[usize],
    symmetries: &[Vec<f64>],
    start: Vec<C64>,
    least: f64,
) -> Option<(Vec<C64>, Vec<f64>)> {
    let largest = |z: &[C64]| z.iter().map(|z| z.norm()).fold(0.0, f64::max);
    let mut standing = Standing {
        system,
        present,
        symmetries,
        sizes: least..1e3 * largest(&start),
    };
    let mut x: Vec<f64> = present
        .iter()
        .flat_map(|&j| [start[j].re, start[j].im])
        .collect();
    x.extend(best_frequencies(system, present, symmetries, &start));
    let (_, at) = METHOD.solve(&mut standing, x).ok()?;
    let Rates { z, omega, terms } = at.known;
    let most = largest(&z);
    let genuine = |&j: &usize| z[j].norm() > 1e-5 * most;
    let rates = present
        .iter()
        .zip(&terms)
        .map(|(&j, terms)| terms / z[j].norm());
    let still = STILL * rates.fold(0.0, f64::max);
    let settled = |omega: f64| if omega.abs() <= still { 0.0 } else { omega };
    let found = present.iter().all(genuine);
    found.then(|| (z.clone(), omega.into_iter().map(settled).collect()))
}

/// The ν that come nearest to Im (dz_j/dt / z_j) = Σ_a ν_a w_aj.
fn best_frequencies(
    system: &AmplitudeSystem,
    present: &[usize],
    symmetries: &[Vec<f64>],
    z: &[C64],
) -> Vec<f64> {
    let rates = system.rates(z);
    let right = DVector::from_fn(present.len(), |i, _| (rates[present[i]] / z[present[i]]).im);
    let matrix = DMatrix::from_fn(present.len(), symmetries.len(), |i, a| {
        symmetries[a][present[i]]
    });
    if symmetries.is_empty() {
        return Vec::new();
    }
    match matrix.svd(true, true).solve(&right, 1e-9) {
        Ok(nu) => nu.iter().copied().collect(),
        Err(_) => vec![0.0; symmetries.len()],
    }
}

/// a dz + b dz̄ as a real two by two block.
fn fill(matrix: &mut DMatrix<f64>, (row, column): (usize, usize), a: C64, b: C64) {
    let (r, c) = (2 * row, 2 * column);
    matrix[(r, c)] = a.re + b.re;
    matrix[(r, c + 1)] = b.im - a.im;
    matrix[(r + 1, c)] = a.im + b.im;
    matrix[(r + 1, c + 1)] = a.re - b.re;
}

/// Whether two states differ by a symmetry: the moduli and all terms of the equations, over their amplitudes, agree.
fn same(system: &AmplitudeSystem, a: &[C64], b: &[C64]) -> bool {
    let size = a.iter().map(|z| z.norm()).fold(0.0, f64::max);
    let moduli = a.iter().zip(b);
    if moduli
        .into_iter()
        .any(|(a, b)| (a.norm() - b.norm()).abs() > SAME * size)
    {
        return false;
    }
    let equations = system.equations.iter().enumerate();
    let mut terms = equations.flat_map(|(j, e)| e.iter().map(move |t| (j, t)));
    terms.all(|(j, term)| {
        let value = |z: &[C64]| power(&term.monomial, z) * z[j].conj();
        let (a, b) = (value(a), value(b));
        (a - b).norm() <= 10.0 * SAME * a.norm().max(b.norm())
    })
}

/// The same state with as many amplitudes as possible real and positive, the first ones before the others.
fn turned(z: Vec<C64>, present: &[usize], symmetries: &[Vec<f64>]) -> Vec<C64> {
    let mut rows: Vec<Vec<f64>> = Vec::new();
    let mut phases: Vec<f64> = Vec::new();
    for &j in present {
        let row: Vec<f64> = symmetries.iter().map(|w| w[j]).collect();
        let mut extended = rows.clone();
        extended.push(row);
        let matrix = DMatrix::from_fn(extended.len(), symmetries.len(), |i, k| extended[i][k]);
        if symmetries.is_empty() || matrix.rank(1e-9) < extended.len() {
            continue;
        }
        rows = extended;
        phases.push(-z[j].arg());
    }
    if rows.is_empty() {
        return z;
    }
    let matrix = DMatrix::from_fn(rows.len(), symmetries.len(), |i, k| rows[i][k]);
    let Ok(theta) = matrix
        .svd(true, true)
        .solve(&DVector::from_vec(phases), 1e-9)
    else {
        return z;
    };
    let turn = |(j, z): (usize, C64)| {
        let angle: f64 = symmetries
            .iter()
            .zip(theta.iter())
            .map(|(w, t)| w[j] * t)
            .sum();
        let turned = z * C64::cis(angle);
        // Rounding of a phase that is zero or π.
        match turned.im.abs() <= 1e-9 * turned.norm() {
            true => C64::new(turned.re, 0.0),
            false => turned,
        }
    };
    z.into_iter().enumerate().map(turn).collect()
}

/// The eigenvalues of the whole system about a state, in the frame that moves with it.
fn eigenvalues(system: &AmplitudeSystem, z: &[C64], frequencies: &[f64]) -> Option<Vec<C64>> {
    let n = z.len();
    let all: Vec<usize> = (0..n).collect();
    let symmetries = symmetries(system, &all);
    let present: Vec<usize> = all
        .iter()
        .copied()
        .filter(|&j| z[j] != C64::new(0.0, 0.0))
        .collect();
    // The frame: symmetries of the whole system that move the modes present as they move.
    let d = symmetries.len();
    let matrix = DMatrix::from_fn(present.len(), d, |i, a| symmetries[a][present[i]]);
    let right = DVector::from_fn(present.len(), |i, _| frequencies[present[i]]);
    let (nu, neutral) = if d == 0 {
        (DVector::zeros(0), 0)
    } else {
        let neutral = matrix.rank(1e-9);
        (
            matrix.clone().svd(true, true).solve(&right, 1e-9).ok()?,
            neutral,
        )
    };
    let size = right.amax();
    if (&matrix * &nu - &right).amax() > 1e-8 * size {
        return None;
    }
    let [slopes, conjugate] = system.slopes(z);
    let mut jacobian = DMatrix::<f64>::zeros(2 * n, 2 * n);
    for i in 0..n {
        let omega: f64 = (0..d).map(|a| nu[a] * symmetries[a][i]).sum();
        for j in 0..n {
            let own = slopes[i][j] - C64::new(0.0, if i == j { omega } else { 0.0 });
            fill(&mut jacobian, (i, j), own, conjugate[i][j]);
        }
    }
    let mut values: Vec<C64> = jacobian.complex_eigenvalues().iter().copied().collect();
    values.sort_by(|a, b| a.norm().total_cmp(&b.norm()));
    let mut rest = values.split_off(neutral);
    rest.sort_by(|a, b| b.re.total_cmp(&a.re).then(b.im.total_cmp(&a.im)));
    Some(rest)
}
