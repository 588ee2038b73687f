//! The amplitude equation of one mode, dA/dt = a0 A + a2 A³ + a4 A⁵ + …: equilibria at every order and of the
//! Padé approximant, and how far the series can be trusted.

use crate::measured::{Decided, Measured};
use crate::model::C64;
use nalgebra::{DMatrix, DVector};

/// The amplitude of a Padé approximant whose error exceeds this part of it is not decided: its error bar is linear, which
/// does not hold for changes as large as the amplitude.
const UNDECIDED: f64 = 0.5;

/// c0, c2, c4, … with their absolute errors.
#[derive(Clone, Debug)]
pub struct AmplitudeEquation {
    /// c0, c2, c4, …
    pub coefficients: Vec<Measured<C64>>,
}

impl AmplitudeEquation {
    /// The order of the last term.
    pub fn order(&self) -> usize {
        2 * self.coefficients.len() - 1
    }

    /// A_e: the root A of a0 + a2 A² + … through `order` that continues P (4.1), the smallest positive one; the reason
    /// where there is none, or where errors leave a0 or the root undecided.
    ///
    /// Whatever the coefficients within their errors, the polynomial in E = A² > 0 lies between those with all
    /// coefficients at one end of their bars. The smallest roots of these two enclose its smallest root.
    pub fn equilibrium(&self, order: usize) -> Decided {
        let real = self.real(order.div_ceil(2))?;
        let sign = real[0].value.signum();
        let at = |side: f64| -> Vec<f64> {
            let shifted = |c: &Measured| sign * c.value + side * c.error;
            real.iter().map(shifted).collect()
        };
        let Some(least) = smallest_root(&at(-1.0)) else {
            return Err(match order {
                3 => "there is no equilibrium at cubic order".to_owned(),
                _ => format!("there is no equilibrium at order {order}"),
            });
        };
        let [Some(middle), Some(most)] = [0.0, 1.0].map(|side| smallest_root(&at(side))) else {
            return Err(format!(
                "the errors of the coefficients leave undecided whether there is an equilibrium at order {order}"
            ));
        };
        Ok(Measured::new(middle, (most - middle).max(middle - least)))
    }

    /// A_e of the diagonal Padé approximant of a0 + a2 E + a4 E² + … in E = A²: the smallest zero, where no pole lies
    /// before it. Its error is the sum of what the error of each coefficient changes.
    pub fn pade(&self) -> Decided {
        if self.coefficients.len() < 3 {
            return Err("the approximant needs order 5".to_owned());
        }
        let count = self.coefficients.len();
        let last = self.coefficients[count - 1];
        if last.value.norm() <= last.error {
            return Err(zero(2 * count - 2));
        }
        let real = self.real(count)?;
        let mut values: Vec<f64> = real.iter().map(|c| c.value).collect();
        let undecided = || "the errors of the coefficients leave its zero undecided".to_owned();
        let none = || "it has no zero before its first pole".to_owned();
        let amplitude = zero_of_pade(&values).ok_or_else(none)?;
        let mut error = 0.0;
        for (n, coefficient) in real.iter().enumerate() {
            let step = coefficient
                .error
                .max(4.0 * f64::EPSILON * coefficient.value.abs());
            let mut largest = 0.0_f64;
            for side in [step, -step] {
                values[n] = coefficient.value + side;
                let moved = zero_of_pade(&values).ok_or_else(undecided)?;
                largest = largest.max((moved - amplitude).abs());
            }
            values[n] = coefficient.value;
            error += largest;
        }
        if error > UNDECIDED * amplitude {
            return Err(undecided());
        }
        Ok(Measured::new(amplitude, error))
    }

    /// An estimate of the amplitude beyond which the series diverges, from its last coefficients; the error is that of
    /// the coefficients, not that of the estimate.
    pub fn radius(&self) -> Decided {
        let sizes: Vec<Measured> = self.coefficients[1..]
            .iter()
            .map(|c| Measured::new(c.value.norm(), c.error))
            .collect();
        let last = 2 * sizes.len();
        let nonzero = |n: usize, size: Measured| {
            if size.is_positive() {
                Ok(size)
            } else {
                Err(zero(n))
            }
        };
        let root = |a: Measured, b: Measured| {
            let quotient = nonzero(last, b).map(|b| a.over(b));
            quotient?.and_then(Measured::sqrt).ok_or_else(|| zero(last))
        };
        // radius² = |c_n/c_{n+2}|, or √|c_n/c_{n+4}| where there are that many: coefficients of a series whose singularities
        // lie off the real axis change sign irregularly, and two steps average over it.
        match sizes.as_slice() {
            [.., a, _, b] => {
                let square = root(nonzero(last - 4, *a)?, *b)?;
                square.sqrt().ok_or_else(|| zero(last))
            }
            [a, b] => root(nonzero(last - 2, *a)?, *b),
            _ => Err("an estimate needs order 5".to_owned()),
        }
    }

    /// The real parts of the first `count` coefficients, if a0 and what may balance it stand clear of their errors.
    fn real(&self, count: usize) -> std::result::Result<Vec<Measured>, String> {
        let real: Vec<Measured> = self.coefficients[..count].iter().map(|c| c.re()).collect();
        if real[0].sign().is_none() {
            return Err("the growth rate is zero within its error".to_owned());
        }
        if real[1..].iter().all(|c| c.sign().is_none()) {
            return Err(
                "the real parts of all nonlinear coefficients are zero within their errors"
                    .to_owned(),
            );
        }
        Ok(real)
    }
}

