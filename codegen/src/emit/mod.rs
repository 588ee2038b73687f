//! Kernels and operators → Rust and readable text.

pub mod difference;
pub mod literal;
pub mod rust;
pub mod text;
