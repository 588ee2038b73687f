//! Staggered layout: which unknown stands where, and which equation is collocated where.
//!
//! By the offsets of the system (Douglis–Nirenberg numbers): field j has N + t_j values, balance i is
//! collocated at N + c_i points, and the boundary conditions, rows that belong to no field, make up the
//! difference. M is the highest degree: the widest field has M + 1 values.

use super::chebyshev::{Grid, GridKind};
use crate::error::{Error, Result};
use crate::model::OffsetsInfo;
use faer::Mat;
use std::collections::HashMap;
use std::sync::{Arc, Mutex};

/// A run of unknowns or equations on one grid.
#[derive(Clone, Debug)]
pub struct Block {
    /// Its points.
    pub grid: GridKind,
    /// Position of the first.
    pub offset: usize,
    /// How many.
    pub len: usize,
}

/// Unknowns by column block, equations by row block, then the boundary conditions.
#[derive(Clone, Debug)]
pub struct Layout {
    /// By field: profiles alone.
    pub columns: Vec<Block>,
    /// By balance.
    pub rows: Vec<Block>,
    /// Where the rows of boundary conditions start.
    pub walls: usize,
    /// Number of unknowns, closures at k = 0 not counted.
    pub size: usize,
}

impl Layout {
    /// The layout of a system at M = `resolution`, `None` without a cross-stream coordinate.
    ///
    /// # Errors
    /// An M at which some balance would have no point.
    pub fn new(offsets: &OffsetsInfo, resolution: Option<usize>) -> Result<Self> {
        let widest = offsets.columns.iter().copied().max().unwrap_or(0).max(1);
        if resolution.is_some_and(|m| m < widest + 2) {
            return Err(Error::input(format!(
                "M = {} is too small: at least {}",
                resolution.unwrap_or(0),
                widest + 2
            )));
        }
        let counts = |offsets: &[usize]| -> Vec<Option<usize>> {
            let count = |offset: &usize| resolution.map(|m| m + 1 - widest + offset);
            offsets.iter().map(count).collect()
        };
        let columns = counts(&offsets.columns);
        let rows = counts(&offsets.rows);
        let (columns, size) = blocks(columns.into_iter().map(|n| column_grid(n, resolution)));
        let (rows, walls) = blocks(rows.into_iter().map(|n| row_grid(n, resolution)));
        Ok(Layout {
            columns,
            rows,
            walls,
            size,
        })
    }
}

/// The points of a field's values: extrema for the widest, and those of the rows where the counts agree.
fn column_grid(count: Option<usize>, resolution: Option<usize>) -> GridKind {
    match count.zip(resolution) {
        None => GridKind::Point,
        Some((n, m)) if n == m + 1 => GridKind::Lobatto(n),
        Some((n, m)) if n + 1 == m => GridKind::Interior(n),
        Some((n, _)) => GridKind::Gauss(n),
    }
}

/// The points of a balance. Interior extrema wherever two conditions or more are taken away: with
/// Chebyshev–Gauss points there, operators of fourth order have spurious modes.
fn row_grid(count: Option<usize>, resolution: Option<usize>) -> GridKind {
    match count.zip(resolution) {
        None => GridKind::Point,
        Some((n, m)) if n < m => GridKind::Interior(n),
        Some((n, _)) => GridKind::Gauss(n),
    }
}

/// Blocks one after another, and where they end.
fn blocks(grids: impl Iterator<Item = GridKind>) -> (Vec<Block>, usize) {
    let mut offset = 0;
    let mut blocks = Vec::new();
    for grid in grids {
        let len = grid.count();
        blocks.push(Block { grid, offset, len });
        offset += len;
    }
    (blocks, offset)
}

/// From which grid, to which, and the order of the derivative.
type MatrixKey = (GridKind, GridKind, usize);

/// Matrices between grids, made once and shared.
#[derive(Default)]
pub struct Discretisation {
    matrices: Mutex<HashMap<MatrixKey, Arc<Mat<f64>>>>,
}

impl Discretisation {
    /// With no matrix made yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// d^order/dξ^order from values on one grid to values on another.
    pub fn matrix(&self, from: GridKind, to: GridKind, order: usize) -> Arc<Mat<f64>> {
        let key = (from, to, order);
        let mut matrices = match self.matrices.lock() {
            Ok(guard) => guard,
            Err(poisoned) => poisoned.into_inner(),
        };
        matrices
            .entry(key)
            .or_insert_with(|| Arc::new(Grid::new(from).derivative_on(&Grid::new(to), order)))
            .clone()
    }
}
