//! Infinite eigenvalues of a pencil L x = c M0 x deflated exactly, so that none can show up as a spurious
//! finite one.

use super::scale::Spectrum;
use crate::error::{Error, Result};
use crate::model::C64;
use crate::numerics::dense::Scalar;
use faer::linalg::solvers::Solve;
use faer::{Mat, MatRef};

/// Rounds of deflation: boundary conditions, a constraint, its hidden constraint, and some to spare.
const MOST_DEFLATIONS: usize = 6;
/// A pivot of a QR decomposition below this part of the largest is zero. It is far above rounding, and a mass that is
/// smaller than this beside the largest would be lost.
const RANK: f64 = 1e-11;
/// A hidden equation whose terms are below this part of the largest terms in rows with mass is rounding of these, some four
/// times the machine's precision, and determines nothing.
const NOISE: f64 = 1e-15;
/// Rounds of scaling rows and columns to comparable size.
const BALANCING: usize = 3;
/// Number of shifts that are tried: the first, one on the scale of the eigenvalues that it gives, and one more where a
/// shift hits an eigenvalue.
const MOST_SHIFTS: usize = 3;
/// The first shift, in units of 1/time of the model: Euler's constant. An eigenvalue of a model with round parameters is
/// hardly ever equal to it.
const FIRST_SHIFT: f64 = 0.577_215_664_901_532_9;
/// Ratio of the shift to the scale of the slow eigenvalues at which these are accurate: (L − σ M0)⁻¹ M0 loses the digits of
/// eigenvalues far below σ, and cannot tell those far above it from infinite ones.
const GOOD_SHIFT: std::ops::Range<f64> = 1e-3..1e6;

/// An eigenvalue with its right eigenvector.
pub type Mode = (C64, Vec<C64>);

/// A pencil without infinite eigenvalues: x = basis · w.
pub struct Reduced<T: Scalar> {
    operator: Mat<T>,
    mass: Mat<T>,
    basis: Mat<T>,
}

impl<T: Scalar> Reduced<T> {
    /// Removes the algebraic equations of a pencil, as often as they hide new ones.
    ///
    /// # Errors
    /// A pencil that is singular for every c, or has no finite eigenvalue.
    pub fn new((mut operator, mut mass): (Mat<T>, Mat<T>)) -> Result<Self> {
        let mut basis = balance(&mut operator, &mut mass);
        // Sizes of the whole pencil. After several deflations the rows that are left may be noise, which compared with
        // itself would look large.
        let rows = largest_of_rows(&mass)
            .into_iter()
            .zip(largest_of_rows(&operator));
        let with_mass = rows.filter(|(mass, _)| *mass > f64::MIN_POSITIVE);
        let terms = with_mass.map(|(_, terms)| terms).fold(0.0, f64::max);
        let masses = largest(&mass);
        // Boundary conditions and constraints as the model gives them may be in any units, and hold no noise.
        let mut noise = 0.0;
        for _ in 0..2 * MOST_DEFLATIONS {
            let size = operator.nrows();
            let zero = |i: &usize| (0..size).all(|j| mass[(*i, j)].size() == 0.0);
            let (algebraic, dynamic): (Vec<usize>, Vec<usize>) = (0..size).partition(zero);
            if dynamic.is_empty() {
                return Err(Error::computation(
                    "the problem has no finite eigenvalue at this wavenumber",
                ));
            }
            if algebraic.is_empty() {
                if !expose(&mut operator, &mut mass, masses) {
                    return Ok(Reduced {
                        operator,
                        mass,
                        basis,
                    });
                }
                noise = NOISE * terms;
                continue;
            }
            let null = null_space(&operator, &algebraic, noise)?;
            let rows = |m: &Mat<T>| Mat::from_fn(dynamic.len(), size, |i, j| m[(dynamic[i], j)]);
            operator = rows(&operator) * &null;
            mass = rows(&mass) * &null;
            basis = &basis * &null;
        }
        Err(Error::computation(
            "the mass matrix stays singular after its hidden constraints are removed",
        ))
    }

