//! Equilibria of amplitude equations up to phase: states that the symmetries of the equations alone move.
//!
//! A symmetry turns z_j by w_j θ; a row w belongs to one where every monomial of the equation of z_j turns like
//! z_j itself: Σ_i w_i (p_i − s_i) = w_j. At an equilibrium dz_j/dt = i Σ_a ν_a w_aj z_j.

use super::standing::{fill, newton};
use super::system::{AmplitudeSystem, power};
use crate::model::C64;
use nalgebra::{DMatrix, DVector};

/// Starts in all, at most.
const MOST_STARTS: usize = 3000;
/// Phases of each amplitude that are tried.
const PHASES: usize = 8;
/// Two solutions that differ by less, relative, are one.
const SAME: f64 = 1e-6;
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

impl Equilibrium {
    /// The equilibrium of a system that differs little, next to this one; nothing where Newton's method finds none of
    /// half to twice the size there.
    pub fn continued(&self, system: &AmplitudeSystem) -> Option<Equilibrium> {
        let present: Vec<usize> = (0..self.z.len())
            .filter(|&j| self.z[j] != C64::new(0.0, 0.0))
            .collect();
        let symmetries = symmetries(system, &present);
        let size = |z: &[C64]| z.iter().map(|z| z.norm()).fold(0.0, f64::max);
        let least = 0.5 * size(&self.z);
        let (z, frequencies) = newton(system, &present, &symmetries, self.z.clone(), least)?;
        (size(&z) < 4.0 * least).then(|| {
            let z = turned(z, &present, &symmetries);
            Equilibrium {
                eigenvalues: eigenvalues(system, &z, &frequencies),
                z,
                frequencies,
            }
        })
    }
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

/// The relative difference below which two solutions are one. Near onset the rounding of frequencies is a part of the growth rates.
fn resolution(system: &AmplitudeSystem) -> f64 {
    let linear = system
        .equations
        .iter()
        .flatten()
        .filter(|t| t.monomial.degree() == 1);
    let (rate, growth) = linear.fold((0.0_f64, f64::INFINITY), |(rate, growth), term| {
        (rate.max(term.g.norm()), growth.min(term.g.re.abs()))
    });
    let rounding = 256.0 * f64::EPSILON * rate / growth;
    SAME.max(if rounding.is_finite() {
        rounding.min(0.3)
    } else {
        0.3
    })
}

/// Whether two states differ by a symmetry: the moduli and all terms of the equations, over their amplitudes, agree.
fn same(system: &AmplitudeSystem, a: &[C64], b: &[C64]) -> bool {
    let tolerance = resolution(system);
    let size = a.iter().map(|z| z.norm()).fold(0.0, f64::max);
    let moduli = a.iter().zip(b);
    if moduli
        .into_iter()
        .any(|(a, b)| (a.norm() - b.norm()).abs() > tolerance * size)
    {
        return false;
    }
    let equations = system.equations.iter().enumerate();
    let mut terms = equations.flat_map(|(j, e)| e.iter().map(move |t| (j, t)));
    terms.all(|(j, term)| {
        let value = |z: &[C64]| power(&term.monomial, z) * z[j].conj();
        let (a, b) = (value(a), value(b));
        (a - b).norm() <= 10.0 * tolerance * a.norm().max(b.norm())
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
    if !jacobian.iter().all(|v| v.is_finite()) {
        return None;
    }
    let mut values: Vec<C64> = jacobian.complex_eigenvalues().iter().copied().collect();
    values.sort_by(|a, b| a.norm().total_cmp(&b.norm()));
    let mut rest = values.split_off(neutral);
    rest.sort_by(|a, b| b.re.total_cmp(&a.re).then(b.im.total_cmp(&a.im)));
    Some(rest)
}
