//! Dense linear algebra over real or complex numbers: the few calls that the solver needs of faer.

use crate::model::C64;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::{factor, solve};
use faer::perm::Perm;
use faer::traits::ComplexField;
use faer::{Conj, Mat, MatMut, MatRef, Par, Spec};

/// Real or complex scalars.
pub trait Scalar: ComplexField + Copy + Send + Sync + std::fmt::Debug {
    /// Drops the imaginary part where the type is real.
    fn from_complex(value: C64) -> Self;
    /// As a complex number.
    fn complex(self) -> C64;
    /// |x|
    fn size(self) -> f64;
    /// Multiplied by a real number.
    fn times(self, factor: f64) -> Self;
    /// The complex conjugate.
    fn conjugate(self) -> Self;
    /// All eigenvalues and right eigenvectors.
    fn eigen(matrix: MatRef<'_, Self>) -> Option<(Vec<C64>, Mat<C64>)>;
    /// All eigenvalues.
    fn eigenvalues(matrix: MatRef<'_, Self>) -> Option<Vec<C64>>;
}

impl Scalar for f64 {
    fn from_complex(value: C64) -> Self {
        value.re
    }

    fn complex(self) -> C64 {
        C64::new(self, 0.0)
    }

    fn size(self) -> f64 {
        self.abs()
    }

    fn times(self, factor: f64) -> f64 {
        self * factor
    }

    fn conjugate(self) -> f64 {
        self
    }

    fn eigen(matrix: MatRef<'_, f64>) -> Option<(Vec<C64>, Mat<C64>)> {
        let eigen = matrix.eigen().ok()?;
        let values = (0..matrix.nrows()).map(|i| eigen.S()[i]).collect();
        Some((values, eigen.U().to_owned()))
    }

    fn eigenvalues(matrix: MatRef<'_, f64>) -> Option<Vec<C64>> {
        matrix.eigenvalues().ok()
    }
}

impl Scalar for C64 {
    fn from_complex(value: C64) -> Self {
        value
    }

    fn complex(self) -> C64 {
        self
    }

    fn size(self) -> f64 {
        // Not `norm`, whose guard against overflow costs more than the rest of the loop.
        self.norm_sqr().sqrt()
    }

    fn times(self, factor: f64) -> C64 {
        self * factor
    }

    fn conjugate(self) -> C64 {
        self.conj()
    }

    fn eigen(matrix: MatRef<'_, C64>) -> Option<(Vec<C64>, Mat<C64>)> {
        let eigen = matrix.eigen().ok()?;
        let values = (0..matrix.nrows()).map(|i| eigen.S()[i]).collect();
        Some((values, eigen.U().to_owned()))
    }

    fn eigenvalues(matrix: MatRef<'_, C64>) -> Option<Vec<C64>> {
        matrix.eigenvalues().ok()
    }
}

/// Complex numbers as scalars of a type that can hold them: a real one loses nothing but rounding.
pub fn scalars<T: Scalar>(values: &[C64]) -> Vec<T> {
    let kept: Vec<T> = values.iter().map(|&v| T::from_complex(v)).collect();
    debug_assert!(
        {
            let size = values.iter().map(|v| v.norm()).fold(0.0, f64::max);
            let lost = kept
                .iter()
                .zip(values)
                .map(|(k, v)| (k.complex() - v).norm());
            lost.fold(0.0, f64::max) <= 1e-6 * size
        },
        "a complex vector in real arithmetic"
    );
    kept
}

/// Runs a loop with the widest vectors that the processor has; the result is the same without.
#[inline(always)]
pub fn vectorised<R>(work: impl FnOnce() -> R) -> R {
    faer::traits::pulp::Arch::new().dispatch(work)
}

/// A square system, rows and columns brought to comparable size (so that units do not matter), factorised once
/// for many right-hand sides.
pub struct Factorised<T: Scalar> {
    /// L below the diagonal, U above and on it: the matrix itself, overwritten.
    factors: Mat<T>,
    rows: Perm<usize>,
    /// 1 / (largest entry of each row)
    scale: Vec<f64>,
    /// 1 / (largest entry of each column of the matrix with scaled rows)
    columns: Vec<f64>,
}

impl<T: Scalar> Factorised<T> {
    /// Factorises a square matrix, which is overwritten.
    pub fn new(mut matrix: Mat<T>) -> Self {
        let n = matrix.nrows();
        let scale = vectorised(
            #[inline(always)]
            || row_scale(&matrix),
        );
        let columns = vectorised(
            #[inline(always)]
            || scale_entries(&mut matrix, &scale),
        );
        let (mut forward, mut backward) = (vec![0; n], vec![0; n]);
        // Parallelism is over points; a matrix belongs to one thread.
        let (parallel, spec) = (Par::Seq, Spec::default());
        let scratch = factor::lu_in_place_scratch::<usize, T>(n, n, parallel, spec);
        factor::lu_in_place(
            matrix.as_mut(),
            &mut forward,
            &mut backward,
            parallel,
            MemStack::new(&mut MemBuffer::new(scratch)),
            spec,
        );
        Factorised {
            factors: matrix,
            rows: Perm::new_checked(forward.into(), backward.into(), n),
            scale,
            columns,
        }
    }

    /// A⁻¹ b; `None` where A is singular.
    pub fn solve_regular(&self, right: &[T]) -> Option<Vec<T>> {
        if self.is_singular() {
            return None;
        }
        let solution = self.solve(right);
        solution
            .iter()
            .all(|x| x.size().is_finite())
            .then_some(solution)
    }

    /// Whether A is singular to rounding: the smallest pivot is at most ε times the largest.
    fn is_singular(&self) -> bool {
        let pivots = (0..self.scale.len()).map(|i| self.factors[(i, i)].size());
        let (least, most) = pivots.fold((f64::INFINITY, 0.0_f64), |(a, b), p| (a.min(p), b.max(p)));
        least.is_nan() || least <= f64::EPSILON * most
    }

    /// A⁻¹ b
    pub fn solve(&self, right: &[T]) -> Vec<T> {
        let mut x: Vec<T> = right
            .iter()
            .zip(&self.scale)
            .map(|(b, s)| b.times(*s))
            .collect();
        let (n, factors) = (x.len(), self.factors.as_ref());
        let parallel = Par::Seq;
        let scratch = solve::solve_in_place_scratch::<usize, T>(n, 1, parallel);
        solve::solve_in_place_with_conj(
            factors,
            factors,
            self.rows.as_ref(),
            Conj::No,
            MatMut::from_column_major_slice_mut(&mut x, n, 1),
            parallel,
            MemStack::new(&mut MemBuffer::new(scratch)),
        );
        x.iter_mut()
            .zip(&self.columns)
            .for_each(|(x, c)| *x = x.times(*c));
        x
    }

    /// A⁻ᴴ b
    pub fn solve_adjoint(&self, right: &[T]) -> Vec<T> {
        let scaled = right.iter().zip(&self.columns);
        let mut x: Vec<T> = scaled.map(|(b, c)| b.times(*c)).collect();
        let (n, factors) = (x.len(), self.factors.as_ref());
        let parallel = Par::Seq;
        let scratch = solve::solve_transpose_in_place_scratch::<usize, T>(n, 1, parallel);
        solve::solve_transpose_in_place_with_conj(
            factors,
            factors,
            self.rows.as_ref(),
            Conj::Yes,
            MatMut::from_column_major_slice_mut(&mut x, n, 1),
            parallel,
            MemStack::new(&mut MemBuffer::new(scratch)),
        );
        x.iter()
            .zip(&self.scale)
            .map(|(x, s)| x.times(*s))
            .collect()
    }
}

/// 1 / (largest entry) of each row; 1 for a row of zeros.
#[inline(always)]
fn row_scale<T: Scalar>(matrix: &Mat<T>) -> Vec<f64> {
    let mut largest = vec![0.0_f64; matrix.nrows()];
    for j in 0..matrix.ncols() {
        for (most, entry) in largest.iter_mut().zip(matrix.col_as_slice(j)) {
            let size = entry.size();
            *most = if size > *most { size } else { *most };
        }
    }
    let invert = |m: f64| if m == 0.0 { 1.0 } else { 1.0 / m };
    largest.into_iter().map(invert).collect()
}

/// Scales rows by the given factors, then columns by 1 / (largest entry); the factors of the columns.
#[inline(always)]
fn scale_entries<T: Scalar>(matrix: &mut Mat<T>, rows: &[f64]) -> Vec<f64> {
    let mut columns = Vec::with_capacity(matrix.ncols());
    for j in 0..matrix.ncols() {
        let column = matrix.col_as_slice_mut(j);
        let mut largest = 0.0_f64;
        for (factor, entry) in rows.iter().zip(&mut *column) {
            *entry = entry.times(*factor);
            let size = entry.size();
            largest = if size > largest { size } else { largest };
        }
        let factor = if largest == 0.0 { 1.0 } else { 1.0 / largest };
        for entry in column {
            *entry = entry.times(factor);
        }
        columns.push(factor);
    }
    columns
}

/// [A c; rᴴ 0] for borders (c, r), each of the length of A.
pub fn bordered<T: Scalar>(matrix: &Mat<T>, borders: &[(Vec<T>, Vec<T>)]) -> Mat<T> {
    let n = matrix.nrows();
    let size = n + borders.len();
    let mut result = Mat::zeros(size, size);
    for j in 0..n {
        let column = result.col_as_slice_mut(j);
        column[..n].copy_from_slice(matrix.col_as_slice(j));
        for (entry, (_, row)) in column[n..].iter_mut().zip(borders) {
            *entry = row[j].conjugate();
        }
    }
    for (b, (column, _)) in borders.iter().enumerate() {
        result.col_as_slice_mut(n + b)[..n].copy_from_slice(column);
    }
    result
}

/// A x
pub fn apply<T: Scalar>(matrix: MatRef<'_, T>, x: &[T]) -> Vec<T> {
    let x = Mat::from_fn(x.len(), 1, |i, _| x[i]);
    let product = matrix * &x;
    product.col_as_slice(0).to_vec()
}

/// Σ conj(x) y
pub fn dot<T: Scalar>(x: &[T], y: &[T]) -> C64 {
    let sum = x
        .iter()
        .zip(y)
        .fold(T::zero_impl(), |sum, (a, b)| sum + a.conjugate() * *b);
    sum.complex()
}

/// √Σ|x|²
pub fn norm<T: Scalar>(x: &[T]) -> f64 {
    dot(x, x).re.sqrt()
}

/// Scales a vector by a real number.
pub fn scaled<T: Scalar>(x: &[T], factor: f64) -> Vec<T> {
    x.iter().map(|a| a.times(factor)).collect()
}

#[cfg(test)]
mod tests {
    use super::{C64, Factorised, dot};
    use faer::Mat;

    /// Hilbert's matrix, every row and column in another unit: A x = b and Aᴴ y = b.
    #[test]
    fn systems_in_any_units() {
        let n = 5;
        let unit = |i: usize| 10_f64.powi(7 * i as i32 - 14);
        let matrix = Mat::from_fn(n, n, |i, j| {
            let hilbert = 1.0 / (i + j + 1) as f64;
            C64::new(hilbert, if i == j { 1.0 } else { 0.0 }) * (unit(i) * unit(n - 1 - j))
        });
        let right: Vec<C64> = (0..n).map(|i| C64::new(unit(i), -0.5 * unit(i))).collect();
        let factorised = Factorised::new(matrix.clone());
        let x = factorised.solve_regular(&right).expect("a regular matrix");
        for (i, b) in right.iter().enumerate() {
            let row: C64 = (0..n).map(|j| matrix[(i, j)] * x[j]).sum();
            assert!((row - b).norm() < 1e-12 * b.norm());
        }
        // ⟨y, A x⟩ = ⟨Aᴴ y, x⟩
        let y = factorised.solve_adjoint(&right);
        let (y_a_x, adjoint_y_x) = (dot(&y, &right), dot(&right, &x));
        assert!((y_a_x - adjoint_y_x).norm() < 1e-12 * y_a_x.norm());
    }

    #[test]
    fn a_singular_matrix_has_no_solution() {
        let matrix = Mat::from_fn(3, 3, |i, j| (i + 1) as f64 * (j + 2) as f64);
        assert!(
            Factorised::new(matrix)
                .solve_regular(&[1.0, 2.0, 3.0])
                .is_none()
        );
    }
}
