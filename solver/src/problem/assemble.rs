//! Matrices from terms: block (row, column) = Σ diag(coefficient) · (i k)^a |k|^b · D^d.

use super::block::{Block, Blocks, Derivative};
use super::closure::{self, Border};
use super::{LinearProblem, Problem, WallRow, quarter_turn};
use crate::collocation::{Discretisation, GridKind, Layout};
use crate::dense::{Scalar, bordered};
use crate::error::Result;
use crate::model::{C64, End, Jet};
use faer::Mat;
use std::collections::BTreeMap;

/// What is assembled: `mass`·M0 + `operator`·L, and `walls` times the boundary conditions.
#[derive(Clone, Copy)]
pub struct Combination {
    /// The factor of M0.
    pub mass: C64,
    /// The factor of L.
    pub operator: C64,
    /// The factor of the boundary conditions.
    pub walls: f64,
}

/// M0 alone.
const MASS: Combination = Combination {
    mass: C64::new(1.0, 0.0),
    operator: C64::new(0.0, 0.0),
    walls: 0.0,
};

/// L with the boundary conditions.
const OPERATOR: Combination = Combination {
    mass: C64::new(0.0, 0.0),
    operator: C64::new(1.0, 0.0),
    walls: 1.0,
};

impl LinearProblem {
    pub(super) fn new(
        layout: Layout,
        terms: Vec<(usize, Jet, Vec<f64>)>,
        walls: Vec<WallRow>,
        column_turns: Vec<usize>,
        row_turns: Vec<usize>,
    ) -> Self {
        LinearProblem {
            layout,
            terms,
            walls,
            column_turns,
            row_turns,
        }
    }

    /// The factor of a jet at wavenumber k in the solver's basis, its row turned by `row_turn`.
    fn symbol(&self, jet: Jet, k: f64, row_turn: usize) -> C64 {
        let column_turn = self.column_turns[usize::from(jet.field)];
        let turns = usize::from(jet.x) + column_turn + 4 - row_turn;
        let size = k.powi(i32::from(jet.x)) * k.abs().powi(i32::from(jet.absx));
        quarter_turn(turns) * size
    }

    /// Turns that make a wall's row real: one for a condition that is odd in the mirror.
    pub(super) fn wall_turn(&self, wall: &WallRow) -> usize {
        let first = wall.linear.first().map(|(jet, _)| *jet);
        first.map_or(0, |jet| {
            (self.column_turns[usize::from(jet.field)] + usize::from(jet.x)) % 2
        })
    }

    /// The factor by which a wall's right-hand side enters the solver's basis.
    pub fn wall_factor(&self, wall: &WallRow) -> C64 {
        if self.column_turns.iter().all(|&t| t == 0) {
            return C64::new(1.0, 0.0);
        }
        quarter_turn(4 - self.wall_turn(wall))
    }

    /// Quarter turns between the solver's basis and physical values of a column.
    pub fn column_turn(&self, column: usize) -> usize {
        self.column_turns[column]
    }

    /// The factor by which a row's right-hand side enters the solver's basis.
    pub fn row_factor(&self, row: usize) -> C64 {
        quarter_turn(4 - self.row_turns[row])
    }

    /// The matrix of `combination` at wavenumber k.
    pub fn matrix<T: Scalar>(
        &self,
        discretisation: &Discretisation,
        scale: f64,
        k: f64,
        combination: Combination,
    ) -> Mat<T> {
        let symbol = |jet, turn| self.symbol(jet, k, turn);
        self.assemble(discretisation, scale, combination, symbol)
    }

    /// d^order/dk^order of [`LinearProblem::matrix`] at k ≠ 0.
    fn wavenumber_derivative<T: Scalar>(
        &self,
        discretisation: &Discretisation,
        scale: f64,
        k: f64,
        combination: Combination,
        order: i32,
    ) -> Mat<T> {
        let symbol = |jet: Jet, turn| {
            let power = f64::from(jet.x) + f64::from(jet.absx);
            let factor: f64 = (0..order).map(|i| (power - f64::from(i)) / k).product();
            self.symbol(jet, k, turn) * factor
        };
        self.assemble(discretisation, scale, combination, symbol)
    }

