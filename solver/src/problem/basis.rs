//! The two bases: physical values, and the solver's basis, in which fields and rows that are odd in the mirror x → −x are
//! divided by i.
//!
//! In a mirror-symmetric model every matrix is real in the solver's basis. A term with an odd number of ∂x connects an
//! odd field with an even row, or an even field with an odd row. ∂x gives a factor i k, and the division takes the i away:
//! with an odd field i q', i k · i q' = −k q' is real, and so is i k q / i = k q in an odd row.

use crate::model::C64;
use crate::numerics::dense::Scalar;
use std::ops::{Add, Deref, DerefMut, Neg, Sub};

/// Values of all unknowns, or of all equations, in the solver's basis: odd ones are divided by i.
#[derive(Clone, Debug, PartialEq)]
pub struct Turned<T = C64>(pub Vec<T>);

/// Physical values of all unknowns, by the layout of the direct problem.
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
    /// A profile of `size` zeros.
    pub fn zero(size: usize) -> Self {
        Profile(vec![C64::new(0.0, 0.0); size])
    }

    /// The complex conjugate.
    pub fn conjugate(&self) -> Self {
        Profile(self.iter().map(|v| v.conj()).collect())
    }

    /// The product with a number.
    pub fn times(&self, factor: C64) -> Self {
        Profile(self.iter().map(|v| v * factor).collect())
    }

    /// Adds `factor` times a profile.
    pub fn add(&mut self, factor: C64, profile: &Profile) {
        let pairs = self.0.iter_mut().zip(&profile.0);
        pairs.for_each(|(sum, value)| *sum += factor * value);
    }

    /// The largest modulus of a value.
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

    /// i where `odd`, in the mirror x → −x, and 1 where even.
    pub fn of(odd: bool) -> Self {
        Turn(u8::from(odd))
    }

    /// Whether it is i or −i.
    pub fn is_odd(self) -> bool {
        self.0 % 2 == 1
    }

    /// The power of i as a number.
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

    fn add(self, turn: Turn) -> Turn {
        Turn::new(self.0 + turn.0)
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

    fn sub(self, turn: Turn) -> Turn {
        self + -turn
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
