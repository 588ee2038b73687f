//! The two bases: physical values, and those in which every matrix of a mirror-symmetric model is real.

use crate::model::C64;
use crate::numerics::dense::Scalar;
use std::ops::{Add, Deref, DerefMut, Neg, Sub};

/// Values of unknowns or equations in the solver's basis: odd ones divided by i.
#[derive(Clone, Debug, PartialEq)]
pub struct Turned<T = C64>(pub Vec<T>);

/// Physical values at the unknowns' points.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile(pub Vec<C64>);

impl<T> Deref for Turned<T> {
    type Target = Vec<T>;

    fn deref(&self) -> &Vec<T> {
        &self.0
    }
}

impl<T> DerefMut for Turned<T> {
    fn deref_mut(&mut self) -> &mut Vec<T> {
        &mut self.0
    }
}

impl Deref for Profile {
    type Target = Vec<C64>;

    fn deref(&self) -> &Vec<C64> {
        &self.0
    }
}

impl DerefMut for Profile {
    fn deref_mut(&mut self) -> &mut Vec<C64> {
        &mut self.0
    }
}

impl Profile {
    /// Zeros.
    pub fn zero(size: usize) -> Self {
        Profile(vec![C64::new(0.0, 0.0); size])
    }

    /// The complex conjugate.
    pub fn conjugate(&self) -> Self {
        Profile(self.iter().map(|v| v.conj()).collect())
    }

    /// Multiplied by a number.
    pub fn times(&self, factor: C64) -> Self {
        Profile(self.iter().map(|v| v * factor).collect())
    }

    /// Adds a multiple of another.
    pub fn add(&mut self, factor: C64, other: &Profile) {
        let pairs = self.0.iter_mut().zip(&other.0);
        pairs.for_each(|(own, other)| *own += factor * other);
    }

    /// The largest modulus.
    pub fn largest(&self) -> f64 {
        self.iter().map(|v| v.norm()).fold(0.0, f64::max)
    }
}

impl<T: Scalar> Turned<T> {
    /// As complex numbers.
    pub fn complex(&self) -> Turned {
        Turned(self.iter().map(|v| v.complex()).collect())
    }
}

/// A power of i, modulo 4.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Turn(u8);

impl Turn {
    /// i^count
    pub fn new(count: u8) -> Self {
        Turn(count % 4)
    }

    /// i for what is odd in the mirror, 1 for what is even.
    pub fn of(odd: bool) -> Self {
        Turn(u8::from(odd))
    }

    /// Whether it is i or −i.
    pub fn is_odd(self) -> bool {
        self.0 % 2 == 1
    }

    /// The number.
    pub fn factor(self) -> C64 {
        match self.0 {
            0 => C64::new(1.0, 0.0),
            1 => C64::new(0.0, 1.0),
            2 => C64::new(-1.0, 0.0),
            _ => C64::new(0.0, -1.0),
        }
    }
}

impl Add for Turn {
    type Output = Turn;

    fn add(self, other: Turn) -> Turn {
        Turn::new(self.0 + other.0)
    }
}

impl Neg for Turn {
    type Output = Turn;

    fn neg(self) -> Turn {
        Turn::new(4 - self.0)
    }
}

impl Sub for Turn {
    type Output = Turn;

    fn sub(self, other: Turn) -> Turn {
        self + -other
    }
}

#[cfg(test)]
mod tests {
    use super::Turn;

    #[test]
    fn turns_multiply() {
        for a in 0..8 {
            for b in 0..8 {
                let (a, b) = (Turn::new(a), Turn::new(b));
                assert_eq!((a + b).factor(), a.factor() * b.factor());
                assert_eq!((a - b).factor(), a.factor() * b.factor().conj());
            }
        }
    }
}
