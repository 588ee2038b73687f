//! Boundary conditions as rows: linear parts for the matrix, higher degrees for the right-hand side.

use super::linear::WallRow;
use crate::base::BaseState;
use crate::model::layout::{read_adjoint_conditions, read_conditions};
use crate::model::{BalanceId, End, FieldId, Jet, KernelId, evaluate};

/// The direct conditions of the base state's case.
pub fn direct(base: &BaseState) -> Vec<WallRow<FieldId>> {
    let case = &base.structure().cases[base.case];
    let kernel = KernelId::Conditions(base.case);
    let values = End::BOTH.map(|end| evaluate(base.model.as_ref(), kernel, &base.at_end(end)));
    let [lower, upper] = &values;
    let row = |(end, monomials): (End, Vec<(&[Jet], f64)>)| {
        let mut row = WallRow {
            end,
            linear: Vec::new(),
            nonlinear: Vec::new(),
        };
        for (monomial, coefficient) in monomials {
            match monomial {
                [jet] => row.linear.push((*jet, coefficient)),
                _ => row.nonlinear.push((monomial.to_vec(), coefficient)),
            }
        }
        row
    };
    read_conditions(&case.conditions, [lower, upper])
        .map(row)
        .collect()
}

/// The adjoint conditions, or why there are none.
pub fn adjoint(base: &BaseState) -> Result<Vec<WallRow<BalanceId>>, String> {
    let case = &base.structure().cases[base.case];
    let conditions = case.adjoint.as_ref().map_err(Clone::clone)?;
    let kernel = KernelId::AdjointConditions(base.case);
    let values = End::BOTH.map(|end| evaluate(base.model.as_ref(), kernel, &base.at_end(end)));
    let [lower, upper] = &values;
    let row = |(end, linear): (End, Vec<(Jet<BalanceId>, f64)>)| WallRow {
        end,
        linear,
        nonlinear: Vec::new(),
    };
    Ok(read_adjoint_conditions(conditions, [lower, upper])
        .map(row)
        .collect())
}
