//! Running error analysis: a number with a bound of its rounding error.

use crate::number::Number;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A real number with a bound of its rounding error, to first order in the machine's precision ε.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WithRounding {
    /// The computed number.
    pub value: f64,
    /// Bound of |error|/ε.
    pub size: f64,
}

impl WithRounding {
    /// f(self), by value and slope of f.
    fn map(self, value: f64, slope: f64) -> Self {
        let size = slope.abs() * self.size + value.abs();
        WithRounding { value, size }
    }
}

impl From<f64> for WithRounding {
    fn from(value: f64) -> Self {
        let size = value.abs();
        WithRounding { value, size }
    }
}

impl Neg for WithRounding {
    type Output = Self;
    fn neg(self) -> Self {
        WithRounding {
            value: -self.value,
            ..self
        }
    }
}

impl Add for WithRounding {
    type Output = Self;
    fn add(self, right: Self) -> Self {
        WithRounding {
            value: self.value + right.value,
            size: self.size + right.size,
        }
    }
}

impl Sub for WithRounding {
    type Output = Self;
    fn sub(self, right: Self) -> Self {
        self + -right
    }
}

impl Mul for WithRounding {
    type Output = Self;
    fn mul(self, right: Self) -> Self {
        WithRounding {
            value: self.value * right.value,
            size: self.size * right.value.abs() + self.value.abs() * right.size,
        }
    }
}

impl Div for WithRounding {
    type Output = Self;
    fn div(self, right: Self) -> Self {
        let value = self.value / right.value;
        WithRounding {
            value,
            size: (self.size + value.abs() * right.size) / right.value.abs(),
        }
    }
}

macro_rules! with_real {
    ($($trait:ident $method:ident)*) => {
        $(impl $trait<f64> for WithRounding {
            type Output = Self;
            fn $method(self, right: f64) -> Self {
                $trait::$method(self, WithRounding::from(right))
            }
        })*
    };
}

with_real!(Add add Sub sub Mul mul Div div);

impl Number for WithRounding {
    fn real_part(self) -> f64 {
        self.value
    }

    fn recip(self) -> Self {
        WithRounding::from(1.0) / self
    }

    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.map(root, 0.5 / root)
    }

    fn powi(self, exponent: i32) -> Self {
        let slope = f64::from(exponent) * self.value.powi(exponent - 1);
        self.map(self.value.powi(exponent), slope)
    }

    fn powf(self, exponent: f64) -> Self {
        let slope = exponent * self.value.powf(exponent - 1.0);
        self.map(self.value.powf(exponent), slope)
    }

    fn exp(self) -> Self {
        self.map(self.value.exp(), self.value.exp())
    }

    fn log(self) -> Self {
        self.map(self.value.ln(), self.value.recip())
    }

    fn sin(self) -> Self {
        self.map(self.value.sin(), self.value.cos())
    }

    fn cos(self) -> Self {
        self.map(self.value.cos(), self.value.sin())
    }

    fn tan(self) -> Self {
        self.map(self.value.tan(), 1.0 + self.value.tan().powi(2))
    }

    fn sinh(self) -> Self {
        self.map(self.value.sinh(), self.value.cosh())
    }

    fn cosh(self) -> Self {
        self.map(self.value.cosh(), self.value.sinh())
    }

    fn tanh(self) -> Self {
        self.map(self.value.tanh(), 1.0 - self.value.tanh().powi(2))
    }

    fn atan(self) -> Self {
        self.map(self.value.atan(), (1.0 + self.value.powi(2)).recip())
    }
}

#[cfg(test)]
mod tests {
    use super::{Number, WithRounding};

    /// 1/3 + 1e10 − 1e10 is off by what the size says.
    #[test]
    fn cancellation_is_seen() {
        let third = WithRounding::from(1.0) / 3.0;
        let sum = third + 1e10 - 1e10;
        let error = (sum.value - 1.0 / 3.0).abs();
        assert!(error > 1e-9 && error <= f64::EPSILON * sum.size);
        assert!(f64::EPSILON * sum.size < 1e-5);
    }

    #[test]
    fn slopes_of_functions() {
        let x = 0.7_f64;
        let image = WithRounding {
            value: x,
            size: 1e3,
        }
        .tanh();
        let expected = 1e3 / x.cosh().powi(2) + x.tanh();
        assert!((image.size - expected).abs() < 1e-10);
    }
}
