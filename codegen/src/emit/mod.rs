//! Kernels and operators → Rust and readable text.

mod comment;
pub mod comparison;
pub mod literal;
pub(crate) mod name;
pub mod rust;
pub mod text;
