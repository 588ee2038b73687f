//! Matrices from terms: block (row, column) = Σ diag(coefficient) · (i k)^a |k|^b · D^d.

use super::{LinearProblem, Problem, WallRow, quarter_turn};
use crate::collocation::{Discretisation, GridKind, Layout};
use crate::dense::Scalar;
use crate::model::{C64, End, Jet};
use faer::Mat;
use std::collections::BTreeMap;

/// What is assembled: `mass`·M0 + `operator`·L, and `walls` times the boundary conditions.
#[derive(Clone, Copy)]
pub struct Combination {
    pub mass: C64,
    pub operator: C64,
    pub walls: f64,
}

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

    /// Turns that make a wall's row real.
    fn wall_turn(&self, wall: &WallRow) -> usize {
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
        let n = self.layout.size;
        let mut matrix = Mat::<T>::zeros(n, n);
        self.add(
            &mut matrix,
            discretisation,
            scale,
            combination,
            |jet, row| self.symbol(jet, k, row),
        );
        matrix
    }

    /// d/dk of [`LinearProblem::matrix`] at k > 0.
    pub fn wavenumber_derivative<T: Scalar>(
        &self,
        discretisation: &Discretisation,
        scale: f64,
        k: f64,
        combination: Combination,
    ) -> Mat<T> {
        let n = self.layout.size;
        let mut matrix = Mat::<T>::zeros(n, n);
        self.add(
            &mut matrix,
            discretisation,
            scale,
            combination,
            |jet, row| {
                let power = f64::from(jet.x) + f64::from(jet.absx);
                self.symbol(jet, k, row) * (power / k)
            },
        );
        matrix
    }

    fn add<T: Scalar>(
        &self,
        matrix: &mut Mat<T>,
        discretisation: &Discretisation,
        scale: f64,
        combination: Combination,
        symbol: impl Fn(Jet, usize) -> C64,
    ) {
        // Terms that share a block and a y-order share one differentiation matrix.
        let mut sums: BTreeMap<(usize, usize, usize), Vec<C64>> = BTreeMap::new();
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
            if weight == C64::new(0.0, 0.0) {
                continue;
            }
            let factor = weight * symbol(*jet, self.row_turns[*row]) * scale.powi(i32::from(jet.y));
            if factor == C64::new(0.0, 0.0) {
                continue;
            }
            let key = (*row, column, usize::from(jet.y));
            let sum = sums
                .entry(key)
                .or_insert_with(|| vec![C64::new(0.0, 0.0); coefficient.len()]);
            for (s, c) in sum.iter_mut().zip(coefficient) {
                *s += factor * *c;
            }
        }
        for ((row, column, order), sum) in sums {
            let (rows, columns) = (&self.layout.rows[row], &self.layout.columns[column]);
            let derivative = discretisation.matrix(columns.grid, rows.grid, order);
            let sum: Vec<T> = sum.into_iter().map(T::from_complex).collect();
            for j in 0..columns.len {
                let source = derivative.col(j);
                let target = matrix.as_mut().col_mut(columns.offset + j);
                let mut target = target.subrows_mut(rows.offset, rows.len);
                for (i, &factor) in sum.iter().enumerate() {
                    target[i] += scaled(factor, source[i]);
                }
            }
        }
        if combination.walls != 0.0 {
            self.add_walls(matrix, discretisation, scale, combination.walls, symbol);
        }
    }

    fn add_walls<T: Scalar>(
        &self,
        matrix: &mut Mat<T>,
        discretisation: &Discretisation,
        scale: f64,
        weight: f64,
        symbol: impl Fn(Jet, usize) -> C64,
    ) {
        for (index, wall) in self.walls.iter().enumerate() {
            let row = self.layout.walls + index;
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
                let derivative = discretisation.matrix(columns.grid, to, usize::from(jet.y));
                let factor =
                    symbol(*jet, turn) * (weight * coefficient * scale.powi(i32::from(jet.y)));
                for j in 0..columns.len {
                    let entry = &mut matrix[(row, columns.offset + j)];
                    *entry += T::from_complex(factor * derivative[(0, j)]);
                }
            }
        }
    }
}

fn scaled<T: Scalar>(factor: T, by: f64) -> T {
    T::from_complex(factor.complex() * by)
}

impl Problem<'_> {
    /// L and M0 at wavenumber k, boundary conditions as rows of L with no mass.
    pub fn pencil<T: Scalar>(&self, k: f64) -> (Mat<T>, Mat<T>) {
        self.pencil_of(&self.direct, k)
    }

    /// M0 at wavenumber k.
    pub fn mass<T: Scalar>(&self, k: f64) -> Mat<T> {
        let (zero, one) = (C64::new(0.0, 0.0), C64::new(1.0, 0.0));
        let mass = Combination {
            mass: one,
            operator: zero,
            walls: 0.0,
        };
        self.direct
            .matrix(self.discretisation, self.scale(), k, mass)
    }

    /// The same for the adjoint problem.
    pub fn pencil_of<T: Scalar>(&self, problem: &LinearProblem, k: f64) -> (Mat<T>, Mat<T>) {
        let (zero, one) = (C64::new(0.0, 0.0), C64::new(1.0, 0.0));
        let operator = Combination {
            mass: zero,
            operator: one,
            walls: 1.0,
        };
        let mass = Combination {
            mass: one,
            operator: zero,
            walls: 0.0,
        };
        (
            problem.matrix(self.discretisation, self.scale(), k, operator),
            problem.matrix(self.discretisation, self.scale(), k, mass),
        )
    }

    /// σ M0 − L, with the boundary conditions as rows; bordered at k = 0.
    pub fn shifted<T: Scalar>(&self, k: f64, shift: C64) -> Mat<T> {
        let combination = Combination {
            mass: shift,
            operator: C64::new(-1.0, 0.0),
            walls: 1.0,
        };
        let matrix = self
            .direct
            .matrix(self.discretisation, self.scale(), k, combination);
        if k == 0.0 {
            self.bordered(matrix)
        } else {
            matrix
        }
    }

    /// L and M0 at k = 0 with the borders of the closures.
    pub fn bordered_pencil<T: Scalar>(&self) -> (Mat<T>, Mat<T>) {
        let (operator, mass) = self.pencil::<T>(0.0);
        let n = mass.nrows();
        let size = n + self.borders.len();
        let mass = Mat::from_fn(size, size, |i, j| {
            if i < n && j < n {
                mass[(i, j)]
            } else {
                T::from_complex(C64::new(0.0, 0.0))
            }
        });
        (self.bordered(operator), mass)
    }

    fn bordered<T: Scalar>(&self, matrix: Mat<T>) -> Mat<T> {
        let n = matrix.nrows();
        let size = n + self.borders.len();
        let real = |value: f64| T::from_complex(C64::new(value, 0.0));
        Mat::from_fn(size, size, |i, j| match (i < n, j < n) {
            (true, true) => matrix[(i, j)],
            (true, false) => real(self.borders[j - n].column[i]),
            (false, true) => real(self.borders[i - n].row[j]),
            (false, false) => real(0.0),
        })
    }
}
