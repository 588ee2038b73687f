//! A matrix kept as blocks diag(coefficient) · D^d: applied as it is, or written out.

use crate::numerics::Applied;
use crate::numerics::dense::{Scalar, vectorised};
use crate::space::Derivative;
use faer::Mat;

/// diag(coefficients) · derivative with its first row and column in the whole.
pub(super) struct Block<T> {
    row: usize,
    column: usize,
    derivative: Derivative,
    coefficients: Vec<T>,
}

impl<T: Scalar> Block<T> {
    /// The factor of the derivative goes into the coefficients.
    pub fn new(
        row: usize,
        column: usize,
        derivative: Derivative,
        mut coefficients: Vec<T>,
    ) -> Self {
        if let Derivative::Dense { factor, .. } = derivative {
            let scaled = coefficients.iter_mut();
            scaled.for_each(|c| *c = c.times(factor));
        }
        Block {
            row,
            column,
            derivative,
            coefficients,
        }
    }
}

/// A square matrix as a sum of blocks.
pub struct Blocks<T> {
    size: usize,
    blocks: Vec<Block<T>>,
}

impl<T: Scalar> Blocks<T> {
    pub(super) fn new(size: usize, blocks: Vec<Block<T>>) -> Self {
        Blocks { size, blocks }
    }

    /// Rows and columns.
    pub fn size(&self) -> usize {
        self.size
    }

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
}

impl<T: Scalar> Applied<T> for Blocks<T> {
    fn apply(&self, x: &[T]) -> Vec<T> {
        let mut result = vec![T::zero_impl(); self.size];
        self.blocks.iter().for_each(|block| {
            vectorised(
                #[inline(always)]
                || block.apply(x, &mut result),
            )
        });
        result
    }

    fn apply_adjoint(&self, y: &[T]) -> Vec<T> {
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
        match &self.derivative {
            Derivative::Selection { start, .. } => {
                for (i, c) in self.coefficients.iter().enumerate() {
                    matrix[(self.row + i, self.column + start + i)] += *c;
                }
            }
            Derivative::Dense {
                matrix: derivative, ..
            } => {
                for j in 0..derivative.ncols() {
                    let target = &mut matrix.col_as_slice_mut(self.column + j)[self.row..];
                    let source = derivative.col_as_slice(j);
                    for ((t, c), d) in target.iter_mut().zip(&self.coefficients).zip(source) {
                        *t += c.times(*d);
                    }
                }
            }
        }
    }

    #[inline(always)]
    fn apply(&self, x: &[T], result: &mut [T]) {
        let x = &x[self.column..];
        let target = result[self.row..].iter_mut().zip(&self.coefficients);
        match &self.derivative {
            Derivative::Selection { start, .. } => {
                target
                    .zip(&x[*start..])
                    .for_each(|((t, c), x)| *t += *c * *x);
            }
            Derivative::Dense {
                matrix: derivative, ..
            } => {
                let mut derived = vec![T::zero_impl(); self.coefficients.len()];
                for (j, value) in x[..derivative.ncols()].iter().enumerate() {
                    for (r, d) in derived.iter_mut().zip(derivative.col_as_slice(j)) {
                        *r += value.times(*d);
                    }
                }
                target.zip(derived).for_each(|((t, c), d)| *t += *c * d);
            }
        }
    }

    #[inline(always)]
    fn apply_adjoint(&self, y: &[T], result: &mut [T]) {
        let pairs = self.coefficients.iter().zip(&y[self.row..]);
        let weighted = pairs.map(|(c, y)| c.conjugate() * *y);
        let target = &mut result[self.column..];
        match &self.derivative {
            Derivative::Selection { start, .. } => {
                let selected = target[*start..].iter_mut();
                selected.zip(weighted).for_each(|(t, w)| *t += w);
            }
            Derivative::Dense {
                matrix: derivative, ..
            } => {
                let weighted: Vec<T> = weighted.collect();
                for (j, t) in target[..derivative.ncols()].iter_mut().enumerate() {
                    for (w, d) in weighted.iter().zip(derivative.col_as_slice(j)) {
                        *t += w.times(*d);
                    }
                }
            }
        }
    }
}
