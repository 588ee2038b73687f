//! An operator collocated at wavenumber k, with its boundary conditions:
//!
//! block (row, column) = Σ_terms diag(coefficient) · (i k)^a |k|^b · ∂y^d

use super::basis::{Profile, Turn, Turned};
use super::block::{Block, Blocks};
use super::closure::Border;
use crate::model::{BalanceId, C64, End, FieldId, Id, Jet, Table};
use crate::numerics::dense::{Scalar, bordered};
use crate::space::{Layout, Points, Space};
use crate::wavevector::WaveVector;
use faer::Mat;
use std::collections::BTreeMap;

/// A matrix to be assembled: mass · M0 + operator · L, and walls · W for the rows of the boundary conditions.
#[derive(Clone, Copy)]
pub struct Combination {
    /// The factor of M0.
    pub mass: C64,
    /// The factor of L.
    pub operator: C64,
    /// The factor of the boundary conditions.
    pub walls: f64,
}

impl Combination {
    /// M0 alone.
    pub const MASS: Combination = Combination {
        mass: C64::new(1.0, 0.0),
        operator: C64::new(0.0, 0.0),
        walls: 0.0,
    };

    /// L with the boundary conditions.
    pub const OPERATOR: Combination = Combination {
        mass: C64::new(0.0, 0.0),
        operator: C64::new(1.0, 0.0),
        walls: 1.0,
    };

    /// σ M0 − L, the boundary conditions being rows of L without mass.
    pub const fn shifted(shift: C64) -> Self {
        Combination {
            mass: shift,
            operator: C64::new(-1.0, 0.0),
            walls: -1.0,
        }
    }

    /// L − c M0 with the boundary conditions.
    pub fn at_eigenvalue(c: C64) -> Self {
        Combination {
            mass: -c,
            ..Combination::OPERATOR
        }
    }
}

/// One boundary condition, Σ coefficient · Π jets = 0.
#[derive(Clone, Debug)]
pub struct WallRow<Column> {
    /// The end at which it holds.
    pub end: End,
    /// Its linear part W: jets with their coefficients.
    pub linear: Vec<(Jet<Column>, f64)>,
    /// Products of jets with their coefficients.
    pub nonlinear: Vec<(Vec<Jet<Column>>, f64)>,
}

/// A term with its coefficient at each point of its row.
#[derive(Clone)]
pub(super) struct CollocatedTerm<Row, Column> {
    pub row: Row,
    pub jet: Jet<Column>,
    pub coefficients: Vec<f64>,
    /// The largest modulus of a coefficient.
    pub largest: f64,
}

/// An operator from columns to rows with mass matrix and boundary conditions.
#[derive(Clone)]
pub struct LinearProblem<Row, Column> {
    /// The interval, or point, on which it is collocated.
    pub space: Space,
    /// Positions and points of unknowns and equations.
    pub layout: Layout<Row, Column>,
    /// The boundary conditions.
    pub walls: Vec<WallRow<Column>>,
    pub(super) terms: Vec<CollocatedTerm<Row, Column>>,
    /// The powers of i by which columns and rows are divided to make matrices real; ones without the symmetry.
    pub(super) column_turns: Table<Column, Turn>,
    pub(super) row_turns: Table<Row, Turn>,
}

/// L and M0: from fields to balances.
pub type Direct = LinearProblem<BalanceId, FieldId>;

/// L† and M0†: from the adjoint fields of balances to fields.
pub type Adjoint = LinearProblem<FieldId, BalanceId>;

/// (i k)^x |k|^absx
pub fn symbol<V>(jet: &Jet<V>, q: WaveVector) -> C64 {
    Turn::new(jet.x).factor() * q.size(jet)
}

impl<Row: Id, Column: Id> LinearProblem<Row, Column> {
    /// (i k)^x |k|^absx of a jet in the solver's basis, in a row that is divided by `row`.
    fn symbol(&self, jet: &Jet<Column>, k: WaveVector, row: Turn) -> C64 {
        let turn = Turn::new(jet.x) + self.column_turns[jet.of] - row;
        turn.factor() * k.size(jet)
    }

    /// The power of i by which a boundary condition is divided in the solver's basis: i for one that is odd in the mirror.
    pub(super) fn wall_turn(&self, wall: &WallRow<Column>) -> Turn {
        let first = wall.linear.first().map(|(jet, _)| *jet);
        first.map_or(Turn::default(), |jet| {
            Turn::of((self.column_turns[jet.of] + Turn::new(jet.x)).is_odd())
        })
    }

