//! What generated models and the solver agree on: structure, jets, kernels as data with their interpreter, number
//! types, and the trait that emitted code and a model run from its tape both implement.
//!
//! Nothing here knows where kernels come from, or what is done with them.

#![warn(missing_docs)]

mod expression;
mod greek;
mod ids;
mod jet;
mod kernel;
pub mod layout;
mod model;
mod nearest;
mod number;
mod rounding;
mod state;
mod structure;
mod tape;

pub use expression::Expression;
pub use greek::{greek, names_a_letter, small_greek};
pub use ids::{BalanceId, BaseRowId, CaseId, FieldId, Id, LawId, ParameterId, SolvedId, Table};
pub use jet::{End, Function, Jet, Operator, jet};
pub use kernel::{
    Array, Kernel, ModelKernels, Operation, RESIDUAL_INPUTS, Register, apply, choose,
};
pub use layout::{Linearised, Measure, output_length};
pub use model::{Model, evaluate};
pub use nearest::nearest;
pub use number::{C64, Number};
pub use rounding::WithRounding;
pub use state::{PointState, StateLayout};
pub use structure::*;
pub use tape::TapeModel;