    /// All eigenvalues by decreasing real part.
    ///
    /// # Errors
    /// An iteration that does not converge.
    pub fn eigenvalues(&self) -> Result<Spectrum> {
        self.solve(|shift, inverse| {
            let values = T::eigenvalues(inverse)?;
            Some(values.into_iter().map(|mu| shift + mu.inv()).collect())
        })
        .map(Spectrum::new)
    }

    /// All eigenvalues with right eigenvectors of the whole pencil, by decreasing real part.
    ///
    /// # Errors
    /// An iteration that does not converge.
    pub fn eigenvectors(&self) -> Result<(Spectrum, Vec<Mode>)> {
        let mut vectors = Mat::zeros(0, 0);
        let values = self.solve(|shift, inverse| {
            let (values, of_inverse) = T::eigen(inverse)?;
            vectors = of_inverse;
            Some(values.into_iter().map(|mu| shift + mu.inv()).collect())
        })?;
        let n = self.basis.nrows();
        let basis = Mat::from_fn(n, self.basis.ncols(), |i, j| self.basis[(i, j)].complex());
        let full = &basis * &vectors;
        let column = |j: usize| (0..n).map(|i| full[(i, j)]).collect();
        let mut pairs: Vec<Mode> = (0..values.len())
            .filter(|&j| values[j].re.is_finite() && values[j].im.is_finite())
            .map(|j| (values[j], column(j)))
            .collect();
        pairs.sort_by(|a, b| super::scale::decreasing(&a.0, &b.0));
        Ok((Spectrum::new(values), pairs))
    }

