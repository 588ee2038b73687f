//! Values along which a task goes.

use serde::{Deserialize, Serialize};

/// How the values of an axis are spaced.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Spacing {
    /// By equal steps.
    #[default]
    Even,
    /// By equal factors.
    Geometric,
}

/// Values of k or of a parameter.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Axis {
    pub name: String,
    pub from: f64,
    pub to: f64,
    pub count: usize,
    #[serde(default)]
    pub spacing: Spacing,
}

impl Axis {
    pub fn values(&self) -> Vec<f64> {
        let steps = self.count - 1;
        let value = |i: usize| {
            let part = i as f64 / steps as f64;
            match self.spacing {
                Spacing::Even => self.from + (self.to - self.from) * part,
                Spacing::Geometric => self.from * (self.to / self.from).powf(part),
            }
        };
        (0..=steps).map(value).collect()
    }
}
