//! A fixed vector without structure, to start iterations from.

use super::dense::Scalar;
use crate::model::C64;

/// n real numbers between 0.63 and 1.37: 1 + 0.37 sin(i²), i being the index from 0 on and i² in radians.
///
/// An iteration that starts from it needs a part along the vector that is sought. Squares of whole numbers are spread
/// over the circle without a period, so that the entries follow no symmetry and no smooth shape that might exclude one.
/// They stay clear of zero, so that every unknown takes part, and are the same on every run.
pub fn arbitrary<T: Scalar>(n: usize) -> Vec<T> {
    let entry = |i: usize| 1.0 + 0.37 * ((i * i) as f64).sin();
    (0..n)
        .map(|i| T::from_complex(C64::new(entry(i), 0.0)))
        .collect()
}
