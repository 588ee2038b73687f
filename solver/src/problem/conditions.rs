//! Boundary conditions as rows: linear parts for the matrix, higher degrees for the right-hand side.

use crate::base::BaseState;
use crate::model::{End, Jet, KernelId, Model, evaluate};

/// One boundary condition: Σ coefficient · Π jets, jets of one field or of several.
#[derive(Clone, Debug)]
pub struct WallRow {
    pub end: End,
    pub linear: Vec<(Jet, f64)>,
    pub nonlinear: Vec<(Vec<Jet>, f64)>,
}

/// The direct conditions of the base state's case.
pub fn direct(model: &dyn Model, base: &BaseState) -> Vec<WallRow> {
    let case = &model.structure().cases[base.case];
    let kernel = KernelId::Conditions(base.case);
    let values = End::BOTH.map(|end| evaluate(model, kernel, &base.at_end(model, end)));
    let mut position = 0;
    let mut rows = Vec::new();
    for condition in &case.conditions {
        let mut row = WallRow {
            end: condition.end,
            linear: Vec::new(),
            nonlinear: Vec::new(),
        };
        for monomial in &condition.monomials {
            let coefficient = values[usize::from(condition.end == End::Upper)][position];
            position += 1;
            match monomial.as_slice() {
                [jet] => row.linear.push((*jet, coefficient)),
                _ => row.nonlinear.push((monomial.clone(), coefficient)),
            }
        }
        rows.push(row);
    }
    rows
}

/// The adjoint conditions, or why there are none.
pub fn adjoint(model: &dyn Model, base: &BaseState) -> Result<Vec<WallRow>, String> {
    let case = &model.structure().cases[base.case];
    let conditions = case.adjoint.as_ref().map_err(Clone::clone)?;
    let kernel = KernelId::AdjointConditions(base.case);
    let values = End::BOTH.map(|end| evaluate(model, kernel, &base.at_end(model, end)));
    let mut position = 0;
    let mut rows = Vec::new();
    for condition in conditions {
        let mut linear = Vec::new();
        for jet in &condition.jets {
            linear.push((
                *jet,
                values[usize::from(condition.end == End::Upper)][position],
            ));
            position += 1;
        }
        rows.push(WallRow {
            end: condition.end,
            linear,
            nonlinear: Vec::new(),
        });
    }
    Ok(rows)
}