    /// Eigenvalues by `method` from (L − σ M0)⁻¹ M0, σ being on the scale of the slow ones.
    fn solve(
        &self,
        mut method: impl FnMut(C64, MatRef<'_, T>) -> Option<Vec<C64>>,
    ) -> Result<Vec<C64>> {
        let mut shift = FIRST_SHIFT;
        let mut latest = None;
        for _ in 0..MOST_SHIFTS {
            let inverse = self.shift_invert(C64::new(shift, 0.0));
            let finite = (0..inverse.ncols())
                .all(|j| inverse.col_as_slice(j).iter().all(|v| v.size().is_finite()));
            let values = finite
                .then(|| method(C64::new(shift, 0.0), inverse.as_ref()))
                .flatten();
            let Some(values) = values else {
                // Any factor that is not 1 leads away from the eigenvalue that was hit.
                shift *= 1.37;
                continue;
            };
            let scale = Spectrum::new(values.clone()).scale();
            latest = Some(values);
            if scale == 0.0 || GOOD_SHIFT.contains(&(shift / scale)) {
                break;
            }
            shift = FIRST_SHIFT * scale;
        }
        latest.ok_or_else(|| Error::computation("the eigenvalue iteration did not converge"))
    }

    /// (L − σ M0)⁻¹ M0
    fn shift_invert(&self, shift: C64) -> Mat<T> {
        let n = self.operator.nrows();
        let shifted = Mat::from_fn(n, n, |i, j| {
            T::from_complex(self.operator[(i, j)].complex() - shift * self.mass[(i, j)].complex())
        });
        let scale: Vec<f64> = largest_of_rows(&shifted)
            .iter()
            .map(|s| s.recip())
            .collect();
        let row_scaled = |m: MatRef<'_, T>| Mat::from_fn(n, n, |i, j| m[(i, j)].times(scale[i]));
        let lu = row_scaled(shifted.as_ref()).partial_piv_lu();
        let mut inverse = row_scaled(self.mass.as_ref());
        lu.solve_in_place(inverse.as_mut());
        inverse
    }
}

/// Brings the entries of rows and columns to comparable size; the scales of the unknowns, diag(d) with
/// x = diag(d) w.
fn balance<T: Scalar>(operator: &mut Mat<T>, mass: &mut Mat<T>) -> Mat<T> {
    let n = operator.ncols();
    let mut scales = vec![1.0; n];
    for _ in 0..BALANCING {
        let sizes = largest_of_rows(operator);
        let sizes = sizes.into_iter().zip(largest_of_rows(mass));
        let factors: Vec<f64> = sizes.map(|(a, b)| power_of_two(a.max(b))).collect();
        scale_rows(operator, &factors);
        scale_rows(mass, &factors);
        for (j, scale) in scales.iter_mut().enumerate() {
            let column = operator.col_as_slice(j).iter().chain(mass.col_as_slice(j));
            let factor = power_of_two(column.map(|v| v.size()).fold(0.0, f64::max));
            *scale *= factor;
            for matrix in [&mut *operator, &mut *mass] {
                let entries = matrix.col_as_slice_mut(j);
                entries.iter_mut().for_each(|v| *v = v.times(factor));
            }
        }
    }
    // Rows of comparable mass, as long as a row without any is one of zeros: later, what cancels is noise.
    let factors: Vec<f64> = largest_of_rows(mass)
        .into_iter()
        .map(power_of_two)
        .collect();
    scale_rows(operator, &factors);
    scale_rows(mass, &factors);
    Mat::from_fn(n, n, |i, j| {
        T::from_complex(C64::new(if i == j { scales[i] } else { 0.0 }, 0.0))
    })
}

/// 1/size, rounded to a power of two, so that scaling is exact.
fn power_of_two(size: f64) -> f64 {
    if size > f64::MIN_POSITIVE && size.is_finite() {
        (-size.log2().round()).exp2()
    } else {
        1.0
    }
}

/// The largest modulus in every row; the smallest positive number for a row of zeros.
fn largest_of_rows<T: Scalar>(matrix: &Mat<T>) -> Vec<f64> {
    let mut largest = vec![f64::MIN_POSITIVE; matrix.nrows()];
    for j in 0..matrix.ncols() {
        for (most, entry) in largest.iter_mut().zip(matrix.col_as_slice(j)) {
            *most = most.max(entry.size());
        }
    }
    largest
}

fn largest<T: Scalar>(matrix: &Mat<T>) -> f64 {
    largest_of_rows(matrix).into_iter().fold(0.0, f64::max)
}

/// Multiplies rows by factors.
fn scale_rows<T: Scalar>(matrix: &mut Mat<T>, factors: &[f64]) {
    for j in 0..matrix.ncols() {
        let column = matrix.col_as_slice_mut(j).iter_mut();
        column.zip(factors).for_each(|(x, f)| *x = x.times(*f));
    }
}

/// Rotates rows so that hidden algebraic equations show as rows without mass; false where there are none.
fn expose<T: Scalar>(operator: &mut Mat<T>, mass: &mut Mat<T>, masses: f64) -> bool {
    let size = mass.nrows();
    let qr = mass.col_piv_qr();
    let r = qr.thin_R();
    let least = RANK * r[(0, 0)].size().max(masses);
    let rank = (0..size).filter(|&i| r[(i, i)].size() > least).count();
    if rank == size {
        return false;
    }
    let q = qr.compute_Q();
    *operator = q.adjoint() * &*operator;
    *mass = q.adjoint() * &*mass;
    for i in rank..size {
        for j in 0..size {
            mass[(i, j)] = T::zero_impl();
        }
    }
    true
}

/// The x for which the algebraic rows vanish: the last columns of Q of their adjoint, each row scaled first
/// so that no equation outweighs another.
fn null_space<T: Scalar>(operator: &Mat<T>, algebraic: &[usize], noise: f64) -> Result<Mat<T>> {
    let size = operator.ncols();
    let sizes = largest_of_rows(operator);
    let nothing = algebraic.iter().any(|&row| sizes[row] <= noise);
    let constraints = Mat::from_fn(size, algebraic.len(), |j, a| {
        let row = algebraic[a];
        operator[(row, j)].conjugate().times(sizes[row].recip())
    });
    let qr = constraints.col_piv_qr();
    let r = qr.thin_R();
    let count = algebraic.len();
    let largest = r[(0, 0)].size();
    if nothing || (0..count).any(|i| r[(i, i)].size() <= RANK * largest) {
        return Err(Error::computation(
            "the linear problem is singular for every growth rate: a field is determined up to \
             something arbitrary; name it as `gauge` in the block `mean`, or check the balances",
        ));
    }
    let q = qr.compute_Q();
    Ok(q.subcols(count, size - count).to_owned())
}

#[cfg(test)]
mod tests {
    use super::Reduced;
    use faer::{Mat, mat};

