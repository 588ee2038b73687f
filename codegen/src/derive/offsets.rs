//! The numbers of points of each balance and of values of each field on the cross-stream interval.
//!
//! A system of mixed order is collocated by numbers c_i ≥ 0 of its balances and t_j of its fields with
//!
//! ```text
//! t_j − c_i ≥ d_ij,     t_j − c_i = d_ij along an assignment of balances to fields of largest Σ d_ij,
//! ```
//!
//! d_ij being the order of field j in balance i (−∞ where it is absent): Douglis & Nirenberg's weights
//! (1955), s_i = −c_i, and the offsets of Pryce's structural analysis (2001). Field j then has N + t_j
//! values, balance i is collocated at N + c_i points, and Σ t_j − Σ c_i boundary conditions make up the
//! difference: rows that belong to no field. The smallest offsets are unique, so nothing depends on the
//! order of declaration. For u, v, p of a viscous flow they are t = (2, 2, 1), c = (0, 0, 1): the staggered
//! grids of P 4.2.

use super::linear::Term;
use landau_contract::{Id, Table};

/// The smallest offsets of a system.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Offsets<Row, Column> {
    /// c_i: points of row i beyond N.
    pub rows: Table<Row, usize>,
    /// t_j: values of column j beyond N.
    pub columns: Table<Column, usize>,
    /// Σ t_j − Σ c_i: the number of boundary conditions.
    pub conditions: usize,
}

/// The smallest offsets, `orders[i][j]` being d_ij; `None` where the balances do not determine the fields.
pub fn offsets<Row, Column>(orders: &Orders<Row, Column>) -> Option<Offsets<Row, Column>> {
    let weights: Vec<Vec<Option<i64>>> = orders
        .iter()
        .map(|row| row.iter().map(|order| order.map(i64::from)).collect())
        .collect();
    let (total, assigned) = assign(&weights)?;
    let fields = orders.first().map_or(0, |row| row.len());
    let mut rows = vec![0_i64; orders.len()];
    let mut columns = vec![0_i64; fields];
    // Each round raises the offsets that violate a condition. It ends because the assignment has the largest weight.
    loop {
        for (j, column) in columns.iter_mut().enumerate() {
            let needed = (0..rows.len()).filter_map(|i| Some(rows[i] + weights[i][j]?));
            *column = needed.fold(0, i64::max);
        }
        let raised: Vec<i64> = assigned
            .iter()
            .enumerate()
            .map(|(i, &j)| columns[j] - weights[i][j].unwrap_or(0))
            .collect();
        if raised == rows {
            break;
        }
        rows = raised;
    }
    Some(Offsets {
        rows: rows.into_iter().map(|n| n as usize).collect(),
        columns: columns.into_iter().map(|n| n as usize).collect(),
        conditions: total as usize,
    })
}

/// The highest y-derivative of each column in each row; `None` where it is absent.
pub type Orders<Row, Column> = Table<Row, Table<Column, Option<u8>>>;

/// The orders in which the first `columns` columns stand in an operator.
pub fn orders<Row: Id, Column: Id>(
    terms: &[Term<Row, Column>],
    rows: usize,
    columns: usize,
) -> Orders<Row, Column> {
    let mut table = Table::filled(rows, Table::filled(columns, None));
    for term in terms.iter().filter(|t| t.jet.of.index() < columns) {
        let entry: &mut Option<u8> = &mut table[term.row][term.jet.of];
        *entry = Some(entry.unwrap_or(0).max(term.jet.y));
    }
    table
}

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

#[cfg(test)]
mod tests {
    use super::{Offsets, offsets};
    use landau_contract::{BalanceId, FieldId, Id};

    fn offsets_of(orders: &[Vec<Option<u8>>]) -> Option<Offsets<BalanceId, FieldId>> {
        offsets(&orders.iter().map(|row| row.clone().into()).collect())
    }

    fn check(orders: &[Vec<Option<u8>>], rows: &[usize], columns: &[usize], conditions: usize) {
        let expected = Offsets {
            rows: rows.to_vec().into(),
            columns: columns.to_vec().into(),
            conditions,
        };
        assert_eq!(offsets_of(orders), Some(expected));
    }

    #[test]
    fn velocity_and_pressure() {
        // u and v momentum, continuity; fields u, v, p
        let orders = [
            vec![Some(2), Some(0), Some(0)],
            vec![None, Some(2), Some(1)],
            vec![Some(0), Some(1), None],
        ];
        check(&orders, &[0, 0, 1], &[2, 2, 1], 4);
    }

    #[test]
    fn density_velocity_and_temperature() {
        // mass, momenta, energy; fields n, u, v, T
        let orders = [
            vec![Some(0), Some(0), Some(1), None],
            vec![Some(0), Some(2), Some(1), Some(0)],
            vec![Some(1), Some(1), Some(2), Some(1)],
            vec![Some(1), Some(0), Some(1), Some(2)],
        ];
        check(&orders, &[1, 0, 0, 0], &[1, 2, 2, 2], 6);
    }

    #[test]
    fn streamfunction_and_vorticity() {
        let orders = [vec![Some(0), Some(2)], vec![Some(2), Some(0)]];
        check(&orders, &[0, 0], &[2, 2], 4);
    }

    /// Balances and fields in another order have the same offsets.
    #[test]
    fn order_of_declaration() {
        let orders = [
            vec![Some(1), None, Some(0)],
            vec![Some(1), Some(2), None],
            vec![None, Some(0), Some(2)],
        ];
        let straight = offsets_of(&orders).expect("a determined system");
        for rotation in 1..3 {
            let turned: Vec<Vec<Option<u8>>> = (0..3)
                .map(|i| {
                    (0..3)
                        .map(|j| orders[(i + rotation) % 3][(j + 2 * rotation) % 3])
                        .collect()
                })
                .collect();
            let turned = offsets_of(&turned).expect("a determined system");
            for i in 0..3 {
                let (row, column) = ((i + rotation) % 3, (i + 2 * rotation) % 3);
                let (i, row) = (BalanceId::at(i), BalanceId::at(row));
                assert_eq!(turned.rows[i], straight.rows[row]);
                let (i, column) = (FieldId::at(i.index()), FieldId::at(column));
                assert_eq!(turned.columns[i], straight.columns[column]);
            }
        }
    }

    #[test]
    fn two_balances_for_one_field() {
        assert_eq!(
            offsets_of(&[vec![Some(1), None], vec![Some(2), None]]),
            None
        );
    }
}
