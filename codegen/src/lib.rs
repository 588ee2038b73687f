//! From balance equations to operators, at build time, symbolically and exactly.
//!
//! The pipeline, one module a stage and one type a stage:
//!
#![doc = include_str!("../STAGES.md")]
//!
//! [`generate()`] is the whole of it on a screen; [`build`] wraps it for a build script.

#![warn(missing_docs)]

pub mod build;
pub mod derive;
pub mod diagnostic;
pub mod emit;
pub mod errata;
pub mod expression;
pub mod form;
pub mod formula;
mod generate;
pub mod graph;
pub mod kernel;
pub mod model;
mod sources;
mod syntax;

/// Identity of this build: a hash of the generator's sources and the contract's, 16 hexadecimal digits.
pub const BUILD: &str = env!("LANDAU_BUILD");

pub use generate::{ORDER, generate, tape};
pub use sources::Sources;
