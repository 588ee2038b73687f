//! A printed formula against the derivation: term by term, exactly.
//!
//! Both sides become polynomials in the fields' derivatives; a term is a product of these, and it
//! agrees when the difference of the two coefficients vanishes identically, laws left opaque and
//! total derivatives such as p⁰_y opened by the chain rule.

mod derived;
mod latex;
mod terms;

pub use latex::symbols;

use crate::derive::Derivation;
use crate::diagnostic::{Diagnostic, Diagnostics, Location, SourceFile};
use crate::form::{Form, Monomial};
use crate::graph::{Graph, Id, Node, Rational};
use crate::model::End;
use latex::{Letters, Vocabulary};
use num_traits::One;
use std::collections::BTreeSet;

/// What a printed formula is about. Balances, fields and laws by name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Subject {
    /// A balance in the full state.
    Balance(String),
    /// A constitutive law; its fields are the arguments.
    Law(String),
    /// A balance of the base state.
    Base(String),
    /// The entry of L in this balance, acting on this field.
    Linear(String, String),
    /// The entry of L† in the row of the first field, acting on the adjoint of the second.
    Adjoint(String, String),
    /// N of this degree in a balance.
    Nonlinear(usize, String),
    /// The condition on a field at an end.
    Condition(End, String),
    /// The condition on the adjoint of a field at an end.
    AdjointCondition(End, String),
}

impl Subject {
    /// Whether the formula is an equation to zero, which may be multiplied by any factor.
    pub(crate) fn is_equation(&self) -> bool {
        matches!(
            self,
            Subject::Balance(_)
                | Subject::Base(_)
                | Subject::Condition(..)
                | Subject::AdjointCondition(..)
        )
    }
}

/// What a printed formula is written in.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Language {
    /// The notation of the spec; n0, p0_nT are base values, u a perturbation.
    Spec,
    /// LaTeX as the source has it.
    Latex,
}

/// What printed formulas share.
#[derive(Clone, Default, Debug)]
pub struct Notation {
    /// Abbreviations, in order: name, and text in the notation of the spec.
    pub abbreviations: Vec<(String, String)>,
    /// Vectors by letter, their components along the periodic and the cross-stream coordinate.
    pub vectors: Vec<(String, [String; 2])>,
}

/// A printed formula.
#[derive(Clone, Debug)]
pub struct Formula {
    /// What it is a formula of.
    pub subject: Subject,
    /// Its number, and its text.
    pub source: SourceFile,
    /// What the text is written in.
    pub language: Language,
    /// Parameters that the formula has no letter for, with their values or choices.
    pub setting: Vec<(String, String)>,
}

/// One term that is not the same.
#[derive(Clone, Debug)]
pub struct Difference {
    /// Which term.
    pub monomial: Monomial,
    /// Its printed coefficient.
    pub printed: Option<Id>,
    /// Its derived coefficient.
    pub derived: Option<Id>,
}

/// A printed formula beside the derivation.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// Terms that one of the two has.
    pub terms: usize,
    /// Terms that differ.
    pub differences: Vec<Difference>,
    /// Brackets of the printed formula that are never closed.
    pub unclosed: usize,
    /// What was derived, as one expression.
    pub subject: Id,
    /// The same as a polynomial in the fields' derivatives.
    pub derived: Form,
}

impl Comparison {
    /// Whether all terms agree, and all brackets are closed.
    pub fn agrees(&self) -> bool {
        self.differences.is_empty() && self.unclosed == 0
    }
}

/// Compares a printed formula with what was derived.
///
/// # Errors
/// A formula that cannot be read, or a subject that the model does not have.
pub fn compare(
    derivation: &mut Derivation,
    notation: &Notation,
    formula: &Formula,
) -> Result<Comparison, Diagnostics> {
    let (source, unclosed) = match formula.language {
        Language::Spec => (formula.source.clone(), 0),
        Language::Latex => in_spec(derivation, notation, formula)?,
    };
    let printed = printed(derivation, &notation.abbreviations, &source)?;
    let setting = derived::setting(derivation, formula)?;
    let subject = derived::subject(derivation, formula, &setting)?;
    let mut sides = [printed, subject].map(|id| match formula.subject {
        // A law is one term, whatever it is a function of.
        Subject::Law(_) => {
            let id = terms::open_law(derivation, id);
            let id = terms::settle(&mut derivation.graph, id, &setting);
            Form::constant(&derivation.graph, id)
        }
        _ => {
            let id = terms::carry_out(derivation, id);
            let id = terms::settle(&mut derivation.graph, id, &setting);
            Form::polynomial(&mut derivation.graph, id)
        }
    });
    if formula.subject.is_equation() {
        let factor = relative_factor(&mut derivation.graph, &sides[0], &sides[1]);
        sides[0] = sides[0].times(&mut derivation.graph, factor);
    }
    let (terms, differences) = differences(derivation, &sides[0], &sides[1]);
    let [_, derived] = sides;
    Ok(Comparison {
        terms,
        differences,
        unclosed,
        subject,
        derived,
    })
}

