//! Parameter values by name, checked against what the model accepts.

use crate::error::{Error, Result};
use crate::model::Structure;
use crate::model::nearest;

/// Values of all parameters of a model; those set to `auto` are still to be determined.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameters {
    /// By parameter; of a switch the position of its choice.
    pub values: Vec<f64>,
    /// Whether the base state determines it.
    pub automatic: Vec<bool>,
}

impl Parameters {
    /// The defaults of the spec.
    pub fn defaults(structure: &Structure) -> Self {
        Parameters {
            values: structure.parameters.iter().map(|p| p.default).collect(),
            automatic: vec![false; structure.parameters.len()],
        }
    }

    /// Position of a parameter by name.
    ///
    /// # Errors
    /// Names the parameters there are.
    pub fn index(structure: &Structure, name: &str) -> Result<usize> {
        structure
            .parameters
            .iter()
            .position(|p| p.name == name)
            .ok_or_else(|| {
                let names: Vec<&str> = structure
                    .parameters
                    .iter()
                    .map(|p| p.name.as_str())
                    .collect();
                let near = nearest(name, names.iter().copied());
                let near = near.map_or(String::new(), |n| format!("; did you mean `{n}`?"));
                Error::input(format!(
                    "the model `{}` has no parameter `{name}`: it has {}{near}",
                    structure.name,
                    if names.is_empty() {
                        "none".into()
                    } else {
                        names.join(", ")
                    }
                ))
            })
    }

    /// Sets a parameter to a number.
    ///
    /// # Errors
    /// Values outside the declared range.
    pub fn set(&mut self, structure: &Structure, index: usize, value: f64) -> Result<()> {
        let info = &structure.parameters[index];
        let whole = info.choices.is_empty() || value.fract() == 0.0;
        if !value.is_finite() || value < info.lower || value > info.upper || !whole {
            return Err(Error::input(format!(
                "{} = {value} is out of range: `{}` accepts {}",
                info.name,
                info.name,
                accepts(structure, index)
            )));
        }
        self.values[index] = value;
        self.automatic[index] = false;
        Ok(())
    }

    /// Sets a parameter from text: a number, the name of a choice, or `auto`.
    ///
    /// # Errors
    /// Says what the parameter accepts.
    pub fn set_text(&mut self, structure: &Structure, name: &str, text: &str) -> Result<()> {
        let index = Self::index(structure, name)?;
        let info = &structure.parameters[index];
        if text == "auto" && info.automatic {
            self.automatic[index] = true;
            return Ok(());
        }
        if let Some(choice) = info.choices.iter().position(|c| c == text) {
            self.values[index] = choice as f64;
            return Ok(());
        }
        let value: f64 = text.parse().map_err(|_| {
            Error::input(format!(
                "{name} = {text} is not a value: `{name}` accepts {}",
                accepts(structure, index)
            ))
        })?;
        self.set(structure, index, value)
    }

    /// Position of the case that the structural switches select.
    pub fn case(&self, structure: &Structure) -> usize {
        let chosen: Vec<usize> = structure
            .switches
            .iter()
            .map(|&switch| self.values[switch] as usize)
            .collect();
        structure
            .cases
            .iter()
            .position(|case| case.choices == chosen)
            .unwrap_or(0)
    }

    /// The value of a parameter as the user writes it.
    pub fn shown(&self, structure: &Structure, index: usize) -> String {
        let info = &structure.parameters[index];
        match info.choices.get(self.values[index] as usize) {
            Some(choice) => choice.clone(),
            None => format!("{}", self.values[index]),
        }
    }
}

/// What a parameter accepts, in words.
pub fn accepts(structure: &Structure, index: usize) -> String {
    let info = &structure.parameters[index];
    let mut text = if !info.choices.is_empty() {
        format!("one of {}", info.choices.join(", "))
    } else {
        match (info.lower.is_finite(), info.upper.is_finite()) {
            (true, true) => format!("a number in {}..{}", info.lower, info.upper),
            (true, false) => format!("a number from {} on", info.lower),
            (false, true) => format!("a number up to {}", info.upper),
            (false, false) => "a number".into(),
        }
    };
    if info.automatic {
        text += ", or auto";
    }
    text
}
