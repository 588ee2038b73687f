//! The amplitude equation of one mode, dA/dt = a0 A + a2 A³ + a4 A⁵ + …: equilibria at every order and of the
//! Padé approximant, and how far the series can be trusted.

use crate::model::C64;
use nalgebra::{DMatrix, DVector};

/// c0, c2, c4, … with their absolute errors.
#[derive(Clone, Debug)]
pub struct AmplitudeEquation {
    /// c0, c2, c4, …
    pub coefficients: Vec<C64>,
    /// Absolute errors of these.
    pub errors: Vec<f64>,
}

impl AmplitudeEquation {
    /// The order of the last term.
    pub fn order(&self) -> usize {
        2 * self.coefficients.len() - 1
    }

    /// A_e: the root A of a0 + a2 A² + … through `order` that continues P (4.1), the smallest positive one; nothing
    /// where errors leave a0 or the slope undecided.
    pub fn equilibrium(&self, order: usize) -> Option<f64> {
        let count = order.div_ceil(2);
        let real: Vec<f64> = self.coefficients[..count].iter().map(|c| c.re).collect();
        self.decided(&real).then(|| smallest_root(&real))?
    }

    /// A_e of the diagonal Padé approximant of a0 + a2 E + a4 E² + … in E = A².
    pub fn pade(&self) -> Option<f64> {
        let real: Vec<f64> = self.coefficients.iter().map(|c| c.re).collect();
        if real.len() < 3 || !self.decided(&real) {
            return None;
        }
        let (above, below) = pade(&real)?;
        let root = smallest_root(&above)?;
        // A pole before the root cuts the approximant off from the small amplitudes.
        let pole = smallest_root(&below);
        pole.is_none_or(|pole| pole > root).then_some(root)
    }

    /// An estimate of the amplitude beyond which the series diverges, from its last coefficients.
    pub fn radius(&self) -> Option<f64> {
        let sizes: Vec<f64> = self.coefficients[1..].iter().map(|c| c.norm()).collect();
        // |c_n/c_{n+1}| in A²; over two steps where there are, for the sign of singularities off the axis swings.
        let square = match sizes.as_slice() {
            [.., a, _, b] => (a / b).sqrt(),
            [a, b] => a / b,
            _ => return None,
        };
        (square.is_finite() && square > 0.0).then(|| square.sqrt())
    }

    /// Whether a0 and what balances it stand clear of their errors.
    fn decided(&self, real: &[f64]) -> bool {
        let clear = |i: usize| real[i].abs() > self.errors[i];
        clear(0) && (1..real.len()).any(clear)
    }
}

/// √E of the smallest positive root of Σ coefficients[n] Eⁿ.
fn smallest_root(coefficients: &[f64]) -> Option<f64> {
    let degree = coefficients.iter().rposition(|c| *c != 0.0)?;
    // In units in which the coefficients are comparable.
    let unit = (1..=degree)
        .filter(|&n| coefficients[n] != 0.0)
        .map(|n| {
            (coefficients[0] / coefficients[n])
                .abs()
                .powf(1.0 / n as f64)
        })
        .fold(f64::INFINITY, f64::min);
    if degree == 0 || !unit.is_finite() || unit == 0.0 {
        return None;
    }
    let scaled: Vec<f64> = (0..=degree)
        .map(|n| coefficients[n] * unit.powi(n as i32))
        .collect();
    let last = scaled[degree];
    let companion = DMatrix::from_fn(degree, degree, |i, j| match j + 1 == degree {
        true => -scaled[i] / last,
        false => f64::from(u8::from(i == j + 1)),
    });
    let value = |e: f64| scaled.iter().rev().fold(0.0, |sum, c| sum * e + c);
    let slope = |e: f64| {
        let terms = scaled.iter().enumerate().skip(1).rev();
        terms.fold(0.0, |sum, (n, c)| sum * e + n as f64 * c)
    };
    let real = |root: &nalgebra::Complex<f64>| {
        (root.im.abs() <= 1e-7 * root.norm() && root.re > 0.0).then_some(root.re)
    };
    let roots = companion.complex_eigenvalues();
    let found = roots.iter().filter_map(real).min_by(f64::total_cmp)?;
    let polished = (0..4).fold(found, |e, _| match slope(e) {
        0.0 => e,
        slope => e - value(e) / slope,
    });
    Some((polished * unit).sqrt())
}

