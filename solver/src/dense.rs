//! Dense linear algebra over real or complex numbers: the few calls that the solver needs of faer.

use crate::model::C64;
use faer::linalg::solvers::{PartialPivLu, SolveCore};
use faer::traits::ComplexField;
use faer::{Conj, Mat, MatRef};

/// Real or complex scalars.
pub trait Scalar: ComplexField + Copy + Send + Sync + std::fmt::Debug {
    /// Drops the imaginary part where the type is real.
    fn from_complex(value: C64) -> Self;
    fn complex(self) -> C64;
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

    fn eigen(matrix: MatRef<'_, C64>) -> Option<(Vec<C64>, Mat<C64>)> {
        let eigen = matrix.eigen().ok()?;
        let values = (0..matrix.nrows()).map(|i| eigen.S()[i]).collect();
        Some((values, eigen.U().to_owned()))
    }

    fn eigenvalues(matrix: MatRef<'_, C64>) -> Option<Vec<C64>> {
        matrix.eigenvalues().ok()
    }
}

/// A square system, rows brought to comparable size, factorised once for many right-hand sides.
pub struct Factorised<T: Scalar> {
    lu: PartialPivLu<T>,
    /// 1 / (largest entry of each row)
    scale: Vec<f64>,
}

impl<T: Scalar> Factorised<T> {
    pub fn new(mut matrix: Mat<T>) -> Self {
        let n = matrix.nrows();
        let mut largest = vec![0.0_f64; n];
        for j in 0..n {
            for (i, size) in largest.iter_mut().enumerate() {
                *size = size.max(matrix[(i, j)].complex().norm());
            }
        }
        let scale: Vec<f64> = largest
            .iter()
            .map(|&m| if m > 0.0 { 1.0 / m } else { 1.0 })
            .collect();
        for j in 0..n {
            for (i, &factor) in scale.iter().enumerate() {
                let entry = &mut matrix[(i, j)];
                *entry = T::from_complex(entry.complex() * factor);
            }
        }
        Factorised {
            lu: matrix.partial_piv_lu(),
            scale,
        }
    }

    /// A⁻¹ b
    pub fn solve(&self, right: &[T]) -> Vec<T> {
        let mut x = Mat::from_fn(right.len(), 1, |i, _| {
            T::from_complex(right[i].complex() * self.scale[i])
        });
        self.lu.solve_in_place_with_conj(Conj::No, x.as_mut());
        (0..right.len()).map(|i| x[(i, 0)]).collect()
    }

    /// A⁻ᴴ b
    pub fn solve_adjoint(&self, right: &[T]) -> Vec<T> {
        let mut x = Mat::from_fn(right.len(), 1, |i, _| right[i]);
        self.lu
            .solve_transpose_in_place_with_conj(Conj::Yes, x.as_mut());
        (0..right.len())
            .map(|i| T::from_complex(x[(i, 0)].complex() * self.scale[i]))
            .collect()
    }
}

/// A x
pub fn apply<T: Scalar>(matrix: MatRef<'_, T>, x: &[T]) -> Vec<T> {
    let x = Mat::from_fn(x.len(), 1, |i, _| x[i]);
    let product = matrix * &x;
    (0..matrix.nrows()).map(|i| product[(i, 0)]).collect()
}

/// Aᴴ x
pub fn apply_adjoint<T: Scalar>(matrix: MatRef<'_, T>, x: &[T]) -> Vec<T> {
    let x = Mat::from_fn(x.len(), 1, |i, _| x[i]);
    let product = matrix.adjoint() * &x;
    (0..matrix.ncols()).map(|i| product[(i, 0)]).collect()
}

/// Σ conj(x) y
pub fn dot<T: Scalar>(x: &[T], y: &[T]) -> C64 {
    x.iter()
        .zip(y)
        .map(|(a, b)| a.complex().conj() * b.complex())
        .sum()
}

/// √Σ|x|²
pub fn norm<T: Scalar>(x: &[T]) -> f64 {
    x.iter().map(|a| a.complex().norm_sqr()).sum::<f64>().sqrt()
}

/// Scales a vector by a number of its own kind.
pub fn scaled<T: Scalar>(x: &[T], factor: C64) -> Vec<T> {
    x.iter()
        .map(|a| T::from_complex(a.complex() * factor))
        .collect()
}
