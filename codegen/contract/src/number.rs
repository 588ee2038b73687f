//! The number types that residuals run on: a closed list.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// Double-precision complex numbers.
pub type C64 = num_complex::Complex64;

/// Coefficients kept by [`Series`]: degrees 0 to 3, enough for N2 and N3.
pub const SERIES_LENGTH: usize = 4;

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

/// A truncated power series Σ a_n ε^n, n < N, over the complex numbers or the reals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Truncated<T, const N: usize>(pub [T; N]);

/// Series to third degree.
pub type Series = Truncated<C64, SERIES_LENGTH>;

impl<T: Number, const N: usize> Truncated<T, N> {
    /// a + b ε
    pub fn line(value: T, slope: T) -> Self {
        let mut series = Truncated::constant(value);
        series.0[1] = slope;
        series
    }

    /// A constant.
    pub fn constant(value: T) -> Self {
        let mut terms = [T::from(0.0); N];
        terms[0] = value;
        Truncated(terms)
    }

    /// Σ_m derivatives[m]/m! (self − a_0)^m
    #[inline(never)]
    fn compose(self, derivatives: [T; N]) -> Self {
        let mut increment = self;
        increment.0[0] = T::from(0.0);
        let mut power = Truncated::constant(T::from(1.0));
        let mut result = Truncated::constant(derivatives[0]);
        let mut factorial = 1.0;
        for (m, &derivative) in derivatives.iter().enumerate().skip(1) {
            power = power * increment;
            factorial *= m as f64;
            let scaled = derivative / factorial;
            for (r, p) in result.0.iter_mut().zip(power.0) {
                *r = *r + p * scaled;
            }
        }
        result
    }

    /// f, f', f'', … at one point from a recurrence.
    fn derivatives(first: T, next: impl Fn(usize, &[T]) -> T) -> [T; N] {
        let mut values = [first; N];
        for m in 1..N {
            values[m] = next(m, &values[..m]);
        }
        values
    }

    /// f(self) from f(a_0) and the series f'(self): n b_n = Σ m a_m f'_(n−m).
    fn integrate(self, value: T, slope: Self) -> Self {
        let mut result = Truncated::constant(value);
        for n in 1..N {
            let mut total = T::from(0.0);
            for m in 1..=n {
                total = total + self.0[m] * slope.0[n - m] * m as f64;
            }
            result.0[n] = total / n as f64;
        }
        result
    }
}

impl<T: Number, const N: usize> From<f64> for Truncated<T, N> {
    fn from(value: f64) -> Self {
        Truncated::constant(T::from(value))
    }
}

impl<T: Number, const N: usize> Neg for Truncated<T, N> {
    type Output = Self;
    fn neg(self) -> Self {
        Truncated(self.0.map(|a| -a))
    }
}

impl<T: Number, const N: usize> Add for Truncated<T, N> {
    type Output = Self;
    fn add(mut self, other: Self) -> Self {
        for (a, b) in self.0.iter_mut().zip(other.0) {
            *a = *a + b;
        }
        self
    }
}

impl<T: Number, const N: usize> Sub for Truncated<T, N> {
    type Output = Self;
    fn sub(mut self, other: Self) -> Self {
        for (a, b) in self.0.iter_mut().zip(other.0) {
            *a = *a - b;
        }
        self
    }
}

impl<T: Number, const N: usize> Mul for Truncated<T, N> {
    type Output = Self;
    #[inline(never)]
    fn mul(self, other: Self) -> Self {
        let mut product = [T::from(0.0); N];
        for (i, &a) in self.0.iter().enumerate() {
            for (j, &b) in other.0.iter().enumerate().take(N - i) {
                product[i + j] = product[i + j] + a * b;
            }
        }
        Truncated(product)
    }
}

impl<T: Number, const N: usize> Div for Truncated<T, N> {
    type Output = Self;
    #[inline(never)]
    fn div(self, other: Self) -> Self {
        let mut quotient = [T::from(0.0); N];
        for n in 0..N {
            let mut rest = self.0[n];
            for (m, &known) in quotient.iter().enumerate().take(n) {
                rest = rest - known * other.0[n - m];
            }
            quotient[n] = rest / other.0[0];
        }
        Truncated(quotient)
    }
}

impl<T: Number, const N: usize> Add<f64> for Truncated<T, N> {
    type Output = Self;
    fn add(mut self, other: f64) -> Self {
        self.0[0] = self.0[0] + other;
        self
    }
}

impl<T: Number, const N: usize> Sub<f64> for Truncated<T, N> {
    type Output = Self;
    fn sub(mut self, other: f64) -> Self {
        self.0[0] = self.0[0] - other;
        self
    }
}

impl<T: Number, const N: usize> Mul<f64> for Truncated<T, N> {
    type Output = Self;
    fn mul(self, other: f64) -> Self {
        Truncated(self.0.map(|a| a * other))
    }
}

impl<T: Number, const N: usize> Div<f64> for Truncated<T, N> {
    type Output = Self;
    fn div(self, other: f64) -> Self {
        Truncated(self.0.map(|a| a / other))
    }
}

impl<T: Number, const N: usize> Number for Truncated<T, N> {
    fn real_part(self) -> f64 {
        self.0[0].real_part()
    }

    fn recip(self) -> Self {
        <Self as From<f64>>::from(1.0) / self
    }

    fn sqrt(self) -> Self {
        self.powf(0.5)
    }

    fn powi(self, exponent: i32) -> Self {
        num_powi(self, exponent)
    }

    // d/dz z^q = q z^(q−1)
    fn powf(self, exponent: f64) -> Self {
        let value = self.0[0];
        let head = if exponent == 0.5 {
            value.sqrt()
        } else {
            value.powf(exponent)
        };
        let derivatives = Self::derivatives(head, |m, known| {
            known[m - 1] * (exponent - (m as f64 - 1.0)) / value
        });
        self.compose(derivatives)
    }

    fn exp(self) -> Self {
        self.compose([self.0[0].exp(); N])
    }

    fn log(self) -> Self {
        self.integrate(self.0[0].log(), self.recip())
    }

    fn sin(self) -> Self {
        let (sine, cosine) = (self.0[0].sin(), self.0[0].cos());
        let cycle = [sine, cosine, -sine, -cosine];
        self.compose(Self::derivatives(sine, |m, _| cycle[m % 4]))
    }

    fn cos(self) -> Self {
        let (sine, cosine) = (self.0[0].sin(), self.0[0].cos());
        let cycle = [cosine, -sine, -cosine, sine];
        self.compose(Self::derivatives(cosine, |m, _| cycle[m % 4]))
    }

    fn tan(self) -> Self {
        self.sin() / self.cos()
    }

    fn sinh(self) -> Self {
        (self.exp() - (-self).exp()) * 0.5
    }

    fn cosh(self) -> Self {
        (self.exp() + (-self).exp()) * 0.5
    }

    fn tanh(self) -> Self {
        self.sinh() / self.cosh()
    }

    fn atan(self) -> Self {
        self.integrate(self.0[0].atan(), (self * self + 1.0).recip())
    }
}
