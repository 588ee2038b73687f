//! Parameters by name, with default and domain, and the values of constant expressions.

use super::Parameter;
use super::context::Context;
use super::mistake::twice;
use super::scope::{Names, Resolved, View};
use crate::diagnostic::{Diagnostic, Location, nearest};
use crate::graph::{Id, Node, ParameterId};
use crate::syntax::tree::*;
use landau_contract::{apply, choose};
use num_traits::ToPrimitive;
use std::collections::HashMap;

impl Names<'_> {
    /// The parameter of this name, if `scope` sees it. Parameters of law files become parameters of the model when they
    /// are first used.
    pub fn find_parameter(&mut self, name: &str, scope: usize) -> Option<ParameterId> {
        if let Some(id) = self.parameters.position(|p| p.name == name) {
            let visible = scope == 0 || self.scopes[scope].parameters.contains_key(name);
            return visible.then_some(id);
        }
        let item = self.scopes[scope].parameters.get(name).cloned()?;
        let parameter = self.parameter(&item).ok()?;
        self.used.push(true);
        Some(self.parameters.push(parameter))
    }

    /// The rational value of an expression in numbers alone.
    pub fn constant(&mut self, expression: &Expression) -> Resolved<f64> {
        let id = self.expression(
            expression,
            &View {
                scope: 0,
                context: Context::Constant,
                arguments: &[],
            },
        );
        let id = id?;
        self.numeric(id).filter(|v| v.is_finite()).ok_or_else(|| {
            Diagnostic::new(
                expression.location.clone(),
                "this is not a number",
                "a number",
            )
        })
    }

    /// The value of an expression of numbers.
    fn numeric(&self, id: Id) -> Option<f64> {
        self.value(id, &|_| None)
    }

    /// The value of an expression of numbers and parameters, each parameter at its default.
    pub fn default_value(&self, id: Id) -> Option<f64> {
        self.value(id, &|parameter| Some(self.parameters[parameter].default))
    }

    fn value(&self, id: Id, parameter: &dyn Fn(ParameterId) -> Option<f64>) -> Option<f64> {
        let mut values: HashMap<Id, f64> = HashMap::new();
        for node in self.graph.topological(&[id]) {
            let value = match self.graph.node(node) {
                Node::Number(value) => value.to_f64()?,
                Node::Pi => std::f64::consts::PI,
                Node::Sum(constant, terms) => {
                    terms.iter().try_fold(constant.to_f64()?, |sum, (t, c)| {
                        Some(sum + values[t] * c.to_f64()?)
                    })?
                }
                Node::Product(factors) => factors.iter().try_fold(1.0, |product, (b, e)| {
                    Some(product * values[b].powf(e.to_f64()?))
                })?,
                Node::Parameter(id) => parameter(*id)?,
                Node::Call(function, argument) => apply(*function, values[argument]),
                Node::Select(switch, branches) => {
                    let branches: Vec<f64> = branches.iter().map(|b| values[b]).collect();
                    choose(parameter(*switch)?, &branches)
                }
                _ => return None,
            };
            values.insert(node, value);
        }
        values.get(&id).copied()
    }

    /// The parameter that an item declares.
    pub fn parameter(&mut self, item: &ParameterItem) -> Resolved<Parameter> {
        let domain = self.domain(&item.domain)?;
        let default = self.default_of(item, &domain.choices)?;
        let Domain {
            lower,
            upper,
            choices,
        } = domain;
        if !(lower..=upper).contains(&default) {
            let message = format!("the default {default} lies outside {lower}..{upper}");
            return Err(Diagnostic::new(
                item.name.location.clone(),
                message,
                format!("a default in {lower}..{upper}"),
            ));
        }
        if let Some(place) = &item.whole {
            whole_number(place, default, &choices)?;
        }
        Ok(Parameter {
            name: item.name.text.clone(),
            doc: item.doc.clone(),
            default,
            lower,
            upper,
            choices,
            whole: item.whole.is_some(),
            location: item.name.location.clone(),
        })
    }

    fn domain(&mut self, domain: &ParameterDomain) -> Resolved<Domain> {
        let (mut lower, mut upper, mut choices) = (f64::NEG_INFINITY, f64::INFINITY, Vec::new());
        match domain {
            ParameterDomain::Any => {}
            ParameterDomain::Range(from, to) => {
                lower = from.as_ref().map_or(Ok(lower), |e| self.constant(e))?;
                upper = to.as_ref().map_or(Ok(upper), |e| self.constant(e))?;
            }
            ParameterDomain::Choices(names) => {
                for (position, name) in names.iter().enumerate() {
                    if names[..position].iter().any(|n| n.text == name.text) {
                        return Err(twice(name));
                    }
                }
                choices = names.iter().map(|n| n.text.clone()).collect();
                (lower, upper) = (0.0, choices.len() as f64 - 1.0);
            }
        }
        Ok(Domain {
            lower,
            upper,
            choices,
        })
    }

    /// The default value of a number, or the position of the default choice.
    fn default_of(&mut self, item: &ParameterItem, choices: &[String]) -> Resolved<f64> {
        match &item.default {
            Some(ParameterDefault::Value(value)) => self.constant(value),
            Some(ParameterDefault::Choice(choice)) => {
                let position = choices.iter().position(|c| *c == choice.text);
                position.map(|position| position as f64).ok_or_else(|| {
                    let message = format!("`{}` is not one of the choices", choice.text);
                    let near = nearest(&choice.text, choices.iter().map(String::as_str));
                    let expected = format!("one of {}", choices.join(", "));
                    Diagnostic::new(choice.location.clone(), message, expected)
                        .maybe_hint(near.map(|n| format!("did you mean `{n}`?")))
                })
            }
            None => {
                let message = format!("the parameter `{}` has no default value", item.name.text);
                Err(Diagnostic::new(
                    item.name.location.clone(),
                    message,
                    format!("`{} = value`", item.name.text),
                ))
            }
        }
    }
}

/// The values that a parameter may take: an interval, or positions in a list of choices.
struct Domain {
    lower: f64,
    upper: f64,
    /// Empty for a number.
    choices: Vec<String>,
}

/// Checks `whole`: it stands beside a number, whose default has no fraction.
fn whole_number(place: &Location, default: f64, choices: &[String]) -> Resolved<()> {
    let refuse = |message: String, expected: &str| {
        let mistake = Diagnostic::new(place.clone(), message, expected);
        Err(mistake)
    };
    if !choices.is_empty() {
        return refuse(
            "a switch has choices, not numbers".into(),
            "no `whole` here",
        );
    }
    if default.fract() != 0.0 {
        let message = format!("the default {default} is no whole number");
        return refuse(message, "a default without a fraction");
    }
    Ok(())
}
