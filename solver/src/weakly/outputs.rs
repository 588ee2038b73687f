//! Output functionals of the state, to second order in the amplitude.

use super::cubic::LandauPoint;
use super::mode::Mode;
use super::normalisation::{quadrature_grid, quadrature_weights};
use crate::collocation::{Grid, GridKind};
use crate::model::layout::read_output;
use crate::model::{C64, Jet, KernelId, evaluate};
use crate::problem::Problem;

/// The value of an output functional: at the base, and the A² correction of its mean.
pub fn outputs(point: &LandauPoint) -> Vec<[f64; 2]> {
    let problem = point.problem;
    let structure = problem.structure();
    let (fundamental, mean) = (&point.fundamental, &point.mean);
    let conjugate = fundamental.conjugate();
    let k = point.k();
    let grid = quadrature_grid(problem);
    let terms_at = |index: usize, xi: f64| {
        let state = problem.base.point(problem.model, xi, k);
        let out = evaluate(problem.model, KernelId::Outputs, &state);
        read_output(&structure.outputs, index, &out)
    };
    let mut values = Vec::new();
    for (index, output) in structure.outputs.iter().enumerate() {
        // Nodes with weights: one place, or a quadrature.
        let (nodes, weights) = if output.at_point && problem.resolution > 0 {
            let place = terms_at(index, -1.0).place;
            let xi = -1.0 + (place - problem.base.lower) * problem.base.scale();
            (vec![xi], vec![1.0])
        } else {
            (Grid::new(grid).nodes, quadrature_weights(problem, grid))
        };
        let mut total = [0.0; 2];
        for (xi, weight) in nodes.iter().zip(&weights) {
            let coefficients = terms_at(index, *xi).coefficients;
            for (monomial, coefficient) in output.monomials.iter().zip(coefficients) {
                let coefficient = weight * coefficient;
                match monomial.as_slice() {
                    [] => total[0] += coefficient,
                    [jet] => total[1] += coefficient * value_at(mean, problem, *jet, *xi).re,
                    [a, b] => {
                        let product = value_at(fundamental, problem, *a, *xi)
                            * value_at(&conjugate, problem, *b, *xi);
                        total[1] += coefficient * 2.0 * product.re;
                    }
                    _ => {}
                }
            }
        }
        values.push(total);
    }
    values
}

/// A jet of a mode at one point of [−1, 1].
pub fn value_at(mode: &Mode, problem: &Problem, jet: Jet, xi: f64) -> C64 {
    let field = usize::from(jet.field);
    let Some(block) = problem.direct.layout.columns.get(field) else {
        return mode.jet(problem, jet, GridKind::Point)[0];
    };
    if problem.resolution == 0 {
        return mode.jet(problem, jet, GridKind::Point)[0];
    }
    let own = mode.jet(problem, jet, block.grid);
    let row = Grid::new(block.grid).interpolate_to(&[xi]);
    own.iter().enumerate().map(|(j, v)| v * row[(0, j)]).sum()
}
