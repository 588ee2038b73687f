//! Truncated polynomials in amplitudes (z_1, z̄_1, …) over all points of a grid at once: the numbers on which
//! the unexpanded residual is run to find what any mode of any order is forced by.
//!
//! [`Monomials`] says which coefficients there are and which products make them, [`Program`] is a residual
//! prepared for such numbers, [`Levels`] holds and makes the coefficients, one degree after another.

mod levels;
mod monomial;
mod program;

pub use levels::Levels;
pub use monomial::{Monomial, Monomials};
pub use program::{Arithmetic, Program};
