//! What an integral condition integrates: its linear part, its expansion, and the density itself.

use super::Opener;
use super::deriver::Deriver;
use crate::diagnostic::{Diagnostic, Location};
use crate::form::Form;
use crate::graph::{Graph, Id, Jet, Node};

/// The density of ∫ density dy, averaged over x.
#[derive(Clone, Debug)]
pub struct Density {
    /// Jets and weights of the linear part; jets with ∂x in them average to zero and are left out.
    pub linear: Vec<(Jet, Id)>,
    /// The expansion around the base state, to the order of the derivation.
    pub form: Form,
    /// The density of the full state, unexpanded.
    pub integrand: Id,
    /// Whether products of perturbations enter it, at any degree.
    pub is_nonlinear: bool,
}

impl Density {
    /// Terms that take part in an average over x: all but linear ones with ∂x in them.
    pub fn averaged(&self) -> Form {
        let terms = self.form.terms.iter();
        let terms = terms.filter(|(m, _)| m.len() != 1 || m[0].is_base());
        Form {
            terms: terms.map(|(m, c)| (m.clone(), *c)).collect(),
        }
    }
}

impl Deriver<'_> {
    /// The density of an integral condition, or a mistake at `place`.
    pub(super) fn density(
        &mut self,
        integrand: Id,
        place: &Location,
        mistakes: &mut Vec<Diagnostic>,
    ) -> Option<Density> {
        let form = self.expand(integrand, place, mistakes)?;
        if form.terms.keys().flatten().any(|jet| jet.t > 0) {
            let message = "the integrand holds a time derivative";
            let expected = "an expression in the fields and their derivatives in space";
            mistakes.push(Diagnostic::new(place.clone(), message, expected));
            return None;
        }
        let model = self.model;
        let mut opener = Opener::new(&model.laws, &model.base.closed, &self.uniform);
        let opened = opener.at_state(self.graph, integrand);
        let linear = form.degree(1);
        let linear = linear.terms.iter().map(|(m, &c)| (m[0], c));
        Some(Density {
            linear: linear.filter(|(jet, _)| jet.is_base()).collect(),
            is_nonlinear: degree(self.graph, opened) > 1,
            integrand,
            form,
        })
    }
}

/// The degree of an expression in jets, as far as its form shows it: 0 without jets, 1 for a sum of jets with
/// coefficients, 2 for everything else.
fn degree(graph: &Graph, id: Id) -> usize {
    let order = graph.topological(&[id]);
    let mut degrees = std::collections::HashMap::new();
    for node in order {
        let of = |child: &Id| -> usize { degrees.get(child).copied().unwrap_or(0) };
        let degree = match graph.node(node) {
            Node::Jet(_) => 1,
            Node::Sum(_, terms) => terms.iter().map(|(term, _)| of(term)).max().unwrap_or(0),
            Node::Select(_, branches) => branches.iter().map(of).max().unwrap_or(0),
            Node::Product(factors) => {
                let with_jets = factors.iter().filter(|(base, _)| of(base) > 0);
                let sum = with_jets.map(|(base, exponent)| {
                    if num_traits::One::is_one(exponent) {
                        of(base)
                    } else {
                        2
                    }
                });
                sum.sum::<usize>().min(2)
            }
            Node::Call(_, argument) => 2 * of(argument).min(1),
            _ => 0,
        };
        degrees.insert(node, degree);
    }
    degrees.get(&id).copied().unwrap_or(0)
}
