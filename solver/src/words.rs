//! Numbers in words and in JSON.

use crate::measured::Measured;
use crate::model::C64;
use serde_json::{Value, json};
use std::path::Path;

/// A finite number, or null.
pub fn number(value: f64) -> Value {
    if value.is_finite() {
        json!(value)
    } else {
        Value::Null
    }
}

/// [re, im]
pub fn complex(value: C64) -> Value {
    Value::Array(vec![number(value.re), number(value.im)])
}

/// A number in a title: six decimals at most, without trailing zeros. Below 10⁻⁴ and above 10¹⁵ all digits, with an exponent.
pub fn short(value: f64) -> String {
    if value != 0.0 && !(1e-4..=1e15).contains(&value.abs()) {
        return format!("{value:e}");
    }
    let text = format!("{value:.6}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// A number as a message quotes it: with all its digits, but by a power of ten where it is very large or very small.
pub fn brief(value: f64) -> String {
    let size = value.abs();
    if value.is_finite() && value != 0.0 && !(1e-5..=1e15).contains(&size) {
        format!("{value:e}")
    } else {
        value.to_string()
    }
}

/// A count with its noun: `1 row`, `2 rows`.
pub fn counted(count: usize, noun: &str) -> String {
    let ending = if count == 1 { "" } else { "s" };
    format!("{count} {noun}{ending}")
}

/// The path of a file as a message has it: on one line, whatever characters are in its name.
pub fn shown_path(path: &Path) -> String {
    let mut shown = String::new();
    for character in path.to_string_lossy().chars() {
        if character.is_control() {
            shown += &format!("\\u{:04x}", u32::from(character));
        } else {
            shown.push(character);
        }
    }
    shown
}

/// A number whose real or imaginary part is set to zero where it is below a hundredth of the error.
pub fn settled(value: C64, error: f64) -> C64 {
    let part = |x: f64| if x.abs() <= 1e-2 * error { 0.0 } else { x };
    C64::new(part(value.re), part(value.im))
}

/// `0.00190361` or `0.0037397 - 0.2375265 i`
pub fn shown(value: C64) -> String {
    let small = value.norm() < 1e-3 && value.norm() > 0.0 || value.norm() >= 1e6;
    let digits = |x: f64| {
        if small {
            format!("{x:.9e}")
        } else {
            format!("{x:.10}")
        }
    };
    if value.im == 0.0 {
        digits(value.re)
    } else {
        let sign = if value.im < 0.0 { '-' } else { '+' };
        format!("{} {sign} {} i", digits(value.re), digits(value.im.abs()))
    }
}

/// A number with its error, in the digits that the error leaves certain, ten at most.
pub fn with_error(value: f64, error: f64) -> String {
    Measured::new(value, error).to_string()
}

/// The amplitude equation at cubic order, dA/dt = a0 A + a2 A³ and dθ/dt = b0 + b2 A², with its numbers.
pub fn amplitude_equation(c0: Measured<C64>, c2: Measured<C64>) -> String {
    let digits = |x: f64, error: f64| Measured::new(x, error).scientific(6);
    let first = |c: Measured<C64>, x: f64| digits(x, c.error);
    let term = |c: Measured<C64>, x: f64| {
        let sign = if x < 0.0 { '-' } else { '+' };
        format!("{sign} {}", digits(x.abs(), c.error))
    };
    let (re0, re2) = (c0.value.re, c2.value.re);
    let mut text = format!("dA/dt = {} A {} A³", first(c0, re0), term(c2, re2));
    let (im0, im2) = (c0.value.im, c2.value.im);
    if im0 != 0.0 || im2 != 0.0 {
        text += &format!(",  dθ/dt = {} {} A²", first(c0, im0), term(c2, im2));
    }
    text
}

/// Most characters of a text from outside that a message quotes: about a line.
const LONGEST_QUOTATION: usize = 100;

/// A text from outside as a message quotes it: on one line without control characters, cut after 100 characters.
pub fn quoted(text: &str) -> String {
    let plain = |c: char| if c.is_control() { ' ' } else { c };
    let mut line: String = text.chars().take(LONGEST_QUOTATION).map(plain).collect();
    if text.chars().nth(LONGEST_QUOTATION).is_some() {
        line.push('…');
    }
    line
}

/// The note on a conserved integral that the spec does not declare.
pub fn undeclared(integral: &str) -> String {
    format!(
        "note: the balances conserve {integral}, which the block `mean` does not name; a slow mean then couples to the \
         pattern's envelope"
    )
}

#[cfg(test)]
mod tests {
    use super::{brief, counted, short, shown_path, with_error};
    use std::path::Path;

    #[test]
    fn words_of_messages() {
        let numbers = [1e300, -1e-300, 1e15, 1e-5, 0.0, 0.25, f64::INFINITY].map(brief);
        let expected = [
            "1e300",
            "-1e-300",
            "1000000000000000",
            "0.00001",
            "0",
            "0.25",
            "inf",
        ];
        assert_eq!(numbers, expected);
        assert_eq!(
            [0, 1, 2].map(|n| counted(n, "row")),
            ["0 rows", "1 row", "2 rows"]
        );
        assert_eq!(shown_path(Path::new("a\nb κ.csv")), "a\\u000ab κ.csv");
    }

    #[test]
    fn numbers_of_any_size() {
        let texts = [0.16, 1708.0, -2.5e-9, 0.0, 1e-4, 1e300].map(short);
        assert_eq!(texts, ["0.16", "1708", "-2.5e-9", "0", "0.0001", "1e300"]);
        assert_eq!(with_error(1e-17, 5e-16), "0 ± 6e-16");
        assert_eq!(with_error(1707.76178, 2e-5), "1707.76178 ± 2e-5");
    }
}
