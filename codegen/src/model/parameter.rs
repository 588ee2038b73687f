//! Parameters: found by name, declared with default and domain, and constants.

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

impl Names {
    /// A parameter seen from a scope; a law file's own are registered on first use.
    pub fn find_parameter(&mut self, name: &str, scope: usize) -> Option<ParameterId> {
        if let Some(id) = self.parameters.position(|p| p.name == name) {
            let visible = scope == 0 || self.scopes[scope].parameters.contains_key(name);
            return visible.then_some(id);
        }
        let item = self.scopes[scope].parameters.get(name).cloned()?;
        let parameter = self.constant_parameter(&item)?;
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

    fn constant_parameter(&mut self, item: &ParameterItem) -> Option<Parameter> {
        self.parameter(item).ok()
    }

    /// A declared parameter.
    pub fn parameter(&mut self, item: &ParameterItem) -> Resolved<Parameter> {
        let (mut lower, mut upper, mut choices) = (f64::NEG_INFINITY, f64::INFINITY, Vec::new());
        match &item.domain {
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
                upper = choices.len() as f64 - 1.0;
                lower = 0.0;
            }
        }
        let default = match &item.default {
            Some(ParameterDefault::Value(value)) => self.constant(value)?,
            Some(ParameterDefault::Choice(choice)) => {
                match choices.iter().position(|c| *c == choice.text) {
                    Some(position) => position as f64,
                    None => {
                        let message = format!("`{}` is not one of the choices", choice.text);
                        let near = nearest(&choice.text, choices.iter().map(String::as_str));
                        return Err(Diagnostic::new(
                            choice.location.clone(),
                            message,
                            format!("one of {}", choices.join(", ")),
                        )
                        .maybe_hint(near.map(|n| format!("did you mean `{n}`?"))));
                    }
                }
            }
            None => {
                let message = format!("the parameter `{}` has no default value", item.name.text);
                return Err(Diagnostic::new(
                    item.name.location.clone(),
                    message,
                    format!("`{} = value`", item.name.text),
                ));
            }
        };
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
        let (name, doc) = (item.name.text.clone(), item.doc.clone());
        Ok(Parameter {
            name,
            doc,
            default,
            lower,
            upper,
            choices,
            whole: item.whole.is_some(),
            location: item.name.location.clone(),
        })
    }
}

/// Refuses `whole` beside choices, and a default that is no whole number.
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
