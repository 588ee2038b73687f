//! Newton's method for equilibria of amplitude equations: every amplitude is constant or turns at a constant frequency.

use super::system::{AmplitudeSystem, Term, power};
use crate::model::C64;
use crate::numerics::{Failure, Linearised, Newton, System};
use nalgebra::{DMatrix, DVector};

/// Whole steps from one start. Starts are many and cheap, and one from which the iteration does not converge is given up.
const METHOD: Newton = Newton {
    most_steps: 60,
    least_part: 1.0,
};
/// Residual of an equation at a solution, relative to the sum of its terms' absolute values. A hundred times above what
/// the rounding of a few dozen terms leaves.
const TOLERANCE: f64 = 1e-11;
/// Rounding error of a sum, relative to the sum of its terms' absolute values.
const ROUNDING: f64 = 4.0 * f64::EPSILON;
/// A frequency below this part of the largest term of dz_j/dt over z_j is zero: above the rounding of a solution to
/// [`TOLERANCE`], and below any frequency that matters.
const STILL: f64 = 1e-9;

/// dz_j/dt = i Σ_a ν_a w_aj z_j for the modes present; unknowns are Re z_j, Im z_j by mode, then the ν_a.
struct Standing<'a> {
    system: &'a AmplitudeSystem,
    present: &'a [usize],
    /// w, `[symmetry][mode]`.
    symmetries: &'a [Vec<f64>],
    /// Range of max |z_j| in which a state is looked for.
    sizes: std::ops::Range<f64>,
}

/// Amplitudes and frequencies of all modes, with the sizes of the equations' terms there.
struct Rates {
    z: Vec<C64>,
    omega: Vec<f64>,
    /// By mode present.
    terms: Vec<Terms>,
}

/// Sizes of the terms of one equation before they cancel.
struct Terms {
    /// |z_j| Σ |Re (term / z_j)|
    growth: f64,
    /// Σ |terms|, the frequency among them.
    all: f64,
}

impl Standing<'_> {
    /// z of all modes, zero where a mode is absent.
    fn amplitudes(&self, x: &[f64]) -> Vec<C64> {
        let mut z = vec![C64::new(0.0, 0.0); self.system.modes()];
        for (a, &j) in self.present.iter().enumerate() {
            z[j] = C64::new(x[2 * a], x[2 * a + 1]);
        }
        z
    }

    /// ω_j = Σ_a ν_a w_aj of all modes.
    fn frequencies(&self, x: &[f64]) -> Vec<f64> {
        let nu = &x[2 * self.present.len()..];
        let omega = |j: usize| nu.iter().zip(self.symmetries).map(|(n, w)| n * w[j]).sum();
        (0..self.system.modes()).map(omega).collect()
    }
}

impl System for Standing<'_> {
    type Jacobian = DMatrix<f64>;
    type Byproduct = Rates;
    type Error = Failure;

    fn linearise(&mut self, x: &[f64]) -> Result<Option<Linearised<Self>>, Failure> {
        let (system, m) = (self.system, self.present.len());
        let (z, omega) = (self.amplitudes(x), self.frequencies(x));
        let rates = system.rates(&z);
        let mut residual = Vec::with_capacity(2 * m);
        for &j in self.present {
            // dz_j/dt − i ω_j z_j
            let left = rates[j] - C64::new(0.0, omega[j]) * z[j];
            residual.extend([left.re, left.im]);
        }
        let [slopes, conjugate] = system.slopes(&z);
        let mut jacobian = DMatrix::<f64>::zeros(2 * m, x.len());
        for (a, &i) in self.present.iter().enumerate() {
            for (b, &j) in self.present.iter().enumerate() {
                let slope = slopes[i][j] - C64::new(0.0, if i == j { omega[i] } else { 0.0 });
                fill(&mut jacobian, (a, b), slope, conjugate[i][j]);
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
            byproduct: Rates { z, omega, terms },
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

    /// The solution of least size, which leaves free phases where they are. Singular values below 10⁻¹² of the largest are
    /// free phases.
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
        let Rates { z, terms, .. } = &at.byproduct;
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

/// The equilibrium that Newton's method reaches from a start, as z and ω of all modes. `None` where it does not converge
/// to amplitudes between `least` and a thousand times the start, or a mode of `present` fades to zero on the way.
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
    let Rates { z, omega, terms } = at.byproduct;
    let most = largest(&z);
    // An amplitude of 10⁻⁵ of the largest is on its way to zero.
    let genuine = |&j: &usize| z[j].norm() > 1e-5 * most;
    let rates = present
        .iter()
        .zip(&terms)
        .map(|(&j, terms)| terms.all / z[j].norm());
    let still = STILL * rates.fold(0.0, f64::max);
    let settled = |omega: f64| if omega.abs() <= still { 0.0 } else { omega };
    let all_present = present.iter().all(genuine);
    all_present.then(|| (z.clone(), omega.into_iter().map(settled).collect()))
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

/// Writes the map dz → a dz + b dz̄ as a real block of two by two at (2 row, 2 column).
pub(super) fn fill(matrix: &mut DMatrix<f64>, (row, column): (usize, usize), a: C64, b: C64) {
    let (r, c) = (2 * row, 2 * column);
    matrix[(r, c)] = a.re + b.re;
    matrix[(r, c + 1)] = b.im - a.im;
    matrix[(r + 1, c)] = a.im + b.im;
    matrix[(r + 1, c + 1)] = a.re - b.re;
}
