//! ∂y^order between points, to be applied to profiles or written into matrices.

use crate::model::C64;
use crate::numerics::dense::vectorised;
use faer::Mat;
use std::sync::Arc;

/// A derivative by y, from values at the points of a profile to values at the points of a row.
#[derive(Clone, Debug)]
pub enum Derivative {
    /// None, and the points are among those of the profile, one after another.
    Selection {
        /// The first of them.
        start: usize,
        /// How many.
        count: usize,
    },
    /// factor · matrix
    Dense {
        /// Points by values; shared.
        matrix: Arc<Mat<f64>>,
        /// (2/h)^order
        factor: f64,
    },
}

impl Derivative {
    /// At all points.
    pub fn of(&self, values: &[C64]) -> Vec<C64> {
        let (matrix, factor) = match self {
            Derivative::Selection { start, count } => return values[*start..][..*count].to_vec(),
            Derivative::Dense { matrix, factor } => (matrix, *factor),
        };
        // Real and imaginary parts apart: with a mirror symmetry one of them is zero.
        let part = |of: fn(&C64) -> f64| {
            let mut result = vec![0.0; matrix.nrows()];
            vectorised(
                #[inline(always)]
                || {
                    for (j, value) in values.iter().enumerate() {
                        let value = of(value) * factor;
                        if value != 0.0 {
                            for (r, m) in result.iter_mut().zip(matrix.col_as_slice(j)) {
                                *r += value * m;
                            }
                        }
                    }
                },
            );
            result
        };
        let parts = part(|v| v.re).into_iter().zip(part(|v| v.im));
        parts.map(|(re, im)| C64::new(re, im)).collect()
    }

    /// Adds `weight` times the row of one point to coefficients of the values.
    pub fn add_row(&self, point: usize, weight: f64, row: &mut [f64]) {
        match self {
            Derivative::Selection { start, .. } => row[start + point] += weight,
            Derivative::Dense { matrix, factor } => {
                let weight = weight * factor;
                for (j, entry) in row[..matrix.ncols()].iter_mut().enumerate() {
                    *entry += weight * matrix[(point, j)];
                }
            }
        }
    }

    /// Σ_j |D_ij| at each point: what rounding of values of size one is multiplied by.
    pub fn amplification(&self) -> Vec<f64> {
        match self {
            Derivative::Selection { count, .. } => vec![1.0; *count],
            Derivative::Dense { matrix, factor } => {
                let mut sums = vec![0.0; matrix.nrows()];
                for j in 0..matrix.ncols() {
                    for (sum, d) in sums.iter_mut().zip(matrix.col_as_slice(j)) {
                        *sum += factor * d.abs();
                    }
                }
                sums
            }
        }
    }

    /// As a matrix, points by the `values` of the profile.
    pub fn matrix(&self, values: usize) -> Mat<f64> {
        match self {
            Derivative::Selection { start, count } => {
                Mat::from_fn(*count, values, |i, j| f64::from(u8::from(j == start + i)))
            }
            Derivative::Dense { matrix, factor } => {
                Mat::from_fn(matrix.nrows(), values, |i, j| factor * matrix[(i, j)])
            }
        }
    }
}