/// A formula in LaTeX, in the notation of the spec, and the brackets that it leaves open.
fn in_spec(
    derivation: &Derivation,
    notation: &Notation,
    formula: &Formula,
) -> Result<(SourceFile, usize), Diagnostics> {
    let model = &derivation.model;
    let fields: Vec<String> = model.fields.iter().map(|f| f.name.clone()).collect();
    let laws: Vec<String> = model.laws.iter().map(|l| l.name.clone()).collect();
    let parameters = model.parameters.iter().map(|p| p.name.clone());
    let abbreviations = notation.abbreviations.iter().map(|(name, _)| name.clone());
    let constants: Vec<String> = parameters.chain(abbreviations).collect();
    let (letters, operand) = match &formula.subject {
        Subject::Balance(_) | Subject::Law(_) => (Letters::State, None),
        Subject::Base(_) => (Letters::Base, None),
        Subject::Nonlinear(..) => (Letters::Perturbation, None),
        Subject::Linear(_, field)
        | Subject::Adjoint(_, field)
        | Subject::Condition(_, field)
        | Subject::AdjointCondition(_, field) => (Letters::Perturbation, Some(field.as_str())),
    };
    let vocabulary = Vocabulary {
        fields: &fields,
        laws: &laws,
        constants: &constants,
        vectors: &notation.vectors,
        coordinates: [&model.periodic, model.coordinate()],
        letters,
        operand,
    };
    let read = latex::read(&formula.source.text, &vocabulary).map_err(|mistake| {
        let (file, range) = (0, mistake.range);
        let place = Location { file, range };
        Diagnostics {
            files: vec![formula.source.clone()],
            list: vec![Diagnostic::new(
                place,
                mistake.message,
                "a formula as papers print it",
            )],
        }
    })?;
    let source = SourceFile {
        path: format!("{}, as it is read", formula.source.path),
        text: read.text,
    };
    Ok((source, read.unclosed))
}

/// The printed text as an expression.
fn printed(
    derivation: &mut Derivation,
    abbreviations: &[(String, String)],
    source: &SourceFile,
) -> Result<Id, Diagnostics> {
    let mut definitions = Vec::new();
    for (name, text) in abbreviations {
        let source = SourceFile {
            path: format!("abbreviation {name}"),
            text: text.clone(),
        };
        let id = derivation
            .model
            .read(&mut derivation.graph, &source, &definitions)?;
        definitions.push((name.clone(), id));
    }
    derivation
        .model
        .read(&mut derivation.graph, source, &definitions)
}

/// The factor between the derived and the printed side of an equation: the ratio of the coefficients of the leading term
/// that both sides have.
fn relative_factor(graph: &mut Graph, printed: &Form, derived: &Form) -> Id {
    let key = |monomial: &&Monomial| {
        let derivatives = monomial.iter().map(|j| (j.y, j.t, j.x)).max();
        (monomial.len() == 1, derivatives)
    };
    let mut shared: Vec<&Monomial> = derived.terms.keys().collect();
    shared.retain(|monomial| printed.terms.contains_key(*monomial));
    match shared.into_iter().max_by_key(key) {
        Some(monomial) => {
            let ratio = graph.div(derived.terms[monomial], printed.terms[monomial]);
            let ratio = graph.collect(ratio);
            // Of expressions without jets only a number or a sign is taken out.
            match (monomial.is_empty(), graph.as_number(ratio)) {
                (true, Some(_)) | (false, _) => ratio,
                (true, None) => sign(graph, derived.terms[monomial], printed.terms[monomial]),
            }
        }
        None => graph.one(),
    }
}

/// The sign by which the second becomes most like the first.
fn sign(graph: &mut Graph, like: Id, of: Id) -> Id {
    let size = |graph: &Graph, id: Id| match graph.node(id) {
        Node::Sum(_, terms) => terms.len(),
        _ => 1,
    };
    let (difference, sum) = (graph.sub(like, of), graph.add(like, of));
    let value = if size(graph, sum) < size(graph, difference) || graph.is_zero(sum) {
        -Rational::one()
    } else {
        Rational::one()
    };
    graph.number(value)
}

/// How many terms either side has, and those that differ.
fn differences(
    derivation: &mut Derivation,
    printed: &Form,
    derived: &Form,
) -> (usize, Vec<Difference>) {
    let monomials: BTreeSet<&Monomial> = printed.terms.keys().chain(derived.terms.keys()).collect();
    let mut differences = Vec::new();
    let (mut terms, zero) = (0, derivation.graph.zero());
    for monomial in monomials {
        let [left, right] = [printed, derived].map(|side| {
            let coefficient = side.terms.get(monomial).copied()?;
            let opened = terms::open_chain(derivation, coefficient);
            (!derivation.graph.vanishes(opened)).then_some((coefficient, opened))
        });
        if left.is_none() && right.is_none() {
            continue;
        }
        terms += 1;
        let opened = |side: Option<(Id, Id)>| side.map_or(zero, |(_, opened)| opened);
        let graph = &mut derivation.graph;
        let difference = graph.sub(opened(left), opened(right));
        if !graph.vanishes(difference) {
            let mut shown =
                |side: Option<(Id, Id)>| side.map(|(written, _)| graph.collect(written));
            differences.push(Difference {
                monomial: monomial.clone(),
                printed: shown(left),
                derived: shown(right),
            });
        }
    }
    (terms, differences)
}
