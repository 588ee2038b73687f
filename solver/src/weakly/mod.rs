//! Weakly nonlinear analysis: the amplitude expansion order by order, Landau coefficients.

mod expansion;
mod landau;
mod mode;
mod normalisation;
mod pattern;

pub use expansion::{Expansion, Key};
pub use landau::{LandauPoint, Selection, from_pair, outputs, point, select, value_at, warm_point};
pub use mode::Mode;
pub use normalisation::{normalise, quadrature_grid, quadrature_weights};
pub use pattern::{Pattern, Window, pattern};
