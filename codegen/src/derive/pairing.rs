//! Which balance determines which field, and how many boundary conditions that asks for.

use super::linear::{Term, orders};

/// The assignment of rows to columns with the largest total weight; `None` entries are forbidden.
///
/// Ties go to the assignment met first (row by row, lowest column first), so the result is the same
/// on every run. Returns `None` where no complete assignment exists.
pub fn assign(weights: &[Vec<Option<i64>>]) -> Option<(i64, Vec<usize>)> {
    // Successive best augmentation over subsets of columns: exact, and models are small.
    let n = weights.len();
    let columns = weights.first().map_or(0, Vec::len);
    if columns > 14 {
        return None;
    }
    let mut best: Vec<Option<(i64, Vec<usize>)>> = vec![None; 1 << columns];
    best[0] = Some((0, Vec::new()));
    for row in weights.iter().take(n) {
        let mut next: Vec<Option<(i64, Vec<usize>)>> = vec![None; 1 << columns];
        for (used, state) in best.iter().enumerate() {
            let Some((total, chosen)) = state else {
                continue;
            };
            for (column, weight) in row.iter().enumerate() {
                let Some(weight) = weight else { continue };
                if used >> column & 1 == 1 {
                    continue;
                }
                let target = &mut next[used | 1 << column];
                let total = total + weight;
                if target.as_ref().is_none_or(|(present, _)| total > *present) {
                    let mut chosen = chosen.clone();
                    chosen.push(column);
                    *target = Some((total, chosen));
                }
            }
        }
        best = next;
    }
    best.into_iter().flatten().max_by_key(|(total, _)| *total)
}

/// The number of boundary conditions that a system of mixed order needs: the largest total
/// y-order over all assignments of rows to fields (Volevich's rule).
pub fn total_order(terms: &[Term], rows: usize, fields: usize) -> Option<usize> {
    let weights: Vec<Vec<Option<i64>>> = orders(terms, rows, fields)
        .iter()
        .map(|row| row.iter().map(|order| order.map(i64::from)).collect())
        .collect();
    assign(&weights).map(|(total, _)| total as usize)
}

/// The field that each balance is collocated with: the one whose ∂t it holds; what is left
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
