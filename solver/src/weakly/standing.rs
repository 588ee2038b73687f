//! Newton's method for states of amplitude equations that stand, drift or oscillate with one frequency a mode.

use super::system::{AmplitudeSystem, Term, power};
use crate::model::C64;
use crate::numerics::{Failure, Linearised, Newton, System};
use nalgebra::{DMatrix, DVector};

/// From one start.
const METHOD: Newton = Newton {
    most_steps: 60,
    least_part: 1.0,
};
/// What is left of the equations at a solution, relative to their terms.
const TOLERANCE: f64 = 1e-11;
/// What rounding leaves of a sum, relative to its terms.
const ROUNDING: f64 = 4.0 * f64::EPSILON;
/// A frequency below this part of the rates is zero.
const STILL: f64 = 1e-9;

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
    /// Of each equation present.
    terms: Vec<Terms>,
}

/// What the sides of an equation are as large as.
struct Terms {
    /// |z_j| Σ |Re (term / z_j)|
    growth: f64,
    /// Σ |terms|, the frequency among them.
    all: f64,
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
        let terms = |&j: &usize| {
            // dz_j/dt over z_j: growth has to balance growth, whatever the frequencies.
            let rate = |t: &Term| t.g * power(&t.monomial, &z) / z[j];
            let rates: Vec<C64> = system.equations[j].iter().map(rate).collect();
            let size = z[j].norm();
            Terms {
                growth: size * rates.iter().map(|c| c.re.abs()).sum::<f64>(),
                all: size * (omega[j].abs() + rates.iter().map(|c| c.norm()).sum::<f64>()),
            }
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
        if !at
            .jacobian
            .iter()
            .chain(right.iter())
            .all(|v| v.is_finite())
        {
            return Ok(None);
        }
        let solved = at.jacobian.clone().svd(true, true);
        let floor = 1e-12 * solved.singular_values.max();
        let step = solved.solve(&right, floor).ok();
        Ok(step.map(|step| step.iter().copied().collect()))
    }

    fn is_last(&self, _: &[f64], _: &[f64]) -> bool {
        false
    }

    fn is_solution(&self, _: &[f64], at: &Linearised<Self>) -> bool {
        let Rates { z, terms, .. } = &at.known;
        let residuals = self.present.iter().zip(at.residual.chunks(2)).zip(terms);
        residuals.into_iter().all(|((&j, r), terms)| {
            let residual = C64::new(r[0], r[1]);
            // In the direction of z_j, where the terms of the growth rate balance, and altogether.
            let growth = (residual / z[j]).re.abs() * z[j].norm();
            growth <= TOLERANCE * terms.growth + ROUNDING * terms.all
                && residual.norm() <= TOLERANCE * terms.all
        })
    }
}

/// The state from a start, with its frequencies.
pub(super) fn newton(
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
        .map(|(&j, terms)| terms.all / z[j].norm());
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
pub(super) fn fill(matrix: &mut DMatrix<f64>, (row, column): (usize, usize), a: C64, b: C64) {
    let (r, c) = (2 * row, 2 * column);
    matrix[(r, c)] = a.re + b.re;
    matrix[(r, c + 1)] = b.im - a.im;
    matrix[(r + 1, c)] = a.im + b.im;
    matrix[(r + 1, c + 1)] = a.re - b.re;
}