    fn assemble<T: Scalar>(
        &self,
        discretisation: &Discretisation,
        scale: f64,
        combination: Combination,
        symbol: impl Fn(Jet, usize) -> C64,
    ) -> Mat<T> {
        self.blocks(discretisation, scale, combination, &symbol)
            .dense()
    }

    /// The balances of `combination`, block by block, then its walls.
    fn blocks<T: Scalar>(
        &self,
        discretisation: &Discretisation,
        scale: f64,
        combination: Combination,
        symbol: &impl Fn(Jet, usize) -> C64,
    ) -> Blocks<T> {
        // Terms that share a block and a y-order share one differentiation matrix.
        let mut sums: BTreeMap<(usize, usize, usize), Vec<T>> = BTreeMap::new();
        let zero = C64::new(0.0, 0.0);
        for (row, jet, coefficient) in &self.terms {
            let column = usize::from(jet.field);
            if column >= self.layout.columns.len() {
                continue;
            }
            let weight = if jet.t > 0 {
                combination.mass
            } else {
                combination.operator
            };
            if weight == zero {
                continue;
            }
            let factor = weight * symbol(*jet, self.row_turns[*row]) * scale.powi(i32::from(jet.y));
            if factor == zero {
                continue;
            }
            let factor = T::from_complex(factor);
            let sum = sums
                .entry((*row, column, usize::from(jet.y)))
                .or_insert_with(|| vec![T::from_complex(zero); coefficient.len()]);
            for (s, c) in sum.iter_mut().zip(coefficient) {
                *s += factor.times(*c);
            }
        }
        let balance = |((row, column, order), coefficients): ((usize, usize, usize), Vec<T>)| {
            let (rows, columns) = (&self.layout.rows[row], &self.layout.columns[column]);
            Block {
                row: rows.offset,
                column: columns.offset,
                derivative: Derivative::new(discretisation, columns.grid, rows.grid, order),
                coefficients,
            }
        };
        let mut blocks: Vec<Block<T>> = sums.into_iter().map(balance).collect();
        if combination.walls != 0.0 {
            self.add_walls(
                &mut blocks,
                discretisation,
                scale,
                combination.walls,
                symbol,
            );
        }
        Blocks {
            size: self.layout.size,
            blocks,
        }
    }

    fn add_walls<T: Scalar>(
        &self,
        blocks: &mut Vec<Block<T>>,
        discretisation: &Discretisation,
        scale: f64,
        weight: f64,
        symbol: &impl Fn(Jet, usize) -> C64,
    ) {
        for (index, wall) in self.walls.iter().enumerate() {
            let turn = self.wall_turn(wall);
            let to = if wall.end == End::Lower {
                GridKind::Lower
            } else {
                GridKind::Upper
            };
            for (jet, coefficient) in &wall.linear {
                let Some(columns) = self.layout.columns.get(usize::from(jet.field)) else {
                    continue;
                };
                let factor =
                    symbol(*jet, turn) * (weight * coefficient * scale.powi(i32::from(jet.y)));
                blocks.push(Block {
                    row: self.layout.walls + index,
                    column: columns.offset,
                    derivative: Derivative::new(
                        discretisation,
                        columns.grid,
                        to,
                        usize::from(jet.y),
                    ),
                    coefficients: vec![T::from_complex(factor)],
                });
            }
        }
    }
}