fn zero(n: usize) -> String {
    format!("c{n} is zero within its error")
}

/// √E of the smallest positive zero of the diagonal Padé approximant.
fn zero_of_pade(real: &[f64]) -> Option<f64> {
    let (above, below) = pade(real)?;
    let root = smallest_root(&above)?;
    // A pole before the root cuts the approximant off from the small amplitudes.
    let pole = smallest_root(&below);
    pole.is_none_or(|pole| pole > root).then_some(root)
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
    let companion = DMatrix::from_fn(degree, degree, |i, j| {
        if j + 1 == degree {
            -scaled[i] / last
        } else {
            f64::from(u8::from(i == j + 1))
        }
    });
    let value = |e: f64| scaled.iter().rev().fold(0.0, |sum, c| sum * e + c);
    let slope = |e: f64| {
        let terms = scaled.iter().enumerate().skip(1).rev();
        terms.fold(0.0, |sum, (n, c)| sum * e + n as f64 * c)
    };
    // A double root splits by the root of the machine's precision, about 10⁻⁸.
    let real = |root: &nalgebra::Complex<f64>| {
        (root.im.abs() <= 1e-7 * root.norm() && root.re > 0.0).then_some(root.re)
    };
    let roots = companion.complex_eigenvalues();
    let smallest = roots.iter().filter_map(real).min_by(f64::total_cmp)?;
    // Newton's method takes away the rounding of the eigenvalue problem.
    let polished = (0..4).fold(smallest, |e, _| match slope(e) {
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
    use super::{AmplitudeEquation, C64, Measured, pade, smallest_root};

    fn with_errors(real: &[f64], errors: &[f64]) -> AmplitudeEquation {
        let coefficient = |(&x, &error)| Measured::new(C64::new(x, 0.0), error);
        AmplitudeEquation {
            coefficients: real.iter().zip(errors).map(coefficient).collect(),
        }
    }

    fn equation(real: &[f64]) -> AmplitudeEquation {
        with_errors(real, &vec![1e-14; real.len()])
    }

    #[test]
    fn equilibria_by_order() {
        // (1 − E)(2 − E) = 2 − 3 E + E²
        let quintic = equation(&[2.0, -3.0, 1.0]);
        assert!((quintic.equilibrium(5).expect("a root").value - 1.0).abs() < 1e-14);
        let cubic = quintic.equilibrium(3).expect("a root").value;
        assert!((cubic - (2.0_f64 / 3.0).sqrt()).abs() < 1e-14);
        let none = equation(&[1.0, 1.0, 1.0]).equilibrium(5).expect_err("none");
        assert!(none.contains("no equilibrium"), "{none}");
    }

    /// a0 + a2 E with a0 = 4 ± 0.4 and a2 = −1 ± 0.1: E between 3.6/1.1 and 4.4/0.9.
    #[test]
    fn an_amplitude_has_the_error_of_its_coefficients() {
        let amplitude = with_errors(&[4.0, -1.0], &[0.4, 0.1]).equilibrium(3);
        let amplitude = amplitude.expect("a root");
        assert!((amplitude.value - 2.0).abs() < 1e-14);
        assert!((amplitude.error - ((4.4_f64 / 0.9).sqrt() - 2.0)).abs() < 1e-12);
    }

    /// What stands on a divisor or a sign within its error is no result.
    #[test]
    fn noise_decides_nothing() {
        let degenerate = with_errors(&[0.1, -1e-16, -1e-17], &[1e-15, 1e-14, 1e-14]);
        for answer in [
            degenerate.equilibrium(3),
            degenerate.equilibrium(5),
            degenerate.pade(),
            degenerate.radius(),
        ] {
            assert!(answer.is_err(), "{answer:?}");
        }
        // c4 = 0: the cubic amplitude stands, a radius does not.
        let cubic = with_errors(&[1.0, -4.0, 1.7e-29], &[1e-15, 1e-14, 1e-27]);
        assert!((cubic.equilibrium(5).expect("a root").value - 0.5).abs() < 1e-12);
        assert!(cubic.radius().expect_err("none").contains("c4 is zero"));
        let onset = with_errors(&[1e-16, -1.0, -1.0], &[1e-15, 1e-14, 1e-14]);
        assert!(
            onset
                .equilibrium(5)
                .expect_err("none")
                .contains("growth rate")
        );
        // Near a double root the errors decide whether there is one.
        let double = with_errors(&[1.0, -2.0, 1.0 + 1e-9], &[1e-6; 3]);
        assert!(
            double
                .equilibrium(5)
                .expect_err("none")
                .contains("undecided")
        );
    }

    /// (1 − 3 E)/(1 + 2 E) = 1 − 5 E + 10 E² − 20 E³ …: the approximant is exact, the series has radius 1/√2.
    #[test]
    fn a_rational_function() {
        let series = equation(&[1.0, -5.0, 10.0, -20.0, 40.0]);
        let whole = series.pade();
        assert!(
            whole.is_err() || whole.is_ok_and(|a| (a.value - (1.0_f64 / 3.0).sqrt()).abs() < 1e-6)
        );
        let short = equation(&[1.0, -5.0, 10.0]);
        let root = short.pade().expect("a root").value;
        assert!((root - (1.0_f64 / 3.0).sqrt()).abs() < 1e-14);
        assert!((short.radius().expect("a radius").value - 0.5_f64.sqrt()).abs() < 1e-14);
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
