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
    /// The number itself, without imaginary part and higher terms.
    fn real_part(self) -> f64;
    fn recip(self) -> Self;
    fn sqrt(self) -> Self;
    fn powi(self, exponent: i32) -> Self;
    fn powf(self, exponent: f64) -> Self;
    fn exp(self) -> Self;
    fn log(self) -> Self;
    fn sin(self) -> Self;
    fn cos(self) -> Self;
    fn tan(self) -> Self;
    fn sinh(self) -> Self;
    fn cosh(self) -> Self;
    fn tanh(self) -> Self;
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
