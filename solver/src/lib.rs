//! Chebyshev collocation, spectra and weakly nonlinear analysis of generated models.
//!
//! Data flows one way, one module a stage:
//!
//! [`model`] (kernels, number types) → [`base`] (base state) → [`collocation`] and [`problem`]
//! (matrices) → [`spectrum`] (modes) → [`weakly`] (amplitude expansion, Landau coefficients) →
//! [`study`] (critical points, sweeps, certificate) → [`cli`].
//!
//! ```no_run
//! # fn main() -> landau_solver::error::Result<()> {
//! # let model: Box<dyn landau_solver::Model> = unimplemented!();
//! use landau_solver::study::Setup;
//! use landau_solver::weakly::Selection;
//!
//! let setup = Setup::new(model.as_ref(), 50);
//! let base = setup.base(None)?;
//! let c2 = setup.with_point(&base, 0.16, Selection::Leading, |point| Ok(point.c2))?;
//! # let _ = c2;
//! # Ok(())
//! # }
//! ```

// X[k;m] is the mode of harmonic k and order m, not a link.
#![allow(rustdoc::broken_intra_doc_links)]

pub mod base;
pub mod cli;
pub mod collocation;
pub mod dense;
pub mod error;
pub mod model;
pub mod parameters;
pub mod problem;
pub mod spectrum;
pub mod study;
pub mod weakly;
pub use model::Model;
