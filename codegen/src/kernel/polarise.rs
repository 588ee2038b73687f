//! Homogeneous forms → symmetric multilinear forms.

use crate::form::{Form, Monomial};
use crate::graph::{BalanceId, Graph, Id, Jet, Node, Rational, Table};
use num_traits::One;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// The distinct jets and coefficients of all nonlinear forms, in order of appearance.
pub(super) fn form_tables(forms: &[Table<BalanceId, Form>]) -> (Vec<Jet>, Vec<Id>) {
    let mut jets = BTreeSet::new();
    let mut coefficients = Vec::new();
    let mut listed = std::collections::HashSet::new();
    for form in forms.iter().flat_map(|rows| rows.iter()) {
        for (monomial, &coefficient) in &form.terms {
            jets.extend(monomial.iter().copied());
            if listed.insert(coefficient) {
                coefficients.push(coefficient);
            }
        }
    }
    (jets.into_iter().collect(), coefficients)
}

/// The symmetric multilinear form of a homogeneous one:
/// Π q_i → 1/d! Σ over permutations of Π q_i[argument σ(i)].
///
/// Slot (0, i) is coefficient i; slot (a, i) is jet i of argument a.
pub(super) fn polarise(
    graph: &mut Graph,
    form: &Form,
    degree: usize,
    jets: &[Jet],
    position: &HashMap<Id, usize>,
) -> Id {
    let place: HashMap<Jet, usize> = jets.iter().enumerate().map(|(i, j)| (*j, i)).collect();
    let mut memo = BTreeMap::new();
    let arguments: Vec<usize> = (1..=degree).collect();
    let factorial: i64 = (1..=degree as i64).product();
    let weight = Rational::new(1.into(), factorial.into());
    let mut parts = Vec::new();
    for (monomial, coefficient) in &form.terms {
        let permutations = permutation_sum(graph, monomial, &arguments, &place, &mut memo);
        let coefficient = graph.slot(0, position[coefficient]);
        parts.push((graph.mul(coefficient, permutations), Rational::one()));
    }
    let total = graph.sum(parts);
    // The factor stands before the whole sum, as one multiplication.
    let weight = graph.number(weight);
    match graph.node(total) {
        Node::Sum(..) => {
            let one = Rational::one();
            graph.intern(Node::Product(vec![(weight, one.clone()), (total, one)]))
        }
        _ => graph.mul(weight, total),
    }
}

/// Σ over permutations σ of Π q_i[argument σ(i)], by the choice of the last jet's argument. `memo` shares the sums over
/// fewer jets between monomials.
fn permutation_sum(
    graph: &mut Graph,
    monomial: &[Jet],
    arguments: &[usize],
    place: &HashMap<Jet, usize>,
    memo: &mut BTreeMap<(Monomial, Vec<usize>), Id>,
) -> Id {
    let Some((last, before)) = monomial.split_last() else {
        return graph.one();
    };
    let key = (monomial.to_vec(), arguments.to_vec());
    if let Some(&sum) = memo.get(&key) {
        return sum;
    }
    let mut parts = Vec::new();
    for (i, &argument) in arguments.iter().enumerate() {
        let mut arguments_left = arguments.to_vec();
        arguments_left.remove(i);
        let inner = permutation_sum(graph, before, &arguments_left, place, memo);
        let slot = graph.slot(argument, place[last]);
        parts.push((graph.mul(inner, slot), Rational::one()));
    }
    let total = graph.sum(parts);
    memo.insert(key, total);
    total
}
