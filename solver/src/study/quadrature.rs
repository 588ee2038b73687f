//! The second route to c2: continuous adjoint, discretised on its own, and spectral quadrature.
//!
//! c2 = ⟨X†, G[1;3]⟩ / ⟨X†, M0 X[1;1]⟩, P (4.13), with every profile on at least 4M points.

use crate::error::{Error, Result};
use crate::model::layout::read_terms;
use crate::model::{BalanceId, C64, Jet, KernelId, Table, evaluate};
use crate::numerics::{beside, inverse_iteration};
use crate::problem::{Combination, Problem, Profile};
use crate::space::Quadrature;
use crate::spectrum::EigenPair;
use crate::weakly::{LandauPoint, Mode};

/// The adjoint eigenfunction X† and its eigenvalue.
pub struct AdjointMode {
    /// Its eigenvalue: the conjugate of c0 but for truncation.
    pub c: C64,
    /// Physical values at the adjoint problem's unknowns.
    pub values: Profile,
}

/// The eigenfunction of L† whose eigenvalue is nearest to the conjugate of c0.
///
/// # Errors
/// A model without adjoint boundary conditions, or an iteration that does not converge.
pub fn adjoint_mode(problem: &Problem, pair: &EigenPair) -> Result<AdjointMode> {
    let adjoint = problem.adjoint()?;
    let k = pair.k;
    let shift = beside(pair.c.conj(), pair.scale);
    let shifted = adjoint.matrix::<C64>(k, Combination::shifted(shift));
    let start = |i: usize| C64::new(1.0 + 0.3 * (i as f64).sin(), 0.0);
    let start: Vec<C64> = (0..adjoint.layout.size).map(start).collect();
    let mass = adjoint.mass(k);
    let starts = (start.clone(), start);
    let found = inverse_iteration(shifted, &mass, shift, pair.scale, starts).ok_or_else(|| {
        Error::computation(format!(
            "the adjoint mode at k = {k} was not found: L† has no isolated eigenvalue near the conjugate of c0 at \
             this M"
        ))
    })?;
    Ok(AdjointMode {
        c: found.c,
        values: adjoint.physical(&found.right),
    })
}

/// c2 by quadrature; `None` where boundary conditions are nonlinear, whose data this route leaves out.
///
/// # Errors
/// A model without adjoint.
pub fn second_landau(point: &LandauPoint, adjoint: &AdjointMode) -> Result<Option<C64>> {
    let problem = point.problem.as_ref();
    if problem.direct.walls.iter().any(|w| !w.nonlinear.is_empty()) {
        return Ok(None);
    }
    let (structure, layout) = (problem.structure(), &problem.adjoint()?.layout);
    let k = point.pair.k;
    let Quadrature { points, nodes } = problem.quadrature();
    let (first, mean, second) = (&point.fundamental, &point.mean, &point.second);
    let conjugate = first.conjugate();
    let jets = &structure.form_jets;
    let table = |mode: &Mode| mode.jets(problem, jets, points);
    let (j1, j1c, j0, j2) = (table(first), table(&conjugate), table(mean), table(second));
    let still = |jet: &Jet| Jet { t: 0, ..*jet };
    let mass_jets: Vec<Jet> = structure.linear.iter().map(|t| still(&t.jet)).collect();
    let mass_values = first.columns(problem, &mass_jets, points);
    let profile = |(_, block): (BalanceId, &crate::space::Block)| {
        let derivative = problem.space().derivative(block.points, points, 0);
        derivative.of(block.of(&adjoint.values))
    };
    let profiles: Table<BalanceId, Vec<C64>> = layout.columns.pairs().map(profile).collect();
    let (mut above, mut below) = (C64::new(0.0, 0.0), C64::new(0.0, 0.0));
    for (i, &(place, weight)) in nodes.iter().enumerate() {
        let base = problem.base.at(place, k);
        let c = evaluate(problem.model(), KernelId::Nonlinear, &base);
        let linear = evaluate(problem.model(), KernelId::Linear, &base);
        let (x, xc, m, s) = (j1.at(i), j1c.at(i), j0.at(i), j2.at(i));
        for (row, profile) in profiles.pairs() {
            // G[1;3] = 2 N2(X11, X02) + 2 N2(X̄11, X22) + 3 N3(X11, X11, X̄11)
            let mut forcing = C64::new(0.0, 0.0);
            if structure.forms[0][row] {
                forcing += 2.0 * problem.model().form(2, row, &c, &[x, m]);
                forcing += 2.0 * problem.model().form(2, row, &c, &[xc, s]);
            }
            if structure.forms[1][row] {
                forcing += 3.0 * problem.model().form(3, row, &c, &[x, x, xc]);
            }
            above += weight * profile[i].conj() * forcing;
        }
        let terms = read_terms(&structure.linear, &linear).zip(&mass_values);
        for ((term, coefficient), values) in terms.filter(|((t, _), _)| t.jet.t > 0) {
            below += weight * profiles[term.row][i].conj() * coefficient * values[i];
        }
    }
    Ok(Some(above / below))
}
