//! The checked model: names resolved, definitions expanded, every expression a node of one graph.

mod amplitude;
mod context;
mod declaration;
mod formula;
mod import;
mod mistake;
mod operation;
mod parameter;
mod place;
mod resolve;
mod scope;
mod statement;
mod switch;

pub use landau_contract::End;
use landau_contract::{BalanceId, FieldId, LawId, ParameterId, Table};
pub use resolve::resolve;

use crate::diagnostic::{Location, shortened};
use crate::formula::{Arrangement, Letters};
use crate::graph::Id;

/// A model whose form has been checked as far as names go. Its expressions are nodes of one graph, which stands beside
/// it.
pub struct Model {
    /// Name in the spec.
    pub name: String,
    /// The text in quotation marks beside the name; empty if there is none.
    pub title: String,
    /// Name of the periodic coordinate.
    pub periodic: String,
    /// The cross-stream coordinate; `None` in a model without one.
    pub interval: Option<Interval>,
    /// In the order of their declaration in the spec.
    pub parameters: Table<ParameterId, Parameter>,
    /// In the order of their declaration in the spec.
    pub fields: Table<FieldId, Field>,
    /// In the order of their declaration in the spec.
    pub laws: Table<LawId, Law>,
    /// In the order of their declaration in the spec.
    pub balances: Table<BalanceId, Balance>,
    /// The base state.
    pub base: Base,
    /// Boundary conditions of all cases.
    pub boundary: Vec<Condition>,
    /// What closes the problem at k = 0.
    pub mean: Vec<Closure>,
    /// What the amplitude measures.
    pub amplitude: Amplitude,
    /// Output functionals.
    pub outputs: Vec<Output>,
    /// A wavenumber and a nearby eigenvalue that show what the model is about.
    pub typical: Option<Typical>,
    /// The text of every file that was read; the spec first.
    pub sources: Vec<crate::diagnostic::SourceFile>,
    /// What its names stand for, so that formulas can be read later.
    declared: scope::Declared,
}

impl Model {
    /// Names of the fields.
    pub fn field_names(&self) -> Table<FieldId, String> {
        self.fields.map(|f| f.name.clone())
    }

    /// The fields that are profiles; they come first.
    pub fn profiles(&self) -> impl Iterator<Item = FieldId> {
        self.fields.ids().filter(|&f| !self.fields[f].uniform)
    }

    /// The names that its expressions are written with.
    pub fn letters(&self, arrangement: Arrangement) -> Letters {
        Letters {
            fields: self.field_names(),
            parameters: self.parameters.map(|p| p.name.clone()),
            laws: self.laws.map(|l| l.name.clone()),
            periodic: self.periodic.clone(),
            coordinate: self.coordinate().to_owned(),
            arrangement,
        }
    }

    /// The line of a place, from 1.
    pub fn line(&self, place: &Location) -> usize {
        let text = self.sources.get(place.file).map_or("", |file| &file.text);
        let before = text.get(..place.range.start).unwrap_or_default();
        before.matches('\n').count() + 1
    }

    /// The text of the spec at a place, on one line.
    pub fn written(&self, place: &Location) -> String {
        let text = self.sources.get(place.file).map_or("", |file| &file.text);
        let written = text.get(place.range.clone()).unwrap_or_default();
        let line = written.split_whitespace().collect::<Vec<_>>().join(" ");
        shortened(&line)
    }

    /// Name of the cross-stream coordinate.
    pub fn coordinate(&self) -> &str {
        self.interval.as_ref().map_or("y", |i| i.name.as_str())
    }
}

/// A wavenumber that shows what a model is about, and the eigenvalue that its mode is near to.
#[derive(Clone, Copy, Debug)]
pub struct Typical {
    /// Wavenumber.
    pub k: f64,
    /// Real and imaginary part of a nearby eigenvalue.
    pub near: Option<[f64; 2]>,
}

/// The cross-stream coordinate.
pub struct Interval {
    /// Name in the spec.
    pub name: String,
    /// The lower bound.
    pub lower: Id,
    /// The upper bound.
    pub upper: Id,
    /// The ends as the user wrote them.
    pub written: [String; 2],
    /// Place of its text in the spec.
    pub location: Location,
}

impl Interval {
    /// The coordinate of an end.
    pub fn end(&self, end: End) -> Id {
        match end {
            End::Lower => self.lower,
            End::Upper => self.upper,
        }
    }

    /// An end as the user wrote it.
    pub fn written(&self, end: End) -> &str {
        &self.written[usize::from(end == End::Upper)]
    }

    /// Whether the user gave an end a name, rather than a formula.
    pub fn named(&self, end: End) -> bool {
        let mut letters = self.written(end).chars();
        self.written(end) != "pi"
            && letters.next().is_some_and(char::is_alphabetic)
            && letters.all(|c| c.is_alphanumeric() || c == '_')
    }
}

