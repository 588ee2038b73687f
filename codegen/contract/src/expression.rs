//! An expression of the spec language that is wanted beside a model: a derived column, a shaded quantity.

use crate::jet::Jet;
use crate::kernel::Kernel;
use crate::structure::Structure;

/// An expression in the full state, compiled for one model.
#[derive(Clone, Debug)]
pub struct Expression {
    /// As it was written.
    pub written: String,
    /// Its program: inputs are the point state and the jets.
    pub kernel: Kernel,
    /// What it reads of the state.
    pub jets: Vec<Jet>,
}

impl Expression {
    /// Its value at a point, `jets` in the order of [`Expression::jets`].
    pub fn evaluate(&self, point: &[f64], jets: &[f64]) -> f64 {
        self.kernel.evaluate(point, jets)[0]
    }

    /// Its value in the base state at a point.
    pub fn at_base(&self, structure: &Structure, point: &[f64]) -> f64 {
        let jets = self.jets.iter().map(|jet| structure.base_jet(*jet, point));
        self.evaluate(point, &jets.collect::<Vec<f64>>())
    }
}
