//! Parameter values by name, checked against what the model accepts.

use crate::error::{Error, Result};
use crate::model::{CaseId, Id, ParameterId, Structure, Table, nearest};
use crate::words;
use serde_json::Value;

/// Values of all parameters of a model. Those set to `auto` hold a start, and the base state determines them.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameters {
    /// The value of each parameter, in its unit; for a switch the position of its choice.
    pub values: Table<ParameterId, f64>,
    /// Whether a parameter is set to `auto`.
    pub automatic: Table<ParameterId, bool>,
}

impl Parameters {
    /// The defaults of the spec.
    pub fn defaults(structure: &Structure) -> Self {
        Parameters {
            values: structure.parameters.map(|p| p.default),
            automatic: structure.parameters.map(|_| false),
        }
    }

    /// The parameter of a name.
    ///
    /// # Errors
    /// There is none; the message names the nearest one and all.
    pub fn named(structure: &Structure, name: &str) -> Result<ParameterId> {
        structure
            .parameters
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
                    "the model `{}` has no parameter `{}`: it has {}{near}",
                    structure.name,
                    words::quoted(name),
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
    /// The value is outside the declared range, or not a whole number where one is needed.
    pub fn set(&mut self, structure: &Structure, parameter: ParameterId, value: f64) -> Result<()> {
        let info = &structure.parameters[parameter];
        let refuse = |trouble: &str| {
            Err(Error::input(format!(
                "{} = {} is {trouble}: `{}` accepts {}",
                info.name,
                words::brief(value),
                info.name,
                accepts(structure, parameter)
            )))
        };
        if !value.is_finite() || value < info.lower || value > info.upper {
            return refuse("out of range");
        }
        if !info.is_continuous() && value.fract() != 0.0 {
            return refuse("not a whole number");
        }
        self.values[parameter] = value;
        self.automatic[parameter] = false;
        Ok(())
    }

    /// Sets a parameter from text: a number, the name of a choice, or `auto`.
    ///
    /// # Errors
    /// There is no such parameter, or it does not accept the text; the message says what it accepts.
    pub fn set_text(&mut self, structure: &Structure, name: &str, text: &str) -> Result<()> {
        let parameter = Self::named(structure, name)?;
        let info = &structure.parameters[parameter];
        if text == "auto" && info.automatic {
            self.automatic[parameter] = true;
            return Ok(());
        }
        if let Some(choice) = info.choices.iter().position(|c| c == text) {
            self.values[parameter] = choice as f64;
            return Ok(());
        }
        let value: f64 = text.parse().map_err(|_| {
            Error::input(format!(
                "{name} = {} is not a value: `{name}` accepts {}",
                words::quoted(text),
                accepts(structure, parameter)
            ))
        })?;
        self.set(structure, parameter, value)
    }

    /// The position of a switch's choice.
    pub fn choice(&self, switch: ParameterId) -> usize {
        self.values[switch] as usize
    }

    /// The case that the structural switches select.
    pub fn case(&self, structure: &Structure) -> CaseId {
        let chosen = structure.switches.iter().map(|&switch| self.choice(switch));
        let chosen: Vec<usize> = chosen.collect();
        let case = structure.cases.position(|case| case.choices == chosen);
        case.unwrap_or(CaseId::at(0))
    }

    /// The value of a parameter as the user writes it: a number, the name of a choice, or `auto`.
    pub fn shown(&self, structure: &Structure, parameter: ParameterId) -> String {
        if self.automatic[parameter] {
            return "auto".to_owned();
        }
        let choices = &structure.parameters[parameter].choices;
        match choices.get(self.choice(parameter)) {
            Some(choice) => choice.clone(),
            None => format!("{}", self.values[parameter]),
        }
    }

    /// All parameters as a JSON object: numbers, and switches by the name of their choice.
    pub fn json(&self, structure: &Structure) -> Value {
        let named = structure.parameters.pairs().map(|(id, info)| {
            let value = if info.choices.is_empty() {
                words::number(self.values[id])
            } else {
                Value::String(self.shown(structure, id))
            };
            (info.name.clone(), value)
        });
        Value::Object(named.collect())
    }

    /// Parameters that are not at their defaults, each as `S = 200`.
    pub fn changed(&self, structure: &Structure) -> Vec<String> {
        let changed = structure.parameters.pairs().filter_map(|(id, info)| {
            let value = self.shown(structure, id);
            let moved = self.automatic[id] || self.values[id] != info.default;
            moved.then(|| format!("{} = {value}", info.name))
        });
        changed.collect()
    }
}

/// What a parameter accepts, in words.
pub fn accepts(structure: &Structure, parameter: ParameterId) -> String {
    let info = &structure.parameters[parameter];
    let mut text = if !info.choices.is_empty() {
        format!("one of {}", info.choices.join(", "))
    } else {
        let number = if info.whole {
            "a whole number"
        } else {
            "a number"
        };
        match (info.lower.is_finite(), info.upper.is_finite()) {
            (true, true) => format!("{number} in {}..{}", info.lower, info.upper),
            (true, false) => format!("{number} from {} on", info.lower),
            (false, true) => format!("{number} up to {}", info.upper),
            (false, false) => number.into(),
        }
    };
    if info.automatic {
        text += ", or auto";
    }
    text
}
