//! dc0/d(parameter): ⟨Y, (∂L − c0 ∂M0) X⟩ / ⟨Y, M0 X⟩, the base state moving along.

use super::Setup;
use crate::base::BaseState;
use crate::dense::{apply, dot};
use crate::error::Result;
use crate::model::C64;
use crate::problem::{Combination, Problem};
use crate::spectrum::EigenPair;
use rayon::prelude::*;

/// Relative step of the difference formula, of fourth order, for the operators.
const STEP: f64 = 1e-3;

/// dc0/dp for every parameter that is a number and not determined by the base.
///
/// The operators' derivative is a fourth-order difference; modes are not differenced. A parameter that L, its
/// conditions and the base state do not hold gives zero exactly.
pub fn parameters(setup: &Setup, base: &BaseState, pair: &EigenPair) -> Vec<(usize, Result<C64>)> {
    let structure = setup.model.structure();
    let free: Vec<usize> = (0..structure.parameters.len())
        .filter(|&i| structure.parameters[i].choices.is_empty() && !setup.parameters.automatic[i])
        .collect();
    free.into_par_iter()
        .map(|index| (index, one(setup, base, pair, index)))
        .collect()
}

fn one(setup: &Setup, base: &BaseState, pair: &EigenPair, index: usize) -> Result<C64> {
    let info = &setup.model.structure().parameters[index];
    let value = setup.parameters.values[index];
    let step = STEP * if value == 0.0 { 1.0 } else { value.abs() };
    let shifted = |shift: f64| -> Result<C64> {
        let mut moved = setup.clone();
        // The formula may reach past a declared range.
        moved.parameters.values[index] = value + shift * step;
        let state = moved.base(Some(base))?;
        quotient_at(&moved, &state, pair)
    };
    // A base state that is solved for anew differs by rounding where the parameter does nothing.
    let floor = 1e-13 * pair.c.norm().max(pair.scale) / step;
    let settled = |slope: C64| {
        let part = |x: f64| if x.abs() <= floor { 0.0 } else { x };
        C64::new(part(slope.re), part(slope.im))
    };
    // Inside the range if need be: one-sided where a bound is near.
    let room = |side: f64| {
        let reach = value + side * 2.0 * step;
        reach >= info.lower && reach <= info.upper
    };
    if room(-1.0) && room(1.0) {
        // (f(−2h) − 8 f(−h) + 8 f(h) − f(2h)) / 12h
        let (a, b) = (shifted(-2.0)?, shifted(-1.0)?);
        let (c, d) = (shifted(1.0)?, shifted(2.0)?);
        return Ok(settled(((a - d) + 8.0 * (c - b)) / (12.0 * step)));
    }
    let side = if room(1.0) { 1.0 } else { -1.0 };
    // (−25 f0 + 48 f1 − 36 f2 + 16 f3 − 3 f4) / 12h
    // The weights sum to zero, so that differences from f0 do.
    let weights = [-25.0, 48.0, -36.0, 16.0, -3.0];
    let first = shifted(0.0)?;
    let mut total = C64::new(0.0, 0.0);
    for (i, weight) in weights.iter().enumerate().skip(1) {
        total += *weight * (shifted(side * 0.5 * i as f64)? - first);
    }
    Ok(settled(total / (12.0 * 0.5 * step * side)))
}

/// ⟨Y, L X⟩ / ⟨Y, M0 X⟩ with the vectors of another state: stationary at the mode itself.
fn quotient_at(setup: &Setup, base: &BaseState, pair: &EigenPair) -> Result<C64> {
    setup.with_problem(base, |problem| {
        let above = dot(&pair.left, &problem.operator(pair.k).apply(&pair.right));
        Ok(above / dot(&pair.left, &problem.mass(pair.k).apply(&pair.right)))
    })
}

/// dc0/dk, exactly: k enters through (ik)^a |k|^b alone.
pub fn wavenumber(problem: &Problem, pair: &EigenPair) -> C64 {
    let combination = Combination {
        mass: -pair.c,
        operator: C64::new(1.0, 0.0),
        walls: 1.0,
    };
    let derivative = problem.direct.wavenumber_derivative::<C64>(
        problem.discretisation,
        problem.scale(),
        pair.k,
        combination,
    );
    let mass = problem.mass::<C64>(pair.k);
    let above = dot(&pair.left, &apply(derivative.as_ref(), &pair.right));
    above / dot(&pair.left, &mass.apply(&pair.right))
}
