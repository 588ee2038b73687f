//! The field that each balance determines: what an adjoint field is called after.

use super::linear::Term;
use super::offsets::{assign, orders};

/// The field that each balance determines: the one whose ∂t it holds; what is left
/// (continuity and pressure, definitions and auxiliary fields) by the derivatives held.
pub fn pair(
    terms: &[Term],
    rows: usize,
    fields: usize,
    given: &[Option<usize>],
) -> Option<Vec<usize>> {
    let orders = orders(terms, rows, fields);
    let mut weights = vec![vec![Some(0_i64); fields]; rows];
    for (row, line) in weights.iter_mut().enumerate() {
        for (field, weight) in line.iter_mut().enumerate() {
            *weight = match (given[row], orders[row][field]) {
                (Some(wanted), _) => (wanted == field).then_some(1000),
                // A field may be paired with a balance that does not hold it (pressure), but for want
                // of a better one only.
                (None, None) => Some(0),
                (None, Some(order)) => Some(1 + i64::from(order)),
            };
        }
    }
    let profiles = |t: &&Term| usize::from(t.jet.field) < fields;
    for term in terms.iter().filter(profiles).filter(|t| t.jet.t > 0) {
        if let Some(weight) = &mut weights[term.row][usize::from(term.jet.field)] {
            // ∂t of the field itself before ∂t under derivatives, either before everything else.
            *weight += if term.jet.y == 0 { 100 } else { 50 };
        }
    }
    assign(&weights).map(|(_, pairing)| pairing)
}
