//! Chebyshev collocation, spectra and weakly nonlinear analysis of generated models.
//!
//! Data flows one way, one module a stage:
//!
//! [`model`] (the contract: kernels, number types) → [`base`] (base state) → [`space`] and [`problem`] (collocation:
//! matrices, as [`pencil`]s) → [`spectrum`] (modes) → [`weakly`] (amplitude expansion, Landau coefficients) →
//! [`study`] (points, critical points, sweeps, certificate); [`numerics`] serves all of them. Numerics alone: figures,
//! reports and the command line stand above, in crates of their own. Results own their data. Points run in parallel
//! on the rayon pool that the caller is in; a matrix belongs to one thread.
//!
//! ```
//! use landau_solver::model::C64;
//! use landau_solver::study::Setup;
//! use landau_solver::weakly::Selection;
//! use landau_solver::{Model, error::Result};
//! use std::sync::Arc;
//!
//! /// c2 of the leading mode at one wavenumber, with M = 50.
//! fn first_landau_coefficient(model: Arc<dyn Model>, k: f64) -> Result<C64> {
//!     let setup = Setup::new(model, 50)?;
//!     let base = setup.base(None)?;
//!     Ok(setup.point(&base, k, Selection::Leading)?.c2)
//! }
//! ```

// X[k;m] is the mode of harmonic k and order m, not a link.
#![allow(rustdoc::broken_intra_doc_links)]
#![warn(missing_docs)]

pub mod base;

pub mod error;
pub mod file;
pub mod measured;
pub mod numerics;
pub mod parameters;
pub mod pencil;
pub mod problem;
pub mod series;
pub mod space;
pub mod spectrum;
pub mod study;
pub mod wavevector;
pub mod weakly;
pub mod words;
pub use landau_contract as model;

/// Identity of this build: a hash of the solver's sources, the contract's and the versions of dependencies, 16
/// hexadecimal digits.
pub const BUILD: &str = env!("LANDAU_BUILD");

pub use model::Model;
