//! Bordering of the problem at k = 0.

use crate::base::BaseState;
use crate::collocation::{Discretisation, Grid, GridKind, Layout, clenshaw_curtis};
use crate::model::{ClosureKind, KernelId, Model, evaluate};

/// One border: a row that closes the problem, and the column of its multiplier.
#[derive(Clone, Debug)]
pub struct Border {
    pub kind: ClosureKind,
    /// The gauge or the unknown number.
    pub field: Option<usize>,
    /// Coefficients of the unknowns.
    pub row: Vec<f64>,
    /// Entries in the collocated equations.
    pub column: Vec<f64>,
}

/// The borders of a case: integrals by spectral quadrature, multipliers through the balances.
pub fn borders(
    model: &dyn Model,
    base: &BaseState,
    layout: &Layout,
    discretisation: &Discretisation,
) -> Vec<Border> {
    let structure = model.structure();
    let case = &structure.cases[base.case];
    let kernel = KernelId::Closures(base.case);
    let point = structure.coordinate.is_none();
    let half = if point {
        0.5
    } else {
        0.5 * (base.upper - base.lower)
    };
    let longest = layout.columns.iter().map(|b| b.len).max().unwrap_or(1);
    let quadrature = if point {
        GridKind::Point
    } else {
        GridKind::Lobatto(2 * longest + 1)
    };
    let nodes = Grid::new(quadrature).nodes;
    let weights = clenshaw_curtis(nodes.len());
    let values: Vec<Vec<f64>> = nodes
        .iter()
        .map(|&xi| evaluate(model, kernel, &base.point(model, xi, 0.0)))
        .collect();
    let mut borders = Vec::new();
    let mut position = 0;
    for closure in &case.closures {
        let mut row = vec![0.0; layout.size];
        for (offset, jet) in closure.density.iter().enumerate() {
            let field = usize::from(jet.field);
            let Some(block) = layout.columns.get(field) else {
                continue;
            };
            let order = usize::from(jet.y);
            let matrix = discretisation.matrix(block.grid, quadrature, order);
            let scale = if point {
                1.0
            } else {
                base.scale().powi(order as i32)
            };
            for (q, weight) in weights.iter().enumerate() {
                let factor = weight * half * values[q][position + offset] * scale;
                for j in 0..block.len {
                    row[block.offset + j] += factor * matrix[(q, j)];
                }
            }
        }
        position += closure.density.len();
        let mut column = vec![0.0; layout.size];
        for (offset, &balance) in closure.column.iter().enumerate() {
            let block = &layout.rows[balance];
            for (i, &xi) in Grid::new(block.grid).nodes.iter().enumerate() {
                let out = evaluate(model, kernel, &base.point(model, xi, 0.0));
                column[block.offset + i] += out[position + offset];
            }
        }
        position += closure.column.len();
        if closure.kind == ClosureKind::Unknown {
            unknown_column(model, base, layout, closure.field, &mut column);
        }
        borders.push(Border {
            kind: closure.kind,
            field: closure.field,
            row,
            column,
        });
    }
    borders
}

/// An unknown number enters the balances with its own coefficients: −L in its column.
fn unknown_column(
    model: &dyn Model,
    base: &BaseState,
    layout: &Layout,
    field: Option<usize>,
    column: &mut [f64],
) {
    let structure = model.structure();
    for (balance, block) in layout.rows.iter().enumerate() {
        for (i, &xi) in Grid::new(block.grid).nodes.iter().enumerate() {
            let out = evaluate(model, KernelId::Linear, &base.point(model, xi, 0.0));
            for (term, coefficient) in structure.linear.iter().zip(&out) {
                if term.row == balance && Some(usize::from(term.jet.field)) == field {
                    column[block.offset + i] -= coefficient;
                }
            }
        }
    }
}
