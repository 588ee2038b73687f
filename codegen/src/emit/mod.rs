//! Kernels and operators → Rust and readable text.

pub mod difference;
mod grouped;
pub mod rust;
pub mod text;
