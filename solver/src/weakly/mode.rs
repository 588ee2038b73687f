//! One Fourier mode of the expansion, and its derivatives where nonlinear terms need them.

use crate::collocation::GridKind;
use crate::dense::vectorised;
use crate::model::{C64, Jet};
use crate::problem::{Problem, quarter_turn};

/// Values of a mode and of its time derivative, physical, at the unknowns' points.
#[derive(Clone, Debug)]
pub struct Mode {
    /// Its wavenumber: ∂x → i q.
    pub q: f64,
    /// Physical values at the unknowns' points.
    pub values: Vec<C64>,
    /// What stands beside the same amplitudes in ∂t X.
    pub rate: Vec<C64>,
    /// The part of it that is no multiple of a mode: constants that drift (mean modes alone; empty for none).
    pub drift: Vec<C64>,
    /// Unknown numbers (mean modes alone), by field after the profiles.
    pub uniform: Vec<C64>,
}

impl Mode {
    /// The mode of −q: complex conjugate.
    pub fn conjugate(&self) -> Mode {
        let conj = |list: &Vec<C64>| list.iter().map(|c| c.conj()).collect();
        Mode {
            q: -self.q,
            values: conj(&self.values),
            rate: conj(&self.rate),
            drift: conj(&self.drift),
            uniform: conj(&self.uniform),
        }
    }

    /// Jets at the points of one grid.
    pub fn jets(&self, problem: &Problem, jets: &[Jet], grid: GridKind) -> JetTable {
        // Jets that differ in ∂x alone share one derivative of the profile.
        let mut derived: Vec<(Jet, Vec<C64>)> = Vec::new();
        let mut table = JetTable {
            jets: jets.len(),
            values: Vec::new(),
        };
        for (position, &jet) in jets.iter().enumerate() {
            let profile = Jet {
                x: 0,
                absx: 0,
                ..jet
            };
            let known = derived.iter().position(|(other, _)| *other == profile);
            let known = known.unwrap_or_else(|| {
                derived.push((profile, self.profile(problem, profile, grid)));
                derived.len() - 1
            });
            let column = &derived[known].1;
            if table.values.is_empty() {
                table.values = vec![C64::new(0.0, 0.0); column.len() * jets.len()];
            }
            let factor = self.symbol(jet);
            let entries = table.values.iter_mut().skip(position).step_by(jets.len());
            for (entry, value) in entries.zip(column) {
                *entry = factor * value;
            }
        }
        table
    }

    /// What rounding can make of the jets, point by point, in units of the machine's precision:
    /// Σ |D| max |value| in place of D value.
    pub fn rounding(&self, problem: &Problem, jets: &[Jet], grid: GridKind) -> Vec<Vec<f64>> {
        let mut table = vec![vec![0.0; jets.len()]; grid.count()];
        for (position, &jet) in jets.iter().enumerate() {
            let factor = self.symbol(jet).norm();
            let Some(block) = problem.direct.layout.columns.get(usize::from(jet.field)) else {
                continue;
            };
            let source = if jet.t == 0 { &self.values } else { &self.rate };
            let order = usize::from(jet.y);
            let matrix = problem.discretisation.matrix(block.grid, grid, order);
            let scale = factor * problem.scale().powi(i32::from(jet.y));
            // Every value was solved for, to the precision of the largest.
            let values = source[block.offset..][..block.len].iter();
            let largest = values.map(|v| v.norm()).fold(0.0, f64::max);
            for j in 0..block.len {
                for (row, d) in table.iter_mut().zip(matrix.col_as_slice(j)) {
                    row[position] += scale * largest * d.abs();
                }
            }
        }
        table
    }

    /// One jet at the points of a grid.
    pub fn jet(&self, problem: &Problem, jet: Jet, grid: GridKind) -> Vec<C64> {
        let factor = self.symbol(jet);
        let mut values = self.profile(problem, jet, grid);
        values.iter_mut().for_each(|v| *v *= factor);
        values
    }

    /// (i q)^x |q|^absx of a jet.
    pub(super) fn symbol(&self, jet: Jet) -> C64 {
        let size = self.q.powi(i32::from(jet.x)) * self.q.abs().powi(i32::from(jet.absx));
        quarter_turn(usize::from(jet.x)) * size
    }

    /// ∂t and ∂y of a jet at the points of a grid, its x-derivatives left out.
    pub(super) fn profile(&self, problem: &Problem, jet: Jet, grid: GridKind) -> Vec<C64> {
        let field = usize::from(jet.field);
        let Some(block) = problem.direct.layout.columns.get(field) else {
            let profiles = problem.direct.layout.columns.len();
            let value = self.uniform.get(field - profiles).copied();
            return vec![value.unwrap_or_default(); grid.count()];
        };
        let source = if jet.t == 0 { &self.values } else { &self.rate };
        let source = &source[block.offset..block.offset + block.len];
        let order = usize::from(jet.y);
        if let Some(start) = block.grid.start_of(grid).filter(|_| order == 0) {
            return source[start..][..grid.count()].to_vec();
        }
        let matrix = problem.discretisation.matrix(block.grid, grid, order);
        let scale = problem.scale().powi(i32::from(jet.y));
        // Real and imaginary parts apart: with a mirror symmetry one of them is zero.
        let part = |of: fn(&C64) -> f64| {
            let mut result = vec![0.0; matrix.nrows()];
            vectorised(
                #[inline(always)]
                || {
                    for (j, value) in source.iter().enumerate() {
                        let value = of(value) * scale;
                        if value != 0.0 {
                            for (r, m) in result.iter_mut().zip(matrix.col_as_slice(j)) {
                                *r += value * m;
                            }
                        }
                    }
                },
            );
            result
        };
        let parts = part(|v| v.re).into_iter().zip(part(|v| v.im));
        parts.map(|(re, im)| C64::new(re, im)).collect()
    }
}

/// Jets at the points of a grid, point by point.
#[derive(Clone, Debug)]
pub struct JetTable {
    jets: usize,
    values: Vec<C64>,
}

impl JetTable {
    /// All jets at one point.
    pub fn at(&self, point: usize) -> &[C64] {
        &self.values[point * self.jets..][..self.jets]
    }

    /// The jets of the conjugate mode.
    pub fn conjugate(&self) -> JetTable {
        JetTable {
            jets: self.jets,
            values: self.values.iter().map(|v| v.conj()).collect(),
        }
    }
}
