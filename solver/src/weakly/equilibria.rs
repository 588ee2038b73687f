//! Equilibria of amplitude equations up to phase: states that the symmetries of the equations alone move.
//!
//! A symmetry turns z_j by w_j θ; a row w belongs to one where every monomial of the equation of z_j turns like
//! z_j itself: Σ_i w_i (p_i − s_i) = w_j. At an equilibrium dz_j/dt = i Σ_a ν_a w_aj z_j.

use super::standing::{fill, newton};
use super::system::{AmplitudeSystem, power};
use crate::model::C64;
use nalgebra::{DMatrix, DVector};

/// Most starts of Newton's method for one set of modes present: a bound on the work.
const MOST_STARTS: usize = 3000;
/// Number of phases that are tried for each amplitude but the first, whose phase is free.
const PHASES: usize = 8;
/// Two solutions whose amplitudes differ by less than this part of the largest are one. Newton's method leaves 10⁻¹¹ of
/// the terms of the equations.
const SAME: f64 = 1e-6;
/// A state whose amplitudes fall below this part of the smallest start is on its way to zero, and is given up.
const VANISHING: f64 = 1e-3;
/// Entries of matrices of whole numbers below this are zero, and so are their singular values in the rank.
const WHOLE: f64 = 1e-9;

/// A state whose amplitudes are constant or turn at a constant frequency each.
#[derive(Clone, Debug)]
pub struct Equilibrium {
    /// The amplitudes, turned so that as many as possible are real and positive.
    pub z: Vec<C64>,
    /// ω_j = (dz_j/dt)/(i z_j) by mode, in units of c0; zero where nothing moves.
    pub frequencies: Vec<f64>,
    /// Eigenvalues of the linearised amplitude equations in the frame that moves with the state, by decreasing real part.
    /// Zeros of the phases that symmetries leave free are left out. `None` where no frame makes the linearisation constant.
    pub eigenvalues: Option<Vec<C64>>,
}

impl Equilibrium {
    /// Whether every perturbation decays; `None` without eigenvalues.
    pub fn stable(&self) -> Option<bool> {
        let values = self.eigenvalues.as_ref()?;
        Some(values.iter().all(|c| c.re < 0.0))
    }

    /// The speed at which the pattern travels as a whole, towards +x where positive: −ω_j/q_j. `None` where that differs
    /// between the modes present.
    pub fn drift(&self, q: &[f64]) -> Option<f64> {
        let present = (0..q.len()).filter(|&j| self.z[j] != C64::new(0.0, 0.0));
        let speeds: Vec<f64> = present.map(|j| -self.frequencies[j] / q[j]).collect();
        let first = *speeds.first()?;
        let size = speeds.iter().fold(0.0, |m: f64, s| m.max(s.abs()));
        let same = speeds.iter().all(|s| (s - first).abs() <= 1e-6 * size);
        same.then_some(first)
    }
}

/// All equilibria but zero that Newton's method reaches from a fixed set of starts, ordered by the modes present, then by
/// Σ|z|².
pub fn equilibria(system: &AmplitudeSystem) -> Vec<Equilibrium> {
    let n = system.modes();
    let mut equilibria: Vec<Equilibrium> = Vec::new();
    for mask in 1_u32..1 << n {
        let present: Vec<usize> = (0..n).filter(|j| mask >> j & 1 == 1).collect();
        if !is_invariant(system, &present) {
            continue;
        }
        let symmetries = symmetries(system, &present);
        let mut of_these_modes: Vec<Equilibrium> = Vec::new();
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
            let is_same = |e: &Equilibrium| same(system, &e.z, &z);
            if !of_these_modes.iter().any(is_same) {
                let z = turned(z, &present, &symmetries);
                let eigenvalues = eigenvalues(system, &z, &frequencies);
                of_these_modes.push(Equilibrium {
                    z,
                    frequencies,
                    eigenvalues,
                });
            }
        }
        let size = |e: &Equilibrium| e.z.iter().map(|z| z.norm_sqr()).sum::<f64>();
        of_these_modes.sort_by(|a, b| size(a).total_cmp(&size(b)));
        equilibria.extend(of_these_modes);
    }
    equilibria
}

