//! Operators → kernels: straight-line programs with common subexpressions shared.

mod assemble;
mod lower;
mod polarise;
mod program;
mod structure;

pub use assemble::kernels;
pub use landau_contract::{Array, Kernel, ModelKernels, Operation, Register};
pub use lower::Lowering;
pub(crate) use program::jets;
