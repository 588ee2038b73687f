//! What was derived, as one expression a subject.

use super::{Formula, Subject};
use crate::derive::{Case, Derivation};
use crate::diagnostic::{Diagnostic, Diagnostics, Location, SourceFile, nearest};
use crate::form::Form;
use crate::graph::{BalanceId, FieldId, Graph, Id, Jet, ParameterId, Rational, Table};
use landau_contract::Id as Position;
use num_traits::One;

type Found<T> = Result<T, Diagnostics>;

/// The values of parameters, and the branches of switches, that a formula is read for.
pub(super) type Setting = Vec<(ParameterId, Value)>;

#[derive(Clone, Debug)]
pub(super) enum Value {
    Number(Rational),
    Choice(usize),
}

/// The derived side of a formula.
pub(super) fn subject(
    derivation: &mut Derivation,
    formula: &Formula,
    setting: &Setting,
) -> Found<Id> {
    let model = &derivation.model;
    let balances = model.balances.map(|b| b.name.clone());
    let laws = model.laws.map(|l| l.name.clone());
    let fields = model.field_names();
    let balance = |name: &str| named(formula, "balance", name, &balances);
    let field = |name: &str| named(formula, "field", name, &fields);
    let paired = |name: &str| {
        let field = field(name)?;
        let row = derivation.operators.pairing.position(|&f| f == field);
        row.ok_or_else(|| absent(formula, "balance paired with", name, &fields))
    };
    let operators = &derivation.operators;
    let form = match &formula.subject {
        Subject::Balance(name) => return Ok(model.balances[balance(name)?].residual),
        Subject::Law(name) => return Ok(model.laws[named(formula, "law", name, &laws)?].body),
        Subject::Base(name) => {
            let balance = balance(name)?;
            let row = operators.base.iter().find(|row| row.balance == balance);
            let row = row.ok_or_else(|| absent(formula, "base-state balance", name, &[]))?;
            return Ok(row.residual);
        }
        Subject::Linear(row, column) => {
            let (row, column) = (balance(row)?, field(column)?);
            let terms = operators.linear.iter().filter(|t| t.row == row);
            let terms = terms.filter(|t| t.jet.of == column && t.jet.t == 0);
            terms.map(|t| (vec![t.jet], t.coefficient)).collect()
        }
        Subject::Adjoint(row, column) => {
            let (row, column) = (field(row)?, paired(column)?);
            let terms = operators.adjoint.iter().filter(|t| t.row == row);
            let terms = terms.filter(|t| t.jet.of == column && t.jet.t == 0);
            let in_fields = |jet| in_fields(&operators.pairing, jet);
            terms
                .map(|t| (vec![in_fields(t.jet)], t.coefficient))
                .collect()
        }
        Subject::Nonlinear(degree, row) => {
            let row = balance(row)?;
            let degrees = 2..=operators.order;
            if !degrees.contains(degree) {
                return Err(absent(
                    formula,
                    "operator of degree",
                    &degree.to_string(),
                    &[],
                ));
            }
            operators.nonlinear[degree - 2][row].terms.clone()
        }
        Subject::Condition(end, name) => {
            let (case, field) = (case(derivation, formula, setting)?, field(name)?);
            let mut all = case.conditions.iter();
            let found = all.find(|c| c.end == *end && c.about() == Some(field));
            let found =
                found.ok_or_else(|| absent(formula, "condition at this end on", name, &[]))?;
            found.form.terms.clone()
        }
        Subject::AdjointCondition(end, name) => {
            let (case, row) = (case(derivation, formula, setting)?, paired(name)?);
            let all = case.adjoint.as_deref().unwrap_or_default();
            let mut all = all.iter();
            let found = all.find(|c| c.end == *end && c.balance == row);
            let found = found
                .ok_or_else(|| absent(formula, "adjoint condition at this end on", name, &[]))?;
            let mut form = Form::default();
            for (jet, symbol) in &found.combination {
                for (&(x, absx), &coefficient) in symbol {
                    let jet = in_fields(&operators.pairing, Jet { x, absx, ..*jet });
                    form.terms.insert(vec![jet], coefficient);
                }
            }
            form.terms
        }
    };
    let form = Form { terms: form };
    Ok(expression(&mut derivation.graph, &form))
}

