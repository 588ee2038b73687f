//! The base state as profiles: what `base` prints, draws and stores.

use super::Setup;
use crate::error::{Error, Result};
use crate::model::FieldId;
use crate::wavevector::WaveVector;
use crate::words;
use serde_json::{Map, Value, json};
use std::fmt;

/// Heights that a profile may have.
const HEIGHTS: std::ops::RangeInclusive<usize> = 2..=100_000;

/// A base state at evenly spaced heights; owns its data.
#[derive(Clone, Debug)]
pub struct BaseReport {
    /// Name of the model.
    pub model: String,
    /// Its title.
    pub title: String,
    /// By name; switches by the name of their choice.
    pub parameters: Value,
    /// Highest degree of its Chebyshev series.
    pub degree: usize,
    /// The size of the last Chebyshev coefficients over the largest.
    pub tail: f64,
    /// What is left of the balances that it was solved from, relative to their terms.
    pub residual: f64,
    /// The cross-stream coordinate, where there is one.
    pub coordinate: Option<String>,
    /// Its values, ascending.
    pub heights: Vec<f64>,
    /// Values of every field by name: profiles, then unknown numbers.
    pub profiles: Vec<(String, Vec<f64>)>,
    /// How many of them are profiles.
    pub varying: usize,
    /// What the base state satisfies but nearly, in words.
    pub notes: Vec<String>,
}

impl BaseReport {
    /// The base state at `points` heights.
    ///
    /// # Errors
    /// A number of heights out of range; a base state that is not found.
    pub fn compute(setup: &Setup, points: usize) -> Result<Self> {
        if !HEIGHTS.contains(&points) {
            return Err(Error::input(format!(
                "points = {points} is out of range: it accepts {} to {}",
                HEIGHTS.start(),
                HEIGHTS.end()
            )));
        }
        let state = setup.base(None)?;
        let structure = setup.model.structure();
        let places = state.space.evenly(points);
        let states: Vec<Vec<f64>> = places
            .iter()
            .map(|&place| state.at(place, WaveVector::MEAN))
            .collect();
        let profile = |field: FieldId| {
            let values = states
                .iter()
                .map(|point| structure.base_value(point, field, 0));
            (structure.fields[field].name.clone(), values.collect())
        };
        Ok(BaseReport {
            model: structure.name.clone(),
            title: structure.title.clone(),
            parameters: state.parameters.json(state.structure()),
            degree: state.degree,
            tail: state.tail(),
            residual: state.residual,
            coordinate: structure.coordinate.clone(),
            heights: places.iter().map(|&place| state.space.y(place)).collect(),
            profiles: structure.fields.ids().map(profile).collect(),
            varying: structure.profiles().len(),
            notes: state.notes.clone(),
        })
    }

    /// The coordinate's name; `y` where there is none.
    pub fn vertical(&self) -> &str {
        self.coordinate.as_deref().unwrap_or("y")
    }

    /// The object that the command line prints: the keys are a contract.
    pub fn json(&self) -> Value {
        let profile = |(name, values): &(String, Vec<f64>)| {
            let values = values.iter().map(|&v| words::number(v)).collect();
            (name.clone(), values)
        };
        json!({
            "model": self.model,
            "parameters": self.parameters,
            "degree": self.degree,
            "tail": words::number(self.tail),
            "residual": words::number(self.residual),
            "notes": self.notes,
            (self.vertical()): self.heights,
            "profiles": self.profiles.iter().map(profile).collect::<Map<String, Value>>(),
        })
    }
}

impl fmt::Display for BaseReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (polynomials, tail) = (self.degree + 1, self.tail);
        writeln!(
            f,
            "{} — base state, {polynomials} Chebyshev polynomials, tail {tail:.1e}",
            self.title
        )?;
        let names = self.profiles.iter().map(|(name, _)| name.as_str());
        for name in std::iter::once(self.vertical()).chain(names) {
            write!(f, "{name:>16}")?;
        }
        for (i, height) in self.heights.iter().enumerate() {
            writeln!(f)?;
            let values = self.profiles.iter().map(|(_, values)| values[i]);
            for value in std::iter::once(*height).chain(values) {
                write!(f, "{value:>16.9}")?;
            }
        }
        for note in &self.notes {
            write!(f, "\nnote: {note}")?;
        }
        Ok(())
    }
}
