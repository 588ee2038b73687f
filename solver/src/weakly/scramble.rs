//! Weights on derivatives that destroy cancellation, to measure the size of a sum of products before its terms cancel.

use crate::model::{C64, Id, Jet};

/// The factor by which a jet is multiplied.
pub(super) type Weight = fn(Jet) -> C64;

/// A fixed pseudo-random factor in [1/2, 3/2) for each derivative (multiples of the golden ratio, which never repeat).
pub(super) fn scrambled(jet: Jet) -> C64 {
    C64::new(0.5 + fraction(jet), 0.0)
}

/// The factor of [`scrambled`] with a phase: products of a mode and its conjugate, such as q ∂x q̄ + q̄ ∂x q, then do not
/// cancel either.
pub(super) fn turned(jet: Jet) -> C64 {
    let fraction = fraction(jet);
    C64::from_polar(0.5 + fraction, std::f64::consts::TAU * fraction)
}

/// The fractional part of n times the golden ratio, n being a number of the derivative.
fn fraction(jet: Jet) -> f64 {
    let orders = [jet.x, jet.absx, jet.y, jet.t].map(usize::from);
    let number = orders
        .iter()
        .fold(jet.of.index(), |sum, order| 5 * sum + order);
    (0.618_033_988_75 * (number + 1) as f64).fract()
}
