//! The Landau point: c0, c2 and what belongs to them at one wavenumber.

use super::bifurcation::{Bifurcation, equilibrium};
use super::expansion::Expansion;
use super::normalisation::{quadrature_grid, quadrature_weights};
use crate::collocation::Grid;
use crate::dense::dot;
use crate::error::Result;
use crate::model::{C64, KernelId, evaluate};
use crate::problem::Problem;
use crate::spectrum::{self, EigenPair};

/// Which mode is meant.
#[derive(Clone, Copy, Debug)]
pub enum Selection<'a> {
    /// The one of largest growth rate.
    Leading,
    /// The one nearest to an eigenvalue.
    Near(C64),
    /// The continuation of a mode known nearby.
    Like(&'a EigenPair),
}

/// c0 and c2 with the modes up to second order.
pub struct LandauPoint<'p, 'm> {
    pub expansion: Expansion<'p, 'm>,
    pub c0: C64,
    pub c2: C64,
    /// What c2 is the sum of: one number for each product of modes that forces X[1;3].
    pub contributions: Vec<C64>,
}

/// The Landau point of a selected mode.
///
/// # Errors
/// A mode that is not found, a resonance.
pub fn point<'p, 'm>(
    problem: &'p Problem<'m>,
    k: f64,
    selection: Selection,
) -> Result<LandauPoint<'p, 'm>> {
    let pair = select(problem, k, selection)?;
    from_pair(problem, pair)
}

/// The selected mode.
///
/// # Errors
/// A mode that is not found.
pub fn select(problem: &Problem, k: f64, selection: Selection) -> Result<EigenPair> {
    match selection {
        Selection::Leading => spectrum::leading(problem, k),
        Selection::Near(target) => spectrum::nearest(problem, k, target),
        Selection::Like(pair) => spectrum::follow(problem, k, pair),
    }
}

/// The point that continues `near`: three factorisations.
///
/// # Errors
/// As [`point`].
pub fn warm_point<'p, 'm>(
    problem: &'p Problem<'m>,
    k: f64,
    near: &EigenPair,
) -> Result<LandauPoint<'p, 'm>> {
    point(problem, k, Selection::Like(near))
}

/// X[0;2], X[2;2] and c2 = ⟨left vector, G[1;3]⟩ / ⟨left vector, M0 X[1;1]⟩, P (3.22).
///
/// # Errors
/// A resonance.
pub fn from_pair<'p, 'm>(problem: &'p Problem<'m>, pair: EigenPair) -> Result<LandauPoint<'p, 'm>> {
    let c0 = pair.c;
    let mut expansion = Expansion::new(problem, pair)?;
    expansion.solve((0, 2))?;
    expansion.solve((2, 2))?;
    let forcing = expansion.products_forcing((1, 3));
    let contributions = expansion.project(&forcing);
    let c2 = contributions.iter().sum();
    Ok(LandauPoint {
        expansion,
        c0,
        c2,
        contributions,
    })
}

impl<'p, 'm> LandauPoint<'p, 'm> {
    /// The expansion carried on through X[1;3] (with c2 from the bordered problem) and X[3;3].
    ///
    /// # Errors
    /// A resonance.
    pub fn third_order(&self) -> Result<Expansion<'p, 'm>> {
        let mut expansion = Expansion::new(self.expansion.problem, self.expansion.pair.clone())?;
        expansion.solve((0, 2))?;
        expansion.solve((2, 2))?;
        expansion.solve_fundamental(3)?;
        expansion.solve((3, 3))?;
        Ok(expansion)
    }

    /// Σ |contribution to c2|: what its rounding errors are relative to.
    pub fn size(&self) -> f64 {
        self.contributions.iter().map(|c| c.norm()).sum()
    }

    /// A_e² = −a0/a2 where that is positive, P (4.1).
    pub fn amplitude(&self) -> Option<f64> {
        let floor = self.rounding();
        equilibrium((self.c0, floor[0]), (self.c2, floor[1]))
    }