impl Equilibrium {
    /// The equilibrium next to this one of a system that differs little. `None` where Newton's method from here reaches
    /// none of half to twice the size.
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

/// Whether amplitudes of absent modes stay zero: their equations hold no term in the amplitudes present alone.
fn is_invariant(system: &AmplitudeSystem, present: &[usize]) -> bool {
    let absent = (0..system.modes()).filter(|j| !present.contains(j));
    let mut terms = absent.flat_map(|j| &system.equations[j]);
    terms.all(|term| {
        let exponents = term.monomial.z.iter().zip(&term.monomial.conj).enumerate();
        let mut outside = exponents.filter(|(i, (p, s))| !present.contains(i) && **p + **s > 0);
        outside.next().is_some() || term.g.norm() == 0.0
    })
}

/// A basis of the symmetries of the equations of the modes present, `[symmetry][mode]`, with zeros for absent modes.
///
/// A symmetry w satisfies Σ_i w_i (p_i − s_i) − w_j = 0 for every monomial (p, s) of the equation of z_j.
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
            let entry = |&i: &usize| differences[i] - f64::from(u8::from(i == j));
            rows.push(present.iter().map(entry).collect());
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

/// A basis of the x with Σ_j rows[r][j] x_j = 0 for every r, by Gauss's elimination; the rows hold small whole numbers.
fn null_space(mut rows: Vec<Vec<f64>>, n: usize) -> Vec<Vec<f64>> {
    let mut pivots: Vec<usize> = Vec::new();
    for column in 0..n {
        let rank = pivots.len();
        let Some(pivot) = (rank..rows.len()).find(|&r| rows[r][column].abs() > WHOLE) else {
            continue;
        };
        rows.swap(rank, pivot);
        let lead = rows[rank][column];
        rows[rank].iter_mut().for_each(|x| *x /= lead);
        let pivot_row = rows[rank].clone();
        for (_, row) in rows.iter_mut().enumerate().filter(|(r, _)| *r != rank) {
            let factor = row[column];
            let entries = row.iter_mut().zip(&pivot_row);
            entries.for_each(|(x, pivot)| *x -= factor * pivot);
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

/// Starts for Newton's method, `[start][mode]`: every combination of some sizes of each amplitude and some phases. Sizes
/// are in geometric progression from a tenth of the smallest at which two terms of an equation balance to three times the
/// largest.
fn starts(system: &AmplitudeSystem, present: &[usize]) -> Vec<Vec<C64>> {
    let Some([least, most]) = balances(system, present) else {
        return Vec::new();
    };
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

/// The smallest and the largest |z| at which two terms of an equation balance: |g_a| |z|^m = |g_b| |z|^n. `None` where no
/// two do.
fn balances(system: &AmplitudeSystem, present: &[usize]) -> Option<[f64; 2]> {
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
    least.is_finite().then_some([least, most])
}

/// The relative difference below which two solutions are one: [`SAME`], or more near onset, where rounding of c_j is no
/// small part of the growth rate a_j. There it is 256 ε |c_j| / a_j, with 0.3 as the most.
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

/// Whether two states differ by a symmetry alone: |z_j|, and each term of dz_j/dt times z̄_j, are the same in both.
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

/// A state turned by the symmetries so that as many amplitudes as possible are real and positive, in the order of modes.
fn turned(z: Vec<C64>, present: &[usize], symmetries: &[Vec<f64>]) -> Vec<C64> {
    let mut rows: Vec<Vec<f64>> = Vec::new();
    let mut phases: Vec<f64> = Vec::new();
    for &j in present {
        let row: Vec<f64> = symmetries.iter().map(|w| w[j]).collect();
        let mut extended = rows.clone();
        extended.push(row);
        let matrix = DMatrix::from_fn(extended.len(), symmetries.len(), |i, k| extended[i][k]);
        if symmetries.is_empty() || matrix.rank(WHOLE) < extended.len() {
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
        .solve(&DVector::from_vec(phases), WHOLE)
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
        if turned.im.abs() <= 1e-9 * turned.norm() {
            C64::new(turned.re, 0.0)
        } else {
            turned
        }
    };
    z.into_iter().enumerate().map(turn).collect()
}

/// Eigenvalues of the equations of all modes, linearised about a state in the frame that moves with it: with z_j =
/// (ζ_j + δ_j) e^{iω_j t} and ω_j = Σ_a ν_a w_aj,
///
/// dδ_i/dt = Σ_j (∂ż_i/∂z_j − i ω_i δ_ij) δ_j + ∂ż_i/∂z̄_j δ̄_j.
///
/// Zeros of the phases that the symmetries leave free are left out. `None` where no symmetry moves the modes as they move.
fn eigenvalues(system: &AmplitudeSystem, z: &[C64], frequencies: &[f64]) -> Option<Vec<C64>> {
    let n = z.len();
    let all: Vec<usize> = (0..n).collect();
    let symmetries = symmetries(system, &all);
    let present: Vec<usize> = all
        .iter()
        .copied()
        .filter(|&j| z[j] != C64::new(0.0, 0.0))
        .collect();
    // The frame: Σ_a ν_a w_aj = ω_j for the modes present.
    let d = symmetries.len();
    let matrix = DMatrix::from_fn(present.len(), d, |i, a| symmetries[a][present[i]]);
    let right = DVector::from_fn(present.len(), |i, _| frequencies[present[i]]);
    let (nu, neutral) = if d == 0 {
        (DVector::zeros(0), 0)
    } else {
        let neutral = matrix.rank(WHOLE);
        (
            matrix.clone().svd(true, true).solve(&right, WHOLE).ok()?,
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
            let slope = slopes[i][j] - C64::new(0.0, if i == j { omega } else { 0.0 });
            fill(&mut jacobian, (i, j), slope, conjugate[i][j]);
        }
    }
    if !jacobian.iter().all(|v| v.is_finite()) {
        return None;
    }
    let mut values: Vec<C64> = jacobian.complex_eigenvalues().iter().copied().collect();
    values.sort_by(|a, b| a.norm().total_cmp(&b.norm()));
    // The smallest are the zeros of the free phases.
    let mut eigenvalues = values.split_off(neutral);
    eigenvalues.sort_by(|a, b| b.re.total_cmp(&a.re).then(b.im.total_cmp(&a.im)));
    Some(eigenvalues)
}
