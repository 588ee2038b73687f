//! A model as the solver sees it: a structure and kernels.
//!
//! Generated code and a model run from its tape implement the same object-safe trait, so that the solver does not know
//! where the kernels come from.

use crate::ids::{BalanceId, CaseId};
use crate::kernel::Kernel;
use crate::layout::output_length;
use crate::number::C64;
use crate::structure::{KernelId, ResidualId, Structure};

/// The interface between a model and the solver.
///
/// Real kernels read the point state of [`crate::StateLayout`]. Coefficients have the units of the spec.
pub trait Model: Send + Sync {
    /// Everything about the model that is not a kernel.
    fn structure(&self) -> &Structure;

    /// Path and text of the spec and of each law file it uses, the spec first.
    fn sources(&self) -> Vec<(String, String)>;

    /// Path and text of every law file that the model could have imported, used or not.
    fn laws(&self) -> Vec<(String, String)>;

    /// Identity of the build of the generator that made the kernels. Two builds that may emit different operations have
    /// different identities. Empty if the kernels were written by hand.
    fn generator(&self) -> &str {
        ""
    }

    /// Runs a real kernel at one point. `point` has the layout of [`Structure::state`], `out` must hold [`output_length`]
    /// values.
    ///
    /// # Panics
    /// If the model has no such kernel: a case that it does not have.
    fn evaluate(&self, kernel: KernelId, point: &[f64], out: &mut [f64]);

    /// N_degree of one balance as a symmetric multilinear form. `c` are the outputs of [`KernelId::Nonlinear`]; `x` has one
    /// slice for each of the `degree` arguments, the values of [`Structure::form_jets`]. Zero for a balance without terms
    /// of that degree.
    ///
    /// # Panics
    /// If the degree is not in 2..=[`Structure::order`].
    fn form(&self, degree: usize, row: BalanceId, c: &[f64], x: &[&[C64]]) -> C64;

    /// The unexpanded residual M ∂t X − R (not divided), or left − right of the conditions, as a program for any
    /// [`crate::Number`]. Its inputs are the point state and the values of [`Structure::residual_jets`]; it has one output
    /// for each balance or condition. `None` if there are no conditions.
    fn residual(&self, residual: ResidualId) -> Option<&Kernel>;

    /// Integrals that the balances of a case keep and the spec does not declare, each as the text that would declare it.
    fn undeclared(&self, _case: CaseId) -> Vec<String> {
        Vec::new()
    }
}

/// The outputs of a real kernel at one point, [`output_length`] of them.
///
/// # Panics
/// If the model has no such kernel.
pub fn evaluate(model: &dyn Model, kernel: KernelId, point: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; output_length(model.structure(), kernel)];
    model.evaluate(kernel, point, &mut out);
    out
}