/// An adjoint jet is of a balance; here it is named by the field that its balance goes with.
fn in_fields(pairing: &Table<BalanceId, FieldId>, jet: Jet<BalanceId>) -> Jet {
    jet.about(pairing[jet.of])
}

/// Something of the model by name.
fn named<I: Position>(
    formula: &Formula,
    what: &str,
    name: &str,
    names: &Table<I, String>,
) -> Found<I> {
    let position = names.position(|n| n == name);
    position.ok_or_else(|| absent(formula, what, name, names))
}

/// Σ coefficient · Π jets.
fn expression(graph: &mut Graph, form: &Form) -> Id {
    let mut parts = Vec::new();
    for (monomial, &coefficient) in &form.terms {
        let mut factors = vec![(coefficient, Rational::one())];
        factors.extend(
            monomial
                .iter()
                .map(|&jet| (graph.jet(jet), Rational::one())),
        );
        parts.push((graph.product(factors), Rational::one()));
    }
    graph.sum(parts)
}

/// The case of the switches that the formula is set in: the default choices where it says nothing.
fn case<'d>(derivation: &'d Derivation, formula: &Formula, setting: &Setting) -> Found<&'d Case> {
    let operators = &derivation.operators;
    let chosen = |switch: ParameterId| {
        let set = setting.iter().find_map(|(parameter, value)| match value {
            Value::Choice(choice) if *parameter == switch => Some(*choice),
            _ => None,
        });
        set.unwrap_or(derivation.model.parameters[switch].default as usize)
    };
    let wanted: Vec<usize> = operators.switches.iter().map(|&s| chosen(s)).collect();
    let case = operators.cases.iter().find(|c| c.choices == wanted);
    case.ok_or_else(|| absent(formula, "case of", "these switches", &[]))
}

/// The parameters that a formula is set in.
pub(super) fn setting(derivation: &mut Derivation, formula: &Formula) -> Found<Setting> {
    let names = derivation.model.parameters.map(|p| p.name.clone());
    let mut setting = Setting::new();
    for (name, text) in &formula.setting {
        let parameter = named(formula, "parameter", name, &names)?;
        let choices = derivation.model.parameters[parameter].choices.clone();
        let value = match choices.iter().position(|choice| choice == text) {
            Some(choice) => Value::Choice(choice),
            None => {
                let what = format!("value of `{name}`");
                let number = number(derivation, text).filter(|_| choices.is_empty());
                Value::Number(number.ok_or_else(|| absent(formula, &what, text, &choices))?)
            }
        };
        setting.push((parameter, value));
    }
    Ok(setting)
}

/// The rational that a text such as 0.9 or 1/3 stands for.
fn number(derivation: &mut Derivation, text: &str) -> Option<Rational> {
    let source = SourceFile {
        path: String::new(),
        text: text.to_owned(),
    };
    let id = derivation
        .model
        .read(&mut derivation.graph, &source, &[])
        .ok()?;
    derivation.graph.as_number(id).cloned()
}

/// A subject that the model does not have.
fn absent(formula: &Formula, what: &str, name: &str, candidates: &[String]) -> Diagnostics {
    let place = Location {
        file: 0,
        range: 0..0,
    };
    let expected = match candidates {
        [] => "another subject".to_owned(),
        names => format!("one of {}", names.join(", ")),
    };
    let near = nearest(name, candidates.iter().map(String::as_str));
    let message = format!("this formula is about a {what} `{name}`, which there is none of");
    let mistake = Diagnostic::new(place, message, expected)
        .maybe_hint(near.map(|n| format!("did you mean `{n}`?")));
    Diagnostics {
        files: vec![formula.source.clone()],
        list: vec![mistake],
    }
}
