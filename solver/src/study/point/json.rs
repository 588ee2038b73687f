//! A Landau point as the object that the command line prints: the keys are a contract.

use super::PointReport;
use crate::measured::{Decided, Measured};
use crate::model::C64;
use crate::words;
use serde_json::{Map, Value, json};

/// Values, errors under the same names, and the reasons why a value is null, by path.
#[derive(Default)]
struct Answers {
    values: Map<String, Value>,
    errors: Map<String, Value>,
}

impl Answers {
    fn real(&mut self, name: &str, value: Measured) {
        self.values
            .insert(name.to_owned(), words::number(value.value));
        self.errors
            .insert(name.to_owned(), words::number(value.error));
    }

    fn complex(&mut self, name: &str, value: Measured<C64>) {
        self.values
            .insert(name.to_owned(), words::complex(value.value));
        self.errors
            .insert(name.to_owned(), words::number(value.error));
    }

    fn missing(&mut self, name: &str) {
        self.values.insert(name.to_owned(), Value::Null);
        self.errors.insert(name.to_owned(), Value::Null);
    }

    /// A value, or null with its reason.
    fn decided(&mut self, name: &str, value: &Decided, reasons: &mut Reasons) {
        match value {
            Ok(value) => self.real(name, *value),
            Err(reason) => {
                self.missing(name);
                reasons.add(name, reason);
            }
        }
    }
}

/// Why values are null, by the path of their keys.
struct Reasons {
    within: &'static str,
    all: Map<String, Value>,
}

impl Reasons {
    fn add(&mut self, name: &str, reason: &str) {
        let path = match self.within {
            "" => name.to_owned(),
            within => format!("{within}.{name}"),
        };
        self.all.insert(path, reason.into());
    }

    fn within(&mut self, key: &'static str) -> &mut Self {
        self.within = key;
        self
    }
}

impl PointReport {
    /// The object that the command line prints.
    pub fn json(&self) -> Value {
        let mut reasons = Reasons {
            within: "",
            all: Map::new(),
        };
        let mut top = Answers::default();
        for (n, coefficient) in self.equation.coefficients.iter().enumerate() {
            top.complex(&format!("c{}", 2 * n), *coefficient);
        }
        top.decided("amplitude", &self.amplitude, &mut reasons);
        let radius = self.equation.radius();
        if self.equation.order() == 3 {
            top.missing("radius");
        } else {
            top.decided("radius", &radius, &mut reasons);
        }
        for (key, answers) in [
            ("resonance", self.resonances()),
            ("outputs", self.output_answers()),
            ("dc0", self.slopes(reasons.within("dc0"))),
            ("amplitudes", self.amplitudes(reasons.within("amplitudes"))),
            ("envelope", self.envelope(reasons.within("envelope"))),
            ("waves", self.wave_answers(reasons.within("waves"))),
        ] {
            if key == "waves" && self.waves.is_none() {
                top.missing(key);
                continue;
            }
            top.values.insert(key.to_owned(), answers.values.into());
            top.errors.insert(key.to_owned(), answers.errors.into());
        }
        let reasons = reasons.within("");
        let stable = self.stable();
        if let Err(reason) = &stable {
            reasons.add("stable", reason);
        }
        let mut object = json!({
            "model": self.model,
            "parameters": self.parameters,
            "k": self.k,
            "M": self.resolution,
            "bifurcation": self.bifurcation.to_string(),
            "normalization": self.normalization,
            "stable": stable.ok(),
            "small_divisors": self.small_divisors,
            "conserved_mean": self.conserved_mean,
            "undeclared": self.undeclared,
            "notes": self.notes,
        });
        for (key, value) in top.values {
            object[key] = value;
        }
        object["error"] = top.errors.into();
        object["not_decided"] = reasons.all.clone().into();
        object
    }

    fn resonances(&self) -> Answers {
        let mut answers = Answers::default();
        answers.real("mean_flow", self.resonance.mean_flow);
        answers.real("second_harmonic", self.resonance.second_harmonic);
        answers
    }

    fn output_answers(&self) -> Answers {
        let mut answers = Answers::default();
        for output in &self.outputs {
            let both = [output.base, output.correction];
            let [values, errors] = [both.map(|m| m.value), both.map(|m| m.error)]
                .map(|numbers| numbers.map(words::number).to_vec());
            answers.values.insert(output.name.clone(), values.into());
            answers.errors.insert(output.name.clone(), errors.into());
        }
        answers
    }

    fn slopes(&self, reasons: &mut Reasons) -> Answers {
        let mut answers = Answers::default();
        for (name, slope) in &self.dc0 {
            match slope {
                Ok(slope) => answers.complex(name, *slope),
                Err(reason) => {
                    answers.missing(name);
                    reasons.add(name, reason);
                }
            }
        }
        answers
    }

    fn amplitudes(&self, reasons: &mut Reasons) -> Answers {
        let mut answers = Answers::default();
        for order in self.orders() {
            let amplitude = self.equation.equilibrium(order);
            answers.decided(&order.to_string(), &amplitude, reasons);
        }
        if self.equation.order() == 3 {
            answers.missing("pade");
        } else {
            answers.decided("pade", &self.equation.pade(), reasons);
        }
        answers
    }

    fn envelope(&self, reasons: &mut Reasons) -> Answers {
        let mut answers = Answers::default();
        answers.complex("dc0_dk", self.slope);
        answers.complex("d2c0_dk2", self.curvature);
        answers.real("group_velocity", self.group_velocity());
        answers.decided("benjamin_feir", &self.benjamin_feir, reasons);
        answers
    }

    fn wave_answers(&self, reasons: &mut Reasons) -> Answers {
        let mut answers = Answers::default();
        match &self.waves {
            None => {}
            Some(Err(reason)) => {
                for key in ["self", "cross"] {
                    answers.missing(key);
                    reasons.add(key, reason);
                }
                answers.values.insert("error".to_owned(), Value::Null);
                answers.values.insert("stable".to_owned(), Value::Null);
            }
            Some(Ok(waves)) => {
                answers.complex("self", waves.self_coefficient);
                answers.complex("cross", waves.cross);
                let largest = waves.self_coefficient.error.max(waves.cross.error);
                answers
                    .values
                    .insert("error".to_owned(), words::number(largest));
                let stable = waves.stable();
                answers.values.insert("stable".to_owned(), json!(stable));
                if stable.is_none() {
                    reasons.add("stable", "a sign that decides it lies within its error");
                }
            }
        }
        answers
    }
}
