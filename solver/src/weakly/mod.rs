//! Weakly nonlinear analysis: Landau coefficients, amplitude expansions of any modes to any order.

mod amplitude;
mod bifurcation;
mod cubic;
mod distance;
mod envelope;
mod equilibria;
mod expansion;
mod forcing;
mod integrals;
mod mode;
mod normalisation;
mod outputs;
mod pattern;
mod response;
mod scramble;
mod standing;
mod system;
mod waves;

pub use amplitude::AmplitudeEquation;
pub use bifurcation::{Bifurcation, Side, equilibrium};
pub use cubic::{CANCELLED_SUM, LandauPoint, Selection, from_pair, point, select, warm_point};
pub use distance::Distance;
pub use envelope::{Envelope, benjamin_feir};
pub use equilibria::{Equilibrium, equilibria};
pub use expansion::{CriticalMode, Expansion};
pub use mode::Mode;
pub use normalisation::normalise;
pub use outputs::outputs;
pub use pattern::{Pattern, PlaneField, Window, pattern};
pub use response::{LEFT_OVER, Multiplier, arithmetic, multiplier_error};
pub use system::{AmplitudeSystem, Term, power};
pub use waves::{Stable, Waves};
