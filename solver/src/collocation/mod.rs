//! Chebyshev collocation: grids, differentiation between grids, quadrature.

mod chebyshev;
mod layout;
mod stretch;

pub use chebyshev::{Grid, GridKind, clenshaw_curtis, coefficients, derivative_values};
pub use layout::{Block, Discretisation, Layout};
pub use stretch::Stretch;