/// A parameter of the model.
#[derive(Clone)]
pub struct Parameter {
    /// Name in the spec.
    pub name: String,
    /// The text in quotation marks beside the name; empty if there is none.
    pub doc: String,
    /// Its value where none is set.
    pub default: f64,
    /// The lower bound.
    pub lower: f64,
    /// The upper bound.
    pub upper: f64,
    /// Names of the values of a switch; empty for a number.
    pub choices: Vec<String>,
    /// Whether it takes whole numbers alone.
    pub whole: bool,
    /// Place of its text in the spec.
    pub location: Location,
}

/// A field of the model.
pub struct Field {
    /// Name in the spec.
    pub name: String,
    /// The text in quotation marks beside the name; empty if there is none.
    pub doc: String,
    /// The least value that the base state may take.
    pub lower: f64,
    /// The upper bound.
    pub upper: f64,
    /// An unknown number, constant in x and y, rather than a profile.
    pub uniform: bool,
    /// Place of its text in the spec.
    pub location: Location,
}

/// An opaque function of the fields, the coordinate and the parameters.
pub struct Law {
    /// Name in the spec.
    pub name: String,
    /// The text in quotation marks beside the name; empty if there is none.
    pub doc: String,
    /// The expression.
    pub body: Id,
}

/// left − right of a balance, divided (if asked) by a base-state quantity.
pub struct Balance {
    /// Name in the spec.
    pub name: String,
    /// The text in quotation marks beside the name; empty if there is none.
    pub doc: String,
    /// In terms of the full state, derivatives not yet carried out.
    pub residual: Id,
    /// What the balance is divided by.
    pub divisor: Option<Id>,
    /// The field that it is for.
    pub paired_field: Option<FieldId>,
    /// Place of its text in the spec.
    pub location: Location,
}

/// left − right of a condition at one end.
#[derive(Clone)]
pub struct Condition {
    /// The end of the interval at which it holds.
    pub end: End,
    /// Left side minus right side.
    pub residual: Id,
    /// Switches and the choices under which the condition holds.
    pub guard: Vec<(ParameterId, usize)>,
    /// Place of its text in the spec.
    pub location: Location,
}

/// ∫ integrand dy = value.
#[derive(Clone)]
pub struct Integral {
    /// What is integrated.
    pub integrand: Id,
    /// The value of the integral: an expression in parameters.
    pub value: Id,
    /// Place of its text in the spec.
    pub location: Location,
}

/// What the spec says of the base state.
pub struct Base {
    /// Closed form of each field, where the spec gives one.
    pub closed: Table<FieldId, Option<Id>>,
    /// A start for each field that is solved for.
    pub guesses: Table<FieldId, Option<Id>>,
    /// Its conditions.
    pub conditions: Vec<Condition>,
    /// Prescribed integrals.
    pub integrals: Vec<Integral>,
    /// Conditions that determine a parameter set to `auto`.
    pub automatic: Vec<(ParameterId, Condition)>,
    /// Place of its text in the spec.
    pub location: Location,
}

/// What closes the problem at k = 0.
#[derive(Clone)]
pub enum Closure {
    /// An integral that does not change.
    Conserved {
        /// What is integrated.
        integrand: Id,
        /// Place of its text in the spec.
        location: Location,
    },
    /// A field that is determined up to a constant.
    Gauge {
        /// The field whose constant is arbitrary.
        field: FieldId,
        /// Place of its text in the spec.
        location: Location,
    },
    /// A number that an integral condition determines.
    Unknown {
        /// The number, declared as a field without a profile.
        field: FieldId,
        /// Its condition.
        integral: Integral,
    },
}

/// What the amplitude measures.
pub enum Amplitude {
    /// ∫ Σ weight |field|² = value
    Integral {
        /// One a field.
        weights: Vec<Weight>,
        /// The value that fixes the size of a mode: an expression in parameters and k.
        value: Id,
        /// As the spec writes it.
        written: String,
    },
    /// |field| = |value| at a place
    Point {
        /// The field whose value is taken.
        field: FieldId,
        /// The place; `None` in a model without a cross-stream coordinate.
        place: Option<Id>,
        /// The value that fixes the size of a mode: an expression in parameters and k.
        value: Id,
        /// Place and value as the user wrote them.
        written: [String; 2],
    },
}

/// weight |field|², the weight also as the user wrote it; that text is empty for the weight 1.
pub struct Weight {
    /// The field whose square counts.
    pub field: FieldId,
    /// Its weight.
    pub weight: Id,
    /// As the spec writes it.
    pub written: String,
}

/// An output functional.
pub struct Output {
    /// Name in the spec.
    pub name: String,
    /// The text in quotation marks beside the name; empty if there is none.
    pub doc: String,
    /// `None` for an integral over the interval.
    pub place: Option<Id>,
    /// The expression.
    pub body: Id,
    /// Place of its text in the spec.
    pub location: Location,
}
