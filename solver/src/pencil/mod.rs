//! Matrix pencils L x = c M0 x with singular M0, whatever they come from: infinite eigenvalues deflated
//! exactly, spectra in order.

mod deflate;
mod scale;

pub use deflate::{Mode, Reduced};
pub use scale::Spectrum;