impl Problem<'_> {
    /// L and M0 at wavenumber k, boundary conditions as rows of L with no mass.
    pub fn pencil<T: Scalar>(&self, k: f64) -> (Mat<T>, Mat<T>) {
        self.pencil_of(&self.direct, k)
    }

    /// M0 at wavenumber k, to be applied rather than factorised.
    pub fn mass<T: Scalar>(&self, k: f64) -> Blocks<T> {
        let symbol = |jet, turn| self.direct.symbol(jet, k, turn);
        self.direct
            .blocks(self.discretisation, self.scale(), MASS, &symbol)
    }

    /// L at wavenumber k with the boundary conditions as rows, to be applied.
    pub fn operator<T: Scalar>(&self, k: f64) -> Blocks<T> {
        let symbol = |jet, turn| self.direct.symbol(jet, k, turn);
        self.direct
            .blocks(self.discretisation, self.scale(), OPERATOR, &symbol)
    }

    /// d^order/dk^order of a combination of L and M0 at k ≠ 0.
    pub fn wavenumber_derivative<T: Scalar>(
        &self,
        k: f64,
        combination: Combination,
        order: i32,
    ) -> Mat<T> {
        let (discretisation, scale) = (self.discretisation, self.scale());
        self.direct
            .wavenumber_derivative(discretisation, scale, k, combination, order)
    }

    /// The same for the adjoint problem.
    pub fn pencil_of<T: Scalar>(&self, problem: &LinearProblem, k: f64) -> (Mat<T>, Mat<T>) {
        (
            problem.matrix(self.discretisation, self.scale(), k, OPERATOR),
            problem.matrix(self.discretisation, self.scale(), k, MASS),
        )
    }

    /// σ M0 − L, the boundary conditions being rows of L without mass; bordered at k = 0.
    pub fn shifted<T: Scalar>(&self, k: f64, shift: C64) -> Mat<T> {
        let combination = Combination {
            mass: shift,
            operator: C64::new(-1.0, 0.0),
            walls: -1.0,
        };
        let matrix = self
            .direct
            .matrix(self.discretisation, self.scale(), k, combination);
        if k == 0.0 {
            bordered_by(matrix, &self.borders)
        } else {
            matrix
        }
    }

    /// L and M0 at k = 0 with the borders of the closures.
    pub fn bordered_pencil<T: Scalar>(&self) -> (Mat<T>, Mat<T>) {
        with_borders(self.pencil::<T>(0.0), &self.borders)
    }

    /// The same for the adjoint problem.
    ///
    /// # Errors
    /// A model without adjoint boundary conditions, or whose closures have no adjoint.
    pub fn bordered_adjoint_pencil<T: Scalar>(&self) -> Result<(Mat<T>, Mat<T>)> {
        let adjoint = self.adjoint()?;
        let layout = &adjoint.layout;
        let kept: Vec<usize> = self.borders.iter().map(|b| b.closure).collect();
        let borders = closure::adjoint(self.model, self.base, layout, self.discretisation, &kept)?;
        Ok(with_borders(self.pencil_of(adjoint, 0.0), &borders))
    }
}

/// A pencil with borders that have no mass.
pub(super) fn with_borders<T: Scalar>(
    (operator, mass): (Mat<T>, Mat<T>),
    borders: &[Border],
) -> (Mat<T>, Mat<T>) {
    let n = mass.nrows();
    let size = n + borders.len();
    let mass = Mat::from_fn(size, size, |i, j| {
        if i < n && j < n {
            mass[(i, j)]
        } else {
            T::zero_impl()
        }
    });
    (bordered_by(operator, borders), mass)
}

fn bordered_by<T: Scalar>(matrix: Mat<T>, borders: &[Border]) -> Mat<T> {
    let real = |value: f64| T::from_complex(C64::new(value, 0.0));
    let borders = borders.iter().map(|border| {
        let column = border.column.iter().map(|&v| real(v)).collect();
        let row = border.row.iter().map(|&v| real(v)).collect();
        (column, row)
    });
    bordered(&matrix, &borders.collect::<Vec<_>>())
}
