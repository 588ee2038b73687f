//! The numbers that kernels run on.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// Double-precision complex numbers.
pub type C64 = num_complex::Complex64;

/// A commutative algebra over the reals with elementary functions.
pub trait Number:
    Copy
    + From<f64>
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
{
    /// The real part of the term of degree 0: what comparisons and choices look at.
    fn real_part(self) -> f64;
    /// 1/a
    fn recip(self) -> Self;
    /// √a, the principal branch.
    fn sqrt(self) -> Self;
    /// a^exponent by repeated squaring.
    fn powi(self, exponent: i32) -> Self;
    /// a^exponent for a real exponent.
    fn powf(self, exponent: f64) -> Self;
    /// e^a
    fn exp(self) -> Self;
    /// Natural logarithm.
    fn log(self) -> Self;
    /// Sine.
    fn sin(self) -> Self;
    /// Cosine.
    fn cos(self) -> Self;
    /// Tangent.
    fn tan(self) -> Self;
    /// Hyperbolic sine.
    fn sinh(self) -> Self;
    /// Hyperbolic cosine.
    fn cosh(self) -> Self;
    /// Hyperbolic tangent.
    fn tanh(self) -> Self;
    /// Inverse tangent.
    fn atan(self) -> Self;
}

macro_rules! scalar_number {
    ($type:ty, |$number:ident| $real:expr) => {
        impl Number for $type {
            fn real_part(self) -> f64 {
                let $number = self;
                $real
            }
            fn recip(self) -> Self {
                <$type>::from(1.0) / self
            }
            fn powi(self, exponent: i32) -> Self {
                num_powi(self, exponent)
            }
            fn powf(self, exponent: f64) -> Self {
                <$type>::powf(self, exponent)
            }
            fn log(self) -> Self {
                self.ln()
            }
            scalar_number!(@same $type: sqrt exp sin cos tan sinh cosh tanh atan);
        }
    };
    (@same $type:ty: $($function:ident)*) => {
        $(fn $function(self) -> Self {
            <$type>::$function(self)
        })*
    };
}

scalar_number!(f64, |x| x);
scalar_number!(C64, |x| x.re);

/// Powers by repeated squaring: the same operations for every number type.
fn num_powi<T: Number>(base: T, exponent: i32) -> T {
    let (mut power, mut square, mut left) = (T::from(1.0), base, exponent.unsigned_abs());
    while left > 0 {
        if left & 1 == 1 {
            power = power * square;
        }
        square = square * square;
        left >>= 1;
    }
    if exponent < 0 { power.recip() } else { power }
}