/// Numerator and denominator of the Padé approximant [⌈m/2⌉/⌊m/2⌋] of Σ_{n ≤ m} c_n Eⁿ.
fn pade(c: &[f64]) -> Option<(Vec<f64>, Vec<f64>)> {
    let m = c.len() - 1;
    let (above, below) = (m.div_ceil(2), m / 2);
    let at = |n: isize| usize::try_from(n).ok().and_then(|n| c.get(n)).copied();
    // In units of E in which the coefficients do not grow.
    let unit = (c[0].abs() / c[m].abs()).powf(1.0 / m as f64);
    let unit = if unit.is_finite() && unit > 0.0 {
        unit
    } else {
        1.0
    };
    let at = |n: isize| at(n).unwrap_or(0.0) * unit.powi(n.max(0) as i32);
    let matrix = DMatrix::from_fn(below, below, |i, j| {
        at(above as isize + i as isize - j as isize)
    });
    let right = DVector::from_fn(below, |i, _| -at((above + i) as isize + 1));
    let solution = matrix.lu().solve(&right)?;
    let mut denominator = vec![1.0];
    denominator.extend(solution.iter());
    let numerator = (0..=above).map(|n| {
        let terms = denominator.iter().enumerate().take(n + 1);
        terms.map(|(j, q)| q * at((n - j) as isize)).sum::<f64>()
    });
    let rescale = |series: Vec<f64>| -> Vec<f64> {
        let terms = series.into_iter().enumerate();
        terms.map(|(n, c)| c / unit.powi(n as i32)).collect()
    };
    Some((rescale(numerator.collect()), rescale(denominator)))
}

#[cfg(test)]
mod tests {
    use super::{AmplitudeEquation, C64, pade, smallest_root};

    fn equation(real: &[f64]) -> AmplitudeEquation {
        AmplitudeEquation {
            coefficients: real.iter().map(|&x| C64::new(x, 0.0)).collect(),
            errors: vec![1e-14; real.len()],
        }
    }

    #[test]
    fn equilibria_by_order() {
        // (1 − E)(2 − E) = 2 − 3 E + E²
        let found = equation(&[2.0, -3.0, 1.0]);
        assert!((found.equilibrium(5).expect("a root") - 1.0).abs() < 1e-14);
        let cubic = found.equilibrium(3).expect("a root");
        assert!((cubic - (2.0_f64 / 3.0).sqrt()).abs() < 1e-14);
        assert_eq!(equation(&[1.0, 1.0, 1.0]).equilibrium(5), None);
    }

    /// (1 − 3 E)/(1 + 2 E) = 1 − 5 E + 10 E² − 20 E³ …: the approximant is exact, the series has radius 1/√2.
    #[test]
    fn a_rational_function() {
        let series = equation(&[1.0, -5.0, 10.0, -20.0, 40.0]);
        assert!(
            (series
                .pade()
                .is_none_or(|a| (a - (1.0_f64 / 3.0).sqrt()).abs() < 1e-6))
        );
        let short = equation(&[1.0, -5.0, 10.0]);
        let root = short.pade().expect("a root");
        assert!((root - (1.0_f64 / 3.0).sqrt()).abs() < 1e-14);
        assert!((short.radius().expect("a radius") - 0.5_f64.sqrt()).abs() < 1e-14);
    }

    #[test]
    fn an_approximant_of_the_exponential() {
        // [1/1] of e^E = (1 + E/2)/(1 − E/2)
        let (above, below) = pade(&[1.0, 1.0, 0.5]).expect("an approximant");
        let near = |a: &[f64], b: [f64; 2]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-15);
        assert!(near(&above, [1.0, 0.5]) && near(&below, [1.0, -0.5]));
        assert_eq!(smallest_root(&[4.0, -1.0]), Some(2.0));
    }
}
