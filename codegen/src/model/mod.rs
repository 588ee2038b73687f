//! The checked model: names resolved, definitions expanded, every expression a node of one graph.

mod amplitude;
mod context;
mod declaration;
mod formula;
mod import;
mod mistake;
mod parameter;
mod resolve;
mod scope;
mod statement;
mod switch;

pub use landau_contract::End;
pub use resolve::resolve;

use crate::diagnostic::Location;
use crate::graph::{Graph, Id, Notation, Printer};

/// A model whose form has been checked as far as names go.
pub struct Model {
    pub name: String,
    pub title: String,
    pub graph: Graph,
    /// Name of the periodic coordinate.
    pub periodic: String,
    pub interval: Option<Interval>,
    pub parameters: Vec<Parameter>,
    pub fields: Vec<Field>,
    pub laws: Vec<Law>,
    pub balances: Vec<Balance>,
    pub base: Base,
    pub boundary: Vec<Condition>,
    pub mean: Vec<Closure>,
    pub amplitude: Amplitude,
    pub outputs: Vec<Output>,
    /// Where the model does what it is there for.
    pub typical: Option<Typical>,
    /// The text of every file that was read; the spec first.
    pub sources: Vec<crate::diagnostic::SourceFile>,
    /// What its names stand for, for formulas that are read later; without the graph.
    names: scope::Names,
}

impl Model {
    pub fn field_names(&self) -> Vec<String> {
        self.fields.iter().map(|f| f.name.clone()).collect()
    }

    /// The names that its expressions are printed with.
    pub fn lettering(&self) -> Lettering {
        Lettering {
            fields: self.field_names(),
            parameters: self.parameters.iter().map(|p| p.name.clone()).collect(),
            laws: self.laws.iter().map(|l| l.name.clone()).collect(),
            periodic: self.periodic.clone(),
            coordinate: self.coordinate().to_owned(),
        }
    }

    /// Name of the cross-stream coordinate.
    pub fn coordinate(&self) -> &str {
        self.interval.as_ref().map_or("y", |i| i.name.as_str())
    }
}

/// Names of fields, parameters, laws and the coordinates.
pub struct Lettering {
    pub fields: Vec<String>,
    parameters: Vec<String>,
    laws: Vec<String>,
    periodic: String,
    coordinate: String,
}

impl Lettering {
    /// A printer of expressions of `graph`.
    pub fn printer<'a>(&'a self, graph: &'a Graph, notation: &'a dyn Notation) -> Printer<'a> {
        Printer {
            graph,
            fields: &self.fields,
            parameters: &self.parameters,
            laws: &self.laws,
            periodic: &self.periodic,
            coordinate: &self.coordinate,
            notation,
        }
    }
}

/// A wavenumber that shows what a model is about, and the eigenvalue that its mode is near to.
#[derive(Clone, Copy, Debug)]
pub struct Typical {
    pub k: f64,
    pub near: Option<[f64; 2]>,
}

/// The cross-stream coordinate.
pub struct Interval {
    pub name: String,
    pub lower: Id,
    pub upper: Id,
    /// The ends as the user wrote them.
    pub written: [String; 2],
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

#[derive(Clone)]
pub struct Parameter {
    pub name: String,
    pub doc: String,
    pub default: f64,
    pub lower: f64,
    pub upper: f64,
    /// Names of the values of a switch; empty for a number.
    pub choices: Vec<String>,
    pub location: Location,
}

pub struct Field {
    pub name: String,
    pub doc: String,
    /// Where the base state must lie.
    pub lower: f64,
    pub upper: f64,
    /// An unknown number, constant in x and y, rather than a profile.
    pub uniform: bool,
    pub location: Location,
}

/// An opaque function of the fields, the coordinate and the parameters.
pub struct Law {
    pub name: String,
    pub doc: String,
    pub body: Id,
}

/// left − right of a balance, divided (if asked) by a base-state quantity.
pub struct Balance {
    pub name: String,
    pub doc: String,
    /// In terms of the full state, derivatives not yet carried out.
    pub residual: Id,
    pub divisor: Option<Id>,
    pub paired_field: Option<usize>,
    pub location: Location,
}

/// left − right of a condition at one end.
#[derive(Clone)]
pub struct Condition {
    pub end: End,
    pub residual: Id,
    /// Switches and the choices under which the condition holds.
    pub guard: Vec<(usize, usize)>,
    pub location: Location,
}

/// ∫ integrand dy = value.
#[derive(Clone)]
pub struct Integral {
    pub integrand: Id,
    pub value: Id,
    pub location: Location,
}

pub struct Base {
    /// Closed form of each field, where the spec gives one.
    pub closed: Vec<Option<Id>>,
    pub guesses: Vec<Option<Id>>,
    pub conditions: Vec<Condition>,
    pub integrals: Vec<Integral>,
    /// Conditions that determine a parameter set to `auto`.
    pub automatic: Vec<(usize, Condition)>,
    pub location: Location,
}

/// What closes the problem at k = 0.
#[derive(Clone)]
pub enum Closure {
    Conserved { integrand: Id, location: Location },
    Gauge { field: usize, location: Location },
    Unknown { field: usize, integral: Integral },
}

pub enum Amplitude {
    /// ∫ Σ weight |field|² = value
    Integral {
        weights: Vec<Weight>,
        value: Id,
        written: String,
    },
    /// |field| = |value| at a place
    Point {
        field: usize,
        place: Option<Id>,
        value: Id,
        /// Place and value as the user wrote them.
        written: [String; 2],
    },
}

/// weight |field|², the weight also as the user wrote it; nothing for 1.
pub struct Weight {
    pub field: usize,
    pub weight: Id,
    pub written: String,
}

pub struct Output {
    pub name: String,
    pub doc: String,
    /// `None` for an integral over the interval.
    pub place: Option<Id>,
    pub body: Id,
    pub location: Location,
}
