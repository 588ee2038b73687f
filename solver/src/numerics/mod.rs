//! Methods that know no model: dense linear algebra, Newton's method, inverse iteration, roots.

mod arbitrary;
pub mod dense;
mod inverse_iteration;
mod newton;
mod noise;
mod root;

pub use arbitrary::arbitrary;
pub use inverse_iteration::{Applied, Eigen, beside, inverse_iteration};
pub use newton::{Failure, Linearised, Newton, System};
pub use noise::Noise;
pub use root::brent;
