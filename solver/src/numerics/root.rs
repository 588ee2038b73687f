//! Roots of continuous functions of one variable.

use crate::error::{Error, Result};

/// Most evaluations of the function. Brent's method needs some ten, and bisection to the machine's precision about fifty.
const MOST_ITERATIONS: usize = 100;

/// A root of f between a and b by Brent's method (Brent 1973, chapter 4), with the value of f there. `fa` and `fb` are the
/// values at a and b, of opposite sign. `tolerance` is the absolute error of the root.
///
/// # Errors
/// f fails, or the iteration does not converge.
pub fn brent(
    mut f: impl FnMut(f64) -> Result<f64>,
    (mut a, mut fa): (f64, f64),
    (mut b, mut fb): (f64, f64),
    tolerance: f64,
) -> Result<(f64, f64)> {
    let (mut c, mut fc, mut d) = (a, fa, b - a);
    let mut e = d;
    for _ in 0..MOST_ITERATIONS {
        if fb * fc > 0.0 {
            (c, fc) = (a, fa);
            d = b - a;
            e = d;
        }
        if fc.abs() < fb.abs() {
            (a, b, c) = (b, c, b);
            (fa, fb, fc) = (fb, fc, fb);
        }
        let near = 2.0 * f64::EPSILON * b.abs() + 0.5 * tolerance;
        let half = 0.5 * (c - b);
        if half.abs() <= near || fb == 0.0 {
            return Ok((b, fb));
        }
        if e.abs() >= near && fa.abs() > fb.abs() {
            let s = fb / fa;
            let (mut p, mut q) = if a == c {
                (2.0 * half * s, 1.0 - s)
            } else {
                let (q, r) = (fa / fc, fb / fc);
                (
                    s * (2.0 * half * q * (q - r) - (b - a) * (r - 1.0)),
                    (q - 1.0) * (r - 1.0) * (s - 1.0),
                )
            };
            if p > 0.0 {
                q = -q;
            }
            p = p.abs();
            if 2.0 * p < (3.0 * half * q - (near * q).abs()).min((e * q).abs()) {
                e = d;
                d = p / q;
            } else {
                d = half;
                e = d;
            }
        } else {
            d = half;
            e = d;
        }
        (a, fa) = (b, fb);
        b += if d.abs() > near {
            d
        } else {
            near.copysign(half)
        };
        fb = f(b)?;
    }
    Err(Error::computation(format!("no root was found near {b}")))
}

#[cfg(test)]
mod tests {
    use super::brent;

    #[test]
    fn roots_of_known_functions() {
        let root = |f: fn(f64) -> f64, a: f64, b: f64| {
            brent(|x| Ok(f(x)), (a, f(a)), (b, f(b)), 1e-14)
                .expect("a root")
                .0
        };
        // Dottie's number
        assert!((root(|x| x.cos() - x, 0.0, 1.0) - 0.739_085_133_215_160_6).abs() < 1e-13);
        assert!((root(|x| x * x * x - 2.0, 3.0, 0.0) - 2.0_f64.cbrt()).abs() < 1e-13);
        // Flat at both ends, steep at the root.
        assert!((root(|x| (20.0 * (x - 0.3)).tanh(), -1.0, 1.0) - 0.3).abs() < 1e-12);
    }
}
