//! A model as the solver sees it: a structure and kernels.
//!
//! Generated code and a model run from its tape implement the same object-safe trait; nothing below
//! this module knows where the kernels come from, or which model they belong to.

use crate::ids::{BalanceId, CaseId};
use crate::kernel::Kernel;
use crate::layout::output_length;
use crate::number::C64;
use crate::structure::{KernelId, ResidualId, Structure};

/// The interface between a model and the solver.
///
/// Real kernels read the point state described at [`KernelId`]; coefficient units are the model's.
pub trait Model: Send + Sync {
    /// Fields, parameters, operator layouts.
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

    /// Runs a real kernel at one point. `out` must hold [`output_length`] values.
    fn evaluate(&self, kernel: KernelId, point: &[f64], out: &mut [f64]);

    /// N_degree of one balance as a symmetric multilinear form: `c` are the outputs of
    /// [`KernelId::Nonlinear`], `x` one slice of [`Structure::form_jets`] an argument.
    fn form(&self, degree: usize, row: BalanceId, c: &[f64], x: &[&[C64]]) -> C64;

    /// The unexpanded residual M ∂t X − R (not divided), or left − right of the conditions, as a program for
    /// numbers of any kind: its inputs are the point state and the jets of [`Structure::residual_jets`], its outputs
    /// one value a balance or condition. Nothing where there are no conditions.
    fn residual(&self, residual: ResidualId) -> Option<&Kernel>;

    /// Integrals that the balances of a case keep and the spec does not declare, as a spec would name them.
    fn undeclared(&self, _case: CaseId) -> Vec<String> {
        Vec::new()
    }
}

/// Runs a real kernel at one point into a new vector.
pub fn evaluate(model: &dyn Model, kernel: KernelId, point: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; output_length(model.structure(), kernel)];
    model.evaluate(kernel, point, &mut out);
    out
}
