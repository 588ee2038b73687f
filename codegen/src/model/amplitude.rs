//! The normalisation: an integral of squared moduli, or a point value.

use super::context::Context;
use super::mistake::view;
use super::place::place_inside;
use super::scope::{Names, Resolved, is_two};
use super::statement::field_index;
use super::{Amplitude, Balance, Closure, Field, Interval, Law, Weight};
use crate::diagnostic::Diagnostic;
use crate::graph::{BalanceId, FieldId, Graph, Id, LawId, Node, Operator, Table};
use crate::syntax::tree::*;
use std::collections::BTreeSet;

/// The amplitude of a spec without such a block: ∫ Σ |q|² dy = 1 over the profiles. Gauges that no time derivative holds,
/// such as a pressure, are left out, since their size depends on the units of the balances.
pub(super) fn default_amplitude(
    fields: &Table<FieldId, Field>,
    balances: &Table<BalanceId, Balance>,
    mean: &[Closure],
    laws: &Table<LawId, Law>,
    names: &mut Names,
) -> Amplitude {
    let moving = moving_fields(names.graph, balances, laws);
    let is_gauge = |field: &FieldId| {
        let mut closures = mean.iter();
        closures
            .any(|closure| matches!(closure, Closure::Gauge { field: gauge, .. } if gauge == field))
    };
    let one = names.graph.one();
    let profiles = fields.ids().filter(|&f| !fields[f].uniform);
    let counted = profiles.filter(|f| !is_gauge(f) || moving.contains(f));
    let weighted = counted.map(|field| Weight {
        field,
        weight: one,
        written: String::new(),
    });
    Amplitude::Integral {
        weights: weighted.collect(),
        value: one,
        written: "1".into(),
    }
}

/// Fields under a time derivative, including those on which a law there depends.
fn moving_fields(
    graph: &Graph,
    balances: &Table<BalanceId, Balance>,
    laws: &Table<LawId, Law>,
) -> BTreeSet<FieldId> {
    let roots: Vec<Id> = balances.iter().map(|b| b.residual).collect();
    let nodes = graph.topological(&roots).into_iter();
    let mut open: Vec<Id> = nodes
        .filter_map(|node| match graph.node(node) {
            Node::Derivative(Operator::Dt, argument) => Some(*argument),
            _ => None,
        })
        .collect();
    let (mut fields, mut opened) = (BTreeSet::new(), BTreeSet::new());
    while let Some(id) = open.pop() {
        for node in graph.topological(&[id]) {
            match graph.node(node) {
                Node::Jet(jet) => {
                    fields.insert(jet.of);
                }
                Node::StateLaw(atom) if opened.insert(atom.law) => open.push(laws[atom.law].body),
                _ => {}
            }
        }
    }
    fields
}

/// The amplitude block.
pub(super) fn amplitude(
    item: &AmplitudeItem,
    interval: Option<&Interval>,
    names: &mut Names,
) -> Resolved<Amplitude> {
    match item {
        AmplitudeItem::Integral { integrand, value } => {
            let mut weights = Vec::new();
            quadratic(integrand, None, names, &mut weights)?;
            let written = names.written(value);
            let value = names.resolve(value, Context::Amplitude)?;
            Ok(Amplitude::Integral {
                weights,
                value,
                written,
            })
        }
        AmplitudeItem::Point {
            place,
            field,
            value,
        } => {
            let written = [
                place.as_ref().map_or(String::new(), |p| names.written(p)),
                names.written(value),
            ];
            let place = match place {
                Some(place) => Some(place_inside(place, interval, names)?),
                None => None,
            };
            let field = modulus_of(field, names)?;
            let value = names.resolve(value, Context::Amplitude)?;
            Ok(Amplitude::Point {
                field,
                place,
                value,
                written,
            })
        }
    }
}

/// The terms weight · |field|² of a sum.
fn quadratic(
    expression: &Expression,
    weight: Option<(Id, String)>,
    names: &mut Names,
    weights: &mut Vec<Weight>,
) -> Resolved<()> {
    match &expression.kind {
        ExpressionKind::Binary(Binary::Add, left, right) => {
            quadratic(left, weight.clone(), names, weights)?;
            quadratic(right, weight, names, weights)
        }
        ExpressionKind::Binary(Binary::Multiply, left, right) => {
            let (factor, square) = if contains_modulus(right) {
                (left, right)
            } else {
                (right, left)
            };
            let text = names.written(factor);
            let factor = names.expression(factor, &view(Context::Profile))?;
            let weight = match weight {
                Some((weight, before)) => {
                    (names.graph.mul(weight, factor), format!("{before} {text}"))
                }
                None => (factor, text),
            };
            quadratic(square, Some(weight), names, weights)
        }
        ExpressionKind::Binary(Binary::Power, base, exponent) if matches!(&exponent.kind, ExpressionKind::Number(two) if is_two(two)) =>
        {
            let field = modulus_of(base, names)?;
            let one = names.graph.one();
            let (weight, written) = weight.unwrap_or((one, String::new()));
            weights.push(Weight {
                field,
                weight,
                written,
            });
            Ok(())
        }
        _ => Err(Diagnostic::new(
            expression.location.clone(),
            "the amplitude is a sum of squared moduli",
            "`weight*|field|^2`",
        )),
    }
}

fn contains_modulus(expression: &Expression) -> bool {
    match &expression.kind {
        ExpressionKind::Modulus(_) => true,
        ExpressionKind::Binary(_, a, b) => contains_modulus(a) || contains_modulus(b),
        ExpressionKind::Negative(inner) => contains_modulus(inner),
        _ => false,
    }
}

fn modulus_of(expression: &Expression, names: &mut Names) -> Resolved<FieldId> {
    match &expression.kind {
        ExpressionKind::Modulus(inner) => modulus_of(inner, names),
        ExpressionKind::Name(text) => {
            let name = Name {
                text: text.clone(),
                location: expression.location.clone(),
            };
            field_index(&name, names)
        }
        _ => Err(Diagnostic::new(
            expression.location.clone(),
            "the amplitude measures fields",
            "`|field|` or the name of a field",
        )),
    }
}
