//! Rewriting both sides of a comparison into the same terms.

use super::derived::{Setting, Value};
use crate::derive::{self, Dependence, Derivation, Opener, base_value};
use crate::graph::{FieldId, Graph, Id, LawAtom, LawId, Node, ParameterId, Table, Variable};
use crate::model::Law;
use std::collections::HashMap;

/// Parameters replaced by their values, switches by the branch that they choose.
pub(super) fn settle(graph: &mut Graph, id: Id, setting: &Setting) -> Id {
    graph.substitute(id, &mut |graph, node| match node {
        Node::Parameter(index) => match value(setting, *index)? {
            Value::Number(number) => Some(graph.number(number.clone())),
            Value::Choice(_) => None,
        },
        Node::Select(switch, branches) => match value(setting, *switch)? {
            Value::Choice(choice) => Some(settle(graph, branches[*choice], setting)),
            Value::Number(_) => None,
        },
        _ => None,
    })
}

fn value(setting: &Setting, parameter: ParameterId) -> Option<&Value> {
    let entry = setting.iter().find(|(index, _)| *index == parameter);
    entry.map(|(_, value)| value)
}

/// The formula of a law, opened down to fields and parameters.
pub(super) fn open_law(derivation: &mut Derivation, id: Id) -> Id {
    let model = &derivation.model;
    let uniform = model.fields.map(|f| f.uniform);
    Opener::new(&model.laws, &model.base.closed, &uniform).at_state(&mut derivation.graph, id)
}

/// Carries out derivatives, puts in the base fields that have a closed form, and drops the derivatives of laws by
/// fields that they do not depend on.
pub(super) fn carry_out(derivation: &mut Derivation, id: Id) -> Id {
    let model = &derivation.model;
    let (laws, closed) = (&model.laws, &model.base.closed);
    let uniform = model.fields.map(|f| f.uniform);
    let graph = &mut derivation.graph;
    let id = derive::carry_out(graph, id, &uniform);
    let depends = derive::dependence(graph, laws, uniform.len());
    let explicit = explicit(graph, laws);
    graph.substitute(id, &mut |graph, node| match node {
        Node::StateLaw(atom) | Node::BaseLaw(atom) if foreign(atom, &depends) => Some(graph.zero()),
        Node::StateLaw(atom) if atom.y > 0 && !explicit[atom.law] => Some(graph.zero()),
        Node::Base(field, order) if closed[*field].is_some() => {
            Some(base_value(graph, closed, *field, *order))
        }
        _ => None,
    })
}

/// Whether a law is differentiated by a field that it does not depend on.
fn foreign(atom: &LawAtom, depends: &Dependence) -> bool {
    let mut index = atom.index.iter().zip(depends[atom.law].iter());
    index.any(|(&order, depends)| order > 0 && !depends)
}

/// Which laws hold the coordinate itself, beside the fields.
fn explicit(graph: &Graph, laws: &Table<LawId, Law>) -> Table<LawId, bool> {
    let mut table: Table<LawId, bool> = Table::default();
    for law in laws {
        let depends = graph.any(law.body, |node| match node {
            Node::Coordinate => true,
            // A law may use those declared before it.
            Node::StateLaw(atom) => table[atom.law],
            _ => false,
        });
        table.push(depends);
    }
    table
}

/// Total derivatives of laws along the base state by the chain rule: p⁰_y = p⁰_n n⁰_y + p⁰_T T⁰_y.
pub(super) fn open_chain(derivation: &mut Derivation, id: Id) -> Id {
    let model = &derivation.model;
    let graph = &mut derivation.graph;
    let depends = derive::dependence(graph, &model.laws, model.fields.len());
    let explicit = explicit(graph, &model.laws);
    let closed = &model.base.closed;
    let mut opened: HashMap<LawAtom, Id> = HashMap::new();
    graph.substitute(id, &mut |graph, node| match node {
        Node::BaseLaw(atom) if atom.y > 0 && !explicit[atom.law] => {
            if let Some(&value) = opened.get(atom) {
                return Some(value);
            }
            let start = LawAtom {
                y: 0,
                ..atom.clone()
            };
            let mut value = graph.base_law(start);
            for _ in 0..atom.y {
                value = along(graph, value, &depends, closed);
            }
            opened.insert(atom.clone(), value);
            Some(value)
        }
        _ => None,
    })
}

/// d/dy of an expression in laws and base fields.
fn along(
    graph: &mut Graph,
    id: Id,
    depends: &Dependence,
    closed: &Table<FieldId, Option<Id>>,
) -> Id {
    let slope = graph.differentiate(id, Variable::AlongBase);
    graph.substitute(slope, &mut |graph, node| match node {
        Node::BaseLaw(atom) if atom.y == 1 => {
            let law = LawAtom {
                y: 0,
                ..atom.clone()
            };
            let mut parts = Vec::new();
            for field in atom.index.ids().filter(|&f| depends[atom.law][f]) {
                let partial = graph.base_law(law.partial(field));
                let gradient = base_value(graph, closed, field, 1);
                let part = graph.mul(partial, gradient);
                parts.push((part, num_traits::One::one()));
            }
            Some(graph.sum(parts))
        }
        _ => None,
    })
}
