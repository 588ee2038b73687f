//! A matrix kept as blocks diag(coefficient) · D^d: applied as it is, or written out.

use crate::collocation::{Discretisation, GridKind};
use crate::dense::{Scalar, vectorised};
use faer::Mat;
use std::sync::Arc;

/// diag(coefficients) · derivative with its first row and column in the whole.
pub(super) struct Block<T> {
    pub row: usize,
    pub column: usize,
    pub derivative: Derivative,
    pub coefficients: Vec<T>,
}

/// D^d from the points of a column to those of a row.
pub(super) enum Derivative {
    /// No derivative, and the row's points are the column's from this one on.
    Selection(usize),
    Dense(Arc<Mat<f64>>),
}

impl Derivative {
    pub(super) fn new(
        discretisation: &Discretisation,
        from: GridKind,
        to: GridKind,
        order: usize,
    ) -> Self {
        match from.start_of(to).filter(|_| order == 0) {
            Some(start) => Derivative::Selection(start),
            None => Derivative::Dense(discretisation.matrix(from, to, order)),
        }
    }
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
        match &self.derivative {
            Derivative::Selection(start) => {
                for (i, c) in self.coefficients.iter().enumerate() {
                    matrix[(self.row + i, self.column + start + i)] += *c;
                }
            }
            Derivative::Dense(derivative) => {
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
            Derivative::Selection(start) => {
                target
                    .zip(&x[*start..])
                    .for_each(|((t, c), x)| *t += *c * *x);
            }
            Derivative::Dense(derivative) => {
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
            Derivative::Selection(start) => {
                let selected = target[*start..].iter_mut();
                selected.zip(weighted).for_each(|(t, w)| *t += w);
            }
            Derivative::Dense(derivative) => {
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
