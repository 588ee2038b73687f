//! Which fields a mode has: what rounding leaves of the others in its vector is put to zero.
//!
//! A wave of one velocity component alone, say, knows nothing of the others, and every product with them vanishes; a
//! force that is a gradient makes a pressure and no flow. Left as noise, such fields would make a c2 of noise, for
//! which no resolution is enough.

use super::{Blocks, Border, Problem};
use crate::model::{C64, FieldId, Table};
use crate::numerics::dense::Scalar;
use crate::numerics::{Applied, Noise};
use crate::space::Block;
use crate::wavevector::WaveVector;

/// The least noise, in units of the machine's precision; without a cross-stream coordinate it is that.
const LEAST: f64 = 125.0;

/// The part of a row below which a solved field is its rounding: some ten times what second derivatives near the walls
/// leave by observation.
fn noise(resolution: Option<usize>) -> f64 {
    f64::EPSILON * resolution.map_or(LEAST, |m| LEAST.max((m as f64).powi(3)))
}

/// Terms of the rows, balances, then walls, then closures, from which fields are told to be there.
pub struct Known {
    /// Fields that are there for certain.
    pub fields: Vec<FieldId>,
    /// What rows hold besides fields: the size of a forcing.
    pub rows: Vec<f64>,
}

impl Problem {
    /// Puts to zero, in a vector of the solver's basis, fields that count in no row to which something else contributes:
    /// known fields, a forcing, or fields that count next to these.
    pub fn clear_absent(&self, k: WaveVector, shift: C64, values: &mut [C64], known: Known) {
        let columns = &self.direct.layout.columns;
        let largest = columns.map(|block| largest(block.of(values)));
        let mut shares = self.direct.shares(k, shift, &largest);
        if k.is_mean() {
            shares.extend(self.closure_shares(&largest));
        }
        let present = self.present(known, &shares);
        for (field, block) in columns.pairs() {
            if !present.contains(&field) {
                values[block.range()].fill(C64::new(0.0, 0.0));
            }
        }
    }

    /// What a field of a given size adds at most to the row of each closure.
    fn closure_shares(&self, largest: &Table<FieldId, f64>) -> Vec<Table<FieldId, f64>> {
        let columns = &self.direct.layout.columns;
        let share = |border: &Border| {
            let sums = columns.pairs().map(|(field, block)| {
                let weights = block.of(&border.row).iter().map(|r| r.abs());
                largest[field] * weights.sum::<f64>()
            });
            sums.collect()
        };
        self.borders.iter().map(share).collect()
    }

    /// The field that an eigenvector has for certain: the one with the largest part of yᴴ M0 x, whatever the units.
    pub fn carrier<T: Scalar>(&self, mass: &Blocks<T>, right: &[T], left: &[T]) -> Known {
        let weights = mass.apply_adjoint(left);
        let part = |block: &Block| -> f64 {
            let pairs = block.of(&weights).iter().zip(block.of(right));
            pairs.map(|(w, x)| w.size() * x.size()).sum()
        };
        let parts = self.direct.layout.columns.pairs();
        let parts = parts.map(|(field, block)| (field, part(block)));
        let most = parts.max_by(|a, b| a.1.total_cmp(&b.1));
        Known {
            fields: most.map(|(field, _)| field).into_iter().collect(),
            ..Known::nothing(self)
        }
    }

    /// The known fields with all that count beside them, row by row.
    fn present(&self, known: Known, shares: &[Table<FieldId, f64>]) -> Vec<FieldId> {
        // Data that are disturbed leave more of an absent field.
        let disturbed = self.noise.map_or(1.0, |_| Noise::SIZE / f64::EPSILON);
        let noise = disturbed * noise(self.resolution);
        let Known { mut fields, rows } = known;
        loop {
            // Beside what is known, in the row in which it counts most.
            let weight = |field: FieldId| {
                let parts = rows.iter().zip(shares).map(|(forcing, row)| {
                    let beside = forcing + fields.iter().map(|&f| row[f]).sum::<f64>();
                    if beside > 0.0 {
                        row[field] / beside
                    } else {
                        0.0
                    }
                });
                parts.fold(0.0, f64::max)
            };
            let others = self.direct.layout.columns.ids();
            let others = others.filter(|field| !fields.contains(field));
            // The weightiest first: next to it another may be noise.
            let most = others.map(|field| (field, weight(field)));
            match most.max_by(|a, b| a.1.total_cmp(&b.1)) {
                Some((field, weight)) if weight > noise => fields.push(field),
                _ => return fields,
            }
        }
    }
}

impl Known {
    fn nothing(problem: &Problem) -> Self {
        let (rows, walls) = (&problem.direct.layout.rows, &problem.direct.walls);
        let rows = rows.len() + walls.len() + problem.borders.len();
        Known {
            fields: Vec::new(),
            rows: vec![0.0; rows],
        }
    }

    /// A forcing of the equations, and of the closures where these are forced.
    pub fn forcing(problem: &Problem, right: &[C64], closures: &[C64]) -> Self {
        let mut known = Known::nothing(problem);
        known.add(problem, right, 1.0);
        let first = known.rows.len() - problem.borders.len();
        for (sum, value) in known.rows[first..].iter_mut().zip(closures) {
            *sum += value.norm();
        }
        known
    }

    /// A multiplier or unknown number of some size, with all that its column and the corner carry.
    pub fn add_border(&mut self, problem: &Problem, border: &Border, size: f64) {
        self.add(problem, &border.column, size);
        let first = self.rows.len() - problem.borders.len();
        for (sum, row) in self.rows[first..].iter_mut().zip(&problem.borders) {
            *sum += row.corner(border).abs() * size;
        }
    }

    /// A column of the equations, times a number of some size.
    pub fn add<T: Scalar>(&mut self, problem: &Problem, column: &[T], factor: f64) {
        let layout = &problem.direct.layout;
        let rows = layout.rows.iter().map(|block| largest(block.of(column)));
        let walls = (0..problem.direct.walls.len()).map(|i| column[layout.walls + i].size());
        for (sum, size) in self.rows.iter_mut().zip(rows.chain(walls)) {
            *sum += factor * size;
        }
    }
}

fn largest<T: Scalar>(values: &[T]) -> f64 {
    values.iter().map(|v| v.size()).fold(0.0, f64::max)
}
