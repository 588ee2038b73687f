//! What a task of a study gives: pictures, tables, numbers, verdicts on statements.

use super::claim::Claim;
use super::study::{Case, Printed, named};
use super::table::Table;
use super::task::called;
use serde::{Deserialize, Serialize};

/// One number beside the printed one.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Number {
    /// The figure that it belongs to.
    pub figure: String,
    /// The case, and what it is.
    pub quantity: String,
    /// The case alone.
    #[serde(default)]
    pub case: String,
    /// What it is, alone.
    #[serde(default)]
    pub name: String,
    /// The statement that it decides.
    #[serde(default)]
    pub decides: Option<String>,
    /// Nothing where it did not come out.
    pub ours: Option<f64>,
    /// Absolute error of ours.
    pub error: Option<f64>,
    /// What the source has.
    pub printed: Option<f64>,
    /// The same with its own digits.
    pub printed_as: Option<String>,
    /// What somebody else computed, where that is no print, and what it is.
    #[serde(default)]
    pub reference: Option<Beside>,
    /// `ok`, or why there is no number.
    pub status: String,
    /// A sentence beside it.
    pub note: String,
    /// The label of the case in the study: a case may be drawn at several places.
    #[serde(skip)]
    pub origin: String,
}

/// A number of somebody else's.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Beside {
    /// What it is.
    pub label: String,
    /// The number.
    pub value: f64,
}

impl Number {
    /// Whether both are one number: a point marked in one picture and asked for beside another.
    fn is(&self, number: &Number) -> bool {
        let free = self.decides.is_none() && number.decides.is_none();
        let same = self.figure == number.figure && self.quantity == number.quantity;
        free && same
            && self.ours == number.ours
            && (self.printed.is_none() || number.printed.is_none())
    }

    /// A number of a case, by the name under which the source may print it.
    pub fn new(figure: &str, case: &Case, quantity: &str, label: String) -> Self {
        let printed = case.printed.get(quantity);
        Number {
            figure: figure.to_owned(),
            quantity: label,
            case: case.label.clone(),
            name: quantity.to_owned(),
            decides: None,
            ours: None,
            error: None,
            printed: printed.map(|p| p.value),
            printed_as: printed.map(|p| p.text.clone()),
            reference: None,
            origin: case.origin.clone().unwrap_or_else(|| case.label.clone()),
            status: "did not come out".to_owned(),
            note: case.note.clone(),
        }
    }

    /// The same with its value.
    pub fn answered(self, ours: f64, error: Option<f64>) -> Self {
        let status = if ours.is_finite() {
            "ok".to_owned()
        } else {
            "no value".to_owned()
        };
        Number {
            ours: Some(ours).filter(|x| x.is_finite()),
            error,
            status,
            ..self
        }
    }

    /// The same without one, and why.
    pub fn failed(self, reason: &str) -> Self {
        Number {
            status: reason.to_owned(),
            ..self
        }
    }

    /// The difference in units of the last printed digit.
    pub fn units(&self) -> Option<f64> {
        let printed = Printed {
            value: self.printed?,
            text: self.printed_as.clone()?,
        };
        Some((self.ours? - printed.value) / printed.last_digit())
    }
}

/// A picture with the data it was drawn from.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Picture {
    /// What stands under it.
    pub caption: String,
    /// What is seen, in a sentence.
    pub says: String,
    /// The drawing; nothing where there is a table and no value to draw.
    pub svg: Option<String>,
    /// Its data.
    pub table: Option<Table>,
    /// Files that stand beside it already, by name.
    pub files: Vec<String>,
}

/// Everything that a figure consists of.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Outcome {
    /// Drawings with their data.
    pub pictures: Vec<Picture>,
    /// Numbers beside printed ones.
    pub numbers: Vec<Number>,
    /// Statements and what became of them.
    #[serde(default)]
    pub claims: Vec<Claim>,
    /// What did not come out, in a sentence.
    pub failures: Vec<String>,
}

impl Outcome {
    /// Files that the pictures came with.
    pub fn files(&self) -> impl Iterator<Item = &String> {
        self.pictures.iter().flat_map(|picture| &picture.files)
    }

