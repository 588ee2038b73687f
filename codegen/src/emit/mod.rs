//! Kernels and operators → Rust and readable text.

pub mod rust;
pub mod text;
