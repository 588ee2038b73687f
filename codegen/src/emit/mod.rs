//! Kernels and operators → Rust and readable text.

pub mod comparison;
pub mod literal;
pub(crate) mod name;
pub mod rust;
pub mod text;
