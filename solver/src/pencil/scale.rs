//! A spectrum in order, and the scale of its slow part.

use crate::model::C64;
use std::cmp::Ordering;

/// Eigenvalues of smallest modulus that set the scale.
const SLOW: usize = 10;

/// Finite eigenvalues by decreasing real part.
#[derive(Clone, Debug, Default)]
pub struct Spectrum {
    /// In units of 1/time of the model.
    pub values: Vec<C64>,
}

/// The order of a spectrum.
pub(super) fn decreasing(a: &C64, b: &C64) -> Ordering {
    b.re.total_cmp(&a.re).then(b.im.total_cmp(&a.im))
}

impl Spectrum {
    /// Sorts eigenvalues; what is not finite is left out.
    pub fn new(mut values: Vec<C64>) -> Self {
        values.retain(|c| c.re.is_finite() && c.im.is_finite());
        values.sort_by(decreasing);
        Spectrum { values }
    }

    /// The unit of time of its slow part: the median modulus of the smallest eigenvalues, or the largest of
    /// all where that is zero.
    pub fn scale(&self) -> f64 {
        let mut sizes: Vec<f64> = self.values.iter().map(|c| c.norm()).collect();
        sizes.sort_by(f64::total_cmp);
        let slow = &sizes[..sizes.len().min(SLOW)];
        match slow.get(slow.len() / 2) {
            Some(&median) if median > 0.0 => median,
            _ => sizes.last().copied().unwrap_or(0.0),
        }
    }

    /// The distance to the member nearest to `target`; infinite for an empty spectrum.
    pub fn distance(&self, target: C64) -> f64 {
        let distances = self.values.iter().map(|c| (c - target).norm());
        distances.fold(f64::INFINITY, f64::min)
    }

    /// The distance of one member to the next nearest; infinite for a single one.
    pub fn gap(&self, member: C64) -> f64 {
        let mut distances: Vec<f64> = self.values.iter().map(|c| (c - member).norm()).collect();
        distances.sort_by(f64::total_cmp);
        distances.get(1).copied().unwrap_or(f64::INFINITY)
    }
}

#[cfg(test)]
mod tests {
    use super::{C64, Spectrum};

    #[test]
    fn order_scale_and_gap() {
        let values = [-3.0, 1.0, -1.0, f64::INFINITY].map(|c| C64::new(c, 0.0));
        let spectrum = Spectrum::new(values.to_vec());
        let sorted: Vec<f64> = spectrum.values.iter().map(|c| c.re).collect();
        assert_eq!(sorted, [1.0, -1.0, -3.0]);
        assert_eq!(spectrum.scale(), 1.0);
        assert_eq!(spectrum.gap(C64::new(1.0, 0.0)), 2.0);
        assert_eq!(spectrum.distance(C64::new(-2.5, 0.0)), 0.5);
    }
}
