//! Two-sided inverse iteration: an eigenvalue of L x = c M0 x with both vectors, one factorisation.

use super::dense::{Factorised, Scalar, dot, norm, scaled};
use crate::model::C64;
use faer::Mat;

/// Most iterations from one shift. Beside a simple eigenvalue far fewer are needed.
const MOST_ITERATIONS: usize = 30;
/// An entry of a vector that falls by more than this factor in one iteration is still on its way to a small value.
const FALLING: f64 = 1e3;
/// Error of a vector of norm 1 at which the iteration ends: 45 times the machine's precision.
const VECTOR: f64 = 1e-14;

/// An eigenvalue of a pencil with its vectors, each of norm 1.
#[derive(Clone, Debug)]
pub struct Eigen<T> {
    /// c with L x = c M0 x.
    pub c: C64,
    /// x with L x = c M0 x.
    pub right: Vec<T>,
    /// y with yᴴ L = c yᴴ M0.
    pub left: Vec<T>,
}

/// A matrix that is applied, from both sides.
pub trait Applied<T> {
    /// A x
    fn apply(&self, x: &[T]) -> Vec<T>;
    /// Aᴴ y
    fn apply_adjoint(&self, y: &[T]) -> Vec<T>;
}

/// A shift next to an eigenvalue c, off by 10⁻⁷ of it, or of a thousandth of `scale` where c is smaller. Inverse iteration
/// then gains seven digits in each step, and the matrix is far from singular to rounding.
pub fn beside(c: C64, scale: f64) -> C64 {
    c + C64::new(1e-7 * c.norm().max(1e-3 * scale), 0.0)
}

/// The eigenvalue of L x = c M0 x nearest to σ, with both vectors, from starts of these.
///
/// `shifted` is σ M0 − L and `shift` is σ. `scale` is the size of the slow eigenvalues, relative to which a small one is
/// zero. `None` where the iteration does not settle.
pub fn inverse_iteration<T: Scalar>(
    shifted: Mat<T>,
    mass: &impl Applied<T>,
    shift: C64,
    scale: f64,
    (right, left): (Vec<T>, Vec<T>),
) -> Option<Eigen<T>> {
    let factorised = Factorised::new(shifted);
    let (mut x, mut y) = (unit(&right), unit(&left));
    let mut mass_x = mass.apply(&right);
    let mut mass_y = mass.apply_adjoint(&left);
    let (mut c, mut change, mut turn) = (shift, f64::INFINITY, 1.0);
    for iteration in 0..MOST_ITERATIONS {
        let new_x = factorised.solve(&mass_x);
        let new_y = factorised.solve_adjoint(&mass_y);
        let (size_x, size_y) = (norm(&new_x), norm(&new_y));
        if !(size_x.is_finite() && size_y.is_finite()) || size_x == 0.0 || size_y == 0.0 {
            return None;
        }
        let new_mass_x = mass.apply(&new_x);
        // With (σ M0 − L) x_new = M0 x_old: c = σ − ⟨y_new, M0 x_old⟩ / ⟨y_new, M0 x_new⟩
        let denominator = dot(&new_y, &new_mass_x);
        if denominator.norm() == 0.0 {
            return None;
        }
        let next = shift - dot(&new_y, &mass_x) / denominator;
        let [new_x, new_y] = [scaled(&new_x, 1.0 / size_x), scaled(&new_y, 1.0 / size_y)];
        let falls = falls(&x, &new_x) || falls(&y, &new_y);
        // Errors of the vectors fall by one factor an iteration, until rounding stops them.
        let turn_before = f64::max(turn, f64::MIN_POSITIVE);
        turn = angle(&x, &new_x).max(angle(&y, &new_y));
        let aligned = turn * turn <= VECTOR * turn_before || turn >= 0.1 * turn_before;
        (x, y) = (new_x, new_y);
        mass_x = scaled(&new_mass_x, 1.0 / size_x);
        mass_y = mass.apply_adjoint(&y);
        let step = (next - c).norm();
        c = next;
        // The error of the eigenvalue is quadratic in that of the vectors: it settles first. Either its step is rounding,
        // or the steps are small and have stopped falling.
        let floor = 1e-14 * c.norm().max((shift - c).norm()) + 1e-17 * scale;
        let small = step < 1e-10 * c.norm().max(1e-6 * scale) && step >= 0.5 * change;
        let settled = step <= floor || small;
        if iteration > 0 && settled && aligned && !falls {
            return Some(Eigen {
                c,
                right: x,
                left: y,
            });
        }
        change = step;
    }
    None
}

/// Whether an entry falls by orders of magnitude. A field in small units has small entries, which the start does not
/// know of; the eigenvalue may settle long before they do.
fn falls<T: Scalar>(before: &[T], after: &[T]) -> bool {
    let mut pairs = before.iter().zip(after);
    pairs.any(|(b, a)| b.size() > FALLING * a.size() && a.size() > 0.0)
}

/// A vector scaled to size one.
fn unit<T: Scalar>(x: &[T]) -> Vec<T> {
    scaled(x, 1.0 / norm(x).max(f64::MIN_POSITIVE))
}

/// ‖b − (aᴴb) a‖, the sine of the angle between two vectors of size one.
fn angle<T: Scalar>(a: &[T], b: &[T]) -> f64 {
    let along = T::from_complex(dot(a, b));
    let across: Vec<T> = a.iter().zip(b).map(|(&a, &b)| b - along * a).collect();
    norm(&across)
}

#[cfg(test)]
mod tests {
    use super::{Applied, beside, inverse_iteration};
    use crate::model::C64;
    use faer::{Mat, mat};

    struct Dense(Mat<f64>);

    impl Applied<f64> for Dense {
        fn apply(&self, x: &[f64]) -> Vec<f64> {
            crate::numerics::dense::apply(self.0.as_ref(), x)
        }

        fn apply_adjoint(&self, y: &[f64]) -> Vec<f64> {
            crate::numerics::dense::apply(self.0.transpose(), y)
        }
    }

    /// x' = −3x + 2y, 2y' = 4x − 2y − z, 0 = x − z: x' = −3x + 2y, y' = 1.5x − y, so that c² + 4c = 0.
    #[test]
    fn a_pencil_with_a_constraint() {
        let operator = mat![[-3.0, 2.0, 0.0], [4.0, -2.0, -1.0], [1.0, 0.0, -1.0]];
        let mass = Dense(mat![[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 0.0]]);
        for exact in [0.0, -4.0] {
            let shift = beside(C64::new(exact + 1e-3, 0.0), 1.0);
            let shifted = Mat::from_fn(3, 3, |i, j| shift.re * mass.0[(i, j)] - operator[(i, j)]);
            let starts = (vec![1.0, 0.3, 0.7], vec![0.2, 1.0, -0.4]);
            let eigen = inverse_iteration(shifted, &mass, shift, 1.0, starts).expect("a mode");
            assert!((eigen.c - exact).norm() < 1e-13, "{}", eigen.c);
            // x = (2, 3 + c, 2); of the left vector yᴴ(L − c M0) = 0.
            let expected = [2.0, 3.0 + exact, 2.0];
            for i in 0..3 {
                let ratio = eigen.right[i] / eigen.right[0];
                assert!((ratio - expected[i] / expected[0]).abs() < 1e-12);
            }
            for j in 0..3 {
                let sum: f64 = (0..3)
                    .map(|i| eigen.left[i] * (operator[(i, j)] - exact * mass.0[(i, j)]))
                    .sum();
                assert!(sum.abs() < 1e-12, "column {j}: {sum}");
            }
        }
    }
}
