//! One Fourier mode X[k;m] of the expansion, and its derivatives where nonlinear terms need them.

use crate::collocation::GridKind;
use crate::model::{C64, Jet};
use crate::problem::{Problem, quarter_turn};

/// Values of X[k;m] and of its time derivative, physical, at the unknowns' points.
#[derive(Clone, Debug)]
pub struct Mode {
    /// The harmonic: ∂x → i · harmonic · k_x.
    pub harmonic: i32,
    pub values: Vec<C64>,
    /// Coefficient of A^m e^{ikθ} in ∂t X.
    pub rate: Vec<C64>,
    /// Unknown numbers (mean modes alone), by field after the profiles.
    pub uniform: Vec<C64>,
}

impl Mode {
    /// The mode of −k: complex conjugate.
    pub fn conjugate(&self) -> Mode {
        let conj = |list: &Vec<C64>| list.iter().map(|c| c.conj()).collect();
        Mode {
            harmonic: -self.harmonic,
            values: conj(&self.values),
            rate: conj(&self.rate),
            uniform: conj(&self.uniform),
        }
    }

    /// Jets at the points of one grid: `[point][jet]`.
    pub fn jets(&self, problem: &Problem, k: f64, jets: &[Jet], grid: GridKind) -> Vec<Vec<C64>> {
        let columns: Vec<Vec<C64>> = jets
            .iter()
            .map(|&jet| self.jet(problem, k, jet, grid))
            .collect();
        let points = columns.first().map_or(0, Vec::len);
        (0..points)
            .map(|i| columns.iter().map(|column| column[i]).collect())
            .collect()
    }

    /// One jet at the points of a grid.
    pub fn jet(&self, problem: &Problem, k: f64, jet: Jet, grid: GridKind) -> Vec<C64> {
        let field = usize::from(jet.field);
        let kx = f64::from(self.harmonic) * k;
        let mut factor = quarter_turn(usize::from(jet.x)) * kx.powi(i32::from(jet.x));
        factor *= kx.abs().powi(i32::from(jet.absx));
        let Some(block) = problem.direct.layout.columns.get(field) else {
            let profiles = problem.direct.layout.columns.len();
            let value = self
                .uniform
                .get(field - profiles)
                .copied()
                .unwrap_or_default();
            let points = crate::collocation::Grid::new(grid).len();
            return vec![value * factor; points];
        };
        factor *= problem.scale().powi(i32::from(jet.y));
        let source = if jet.t == 0 { &self.values } else { &self.rate };
        let source = &source[block.offset..block.offset + block.len];
        let matrix = problem
            .discretisation
            .matrix(block.grid, grid, usize::from(jet.y));
        let mut result = vec![C64::new(0.0, 0.0); matrix.nrows()];
        for (j, value) in source.iter().enumerate() {
            let value = value * factor;
            for (r, m) in result.iter_mut().zip(matrix.col(j).iter()) {
                *r += value * *m;
            }
        }
        result
    }
}
