//! The mirror symmetry x → −x at k = 0. The mean modes of a steady pattern have no odd part. Those of a wave have one: a
//! wave drives a mean flow.

use super::{Blocks, Problem};
use crate::model::{Id, Table};
use crate::numerics::dense::{Factorised, Scalar, norm, scaled};
use crate::numerics::{Applied, arbitrary};
use crate::space::Block;
use faer::Mat;

/// Number of inverse iterations by which a distance from singularity is estimated. The last half of them is averaged.
const POWERS: usize = 16;

/// Positions of the even equations and unknowns in the problem bordered at k = 0. There are as many of either.
pub struct EvenPart {
    rows: Vec<usize>,
    columns: Vec<usize>,
}

impl Problem {
    /// The even part of the problem at k = 0; `None` without the symmetry, or where equations and unknowns differ in number.
    pub fn even_part(&self) -> Option<EvenPart> {
        let parity = self.structure().parity.as_ref()?;
        let layout = &self.direct.layout;
        let mut columns = positions(&parity.fields, &layout.columns, false);
        let mut rows = positions(&parity.rows, &layout.rows, false);
        for (index, wall) in self.direct.walls.iter().enumerate() {
            if !self.direct.wall_turn(wall).is_odd() {
                rows.push(layout.walls + index);
            }
        }
        for (index, border) in self.borders.iter().enumerate() {
            // An odd density says nothing about the even fields.
            if !border.is_odd {
                rows.push(layout.size + index);
                columns.push(layout.size + index);
            }
        }
        (rows.len() == columns.len()).then_some(EvenPart { rows, columns })
    }
}

/// Positions in the blocks of one parity: of the odd blocks where `parity` is true, else of the even ones.
fn positions<I: Id>(odd: &Table<I, bool>, blocks: &Table<I, Block>, parity: bool) -> Vec<usize> {
    let blocks = odd.iter().zip(blocks.iter());
    let chosen = blocks.filter(|(odd, _)| **odd == parity);
    chosen.flat_map(|(_, block)| block.range()).collect()
}

impl Problem {
    /// Positions of the unknowns that change sign in the mirror, then of the equations that do.
    pub fn odd_positions(&self) -> (Vec<usize>, Vec<usize>) {
        let Some(parity) = &self.structure().parity else {
            return (Vec::new(), Vec::new());
        };
        let layout = &self.direct.layout;
        let unknowns = positions(&parity.fields, &layout.columns, true);
        let mut equations = positions(&parity.rows, &layout.rows, true);
        let walls = self.direct.walls.iter().enumerate();
        let walls = walls.filter(|(_, wall)| self.direct.wall_turn(wall).is_odd());
        equations.extend(walls.map(|(index, _)| layout.walls + index));
        (unknowns, equations)
    }
}

/// A factorised system A x = b, or the even part of one.
pub struct Solver<T: Scalar> {
    factors: Factorised<T>,
    part: Option<EvenPart>,
    size: usize,
}

impl<T: Scalar> Solver<T> {
    /// Factorises the whole matrix.
    pub fn whole(matrix: Mat<T>) -> Self {
        Solver {
            size: matrix.nrows(),
            factors: Factorised::new(matrix),
            part: None,
        }
    }

    /// Factorises the even part. Odd unknowns of a solution are zero.
    pub fn even(matrix: &Mat<T>, part: EvenPart) -> Self {
        let n = part.rows.len();
        let mut even = Mat::zeros(n, n);
        for (j, &column) in part.columns.iter().enumerate() {
            let source = matrix.col_as_slice(column);
            for (target, &row) in even.col_as_slice_mut(j).iter_mut().zip(&part.rows) {
                *target = source[row];
            }
        }
        Solver {
            size: matrix.nrows(),
            factors: Factorised::new(even),
            part: Some(part),
        }
    }

    /// A⁻¹ b; `None` where A is singular.
    pub fn solve(&self, right: &[T]) -> Option<Vec<T>> {
        let Some(part) = &self.part else {
            return self.factors.solve_regular(right);
        };
        let right: Vec<T> = part.rows.iter().map(|&row| right[row]).collect();
        let mut solution = vec![T::zero_impl(); self.size];
        for (&column, value) in part.columns.iter().zip(self.factors.solve_regular(&right)?) {
            solution[column] = value;
        }
        Some(solution)
    }

    /// The distance of σ from the nearest eigenvalue of L, in units of σ, to a few parts in a hundred.
    ///
    /// ‖((σ M0 − L)⁻¹ M0)ⁿ x‖ grows like |σ − c|⁻ⁿ with the nearest eigenvalue c: the distance is the inverse of the mean
    /// growth factor.
    pub fn distance(&self, mass: &Blocks<T>) -> f64 {
        let mut x: Vec<T> = arbitrary(mass.size());
        let mut sizes = Vec::with_capacity(POWERS);
        for _ in 0..POWERS {
            let size = norm(&x);
            if size == 0.0 {
                // Nothing has mass but what a border takes out.
                return f64::INFINITY;
            }
            sizes.push(size);
            let mut right = mass.apply(&scaled(&x, 1.0 / size));
            right.resize(self.size, T::zero_impl());
            match self.solve(&right) {
                Some(next) => x = next[..mass.size()].to_vec(),
                None => return 0.0,
            }
        }
        let last = &sizes[POWERS / 2..];
        let mean = last.iter().map(|s| s.ln()).sum::<f64>() / last.len() as f64;
        (-mean).exp()
    }
}
