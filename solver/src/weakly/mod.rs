//! Weakly nonlinear analysis: the amplitude expansion order by order, Landau coefficients.

mod bifurcation;
mod expansion;
mod landau;
mod mode;
mod normalisation;
mod pattern;

pub use bifurcation::{Bifurcation, Side, equilibrium};
pub use expansion::{Expansion, Key, Multiplier};
pub use landau::{LandauPoint, Selection, from_pair, outputs, point, select, value_at, warm_point};
pub use mode::Mode;
pub use normalisation::{normalise, quadrature_grid, quadrature_weights};
pub use pattern::{Pattern, Window, pattern};
