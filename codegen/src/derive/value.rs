//! Values of the base state as expressions.

use crate::graph::{FieldId, Graph, Id, Table, Variable};

/// ∂y^order of a base field: an atom where the base is solved for, an expression where it is given.
pub fn base_value(
    graph: &mut Graph,
    closed: &Table<FieldId, Option<Id>>,
    field: FieldId,
    order: u8,
) -> Id {
    match closed[field] {
        None => graph.base(field, order),
        Some(mut value) => {
            for _ in 0..order {
                value = graph.differentiate(value, Variable::AlongBase);
            }
            value
        }
    }
}