    fn values(operator: Mat<f64>, mass: Mat<f64>) -> Option<Vec<f64>> {
        let reduced = Reduced::new((operator, mass)).ok()?;
        let spectrum = reduced.eigenvalues().ok()?;
        Some(spectrum.values.iter().map(|c| c.re).collect())
    }

    fn agree(spectrum: Option<Vec<f64>>, expected: &[f64]) {
        let spectrum = spectrum.expect("a spectrum");
        assert_eq!(spectrum.len(), expected.len(), "{spectrum:?}");
        for (a, b) in spectrum.iter().zip(expected) {
            assert!((a - b).abs() < 1e-12, "{spectrum:?}");
        }
    }

    /// x' = −x + y, 0 = x − 2y: x' = −x/2.
    #[test]
    fn a_constraint() {
        agree(
            values(mat![[-1.0, 1.0], [1.0, -2.0]], mat![[1.0, 0.0], [0.0, 0.0]]),
            &[-0.5],
        );
    }

    /// x' = −3x + z, y' = −y − z, 0 = x − y: hidden z = x, hence x' = −2x. Also with y' in other units.
    #[test]
    fn a_hidden_constraint() {
        for unit in [1.0, 1e-9, 1e9] {
            let operator = mat![[-3.0, 0.0, 1.0], [0.0, -unit, -unit], [1.0, -1.0, 0.0]];
            let mass = mat![[1.0, 0.0, 0.0], [0.0, unit, 0.0], [0.0, 0.0, 0.0]];
            agree(values(operator, mass), &[-2.0]);
        }
    }

    /// x' = y, 0 = x: nothing moves; nor where z cancels, x' = −3x + z, y' = −y + z, 0 = x − y. And a z that no
    /// equation holds.
    #[test]
    fn pencils_without_an_answer() {
        let cancelling = mat![[-3.0, 0.0, 1.0], [0.0, -1.0, 1.0], [1.0, -1.0, 0.0]];
        let mass = mat![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0]];
        assert_eq!(values(cancelling, mass), None);
        assert_eq!(
            values(mat![[0.0, 1.0], [1.0, 0.0]], mat![[1.0, 0.0], [0.0, 0.0]]),
            None
        );
        let undetermined = mat![[-1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [2.0, 2.0, 0.0]];
        let mass = mat![[1.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]];
        assert_eq!(values(undetermined, mass), None);
    }

    /// Eigenvalues of one size around another: answers do not depend on the unit of time.
    #[test]
    fn any_unit_of_time() {
        for unit in [1e-12, 1.0, 1e12] {
            let operator = mat![[-unit, 0.0], [0.5 * unit, 2.0 * unit]];
            let c = values(operator, Mat::identity(2, 2)).expect("a spectrum");
            assert!((c[0] / unit - 2.0).abs() < 1e-12 && (c[1] / unit + 1.0).abs() < 1e-12);
        }
        // A condition has no unit of time: x' = −x + y, 0 = x − 2y again.
        for unit in [1e-18, 1e18] {
            let operator = mat![[-unit, unit], [1.0, -2.0]];
            let c = values(operator, mat![[1.0, 0.0], [0.0, 0.0]]).expect("a spectrum");
            assert!((c[0] / unit + 0.5).abs() < 1e-12, "{c:?}");
        }
    }
}
