//! Conditions that follow from other conditions at the same end.

use super::boundary::Combination;
use super::deriver::Deriver;
use super::wall::{WallCondition, linear_row, solved_at};
use crate::graph::FieldId;
use crate::model::End;

/// The first condition that, to first order, follows from those before it at its end.
///
/// Such a condition counts as one and determines nothing: the linear problem is singular.
pub(super) fn redundant(deriver: &mut Deriver, conditions: &[WallCondition]) -> Option<usize> {
    End::BOTH.into_iter().find_map(|end| {
        let mut rows: Vec<Combination<FieldId>> = Vec::new();
        for (position, condition) in conditions.iter().enumerate() {
            if condition.end != end {
                continue;
            }
            rows.push(linear_row(condition));
            let solved =
                deriver.aside(|deriver| solved_at(deriver, end, rows.clone(), &Vec::new()));
            if solved.is_ok_and(|reduced| reduced.rules.len() < rows.len()) {
                return Some(position);
            }
        }
        None
    })
}
