//! Staggered layout: which unknown stands where, and which equation is collocated where.
//!
//! A field without boundary condition lives on M Gauss points; a field with q conditions has M+1
//! extrema, and its balance is collocated at M+1−q points (the interior extrema for q = 2).

use super::chebyshev::{Grid, GridKind};
use faer::Mat;
use std::collections::HashMap;
use std::sync::{Arc, Mutex};

/// A run of unknowns or equations on one grid.
#[derive(Clone, Debug)]
pub struct Block {
    pub grid: GridKind,
    pub offset: usize,
    pub len: usize,
}

/// Unknowns by column block, equations by row block, then the boundary conditions.
#[derive(Clone, Debug)]
pub struct Layout {
    pub columns: Vec<Block>,
    pub rows: Vec<Block>,
    /// Where the rows of boundary conditions start.
    pub walls: usize,
    /// Number of unknowns, closures at k = 0 not counted.
    pub size: usize,
}

impl Layout {
    /// Layout for fields with `conditions[f]` boundary conditions each, row r belonging to the
    /// field `pairing[r]`; `resolution` is M, `None` without a cross-stream coordinate.
    pub fn new(conditions: &[usize], pairing: &[usize], resolution: Option<usize>) -> Self {
        let grid = |field: usize| match (resolution, conditions[field]) {
            (None, _) => GridKind::Point,
            (Some(m), 0) => GridKind::Gauss(m),
            (Some(m), _) => GridKind::Lobatto(m + 1),
        };
        let mut columns = Vec::new();
        let mut size = 0;
        for field in 0..conditions.len() {
            let kind = grid(field);
            columns.push(Block {
                grid: kind,
                offset: size,
                len: kind.count(),
            });
            size += kind.count();
        }
        let mut rows = Vec::new();
        let mut offset = 0;
        for &field in pairing {
            let kind = match (resolution, conditions[field]) {
                (None, _) => GridKind::Point,
                (Some(m), 0) => GridKind::Gauss(m),
                (Some(m), 2) => GridKind::Interior(m - 1),
                (Some(m), q) => GridKind::Gauss((m + 1).saturating_sub(q)),
            };
            rows.push(Block {
                grid: kind,
                offset,
                len: kind.count(),
            });
            offset += kind.count();
        }
        Layout {
            columns,
            rows,
            walls: offset,
            size,
        }
    }
}

/// From which grid, to which, and the order of the derivative.
type MatrixKey = (GridKind, GridKind, usize);

/// Matrices between grids, made once and shared.
#[derive(Default)]
pub struct Discretisation {
    matrices: Mutex<HashMap<MatrixKey, Arc<Mat<f64>>>>,
}

impl Discretisation {
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
