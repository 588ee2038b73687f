//! Sets to zero the fields that take no part in a mode.
//!
//! A wave of one velocity component leaves the remaining ones at zero, and every product with these vanishes. A force that is a
//! gradient makes a pressure and no flow. A solved vector holds rounding noise in such fields; products of that noise
//! would give a c2 that never converges.

use super::{Blocks, Border, Problem};
use crate::model::{C64, FieldId, Table};
use crate::numerics::dense::Scalar;
use crate::numerics::{Applied, Noise};
use crate::space::Block;
use crate::wavevector::WaveVector;

/// The least noise, in units of the machine's precision: M³ at M = 5, and the noise where there is no cross-stream
/// coordinate.
const LEAST: f64 = 125.0;

/// Size below which a field counts as noise, relative to what stands beside it in a row: ε M³. Second derivatives near a
/// wall amplify rounding by about M³/10, as observed, so that there is a factor of ten to spare.
fn noise(resolution: Option<usize>) -> f64 {
    f64::EPSILON * resolution.map_or(LEAST, |m| LEAST.max((m as f64).powi(3)))
}

/// What is certain to be present in a problem, and from which the presence of fields follows.
pub struct Sources {
    /// Fields that are certain to be present.
    pub fields: Vec<FieldId>,
    /// Size of the forcing in each row: balances, then walls, then closures.
    pub rows: Vec<f64>,
}

impl Problem {
    /// Sets absent fields to zero in a vector of the solver's basis, with one value an unknown. A field is present where
    /// it is more than noise in a row of σ M0 − L beside the sources or beside another field that is present.
    pub fn clear_absent(&self, k: WaveVector, shift: C64, values: &mut [C64], sources: Sources) {
        let columns = &self.direct.layout.columns;
        let largest = columns.map(|block| largest(block.of(values)));
        let mut shares = self.direct.shares(k, shift, &largest);
        if k.is_mean() {
            shares.extend(self.closure_shares(&largest));
        }
        let present = self.present(sources, &shares);
        for (field, block) in columns.pairs() {
            if !present.contains(&field) {
                values[block.range()].fill(C64::new(0.0, 0.0));
            }
        }
    }

    /// The most that a field of a given size contributes to the row of each closure.
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

    /// The field that is certain to be present in an eigenvector: the one with the largest part of yᴴ M0 x, which does not
    /// depend on units.
    pub fn carrier<T: Scalar>(&self, mass: &Blocks<T>, right: &[T], left: &[T]) -> Sources {
        let weights = mass.apply_adjoint(left);
        let part = |block: &Block| -> f64 {
            let pairs = block.of(&weights).iter().zip(block.of(right));
            pairs.map(|(w, x)| w.size() * x.size()).sum()
        };
        let parts = self.direct.layout.columns.pairs();
        let parts = parts.map(|(field, block)| (field, part(block)));
        let most = parts.max_by(|a, b| a.1.total_cmp(&b.1));
        Sources {
            fields: most.map(|(field, _)| field).into_iter().collect(),
            ..Sources::none(self)
        }
    }

    /// The fields that are present, `shares[row][field]` being the most that a field contributes to a row.
    fn present(&self, sources: Sources, shares: &[Table<FieldId, f64>]) -> Vec<FieldId> {
        // Disturbed data leave more noise in an absent field than rounding does.
        let disturbed = self.noise.map_or(1.0, |_| Noise::SIZE / f64::EPSILON);
        let noise = disturbed * noise(self.resolution);
        let Sources { mut fields, rows } = sources;
        loop {
            // Share of the row beside the sources and the fields present, in the row where it is largest.
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
            let candidates = self.direct.layout.columns.ids();
            let candidates = candidates.filter(|field| !fields.contains(field));
            // The one of largest share first: beside it the next one may be noise.
            let parts = candidates.map(|field| (field, weight(field)));
            match parts.max_by(|a, b| a.1.total_cmp(&b.1)) {
                Some((field, weight)) if weight > noise => fields.push(field),
                _ => return fields,
            }
        }
    }
}

impl Sources {
    fn none(problem: &Problem) -> Self {
        let (rows, walls) = (&problem.direct.layout.rows, &problem.direct.walls);
        let rows = rows.len() + walls.len() + problem.borders.len();
        Sources {
            fields: Vec::new(),
            rows: vec![0.0; rows],
        }
    }

    /// The forcing of a problem: right-hand sides of balances and boundary conditions, and of the closures, none of which
    /// where `closures` is empty.
    pub fn forcing(problem: &Problem, right: &[C64], closures: &[C64]) -> Self {
        let mut sources = Sources::none(problem);
        sources.add(problem, right, 1.0);
        let first = sources.rows.len() - problem.borders.len();
        for (sum, value) in sources.rows[first..].iter_mut().zip(closures) {
            *sum += value.norm();
        }
        sources
    }

    /// Adds a multiplier or unknown number of a given size: its column in the equations, its corner in the closures.
    pub fn add_border(&mut self, problem: &Problem, border: &Border, size: f64) {
        self.add(problem, &border.column, size);
        let first = self.rows.len() - problem.borders.len();
        for (sum, row) in self.rows[first..].iter_mut().zip(&problem.borders) {
            *sum += row.corner(border).abs() * size;
        }
    }

    /// Adds the sizes of a column of the equations, times a factor.
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
