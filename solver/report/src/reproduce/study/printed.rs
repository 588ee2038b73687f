//! Printed numbers, which have digits.

use serde::{Deserialize, Deserializer, Serialize};

/// A printed number with its digits: in the file a number, or a text where the last digits are zeros.
#[derive(Clone, Debug, Serialize, PartialEq)]
pub struct Printed {
    pub value: f64,
    pub text: String,
}

impl Printed {
    /// The number that a text prints; NaN where it prints none.
    pub fn of(text: &str) -> Self {
        Printed {
            value: text.trim().parse().unwrap_or(f64::NAN),
            text: text.trim().to_owned(),
        }
    }

    /// One in the last printed place.
    pub fn last_digit(&self) -> f64 {
        let (mantissa, exponent) = self
            .text
            .split_once(['e', 'E'])
            .unwrap_or((&self.text, "0"));
        let decimals = mantissa.split_once('.').map_or(0, |(_, d)| d.len() as i32);
        10_f64.powi(exponent.parse::<i32>().unwrap_or(0) - decimals)
    }
}

impl<'d> Deserialize<'d> for Printed {
    fn deserialize<D: Deserializer<'d>>(input: D) -> std::result::Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged)]
        enum Written {
            Number(f64),
            Text(String),
            Kept { text: String },
        }
        let printed = match Written::deserialize(input)? {
            Written::Number(value) => Printed::of(&value.to_string()),
            Written::Text(text) | Written::Kept { text, .. } => Printed::of(&text),
        };
        match printed.value.is_finite() {
            true => Ok(printed),
            false => Err(serde::de::Error::custom(format!(
                "`{}` is no number; a printed value is a number, or a text with its digits such as \"0.1790\"",
                printed.text
            ))),
        }
    }
}
