//! Methods that know no model: dense linear algebra, Newton's method, inverse iteration, roots.

pub mod dense;
mod inverse_iteration;
mod newton;
mod noise;
mod root;

pub use inverse_iteration::{Applied, Eigen, beside, inverse_iteration};
pub use newton::{Failure, Linearised, Newton, System};
pub use noise::Noise;
pub use root::brent;
