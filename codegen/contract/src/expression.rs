//! Expressions of the spec language that a user gives beside the model: derived columns, shaded quantities.

use crate::jet::Jet;
use crate::kernel::Kernel;
use crate::structure::Structure;

/// An expression in the full state, compiled for one model.
#[derive(Clone, Debug)]
pub struct Expression {
    /// The text that the user gave.
    pub written: String,
    /// The program: its inputs are the point state and `jets`, its one output is the value.
    pub kernel: Kernel,
    /// The jets of the full state that the program reads.
    pub jets: Vec<Jet>,
}

impl Expression {
    /// The value at a point state, with the values of the jets in the order of [`Expression::jets`].
    pub fn evaluate(&self, point: &[f64], jets: &[f64]) -> f64 {
        self.kernel.evaluate(point, jets)[0]
    }

    /// The value in the base state, whose point state is `point`.
    pub fn at_base(&self, structure: &Structure, point: &[f64]) -> f64 {
        let jets = self.jets.iter().map(|jet| structure.base_jet(*jet, point));
        self.evaluate(point, &jets.collect::<Vec<f64>>())
    }
}
