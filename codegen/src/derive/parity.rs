//! Is the model its own mirror image under x → −x?
//!
//! Signs s_f of the fields and r_i of the balances such that each monomial of each balance keeps its
//! sign: r_i + Σ s_f + (number of ∂x) = 0 mod 2, a linear system over two elements, derived from the
//! expanded balances and never declared.

use crate::form::Form;
use crate::graph::{BalanceId, FieldId, Table};
use landau_contract::Id as _;

/// `true` is odd: the field (or balance) changes sign in the mirror.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Parity {
    /// By field.
    pub fields: Table<FieldId, bool>,
    /// By balance.
    pub rows: Table<BalanceId, bool>,
}

/// The parity of a model, or `None` where it has no such symmetry.
///
/// `forms` are the balances, `conditions` those of the walls and on integrals (each may have either parity).
pub fn parity(forms: &[Form], conditions: &[&Form], fields: usize) -> Option<Parity> {
    let unknowns = fields + forms.len() + conditions.len();
    let mut system: Vec<Vec<bool>> = Vec::new();
    for (row, form) in forms.iter().chain(conditions.iter().copied()).enumerate() {
        for monomial in form.terms.keys().filter(|m| !m.is_empty()) {
            let mut equation = vec![false; unknowns + 1];
            equation[fields + row] = true;
            for jet in monomial {
                equation[jet.of.index()] ^= true;
                equation[unknowns] ^= jet.x % 2 == 1;
            }
            system.push(equation);
        }
    }
    let signs = solve(system, unknowns)?;
    Some(Parity {
        fields: signs[..fields].to_vec().into(),
        rows: signs[fields..fields + forms.len()].to_vec().into(),
    })
}

/// Gauss–Jordan over two elements; free unknowns are 0.
fn solve(mut system: Vec<Vec<bool>>, unknowns: usize) -> Option<Vec<bool>> {
    let mut pivots = Vec::new();
    let mut rank = 0;
    // Later unknowns (balances) are eliminated first, so that free choices fall on fields.
    for column in (0..unknowns).rev() {
        let Some(pivot) = (rank..system.len()).find(|&r| system[r][column]) else {
            continue;
        };
        system.swap(rank, pivot);
        let row = system[rank].clone();
        for (r, line) in system.iter_mut().enumerate() {
            if r != rank && line[column] {
                for (bit, by) in line.iter_mut().zip(&row) {
                    *bit ^= by;
                }
            }
        }
        pivots.push(column);
        rank += 1;
    }
    if system[rank..].iter().any(|row| row[unknowns]) {
        return None;
    }
    let mut values = vec![false; unknowns];
    for (row, &column) in pivots.iter().enumerate() {
        values[column] = system[row][unknowns];
    }
    Some(values)
}