    /// The factor that takes the right-hand side of a boundary condition into the solver's basis.
    pub fn wall_factor(&self, wall: &WallRow<Column>) -> C64 {
        if self
            .column_turns
            .iter()
            .all(|&turn| turn == Turn::default())
        {
            return C64::new(1.0, 0.0);
        }
        (-self.wall_turn(wall)).factor()
    }

    /// The physical value of a column over its value in the solver's basis.
    pub fn column_factor(&self, column: Column) -> C64 {
        self.column_turns[column].factor()
    }

    /// The factor that takes the right-hand side of a row into the solver's basis.
    pub fn row_factor(&self, row: Row) -> C64 {
        (-self.row_turns[row]).factor()
    }

    /// Physical values of the unknowns from those in the solver's basis.
    pub fn physical<T: Scalar>(&self, x: &[T]) -> Profile {
        let mut values = Profile::zero(self.layout.size);
        for (column, block) in self.layout.columns.pairs() {
            let factor = self.column_turns[column].factor();
            for i in block.range() {
                values[i] = x[i].complex() * factor;
            }
        }
        values
    }

    /// Physical values in the solver's basis.
    pub fn turned(&self, values: &Profile) -> Turned {
        let mut turned = Turned(values.to_vec());
        for (column, block) in self.layout.columns.pairs() {
            let factor = (-self.column_turns[column]).factor();
            turned[block.range()].iter_mut().for_each(|v| *v *= factor);
        }
        turned
    }

    /// A combination of L and M0 at wavenumber k, as a sum of blocks.
    pub fn blocks<T: Scalar>(&self, k: WaveVector, combination: Combination) -> Blocks<T> {
        self.assemble(combination, &|jet, turn| self.symbol(jet, k, turn))
    }

    /// A combination of L and M0 at wavenumber k, as a matrix.
    pub fn matrix<T: Scalar>(&self, k: WaveVector, combination: Combination) -> Mat<T> {
        self.blocks(k, combination).dense()
    }

    /// M0 at wavenumber k.
    pub fn mass<T: Scalar>(&self, k: WaveVector) -> Blocks<T> {
        self.blocks(k, Combination::MASS)
    }

    /// L and M0 at wavenumber k, boundary conditions as rows of L with no mass.
    pub fn pencil<T: Scalar>(&self, k: WaveVector) -> (Mat<T>, Mat<T>) {
        (
            self.matrix(k, Combination::OPERATOR),
            self.matrix(k, Combination::MASS),
        )
    }

    /// d^order/dk^order of a combination at k ≠ 0: that of k^n is k^n n (n − 1) … / k^order.
    pub fn wavenumber_derivative(
        &self,
        k: WaveVector,
        combination: Combination,
        order: u8,
    ) -> Blocks<C64> {
        self.assemble(combination, &|jet, turn| {
            let power = f64::from(jet.x) + f64::from(jet.absx);
            let factors = (0..order).map(|i| (power - f64::from(i)) / k.k());
            self.symbol(jet, k, turn) * factors.product::<f64>()
        })
    }

