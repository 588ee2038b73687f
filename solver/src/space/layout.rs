//! Staggered layout: which unknown stands where, and which equation is collocated where.
//!
//! By the offsets of the system (Douglis–Nirenberg numbers): column j has N + t_j values, row i is
//! collocated at N + c_i points, and the boundary conditions, rows that belong to no column, make up the
//! difference. M is the highest degree: the widest column has M + 1 values.

use super::Points;
use super::chebyshev::GridKind;
use crate::error::{Error, Result};
use crate::model::{Id, OffsetsInfo, Table};
use std::ops::Range;

/// A run of unknowns or equations on one family of points.
#[derive(Clone, Debug)]
pub struct Block {
    /// Its points.
    pub points: Points,
    /// Position of the first.
    pub offset: usize,
    /// How many.
    pub len: usize,
}

impl Block {
    /// The positions.
    pub fn range(&self) -> Range<usize> {
        self.offset..self.offset + self.len
    }

    /// The part of a vector of all unknowns, or of all equations, that belongs to this block.
    pub fn of<'x, T>(&self, all: &'x [T]) -> &'x [T] {
        &all[self.range()]
    }
}

/// Unknowns by column, equations by row, then the boundary conditions.
#[derive(Clone, Debug)]
pub struct Layout<Row, Column> {
    /// Profiles alone, and of a base state its numbers after them.
    pub columns: Table<Column, Block>,
    /// The equations.
    pub rows: Table<Row, Block>,
    /// Where the rows of boundary conditions start.
    pub walls: usize,
    /// Number of unknowns, closures at k = 0 not counted.
    pub size: usize,
}

impl<Row: Id, Column: Id> Layout<Row, Column> {
    /// The layout of a perturbation at M = `resolution`, `None` without a cross-stream coordinate: interior extrema
    /// for rows wherever conditions are taken away (with Chebyshev–Gauss points there, operators of fourth order
    /// have spurious modes), and for columns the points of the rows where the counts agree.
    ///
    /// # Errors
    /// An M at which some row would have no point.
    pub fn staggered(
        offsets: &OffsetsInfo<Row, Column>,
        resolution: Option<usize>,
    ) -> Result<Self> {
        let widest = offsets.columns.iter().copied().max().unwrap_or(0).max(1);
        let Some(m) = resolution else {
            let point = |_: &usize| GridKind::Point;
            return Ok(Layout::of(
                offsets.columns.map(point),
                offsets.rows.map(point),
            ));
        };
        if m < widest + 2 {
            return Err(Error::input(format!(
                "M = {m} is too small: at least {}",
                widest + 2
            )));
        }
        let count = |offset: &usize| m + 1 - widest + offset;
        let column = |offset: &usize| match count(offset) {
            n if n == m + 1 => GridKind::Lobatto(n),
            n if n + 1 == m => GridKind::Interior(n),
            n => GridKind::Gauss(n),
        };
        let row = |offset: &usize| match count(offset) {
            n if n < m => GridKind::Interior(n),
            n => GridKind::Gauss(n),
        };
        Ok(Layout::of(
            offsets.columns.map(column),
            offsets.rows.map(row),
        ))
    }

    /// The layout of a base state of some degree, with `numbers` unknown numbers: extrema for every profile, whose
    /// values become Chebyshev coefficients, and zeros of polynomials for the rows.
    pub fn extremal(offsets: &OffsetsInfo<Row, Column>, degree: usize, numbers: usize) -> Self {
        let widest = offsets.columns.iter().copied().max().unwrap_or(0);
        let count = |offset: &usize| degree + 1 - widest + offset;
        let mut columns = offsets.columns.map(|t| GridKind::Lobatto(count(t)));
        columns.extend(std::iter::repeat_n(GridKind::Point, numbers));
        Layout::of(columns, offsets.rows.map(|c| GridKind::Gauss(count(c))))
    }

    fn of(columns: Table<Column, GridKind>, rows: Table<Row, GridKind>) -> Self {
        let (columns, size) = blocks(columns);
        let (rows, walls) = blocks(rows);
        Layout {
            columns,
            rows,
            walls,
            size,
        }
    }

    /// The families of points that rows are collocated on, each once, with its rows.
    pub fn groups(&self) -> Vec<(Points, Vec<Row>)> {
        let mut groups: Vec<(Points, Vec<Row>)> = Vec::new();
        for (row, block) in self.rows.pairs() {
            match groups
                .iter_mut()
                .find(|(points, _)| *points == block.points)
            {
                Some((_, rows)) => rows.push(row),
                None => groups.push((block.points, vec![row])),
            }
        }
        groups
    }
}

/// Blocks one after another, and where they end.
fn blocks<I: Id>(grids: Table<I, GridKind>) -> (Table<I, Block>, usize) {
    let mut offset = 0;
    let mut next = |grid: &GridKind| {
        let block = Block {
            points: Points(*grid),
            offset,
            len: grid.count(),
        };
        offset += block.len;
        block
    };
    let blocks = grids.map(&mut next);
    (blocks, offset)
}

#[cfg(test)]
mod tests {
    use super::{Layout, Points};
    use crate::model::{BalanceId, FieldId, OffsetsInfo};
    use crate::space::chebyshev::GridKind;

    /// u, v, p of a viscous flow (P 4.2): velocities at the extrema, pressure between, continuity at one point more.
    #[test]
    fn staggered_grids_of_a_viscous_flow() {
        let offsets = OffsetsInfo {
            rows: vec![0, 0, 1].into(),
            columns: vec![2, 2, 1].into(),
        };
        let layout: Layout<BalanceId, FieldId> =
            Layout::staggered(&offsets, Some(10)).expect("a layout");
        let counts = layout.columns.iter().map(|b| b.len).collect::<Vec<_>>();
        assert_eq!(
            (counts, layout.size, layout.walls),
            (vec![11, 11, 10], 32, 28)
        );
        let points = |kind| Points(kind);
        assert_eq!(
            layout.columns[FieldId(0)].points,
            points(GridKind::Lobatto(11))
        );
        assert_eq!(
            layout.columns[FieldId(2)].points,
            points(GridKind::Gauss(10))
        );
        assert_eq!(layout.groups().len(), 2);
        assert!(Layout::<BalanceId, FieldId>::staggered(&offsets, Some(3)).is_err());
    }
}
