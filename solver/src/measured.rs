//! A number with its absolute error: what can be said of it, and how it is printed.

use crate::model::C64;
use std::fmt;
use std::ops::{Add, Mul, Neg, Sub};

/// Decimals that are printed at most.
const MOST_DECIMALS: i32 = 10;
/// Sizes that are printed without an exponent.
const PLAIN: std::ops::Range<f64> = 1e-3..1e7;

/// A real or complex number and its absolute error, in the same unit. An error of a complex number bounds the modulus
/// of the difference. An infinite error says that nothing is known.
///
/// It displays as `1707.76178 ± 2e-5`: no digit stands beyond the first digit of the error, and the error is rounded up.
/// An exact zero is `0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured<T = f64> {
    /// The number.
    pub value: T,
    /// Its absolute error.
    pub error: f64,
}

/// A quantity that may have no answer: its value with the error, or the reason in words.
pub type Decided<T = f64> = std::result::Result<Measured<T>, String>;

impl<T> Measured<T> {
    /// A number with its absolute error; an error that is no number is infinite.
    pub fn new(value: T, error: f64) -> Self {
        let error = if error.is_nan() { f64::INFINITY } else { error };
        Measured { value, error }
    }

    /// The same value with an error that is no smaller than `error`.
    pub fn widened(self, error: f64) -> Self {
        let error = self.error.max(error);
        Measured::new(self.value, error)
    }
}

impl Measured<f64> {
    /// 1 or −1, or nothing where the error leaves the sign undecided.
    pub fn sign(self) -> Option<f64> {
        (self.value.abs() > self.error).then(|| self.value.signum())
    }

    /// Whether it is positive for certain.
    pub fn is_positive(self) -> bool {
        self.sign() == Some(1.0)
    }

    /// Whether it is negative for certain.
    pub fn is_negative(self) -> bool {
        self.sign() == Some(-1.0)
    }

    /// The quotient; nothing where the divisor is zero within its error.
    pub fn over(self, divisor: Self) -> Option<Self> {
        let least = divisor.value.abs() - divisor.error;
        // |a/b − (a + δa)/(b + δb)| ≤ (|δa| + |a/b| |δb|)/(|b| − |δb|)
        let value = self.value / divisor.value;
        (least > 0.0).then(|| {
            let error = (self.error + value.abs() * divisor.error) / least;
            Measured::new(value, error)
        })
    }

    /// The square root; nothing where the number is not positive for certain.
    pub fn sqrt(self) -> Option<Self> {
        // |√x − √(x + δ)| ≤ |δ|/√x
        let root = self.value.sqrt();
        self.is_positive()
            .then(|| Measured::new(root, self.error / root))
    }

    /// The digits that the error leaves, at most `decimals` of them after the point or the leading digit, without the
    /// error.
    pub fn digits(self, decimals: i32) -> String {
        let (place, _) = place(&[self.value], self.error, decimals);
        digits(self.value, self.error, place, decimals)
    }
}

impl Measured<f64> {
    /// The same digits in exponential form.
    pub fn scientific(self, decimals: i32) -> String {
        let (place, _) = place(&[self.value], self.error, decimals);
        if self.value.abs() <= self.error {
            return "0".to_owned();
        }
        exponential(self.value, place, decimals)
    }
}

impl Measured<C64> {
    /// The real part; its error is that of the number.
    pub fn re(self) -> Measured {
        Measured::new(self.value.re, self.error)
    }

    /// The imaginary part; its error is that of the number.
    pub fn im(self) -> Measured {
        Measured::new(self.value.im, self.error)
    }
}

impl Neg for Measured<f64> {
    type Output = Self;

    fn neg(self) -> Self {
        Measured::new(0.0 - self.value, self.error)
    }
}

impl Add for Measured<f64> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Measured::new(self.value + other.value, self.error + other.error)
    }
}

impl Sub for Measured<f64> {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Measured<f64> {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let error = self.value.abs() * other.error + (other.value.abs() + other.error) * self.error;
        Measured::new(self.value * other.value, error)
    }
}

