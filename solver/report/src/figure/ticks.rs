//! Numbers along axes: one style an axis.

use kuva::prelude::TickFormat;
use std::sync::Arc;

/// Sizes between which an axis is labelled in plain decimals.
const PLAIN: [f64; 2] = [1e-4, 1e5];

/// Plain decimals, or powers of ten where the numbers are very large or small.
pub(super) fn linear(largest: f64) -> TickFormat {
    match (PLAIN[0]..PLAIN[1]).contains(&largest) || largest == 0.0 {
        true => TickFormat::Custom(Arc::new(decimal)),
        false => TickFormat::Custom(Arc::new(scientific)),
    }
}

/// 10⁻³; what lies between the powers stays without a label, unless there is no power to see.
pub(super) fn logarithmic(smallest: f64, largest: f64) -> TickFormat {
    let decades = largest.log10().floor() - smallest.log10().ceil();
    match decades >= 1.0 {
        true => TickFormat::Custom(Arc::new(power_of_ten)),
        false => linear(largest),
    }
}

/// A size in a legend: three digits.
pub(super) fn size(value: f64) -> String {
    let text = format!("{value:.2e}");
    let rounded = text.parse().unwrap_or(value);
    match (1e-3..1e4).contains(&rounded) {
        true => decimal(rounded),
        false => scientific(rounded),
    }
}

/// 0.05, with no more digits than it has.
fn decimal(value: f64) -> String {
    let text = format!("{value:.6}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    match text {
        "-0" | "" => "0".to_owned(),
        text => text.replace('-', "−"),
    }
}

/// 2·10⁻⁵
fn scientific(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let text = format!("{value:.3e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let mantissa = decimal(mantissa.parse().unwrap_or(f64::NAN));
    match mantissa.as_str() {
        "1" => format!("10{}", raised(exponent)),
        "−1" => format!("−10{}", raised(exponent)),
        mantissa => format!("{mantissa}·10{}", raised(exponent)),
    }
}

fn power_of_ten(value: f64) -> String {
    let exponent = value.log10().round();
    match (value.log10() - exponent).abs() < 1e-6 {
        true => scientific(10_f64.powf(exponent)),
        false => String::new(),
    }
}

fn raised(digits: &str) -> String {
    const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let sign = |c: char| match c.to_digit(10) {
        Some(digit) => RAISED[digit as usize],
        None => '⁻',
    };
    digits.chars().map(sign).collect()
}

#[cfg(test)]
mod tests {
    use super::{decimal, power_of_ten, scientific, size};

    #[test]
    fn numbers_in_one_style() {
        assert_eq!(
            [0.05, -0.5, 0.0, 12.0].map(decimal),
            ["0.05", "−0.5", "0", "12"]
        );
        assert_eq!(
            [2e-5, 1e-5, -3e7].map(scientific),
            ["2·10⁻⁵", "10⁻⁵", "−3·10⁷"]
        );
        assert_eq!(
            [1.3912, 0.052_345, 9.876e-5].map(size),
            ["1.39", "0.0523", "9.88·10⁻⁵"]
        );
        assert_eq!([1e-3, 2e-3, 10.0].map(power_of_ten), ["10⁻³", "", "10¹"]);
    }
}
