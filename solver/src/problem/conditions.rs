//! Boundary conditions as rows: linear parts for the matrix, higher degrees for the right-hand side.

use crate::base::BaseState;
use crate::model::layout::{read_adjoint_conditions, read_conditions};
use crate::model::{End, Jet, KernelId, Model, evaluate};

/// One boundary condition: Σ coefficient · Π jets, jets of one field or of several.
#[derive(Clone, Debug)]
pub struct WallRow {
    /// Where it holds.
    pub end: End,
    /// Its linear part: jet and coefficient.
    pub linear: Vec<(Jet, f64)>,
    /// Products of jets with their coefficients.
    pub nonlinear: Vec<(Vec<Jet>, f64)>,
}

/// The direct conditions of the base state's case.
pub fn direct(model: &dyn Model, base: &BaseState) -> Vec<WallRow> {
    let case = &model.structure().cases[base.case];
    let kernel = KernelId::Conditions(base.case);
    let values = End::BOTH.map(|end| evaluate(model, kernel, &base.at_end(model, end)));
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
pub fn adjoint(model: &dyn Model, base: &BaseState) -> Result<Vec<WallRow>, String> {
    let case = &model.structure().cases[base.case];
    let conditions = case.adjoint.as_ref().map_err(Clone::clone)?;
    let kernel = KernelId::AdjointConditions(base.case);
    let values = End::BOTH.map(|end| evaluate(model, kernel, &base.at_end(model, end)));
    let [lower, upper] = &values;
    let row = |(end, linear): (End, Vec<(Jet, f64)>)| WallRow {
        end,
        linear,
        nonlinear: Vec::new(),
    };
    Ok(read_adjoint_conditions(conditions, [lower, upper])
        .map(row)
        .collect())
}
