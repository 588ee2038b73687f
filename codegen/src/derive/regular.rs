//! Conditions at a singular end of the interval, such as an axis r = 0.
//!
//! Where the weights of the balances vanish, so does the boundary form, and asks for less than there are
//! adjoint conditions. Regularity takes their place: the leading term of each adjoint balance
//! in powers of the distance from the end. (r Y')' + r g Y = 0 asks for Y' = 0 at r = 0.

use super::boundary::{Combination, split};
use super::deriver::Deriver;
use super::linear::AdjointTerm;
use super::wall::{BaseRules, at_end};
use crate::graph::{BalanceId, FieldId, Id, Variable};
use crate::model::End;
use std::collections::BTreeMap;

/// Powers of the distance that are looked for.
const HIGHEST_POWER: usize = 4;

/// What regularity asks of the adjoint fields at an end, the conditions of highest derivative first.
pub(super) fn conditions(
    deriver: &mut Deriver,
    adjoint: &[AdjointTerm],
    end: End,
    rules: &BaseRules,
) -> Vec<Combination<BalanceId>> {
    let mut rows: BTreeMap<FieldId, Vec<AdjointTerm>> = BTreeMap::new();
    for term in adjoint {
        rows.entry(term.row).or_default().push(*term);
    }
    let mut list = Vec::new();
    for terms in rows.into_values() {
        list.extend(leading(deriver, &terms, end, rules));
    }
    let order = |c: &Combination<BalanceId>| c.keys().map(|jet| jet.y).max();
    list.sort_by_key(|c| std::cmp::Reverse(order(c)));
    list
}

/// The terms of lowest power in the distance from the end, where that is no power of all regular balances.
fn leading(
    deriver: &mut Deriver,
    terms: &[AdjointTerm],
    end: End,
    rules: &BaseRules,
) -> Option<Combination<BalanceId>> {
    let place = deriver.place(end);
    let mut coefficients: Vec<Id> = terms.iter().map(|t| t.coefficient).collect();
    for _ in 0..=HIGHEST_POWER {
        let mut values = Vec::with_capacity(terms.len());
        for &coefficient in &coefficients {
            let value = at_end(deriver.graph, place, end, rules, coefficient);
            if deriver.graph.is_undefined(value) {
                return None;
            }
            values.push((value, deriver.graph.vanishes(value)));
        }
        if values.iter().all(|(_, zero)| *zero) {
            for coefficient in &mut coefficients {
                *coefficient = deriver
                    .graph
                    .differentiate(*coefficient, Variable::AlongBase);
            }
            continue;
        }
        let highest = terms.iter().map(|t| t.jet.y).max().unwrap_or(0);
        let mut combination = Combination::new();
        for (term, (value, zero)) in terms.iter().zip(values) {
            if zero {
                continue;
            }
            // The highest derivative or a time derivative to leading order: the balance is a regular one.
            if term.jet.t > 0 || term.jet.y == highest {
                return None;
            }
            let (jet, symbol) = split(term.jet, value);
            combination.entry(jet).or_default().extend(symbol);
        }
        return Some(combination);
    }
    None
}
