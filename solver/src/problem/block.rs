//! A matrix kept as blocks diag(coefficient) · D^d: applied as it is, or written out.

use crate::dense::{Scalar, vectorised};
use faer::Mat;
use std::sync::Arc;

/// diag(coefficients) · derivative with its first row and column in the whole.
pub(super) struct Block<T> {
    pub row: usize,
    pub column: usize,
    pub derivative: Arc<Mat<f64>>,
    pub coefficients: Vec<T>,
}

/// A square matrix as a sum of blocks.
pub struct Blocks<T> {
    pub(super) size: usize,
    pub(super) blocks: Vec<Block<T>>,
}

impl<T: Scalar> Blocks<T> {
    /// A, written out.
    pub fn dense(&self) -> Mat<T> {
        let mut matrix = Mat::zeros(self.size, self.size);
        self.blocks.iter().for_each(|block| {
            vectorised(
                #[inline(always)]
                || block.add_to(&mut matrix),
            )
        });
        matrix
    }

    /// A x
    pub fn apply(&self, x: &[T]) -> Vec<T> {
        let mut result = vec![T::zero_impl(); self.size];
        self.blocks.iter().for_each(|block| {
            vectorised(
                #[inline(always)]
                || block.apply(x, &mut result),
            )
        });
        result
    }

    /// Aᴴ y
    pub fn apply_adjoint(&self, y: &[T]) -> Vec<T> {
        let mut result = vec![T::zero_impl(); self.size];
        self.blocks.iter().for_each(|block| {
            vectorised(
                #[inline(always)]
                || block.apply_adjoint(y, &mut result),
            )
        });
        result
    }
}

impl<T: Scalar> Block<T> {
    #[inline(always)]
    fn add_to(&self, matrix: &mut Mat<T>) {
        for j in 0..self.derivative.ncols() {
            let target = &mut matrix.col_as_slice_mut(self.column + j)[self.row..];
            let source = self.derivative.col_as_slice(j);
            for ((t, c), d) in target.iter_mut().zip(&self.coefficients).zip(source) {
                *t += c.times(*d);
            }
        }
    }

    #[inline(always)]
    fn apply(&self, x: &[T], result: &mut [T]) {
        let mut derived = vec![T::zero_impl(); self.coefficients.len()];
        let x = &x[self.column..][..self.derivative.ncols()];
        for (j, value) in x.iter().enumerate() {
            for (r, d) in derived.iter_mut().zip(self.derivative.col_as_slice(j)) {
                *r += value.times(*d);
            }
        }
        let target = &mut result[self.row..];
        for ((t, c), d) in target.iter_mut().zip(&self.coefficients).zip(derived) {
            *t += *c * d;
        }
    }

    #[inline(always)]
    fn apply_adjoint(&self, y: &[T], result: &mut [T]) {
        let pairs = self.coefficients.iter().zip(&y[self.row..]);
        let weighted: Vec<T> = pairs.map(|(c, y)| c.conjugate() * *y).collect();
        let target = &mut result[self.column..][..self.derivative.ncols()];
        for (j, t) in target.iter_mut().enumerate() {
            for (w, d) in weighted.iter().zip(self.derivative.col_as_slice(j)) {
                *t += w.times(*d);
            }
        }
    }
}