impl Mul<f64> for Measured<f64> {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        Measured::new(self.value * factor, self.error * factor.abs())
    }
}

impl fmt::Display for Measured<f64> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (place, error) = place(&[self.value], self.error, MOST_DECIMALS);
        let value = digits(self.value, self.error, place, MOST_DECIMALS);
        if self.error == 0.0 && self.value == 0.0 {
            return f.write_str("0");
        }
        write!(f, "{value} ± {}", error_bar(error))
    }
}

impl fmt::Display for Measured<C64> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let C64 { re, im } = self.value;
        if im == 0.0 {
            return self.re().fmt(f);
        }
        let (place, bar) = place(&[re, im], self.error, MOST_DECIMALS);
        // Of a number of modulus zero within its error one zero is enough.
        let [real, imaginary] = [re, im.abs()].map(|x| digits(x, self.error, place, MOST_DECIMALS));
        if imaginary == "0" {
            return write!(f, "{real} ± {}", error_bar(bar));
        }
        let sign = if im < 0.0 { '-' } else { '+' };
        write!(f, "{real} {sign} {imaginary} i ± {}", error_bar(bar))
    }
}

/// The power of ten of the last digit to print of some numbers, and the error as it is printed: one digit, rounded up.
/// The printed error includes what the printed digits leave out.
fn place(values: &[f64], error: f64, decimals: i32) -> (i32, f64) {
    if !(error.is_finite() && error > 0.0) {
        return (i32::MIN, error);
    }
    let size = values.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let last = last_place(size, decimals);
    let cut = |place: i32| {
        let cut = |x: &f64| shown(*x, place.max(last), error) - x;
        values.iter().map(cut).fold(0.0, f64::hypot)
    };
    let mut place = exponent(error);
    loop {
        let unit = 10_f64.powi(place);
        let rounded = ((error + cut(place)) / unit - 1e-9).ceil().max(1.0);
        if rounded < 10.0 {
            return (place, rounded * unit);
        }
        place += 1;
    }
}

/// What is shown of a number: zero where it is zero within its error, else its digits to a place.
fn shown(value: f64, place: i32, error: f64) -> f64 {
    let unit = 10_f64.powi(place);
    if value.abs() <= error {
        0.0
    } else {
        (value / unit).round() * unit
    }
}

/// The place of the last digit of a number of some size that is printed with so many decimals.
fn last_place(size: f64, decimals: i32) -> i32 {
    if PLAIN.contains(&size) {
        -decimals
    } else {
        exponent(size).saturating_sub(decimals)
    }
}

/// ⌊log₁₀ x⌋
fn exponent(x: f64) -> i32 {
    x.abs().log10().floor() as i32
}

/// A number with its digits to a place, in plain or exponential form; `0` where it is zero within its error.
fn digits(value: f64, error: f64, place: i32, decimals: i32) -> String {
    let size = value.abs();
    if size <= error {
        return "0".to_owned();
    }
    if PLAIN.contains(&size) && place <= 0 {
        let decimals = place.saturating_neg().min(decimals) as usize;
        return format!("{value:.decimals$}");
    }
    exponential(value, place, decimals)
}

/// A number with its digits to a place in exponential form.
fn exponential(value: f64, place: i32, decimals: i32) -> String {
    if !value.is_finite() {
        return value.to_string();
    }
    // Rounding may bring it to the next power of ten.
    let unit = 10_f64.powi(place.max(exponent(value).saturating_sub(decimals)));
    let rounded = (value / unit).round() * unit;
    let last = exponent(rounded).saturating_sub(place);
    let decimals = last.clamp(0, decimals) as usize;
    format!("{rounded:.decimals$e}")
}

