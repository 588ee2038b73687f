//! The derived side of a comparison: for every subject, one expression.

use super::{Formula, Subject};
use crate::derive::{Case, Derivation};
use crate::diagnostic::{Diagnostic, Diagnostics, Location, SourceFile, nearest};
use crate::form::Form;
use crate::graph::{BalanceId, FieldId, Graph, Id, Jet, ParameterId, Rational, Table};
use crate::model::End;
use landau_contract::Id as Position;
use num_traits::One;

/// The values of parameters, and the branches of switches, that a formula is read for.
pub(super) type Setting = Vec<(ParameterId, Value)>;

#[derive(Clone, Debug)]
pub(super) enum Value {
    Number(Rational),
    Choice(usize),
}

/// The derived side of a formula, as a node of the derivation's graph.
pub(super) fn subject(
    derivation: &mut Derivation,
    formula: &Formula,
    setting: &Setting,
) -> Result<Id, Diagnostics> {
    let lookup = Lookup {
        derivation,
        formula,
        setting,
    };
    let form = match &formula.subject {
        Subject::Balance(name) => return lookup.balance_residual(name),
        Subject::Law(name) => return lookup.law(name),
        Subject::Base(name) => return lookup.base_residual(name),
        Subject::Linear(balance, field) => lookup.linear(balance, field)?,
        Subject::Adjoint(row, column) => lookup.adjoint(row, column)?,
        Subject::Nonlinear(degree, balance) => lookup.nonlinear(*degree, balance)?,
        Subject::Condition(end, field) => lookup.condition(*end, field)?,
        Subject::AdjointCondition(end, field) => lookup.adjoint_condition(*end, field)?,
    };
    Ok(expression(&mut derivation.graph, &form))
}

/// Finds what a formula is about among everything that was derived.
struct Lookup<'a> {
    derivation: &'a Derivation,
    formula: &'a Formula,
    setting: &'a Setting,
}

impl Lookup<'_> {
    fn balance_residual(&self, name: &str) -> Result<Id, Diagnostics> {
        Ok(self.derivation.model.balances[self.balance(name)?].residual)
    }

    fn law(&self, name: &str) -> Result<Id, Diagnostics> {
        let laws = &self.derivation.model.laws;
        let law = named(self.formula, "law", name, &laws.map(|l| l.name.clone()))?;
        Ok(laws[law].body)
    }

    fn base_residual(&self, name: &str) -> Result<Id, Diagnostics> {
        let balance = self.balance(name)?;
        let rows = &self.derivation.operators.base;
        let row = rows.iter().find(|row| row.balance == balance);
        row.map(|row| row.residual)
            .ok_or_else(|| absent(self.formula, "base-state balance", name, &[]))
    }

    /// L of a balance, acting on a field.
    fn linear(&self, balance: &str, field: &str) -> Result<Form, Diagnostics> {
        let (balance, field) = (self.balance(balance)?, self.field(field)?);
        let linear = self.derivation.operators.linear.iter();
        let entry = linear.filter(|t| t.row == balance && t.jet.of == field && t.jet.t == 0);
        let terms = entry.map(|t| (vec![t.jet], t.coefficient)).collect();
        Ok(Form { terms })
    }

    /// L† in the row of a field, acting on the adjoint of the field `column`.
    fn adjoint(&self, row: &str, column: &str) -> Result<Form, Diagnostics> {
        let (row, column) = (self.field(row)?, self.paired_balance(column)?);
        let adjoint = self.derivation.operators.adjoint.iter();
        let entry = adjoint.filter(|t| t.row == row && t.jet.of == column && t.jet.t == 0);
        let terms = entry
            .map(|t| (vec![self.in_fields(t.jet)], t.coefficient))
            .collect();
        Ok(Form { terms })
    }

    /// N of a degree in a balance.
    fn nonlinear(&self, degree: usize, balance: &str) -> Result<Form, Diagnostics> {
        let balance = self.balance(balance)?;
        let operators = &self.derivation.operators;
        if !(2..=operators.order).contains(&degree) {
            let degree = degree.to_string();
            return Err(absent(self.formula, "operator of degree", &degree, &[]));
        }
        Ok(operators.nonlinear[degree - 2][balance].clone())
    }

    fn condition(&self, end: End, name: &str) -> Result<Form, Diagnostics> {
        let (case, field) = (self.case()?, self.field(name)?);
        let mut conditions = case.conditions.iter();
        let condition = conditions.find(|c| c.end == end && c.about() == Some(field));
        condition
            .map(|condition| condition.form.clone())
            .ok_or_else(|| absent(self.formula, "condition at this end on", name, &[]))
    }

    fn adjoint_condition(&self, end: End, name: &str) -> Result<Form, Diagnostics> {
        let (case, row) = (self.case()?, self.paired_balance(name)?);
        let mut conditions = case.adjoint.as_deref().unwrap_or_default().iter();
        let condition = conditions.find(|c| c.end == end && c.balance == row);
        let condition = condition
            .ok_or_else(|| absent(self.formula, "adjoint condition at this end on", name, &[]))?;
        let mut form = Form::default();
        for (jet, symbol) in &condition.combination {
            for (&(x, absx), &coefficient) in symbol {
                let jet = self.in_fields(Jet { x, absx, ..*jet });
                form.terms.insert(vec![jet], coefficient);
            }
        }
        Ok(form)
    }

    fn balance(&self, name: &str) -> Result<BalanceId, Diagnostics> {
        let names = self.derivation.model.balances.map(|b| b.name.clone());
        named(self.formula, "balance", name, &names)
    }

    fn field(&self, name: &str) -> Result<FieldId, Diagnostics> {
        let names = self.derivation.model.field_names();
        named(self.formula, "field", name, &names)
    }

    /// The balance whose adjoint field goes with the field of this name.
    fn paired_balance(&self, name: &str) -> Result<BalanceId, Diagnostics> {
        let field = self.field(name)?;
        let pairing = &self.derivation.operators.pairing;
        pairing.position(|&f| f == field).ok_or_else(|| {
            let names = self.derivation.model.field_names();
            absent(self.formula, "balance paired with", name, &names)
        })
    }

    /// An adjoint jet belongs to a balance; formulas name it by the field that the balance is paired with.
    fn in_fields(&self, jet: Jet<BalanceId>) -> Jet {
        jet.about(self.derivation.operators.pairing[jet.of])
    }

    /// The case of the switches that the formula is set in. A switch that it does not set keeps its default choice.
    fn case(&self) -> Result<&Case, Diagnostics> {
        let operators = &self.derivation.operators;
        let chosen = |&switch: &ParameterId| {
            let choice = self
                .setting
                .iter()
                .find_map(|(parameter, value)| match value {
                    Value::Choice(choice) if *parameter == switch => Some(*choice),
                    _ => None,
                });
            choice.unwrap_or(self.derivation.model.parameters[switch].default as usize)
        };
        let choices: Vec<usize> = operators.switches.iter().map(chosen).collect();
        let case = operators.cases.iter().find(|c| c.choices == choices);
        case.ok_or_else(|| absent(self.formula, "case of", "these switches", &[]))
    }
}

/// The position of a name in a list of the model.
fn named<I: Position>(
    formula: &Formula,
    what: &str,
    name: &str,
    names: &Table<I, String>,
) -> Result<I, Diagnostics> {
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

/// The parameters that a formula sets, with their values.
pub(super) fn setting(
    derivation: &mut Derivation,
    formula: &Formula,
) -> Result<Setting, Diagnostics> {
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

/// The mistake of a formula about something that the model does not have.
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
