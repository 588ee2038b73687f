//! Opening the laws: opaque atoms become their closed forms and derivatives of these.
//!
//! This happens last, when kernels are made; until then L, N2 and N3 do not depend on the closure.

use super::value::base_value;
use crate::graph::{FieldId, Graph, Id, Jet, LawAtom, LawId, Node, Operator, Table, Variable};
use crate::model::Law;
use std::collections::HashMap;

/// Replaces laws by their closed forms.
pub struct Opener<'a> {
    laws: &'a Table<LawId, Law>,
    closed: &'a Table<FieldId, Option<Id>>,
    uniform: &'a Table<FieldId, bool>,
    partials: HashMap<LawAtom, Id>,
}

impl<'a> Opener<'a> {
    /// An opener for the laws, closed base fields and unknown numbers of a model.
    pub fn new(
        laws: &'a Table<LawId, Law>,
        closed: &'a Table<FieldId, Option<Id>>,
        uniform: &'a Table<FieldId, bool>,
    ) -> Self {
        Opener {
            laws,
            closed,
            uniform,
            partials: HashMap::new(),
        }
    }

    /// A base-state expression in base fields, parameters and the coordinate alone.
    pub fn at_base(&mut self, graph: &mut Graph, id: Id) -> Id {
        let mut opened = HashMap::new();
        for node in graph.topological(&[id]) {
            if let Node::BaseLaw(atom) = graph.node(node).clone() {
                let value = self.base_atom(graph, &atom);
                opened.insert(atom, value);
            }
        }
        graph.substitute(id, &mut |_, node| match node {
            Node::BaseLaw(atom) => opened.get(atom).copied(),
            _ => None,
        })
    }

    fn base_atom(&mut self, graph: &mut Graph, atom: &LawAtom) -> Id {
        let partial = self.partial(
            graph,
            &LawAtom {
                y: 0,
                ..atom.clone()
            },
        );
        let closed = self.closed;
        let mut value = graph.substitute(partial, &mut |graph, node| match node {
            Node::Jet(jet) => Some(base_value(graph, closed, jet.of, jet.y)),
            _ => None,
        });
        // p⁰_ny = d/dy p_n(n⁰(y), T⁰(y), y)
        for _ in 0..atom.y {
            value = graph.differentiate(value, Variable::AlongBase);
        }
        value
    }

    /// An expression of the full state in fields and their derivatives alone, every differential
    /// operator carried out.
    pub fn at_state(&mut self, graph: &mut Graph, id: Id) -> Id {
        let carried = carry_out(graph, id, self.uniform);
        let mut opened = HashMap::new();
        for node in graph.topological(&[carried]) {
            if let Node::StateLaw(atom) = graph.node(node).clone() {
                let value = self.partial(graph, &atom);
                opened.insert(atom, value);
            }
        }
        graph.substitute(carried, &mut |_, node| match node {
            Node::StateLaw(atom) => opened.get(atom).copied(),
            _ => None,
        })
    }

    /// A partial derivative of a law, laws inside it opened too.
    fn partial(&mut self, graph: &mut Graph, atom: &LawAtom) -> Id {
        if let Some(&value) = self.partials.get(atom) {
            return value;
        }
        let value = if let Some(field) = atom.index.position(|&order| order > 0) {
            let mut lower = atom.clone();
            lower.index[field] -= 1;
            let lower = self.partial(graph, &lower);
            graph.differentiate(lower, Variable::Field(field))
        } else if atom.y > 0 {
            let lower = self.partial(
                graph,
                &LawAtom {
                    y: atom.y - 1,
                    ..atom.clone()
                },
            );
            graph.differentiate(lower, Variable::Coordinate)
        } else {
            let body = self.laws[atom.law].body;
            self.at_state(graph, body)
        };
        self.partials.insert(atom.clone(), value);
        value
    }
}

/// Carries out each unevaluated derivative by the chain rule.
pub fn carry_out(graph: &mut Graph, id: Id, uniform: &Table<FieldId, bool>) -> Id {
    let mut done: HashMap<Id, Id> = HashMap::new();
    // Children come first, so that inner derivatives are carried out before outer ones.
    for node in graph.topological(&[id]) {
        if let Node::Derivative(operator, argument) = *graph.node(node) {
            let argument = replace_derivatives(graph, argument, &done);
            let value = if operator == Operator::AbsDx {
                abs_dx(graph, argument)
            } else {
                graph.differentiate(argument, Variable::State(operator))
            };
            done.insert(node, value);
        }
    }
    let carried = replace_derivatives(graph, id, &done);
    graph.substitute(carried, &mut |graph, node| match node {
        Node::Jet(jet) if uniform[jet.of] && *jet != Jet::value(jet.of) => Some(graph.zero()),
        _ => None,
    })
}

fn replace_derivatives(graph: &mut Graph, id: Id, done: &HashMap<Id, Id>) -> Id {
    graph.substitute(id, &mut |graph, node| match node {
        Node::Derivative(operator, argument) => {
            let written = graph.derivative(*operator, *argument);
            done.get(&written).copied()
        }
        _ => None,
    })
}

/// |∂x| of a linear expression: each jet gains the operator, what has no jet goes.
fn abs_dx(graph: &mut Graph, id: Id) -> Id {
    let without_jets = graph.substitute(id, &mut |graph, node| match node {
        Node::Jet(_) => Some(graph.zero()),
        _ => None,
    });
    let raised = graph.substitute(id, &mut |graph, node| match node {
        Node::Jet(jet) => Some(graph.jet(jet.derived(Operator::AbsDx))),
        _ => None,
    });
    graph.sub(raised, without_jets)
}

/// For each law, which fields it depends on.
pub type Dependence = Table<LawId, Table<FieldId, bool>>;

/// For each law, which fields it depends on.
pub fn dependence(graph: &Graph, laws: &Table<LawId, Law>, fields: usize) -> Dependence {
    let mut table = Dependence::default();
    for law in laws {
        let mut depends: Table<FieldId, bool> = Table::filled(fields, false);
        for node in graph.topological(&[law.body]) {
            match graph.node(node) {
                Node::Jet(jet) => depends[jet.of] = true,
                // A law may use those declared before it.
                Node::StateLaw(atom) => {
                    for (here, there) in depends.iter_mut().zip(table[atom.law].iter()) {
                        *here |= there;
                    }
                }
                _ => {}
            }
        }
        table.push(depends);
    }
    table
}
