//! The mirror symmetry x → −x at k = 0: a mean mode has no odd part.

use super::Problem;
use crate::dense::{Factorised, Scalar};
use faer::Mat;

/// The equations and unknowns of the even fields among those of the problem bordered at k = 0.
pub struct EvenPart {
    rows: Vec<usize>,
    columns: Vec<usize>,
}

impl Problem<'_> {
    /// The even part of the problem at k = 0, where there is the symmetry.
    pub fn even_part(&self) -> Option<EvenPart> {
        let parity = self.structure().parity.as_ref()?;
        let layout = &self.direct.layout;
        let even = |odd: &[bool], blocks: &[crate::collocation::Block]| -> Vec<usize> {
            let blocks = odd.iter().zip(blocks).filter(|(odd, _)| !**odd);
            blocks
                .flat_map(|(_, b)| b.offset..b.offset + b.len)
                .collect()
        };
        let unknowns = even(&parity.fields, &layout.columns);
        let mut columns = unknowns.clone();
        let mut rows = even(&parity.rows, &layout.rows);
        for (index, wall) in self.direct.walls.iter().enumerate() {
            if !parity.fields[wall.owner] {
                rows.push(layout.walls + index);
            }
        }
        for (index, border) in self.borders.iter().enumerate() {
            // The integral of an odd field says nothing about the even ones.
            if unknowns.iter().any(|&c| border.row[c] != 0.0) {
                rows.push(layout.size + index);
                columns.push(layout.size + index);
            }
        }
        (rows.len() == columns.len()).then_some(EvenPart { rows, columns })
    }
}

impl EvenPart {
    /// A⁻¹ b for an even b, odd unknowns being zero; nothing where A is singular.
    pub fn solve<T: Scalar>(&self, matrix: &Mat<T>, right: &[T]) -> Option<Vec<T>> {
        let n = self.rows.len();
        let mut part = Mat::zeros(n, n);
        for (j, &column) in self.columns.iter().enumerate() {
            let source = matrix.col_as_slice(column);
            for (target, &row) in part.col_as_slice_mut(j).iter_mut().zip(&self.rows) {
                *target = source[row];
            }
        }
        let right: Vec<T> = self.rows.iter().map(|&row| right[row]).collect();
        let mut solution = vec![T::zero_impl(); matrix.ncols()];
        let even = Factorised::new(part).solve_regular(&right)?;
        for (&column, value) in self.columns.iter().zip(even) {
            solution[column] = value;
        }
        Some(solution)
    }
}
