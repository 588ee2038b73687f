//! The wavevector of a perturbation.

use crate::error::{Error, Result};
use crate::model::Jet;
use crate::words::brief;
use std::fmt;
use std::ops::{Add, Mul, Neg};

/// Wavevectors that differ by a smaller part of the longest are one.
const SAME: f64 = 1e-9;

/// The wavevector q of e^{i q·x}, in units of 1/length: one component for each periodic coordinate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WaveVector {
    along_x: f64,
}

impl WaveVector {
    /// That of a mean: zero.
    pub const MEAN: Self = WaveVector { along_x: 0.0 };

    /// The wavevector with a component k along x, of either sign; that of a mean where k = 0.
    pub fn along_x(k: f64) -> Self {
        WaveVector { along_x: k }
    }

    /// A wave along x, with k > 0.
    ///
    /// # Errors
    /// A k that is no positive number.
    pub fn wave(k: f64) -> Result<Self> {
        if k.is_finite() && k > 0.0 {
            return Ok(WaveVector { along_x: k });
        }
        Err(Error::input(format!(
            "k = {} is not a wavenumber: it has to be a positive number",
            brief(k)
        )))
    }

    /// A wave along x that may run the other way, with k ≠ 0.
    ///
    /// # Errors
    /// A k that is zero or no number; the message names |k|.
    pub fn either_way(k: f64) -> Result<Self> {
        let forwards = Self::wave(k.abs())?;
        Ok(if k < 0.0 { -forwards } else { forwards })
    }

    /// Its component along x.
    pub fn k(self) -> f64 {
        self.along_x
    }

    /// |q|
    pub fn length(self) -> f64 {
        self.along_x.abs()
    }

    /// Whether it is that of a mean.
    pub fn is_mean(self) -> bool {
        self == Self::MEAN
    }

    /// Whether −q is the one that stands for both: its first component that is not zero is negative.
    pub fn is_reversed(self) -> bool {
        self.along_x < 0.0
    }

    /// Whether two wavevectors differ by rounding alone, relative to `length`.
    pub fn is_same(self, neighbour: Self, length: f64) -> bool {
        (self + -neighbour).length() <= SAME * length
    }

    /// What ∂x and |∂x| of a jet make of e^{i q·x}, but for the factor i^x: k^x |k|^absx.
    pub fn size<V>(self, jet: &Jet<V>) -> f64 {
        self.along_x.powi(i32::from(jet.x)) * self.length().powi(i32::from(jet.absx))
    }
}

impl Neg for WaveVector {
    type Output = Self;

    fn neg(self) -> Self {
        WaveVector {
            along_x: -self.along_x,
        }
    }
}

impl Add for WaveVector {
    type Output = Self;

    fn add(self, summand: Self) -> Self {
        WaveVector {
            along_x: self.along_x + summand.along_x,
        }
    }
}

impl Mul<WaveVector> for f64 {
    type Output = WaveVector;

    fn mul(self, vector: WaveVector) -> WaveVector {
        WaveVector {
            along_x: self * vector.along_x,
        }
    }
}

impl std::iter::Sum for WaveVector {
    fn sum<I: Iterator<Item = Self>>(vectors: I) -> Self {
        vectors.fold(Self::MEAN, Self::add)
    }
}

impl fmt::Display for WaveVector {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.along_x.fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::{Jet, WaveVector};

    #[test]
    fn waves_are_positive_numbers() {
        for k in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(WaveVector::wave(k).is_err(), "{k}");
        }
        let back = WaveVector::either_way(-2.0).expect("a wave");
        assert!(back.is_reversed() && !back.is_mean());
        assert_eq!((back + -back, back.length()), (WaveVector::MEAN, 2.0));
        assert!(WaveVector::either_way(0.0).is_err());
    }

    /// ∂x³ |∂x| e^{ikx} = −i k³ |k| e^{ikx}
    #[test]
    fn sizes_of_jets() {
        let jet = Jet {
            x: 3,
            absx: 1,
            ..Jet::value(0_usize)
        };
        let q = WaveVector::either_way(-2.0).expect("a wave");
        assert_eq!(q.size(&jet), -16.0);
    }
}
