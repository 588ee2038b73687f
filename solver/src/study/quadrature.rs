//! The second route to c2: continuous adjoint, discretised on its own, and spectral quadrature.
//!
//! c2 = ⟨X†, G[1;3]⟩ / ⟨X†, M0 X[1;1]⟩, P (4.13), with every profile on at least 4M points.

use crate::collocation::{Grid, GridKind};
use crate::dense::{Factorised, apply, dot, norm};
use crate::error::{Error, Result};
use crate::model::{C64, Jet, KernelId, evaluate};
use crate::problem::{LinearProblem, Problem, quarter_turn};
use crate::spectrum::{EigenPair, beside};
use crate::weakly::{LandauPoint, Mode, quadrature_grid, quadrature_weights};

/// The adjoint eigenfunction X† and its eigenvalue.
pub struct AdjointMode {
    /// Its eigenvalue: the conjugate of c0 but for truncation.
    pub c: C64,
    /// Physical values at the adjoint problem's unknowns.
    pub values: Vec<C64>,
}

/// The eigenfunction of L† whose eigenvalue is nearest to the conjugate of c0.
///
/// # Errors
/// A model without adjoint boundary conditions, or an iteration that does not converge.
pub fn adjoint_mode(problem: &Problem, pair: &EigenPair) -> Result<AdjointMode> {
    let adjoint = problem.adjoint()?;
    let k = pair.k;
    let shift = beside(pair.c.conj(), pair.scale);
    let (operator, mass) = problem.pencil_of::<C64>(adjoint, k);
    let n = mass.nrows();
    let shifted = faer::Mat::from_fn(n, n, |i, j| shift * mass[(i, j)] - operator[(i, j)]);
    let factorised = Factorised::new(shifted);
    let mut x: Vec<C64> = (0..n)
        .map(|i| C64::new(1.0 + 0.3 * (i as f64).sin(), 0.0))
        .collect();
    let (mut c, mut change) = (shift, f64::INFINITY);
    for iteration in 0..60 {
        let mass_x = apply(mass.as_ref(), &x);
        let next = factorised.solve(&mass_x);
        let size = norm(&next);
        if !size.is_finite() || size == 0.0 {
            break;
        }
        // (σ M0 − L) next = M0 x
        let mass_next = apply(mass.as_ref(), &next);
        let estimate = shift - dot(&mass_next, &mass_x) / dot(&mass_next, &mass_next);
        x = next.into_iter().map(|v| v / size).collect();
        let step = (estimate - c).norm();
        c = estimate;
        let floor = 1e-13 * c.norm().max((shift - c).norm());
        let small = 1e-9 * c.norm().max(1e-6 * pair.scale);
        if iteration > 1 && (step <= floor || (step < small && step >= 0.5 * change)) {
            return Ok(AdjointMode {
                c,
                values: physical(adjoint, &x),
            });
        }
        change = step;
    }
    Err(Error::computation(format!(
        "the adjoint mode at k = {k} was not found: L† has no isolated eigenvalue near the conjugate of c0 at this M"
    )))
}

fn physical(problem: &LinearProblem, x: &[C64]) -> Vec<C64> {
    let mut values = x.to_vec();
    for (column, block) in problem.layout.columns.iter().enumerate() {
        for value in &mut values[block.offset..block.offset + block.len] {
            *value *= quarter_turn(problem.column_turn(column));
        }
    }
    values
}

/// c2 by quadrature; `None` where boundary conditions are nonlinear, whose data this route leaves out.
///
/// # Errors
/// A model without adjoint.
pub fn second_landau(point: &LandauPoint, adjoint: &AdjointMode) -> Result<Option<C64>> {
    let problem = point.problem;
    if problem.direct.walls.iter().any(|w| !w.nonlinear.is_empty()) {
        return Ok(None);
    }
    let layout = &problem.adjoint()?.layout;
    let structure = problem.structure();
    let k = point.k();
    let grid = quadrature_grid(problem);
    let (nodes, weights) = (Grid::new(grid).nodes, quadrature_weights(problem, grid));
    let (first, mean, second) = (&point.fundamental, &point.mean, &point.second);
    let conjugate = first.conjugate();
    let jets = &structure.form_jets;
    let table = |mode: &Mode| mode.jets(problem, jets, grid);
    let (j1, j1c, j0, j2) = (table(first), table(&conjugate), table(mean), table(second));
    let mass: Vec<_> = structure
        .linear
        .iter()
        .enumerate()
        .filter(|(_, t)| t.jet.t > 0)
        .collect();
    let mass_jets: Vec<Jet> = mass.iter().map(|(_, t)| Jet { t: 0, ..t.jet }).collect();
    let mass_values: Vec<Vec<C64>> = mass_jets
        .iter()
        .map(|&jet| first.jet(problem, jet, grid))
        .collect();
    let profiles: Vec<Vec<C64>> = (0..layout.columns.len())
        .map(|row| {
            on_grid(
                problem,
                layout.columns[row].grid,
                grid,
                &adjoint.values[layout.columns[row].offset..][..layout.columns[row].len],
            )
        })
        .collect();
    let (mut above, mut below) = (C64::new(0.0, 0.0), C64::new(0.0, 0.0));
    for (i, &xi) in nodes.iter().enumerate() {
        let base = problem.base.point(problem.model, xi, k);
        let c = evaluate(problem.model, KernelId::Nonlinear, &base);
        let linear = evaluate(problem.model, KernelId::Linear, &base);
        let (x, xc, m, s) = (j1.at(i), j1c.at(i), j0.at(i), j2.at(i));
        for (row, profile) in profiles.iter().enumerate() {
            // G[1;3] = 2 N2(X11, X02) + 2 N2(X̄11, X22) + 3 N3(X11, X11, X̄11)
            let mut forcing = C64::new(0.0, 0.0);
            if structure.forms[0][row] {
                forcing += 2.0 * problem.model.form(2, row, &c, &[x, m]);
                forcing += 2.0 * problem.model.form(2, row, &c, &[xc, s]);
            }
            if structure.forms[1][row] {
                forcing += 3.0 * problem.model.form(3, row, &c, &[x, x, xc]);
            }
            above += weights[i] * profile[i].conj() * forcing;
        }
        for ((index, term), values) in mass.iter().zip(&mass_values) {
            below += weights[i] * profiles[term.row][i].conj() * linear[*index] * values[i];
        }
    }
    Ok(Some(above / below))
}

/// Values on another grid.
pub fn on_grid(problem: &Problem, from: GridKind, to: GridKind, values: &[C64]) -> Vec<C64> {
    let matrix = problem.discretisation.matrix(from, to, 0);
    (0..matrix.nrows())
        .map(|i| {
            values
                .iter()
                .enumerate()
                .map(|(j, v)| v * matrix[(i, j)])
                .sum()
        })
        .collect()
}