    /// Adds everything of another outcome.
    pub fn add(&mut self, outcome: Outcome) {
        self.pictures.extend(outcome.pictures);
        for number in outcome.numbers {
            match self.numbers.iter_mut().find(|earlier| earlier.is(&number)) {
                // With what is printed, if either has it.
                Some(earlier) if earlier.printed.is_none() => *earlier = number,
                Some(_) => {}
                None => self.numbers.push(number),
            }
        }
        self.claims.extend(outcome.claims);
        self.failures.extend(outcome.failures);
    }

    /// Why what is labelled so did not come out.
    pub fn reason(&self, label: &str) -> String {
        let start = format!("{}: ", called(label));
        let reason = self.failures.iter().find_map(|f| f.strip_prefix(&start));
        reason.unwrap_or("did not come out").to_owned()
    }

    /// A printed number is answered by a number of its own case and name, or named as missed.
    pub fn demand_partners(&mut self, figure: &str, cases: &[Case]) {
        for case in cases {
            for quantity in case.printed.keys() {
                let answers = |n: &Number| n.origin == case.label && n.name == *quantity;
                if self.numbers.iter().any(answers) {
                    continue;
                }
                let label = named(case, quantity);
                let number = Number::new(figure, case, quantity, label);
                self.numbers
                    .push(number.failed("nothing in this task is called so"));
            }
        }
        let missed = self.numbers.iter().filter(|n| n.ours.is_none());
        let missed = missed.filter(|n| n.printed.is_some() || n.reference.is_some());
        let told = |n: &&Number| {
            let start = format!("{}: ", n.quantity);
            !self.failures.iter().any(|f| f.starts_with(&start))
        };
        let untold: Vec<String> = missed
            .filter(told)
            .map(|n| format!("{}: {}", n.quantity, n.status))
            .collect();
        self.failures.extend(untold);
    }
}

#[cfg(test)]
mod tests {
    use super::super::study::{Case, Printed};
    use super::{Number, Outcome};

    #[test]
    fn differences_in_units_of_the_last_printed_digit() {
        let number = |ours: f64, printed: &str| Number {
            figure: String::new(),
            quantity: String::new(),
            case: String::new(),
            name: String::new(),
            decides: None,
            ours: Some(ours),
            error: None,
            printed: printed.parse().ok(),
            printed_as: Some(printed.to_owned()),
            reference: None,
            status: String::new(),
            note: String::new(),
            origin: String::new(),
        };
        let units = |ours, printed| number(ours, printed).units().expect("units");
        assert!((units(0.0368, "0.0366") - 2.0).abs() < 1e-9);
        assert!((units(0.18, "0.1790") - 10.0).abs() < 1e-9);
        assert!((units(64.28, "64.23") - 5.0).abs() < 1e-9);
        assert!((units(6.4e-3, "6.38e-3") - 2.0).abs() < 1e-9);
        assert_eq!(Printed::of("1700").last_digit(), 1.0);
    }

    /// Each printed number is answered by the number of its own case and name.
    #[test]
    fn a_printed_number_is_answered_or_missed() {
        let case = |label: &str, value: &str| Case {
            label: label.to_owned(),
            printed: [("k".to_owned(), Printed::of(value))].into(),
            ..Case::default()
        };
        let cases = [case("one", "2.2"), case("two", "99.0")];
        let mut outcome = Outcome::default();
        let name = |case: &Case, name: &str| {
            Number::new("1", case, name, format!("{}: {name}", case.label))
        };
        outcome
            .numbers
            .push(name(&cases[0], "k").answered(2.2, None));
        // Another number of the second case, whose name ends as the printed one.
        outcome
            .numbers
            .push(name(&cases[1], "second k").answered(2.2, None));
        outcome.demand_partners("1", &cases);
        assert_eq!(outcome.numbers.len(), 3);
        assert_eq!(
            (outcome.numbers[2].printed, outcome.numbers[2].ours),
            (Some(99.0), None)
        );
        assert_eq!(
            outcome.failures,
            ["two: k: nothing in this task is called so"]
        );
        // One that has no value is no answer.
        let mut outcome = Outcome::default();
        outcome
            .numbers
            .push(name(&cases[0], "k").failed("no equilibrium"));
        outcome.demand_partners("1", &cases[..1]);
        assert_eq!(outcome.failures, ["one: k: no equilibrium"]);
    }
}