fn error_bar(error: f64) -> String {
    if error == 0.0 {
        "0".to_owned()
    } else if error.is_finite() {
        format!("{error:.0e}")
    } else {
        "∞".to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::{C64, Measured};

    fn shown(value: f64, error: f64) -> String {
        Measured::new(value, error).to_string()
    }

    #[test]
    fn no_digit_beyond_the_error() {
        assert_eq!(shown(1_707.761_777_1, 1.9e-5), "1707.76178 ± 3e-5");
        assert_eq!(shown(5775.4, 2.4), "5775 ± 3e0");
        assert_eq!(shown(-3_224.672_822, 167.0), "-3.2e3 ± 2e2");
        assert_eq!(shown(0.25, 9.6e-3), "0.25 ± 1e-2");
        assert_eq!(shown(1e-17, 5e-16), "0 ± 6e-16");
        assert_eq!(shown(5.396e-5, 1e-9), "5.3960e-5 ± 1e-9");
        assert_eq!(shown(0.0, 0.0), "0");
        assert_eq!(shown(0.5, 1e-15), "0.5000000000 ± 1e-15");
        assert_eq!(shown(2.0, f64::NAN), "0 ± ∞");
        let wave = Measured::new(C64::new(0.003_739_7, -0.237_526_54), 2e-8);
        assert_eq!(wave.to_string(), "0.00373970 - 0.23752654 i ± 2e-8");
        let steady = Measured::new(C64::new(-3.0, 1e-13), 3e-12);
        assert_eq!(steady.to_string(), "-3.0000000000 ± 4e-12");
        let neutral = Measured::new(C64::new(1e-13, 2.5), 3e-12);
        assert_eq!(neutral.to_string(), "0 + 2.5000000000 i ± 4e-12");
        assert_eq!(shown(-8e-13, 5e-12), "0 ± 6e-12");
        assert_eq!(shown(9.7e-5, 6e-6), "9.7e-5 ± 6e-6");
    }

    /// Every value that the error admits lies within the printed error of the printed number, and the printed error is no
    /// larger than the digits need.
    #[test]
    fn the_printed_bar_holds() {
        for i in 0..2000 {
            let value = 10_f64.powf(-6.0 + 0.007 * f64::from(i)) * 1.37;
            let error = value * 10_f64.powf(-14.0 * f64::from(i * 7919 % 2000) / 2000.0);
            let text = shown(value, error);
            let (digits, bar) = text.split_once(" ± ").expect("a bar");
            let [digits, bar] = [digits, bar].map(|t| t.parse::<f64>().expect("a number"));
            let rounding = 2.0 * f64::EPSILON * value;
            assert!(
                (digits - value).abs() + error <= bar * (1.0 + 1e-7) + rounding,
                "{text}: {value} {error}"
            );
            // Half a unit of the tenth decimal at most is left out.
            let least = 1e-10 * value.max(1.0);
            assert!(bar <= 3.0 * error.max(least), "{text}: {error}");
        }
    }

    #[test]
    fn the_printed_bar_holds_what_the_tenth_decimal_leaves_out() {
        assert_eq!(shown(0.001_193_220_118_24, 2e-11), "0.0011932201 ± 4e-11");
        let number = Measured::new(C64::new(0.123_456_789_04, 0.123_456_789_03), 1e-13);
        assert_eq!(number.to_string(), "0.1234567890 + 0.1234567890 i ± 6e-11");
    }

    #[test]
    fn quotients_and_roots_are_decided_or_not() {
        let [four, two] = [Measured::new(4.0, 0.1), Measured::new(2.0, 0.1)];
        let quotient = four.over(two).expect("a quotient");
        assert!((quotient.value - 2.0).abs() < 1e-15);
        // 4.1/1.9 = 2.157…
        assert!(quotient.error >= 0.157 && quotient.error < 0.2);
        assert!(four.over(Measured::new(0.1, 0.2)).is_none());
        assert!((-four).sqrt().is_none() && Measured::new(0.1, 0.2).sqrt().is_none());
        assert_eq!(Measured::new(1e-17, 1e-16).sign(), None);
        // 4.1 · 2.1 = 8.61
        assert!((four * two).error >= 0.609);
    }
}