    /// The kind of bifurcation, rounding set aside.
    pub fn bifurcation(&self) -> Bifurcation {
        let floor = self.rounding();
        Bifurcation::new((self.c0, floor[0]), (self.c2, floor[1]))
    }

    /// What rounding leaves undecided of c0 and c2 at least.
    pub fn rounding(&self) -> [f64; 2] {
        let scale = self.expansion.pair.scale.max(self.c0.norm());
        [1e-14 * scale, 1e-14 * self.size()]
    }
}

impl Expansion<'_, '_> {
    /// ⟨left vector, forcing⟩ / ⟨left vector, M0 X[1;1]⟩ of each, with the discrete left vector.
    pub fn project(&self, forcing: &[Vec<C64>]) -> Vec<C64> {
        let mass = self.problem.mass::<C64>(self.k);
        let mass_x = mass.apply(&self.solver_basis(&self.modes[&(1, 1)].values));
        let below = dot(&self.pair.left, &mass_x);
        let above = forcing.iter().map(|f| dot(&self.pair.left, f));
        above.map(|a| a / below).collect()
    }
}

/// The value of an output functional: at the base, and the A² correction of its mean.
pub fn outputs(point: &LandauPoint) -> Vec<[f64; 2]> {
    let problem = point.expansion.problem;
    let structure = problem.structure();
    let fundamental = &point.expansion.modes[&(1, 1)];
    let (mean, conjugate) = (&point.expansion.modes[&(0, 2)], fundamental.conjugate());
    let k = point.expansion.k;
    let grid = quadrature_grid(problem);
    let mut position = 0;
    let mut values = Vec::new();
    for output in &structure.outputs {
        // Nodes with weights: one place, or a quadrature.
        let first = evaluate(
            problem.model,
            KernelId::Outputs,
            &problem.base.point(problem.model, -1.0, k),
        );
        let (nodes, weights) = if output.at_point && problem.resolution > 0 {
            (
                vec![-1.0 + (first[position] - problem.base.lower) * problem.base.scale()],
                vec![1.0],
            )
        } else {
            (Grid::new(grid).nodes, quadrature_weights(problem, grid))
        };
        let mut total = [0.0; 2];
        for (xi, weight) in nodes.iter().zip(&weights) {
            let out = evaluate(
                problem.model,
                KernelId::Outputs,
                &problem.base.point(problem.model, *xi, k),
            );
            for (offset, monomial) in output.monomials.iter().enumerate() {
                let coefficient = weight * out[position + 1 + offset];
                match monomial.as_slice() {
                    [] => total[0] += coefficient,
                    [jet] => total[1] += coefficient * value_at(mean, problem, k, *jet, *xi).re,
                    [a, b] => {
                        let product = value_at(fundamental, problem, k, *a, *xi)
                            * value_at(&conjugate, problem, k, *b, *xi);
                        total[1] += coefficient * 2.0 * product.re;
                    }
                    _ => {}
                }
            }
        }
        position += 1 + output.monomials.len();
        values.push(total);
    }
    values
}

/// A jet of a mode at one point of [−1, 1].
pub fn value_at(
    mode: &super::Mode,
    problem: &Problem,
    k: f64,
    jet: crate::model::Jet,
    xi: f64,
) -> C64 {
    let field = usize::from(jet.field);
    let Some(block) = problem.direct.layout.columns.get(field) else {
        return mode.jet(problem, k, jet, crate::collocation::GridKind::Point)[0];
    };
    if problem.resolution == 0 {
        return mode.jet(problem, k, jet, crate::collocation::GridKind::Point)[0];
    }
    let own = mode.jet(problem, k, jet, block.grid);
    let row = Grid::new(block.grid).interpolate_to(&[xi]);
    own.iter().enumerate().map(|(j, v)| v * row[(0, j)]).sum()
}
