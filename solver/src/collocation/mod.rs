//! Chebyshev collocation: grids, differentiation between grids, quadrature.

mod chebyshev;
mod layout;
mod stretch;

pub use chebyshev::{Grid, GridKind, Series, clenshaw_curtis, coefficients};
pub use layout::{Block, Discretisation, Layout};
pub use stretch::Stretch;
