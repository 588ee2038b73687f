//! Statements of a source, and the criteria that decide them.

use super::Axis;
use super::task::Asked;
use serde::{Deserialize, Serialize};

/// What decides a statement.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Where the critical point lies.
    Place,
    /// Where A_e is largest over an axis.
    LargestAmplitude,
    /// Where a0 is largest over an axis.
    LargestGrowth,
    /// A derived column: an output, or an expression in the base state.
    Column,
    A0,
    A2,
    /// A_e
    Amplitude,
}

/// Who set the bound of a criterion.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Threshold {
    /// The study: the source says less than a number.
    #[default]
    Ours,
    /// The quoted words: a number that they name, or a sign or trend that they state.
    Source,
}

/// A statement of the source, and what decides it in each case.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Statement {
    /// Words of the source, verbatim.
    pub quote: Option<String>,
    /// Where the source has them.
    pub section: Option<String>,
    /// The statement in words of the study, where nothing is quoted.
    pub says: Option<String>,
    /// Who set the bound.
    #[serde(default)]
    pub threshold: Threshold,
    /// What the number is called.
    pub name: String,
    pub quantity: Quantity,
    /// At a critical point; at the wavenumber of the case otherwise.
    pub at: Option<Asked>,
    /// What a largest value is looked for over.
    pub over: Option<Axis>,
    pub above: Option<f64>,
    pub below: Option<f64>,
    /// Within this part of the first case's value.
    pub as_first_within: Option<f64>,
    /// Farther than this part of the first case's value from it.
    pub apart_from_first: Option<f64>,
    /// What a column holds, as `sweep --column` takes it.
    pub column: Option<String>,
    /// From each case to the next.
    pub trend: Option<Trend>,
}

impl Statement {
    /// The statement: words of the source where they are quoted, of the study otherwise.
    pub fn words(&self) -> &str {
        let words = self.quote.as_ref().or(self.says.as_ref());
        words.map_or("", String::as_str)
    }

    /// What has to be true of the numbers, in words: `a2 at k_l < 0`.
    pub fn criterion(&self) -> String {
        let name = match self.quantity {
            Quantity::LargestAmplitude | Quantity::LargestGrowth => {
                let axis = self.over.as_ref().map_or("", |axis| axis.name.as_str());
                format!("{} ({axis} where it is largest)", self.name)
            }
            _ => self.name.clone(),
        };
        let mut parts: Vec<String> = Vec::new();
        match (self.above, self.below) {
            (Some(above), Some(below)) => parts.push(format!("{above} < {name} < {below}")),
            (Some(above), None) => parts.push(format!("{name} > {above}")),
            (None, Some(below)) => parts.push(format!("{name} < {below}")),
            (None, None) => {}
        }
        if let Some(share) = self.as_first_within {
            let share = percent(share);
            parts.push(format!("{name} within {share} of the first case's"));
        }
        if let Some(share) = self.apart_from_first {
            let share = percent(share);
            parts.push(format!("{name} more than {share} from the first case's"));
        }
        if let Some(trend) = self.trend {
            let way = match trend {
                Trend::Rising => "rises",
                Trend::Falling => "falls",
            };
            parts.push(format!("{name} {way} from case to case"));
        }
        parts.join(", and ")
    }
}

/// A share as a reader has it: two digits, in per cent, or by a power of ten where that is small.
pub fn percent(share: f64) -> String {
    if share == 0.0 || share.abs() >= 1e-4 {
        let digits = format!("{:.1e}", 100.0 * share);
        // Back from the exponent: 1.5e0 is 1.5, 1.0e0 is 1.
        let value: f64 = digits.parse().unwrap_or(100.0 * share);
        format!("{value} %")
    } else {
        format!("{share:.1e} of the value")
    }
}

/// Which way numbers go from case to case.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Trend {
    Rising,
    Falling,
}
