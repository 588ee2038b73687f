//! The field that each balance determines. The adjoint field of the balance takes its name.

use super::linear::DirectTerm;
use super::offsets::{assign, orders};
use landau_contract::{BalanceId, FieldId, Id, Table};

/// The field that each balance determines: the one whose ∂t it holds. The balances without ∂t (continuity, definitions)
/// are paired with the fields left over (pressure, auxiliary fields) by the derivatives that they hold.
pub fn pair(
    terms: &[DirectTerm],
    fields: usize,
    given: &Table<BalanceId, Option<FieldId>>,
) -> Option<Table<BalanceId, FieldId>> {
    let orders = orders(terms, given.len(), fields);
    let mut weights: Vec<Vec<Option<i64>>> = Vec::with_capacity(given.len());
    for (row, orders) in orders.pairs() {
        let weight = |(field, order): (FieldId, &Option<u8>)| match (given[row], *order) {
            (Some(wanted), _) => (wanted == field).then_some(1000),
            // A field may be paired with a balance that does not hold it (pressure and continuity), but only if no
            // balance that holds it is free.
            (None, None) => Some(0),
            (None, Some(order)) => Some(1 + i64::from(order)),
        };
        weights.push(orders.pairs().map(weight).collect());
    }
    let profiles = |t: &&DirectTerm| t.jet.of.index() < fields;
    for term in terms.iter().filter(profiles).filter(|t| t.jet.t > 0) {
        if let Some(weight) = &mut weights[term.row.index()][term.jet.of.index()] {
            // First ∂t of the field itself, then ∂t under derivatives, then derivatives without ∂t.
            *weight += if term.jet.y == 0 { 100 } else { 50 };
        }
    }
    let (_, pairing) = assign(&weights)?;
    Some(pairing.into_iter().map(FieldId::at).collect())
}