    /// The rows of `combination`, block by block, then its walls.
    fn assemble<T: Scalar>(
        &self,
        combination: Combination,
        symbol: &impl Fn(&Jet<Column>, Turn) -> C64,
    ) -> Blocks<T> {
        // Terms that share a block and a y-order share one differentiation matrix.
        let mut sums: BTreeMap<(Row, Column, usize), Vec<T>> = BTreeMap::new();
        let zero = C64::new(0.0, 0.0);
        for CollocatedTerm {
            row,
            jet,
            coefficients,
            ..
        } in &self.terms
        {
            if self.layout.columns.find(jet.of).is_none() {
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
            let factor = weight * symbol(jet, self.row_turns[*row]);
            if factor == zero {
                continue;
            }
            let factor = T::from_complex(factor);
            let sum = sums
                .entry((*row, jet.of, usize::from(jet.y)))
                .or_insert_with(|| vec![T::from_complex(zero); coefficients.len()]);
            for (s, c) in sum.iter_mut().zip(coefficients) {
                *s += factor.times(*c);
            }
        }
        let block = |((row, column, order), coefficients): ((Row, Column, usize), Vec<T>)| {
            let (rows, columns) = (&self.layout.rows[row], &self.layout.columns[column]);
            let derivative = self.space.derivative(columns.points, rows.points, order);
            Block::new(rows.offset, columns.offset, derivative, coefficients)
        };
        let mut blocks: Vec<Block<T>> = sums.into_iter().map(block).collect();
        if combination.walls != 0.0 {
            self.add_walls(&mut blocks, combination.walls, symbol);
        }
        Blocks::new(self.layout.size, blocks)
    }

    /// Adds `weight` times the linear parts of the boundary conditions, a row each.
    fn add_walls<T: Scalar>(
        &self,
        blocks: &mut Vec<Block<T>>,
        weight: f64,
        symbol: &impl Fn(&Jet<Column>, Turn) -> C64,
    ) {
        for (index, wall) in self.walls.iter().enumerate() {
            let (turn, to) = (self.wall_turn(wall), Points::end(wall.end));
            for (jet, coefficient) in &wall.linear {
                let Some(columns) = self.layout.columns.find(jet.of) else {
                    continue;
                };
                let factor = symbol(jet, turn) * (weight * coefficient);
                let order = usize::from(jet.y);
                let derivative = self.space.derivative(columns.points, to, order);
                let row = self.layout.walls + index;
                let coefficients = vec![T::from_complex(factor)];
                blocks.push(Block::new(row, columns.offset, derivative, coefficients));
            }
        }
    }

    /// Σ |coefficient| |k|^a (2/h)^d over the chosen terms of a row, at each of its points; h is the length of the interval.
    pub(super) fn term_sizes(
        &self,
        row: Row,
        k: WaveVector,
        chosen: impl Fn(&Jet<Column>) -> bool,
    ) -> Vec<f64> {
        let mut sums = vec![0.0; self.layout.rows[row].len];
        let terms = self.terms.iter();
        for term in terms.filter(|term| term.row == row && chosen(&term.jet)) {
            let jet = &term.jet;
            let size = k.length().powi(i32::from(jet.x + jet.absx))
                * self.space.rate().powi(i32::from(jet.y));
            for (sum, c) in sums.iter_mut().zip(&term.coefficients) {
                *sum += c.abs() * size;
            }
        }
        sums
    }

    /// The most that a column of a given size contributes to each row of L − c M0, then to each boundary condition,
    /// `[row][column]`: Σ |coefficient| |k|^a (2/h)^d |c|^t size.
    pub fn shares(
        &self,
        k: WaveVector,
        c: C64,
        sizes: &Table<Column, f64>,
    ) -> Vec<Table<Column, f64>> {
        let rates = [k.length(), self.space.rate(), c.norm()];
        let size = |jet: &Jet<Column>| {
            let orders = [jet.x + jet.absx, jet.y, jet.t].map(i32::from);
            let powers = rates.iter().zip(orders).filter(|(_, order)| *order > 0);
            let symbol: f64 = powers.map(|(rate, order)| rate.powi(order)).product();
            sizes.find(jet.of).map_or(0.0, |size| size * symbol)
        };
        let mut shares = vec![sizes.map(|_| 0.0); self.layout.rows.len() + self.walls.len()];
        for term in &self.terms {
            if sizes.find(term.jet.of).is_some() {
                shares[term.row.index()][term.jet.of] += term.largest * size(&term.jet);
            }
        }
        for (index, wall) in self.walls.iter().enumerate() {
            for (jet, coefficient) in &wall.linear {
                if sizes.find(jet.of).is_some() {
                    shares[self.layout.rows.len() + index][jet.of] += coefficient.abs() * size(jet);
                }
            }
        }
        shares
    }

    /// Whether a row holds the time derivative of a column.
    pub(super) fn has_mass(&self, row: Row, column: Column) -> bool {
        let mut terms = self.terms.iter();
        terms.any(|term| term.row == row && term.jet.t > 0 && term.jet.of == column)
    }
}

/// The pencil of L and M0 with borders, which have no mass. A multiplier or unknown number in it has the opposite sign of
/// that in σ M0 − L, since L itself has.
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
    (
        bordered_by(operator, borders, |row, of| -row.corner(of)),
        mass,
    )
}

/// [A c; r d]: `corner` gives d by the border of the row and that of the column.
pub(super) fn bordered_by<T: Scalar>(
    matrix: Mat<T>,
    borders: &[Border],
    corner: impl Fn(&Border, &Border) -> f64,
) -> Mat<T> {
    let n = matrix.nrows();
    let real = |value: f64| T::from_complex(C64::new(value, 0.0));
    let vectors = borders.iter().map(|border| {
        let column = border.column.iter().map(|&v| real(v)).collect();
        let row = border.row.iter().map(|&v| real(v)).collect();
        (column, row)
    });
    let mut result = bordered(&matrix, &vectors.collect::<Vec<_>>());
    for (i, row) in borders.iter().enumerate() {
        for (j, of) in borders.iter().enumerate() {
            result[(n + i, n + j)] = real(corner(row, of));
        }
    }
    result
}
