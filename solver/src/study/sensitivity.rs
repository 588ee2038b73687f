//! dc0/d(parameter): ⟨Y, (∂L − c0 ∂M0) X⟩ / ⟨Y, M0 X⟩, the base state moving along; dc0/dk.

use super::Setup;
use crate::base::{BaseState, automatic_conditions};
use crate::error::{Error, Result};
use crate::model::{C64, ParameterId};
use crate::numerics::Applied;
use crate::numerics::dense::dot;
use crate::problem::Combination;
use crate::spectrum::EigenPair;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use std::sync::Arc;

/// Relative step of the difference formula, of fourth order, for the operators.
const STEP: f64 = 1e-3;
/// Times that another size has to be larger to be tried.
const LARGER: f64 = 1e3;
/// What rounding leaves of a base state that is solved for anew, relative.
const ROUNDING: f64 = 1e-13;

/// Derivatives by one parameter, the others fixed: of c0, and of the conditions of automatic parameters.
struct Partial {
    growth: C64,
    conditions: DVector<f64>,
}

/// dc0/dp for every parameter that varies continuously and is not determined by the base.
///
/// The operators' derivative is a fourth-order difference; modes are not differenced. A parameter that L, its
/// conditions and the base state do not hold gives zero exactly. Automatic parameters follow their conditions
/// g = 0: dc0/dp = ∂c0/∂p − ∂c0/∂h (∂g/∂h)⁻¹ ∂g/∂p.
pub fn parameters(
    setup: &Setup,
    base: &BaseState,
    pair: &EigenPair,
) -> Vec<(ParameterId, Result<C64>)> {
    let structure = setup.model.structure();
    let numbers = structure.parameters.ids();
    let numbers = numbers.filter(|&id| structure.parameters[id].is_continuous());
    let (automatic, free): (Vec<ParameterId>, Vec<ParameterId>) =
        numbers.partition(|&id| setup.parameters.automatic[id]);
    let partial = |&id: &ParameterId| partial(setup, base, pair, id, &automatic);
    let own: Result<Vec<Partial>> = automatic.par_iter().map(partial).collect();
    let follow = |found: Result<Partial>| -> Result<C64> {
        let found = found?;
        if automatic.is_empty() {
            return Ok(found.growth);
        }
        let own = own.as_ref().map_err(Clone::clone)?;
        let columns: Vec<_> = own.iter().map(|p| p.conditions.clone()).collect();
        let moved = DMatrix::from_columns(&columns)
            .lu()
            .solve(&found.conditions)
            .ok_or_else(|| Error::computation("an automatic parameter is not determined"))?;
        let along: C64 = own
            .iter()
            .zip(moved.iter())
            .map(|(p, m)| p.growth * *m)
            .sum();
        Ok(found.growth - along)
    };
    let found: Vec<(ParameterId, Result<Partial>)> =
        free.par_iter().map(|id| (*id, partial(id))).collect();
    found.into_iter().map(|(id, p)| (id, follow(p))).collect()
}

/// With a step that belongs to the parameter's value; where that is as good as zero, and rounding hides what the step
/// does, to its default, or to one.
fn partial(
    setup: &Setup,
    base: &BaseState,
    pair: &EigenPair,
    parameter: ParameterId,
    automatic: &[ParameterId],
) -> Result<Partial> {
    let info = &setup.model.structure().parameters[parameter];
    let mut sizes: Vec<f64> = Vec::new();
    for size in [base.parameters.values[parameter], info.default, 1.0] {
        let larger = sizes.last().is_none_or(|last| size.abs() > LARGER * last);
        if size != 0.0 && larger {
            sizes.push(size.abs());
        }
    }
    let by = |size: &f64| partial_by(setup, base, pair, parameter, automatic, STEP * size);
    let (own, larger) = sizes.split_first().unwrap_or((&1.0, &[]));
    let found = by(own)?;
    let acts =
        |p: &Partial| p.growth != C64::new(0.0, 0.0) || p.conditions.iter().any(|c| *c != 0.0);
    if acts(&found) {
        return Ok(found);
    }
    // A larger step may leave where the model makes sense.
    let mut others = larger.iter().filter_map(|size| by(size).ok());
    Ok(others.find(acts).unwrap_or(found))
}

fn partial_by(
    setup: &Setup,
    base: &BaseState,
    pair: &EigenPair,
    parameter: ParameterId,
    automatic: &[ParameterId],
    step: f64,
) -> Result<Partial> {
    let info = &setup.model.structure().parameters[parameter];
    let value = base.parameters.values[parameter];
    let shifted = |shift: f64| -> Result<Partial> {
        let mut moved = setup.clone();
        // The formula may reach past a declared range.
        moved.parameters = base.parameters.clone();
        moved.parameters.automatic.fill(false);
        moved.parameters.values[parameter] = value + shift * step;
        let state = Arc::new(base.moved(&moved.parameters)?);
        Ok(Partial {
            growth: quotient_at(&moved, &state, pair)?,
            conditions: automatic_conditions(&state, automatic),
        })
    };
    // Inside the range if need be: one-sided where a bound is near.
    let room = |side: f64| {
        let reach = value + side * 2.0 * step;
        reach >= info.lower && reach <= info.upper
    };
    // The weights of a formula sum to zero, so that differences from one of its points do.
    let (places, weights, scale): (Vec<f64>, Vec<f64>, f64) = if room(-1.0) && room(1.0) {
        // (f(−2h) − 8 f(−h) + 8 f(h) − f(2h)) / 12h
        let weights = vec![1.0, -8.0, 8.0, -1.0];
        (vec![-2.0, -1.0, 1.0, 2.0], weights, 12.0 * step)
    } else {
        // (−25 f0 + 48 f1 − 36 f2 + 16 f3 − 3 f4) / 12h
        let side = if room(1.0) { 0.5 } else { -0.5 };
        let places = (0..5).map(|i| side * f64::from(i)).collect();
        let weights = vec![-25.0, 48.0, -36.0, 16.0, -3.0];
        (places, weights, 12.0 * side * step)
    };
    let points: Result<Vec<Partial>> = places.into_iter().map(shifted).collect();
    let points = points?;
    let (mut growth, mut conditions) = (C64::new(0.0, 0.0), points[0].conditions.clone() * 0.0);
    for (point, weight) in points.iter().zip(&weights).skip(1) {
        growth += (point.growth - points[0].growth) * *weight;
        conditions += (&point.conditions - &points[0].conditions) * *weight;
    }
    // A base state that is solved for anew differs by rounding where the parameter does nothing.
    let floor = ROUNDING * pair.c.norm().max(pair.scale) / step;
    let part = |x: f64| if x.abs() <= floor { 0.0 } else { x };
    let growth = growth / scale;
    Ok(Partial {
        growth: C64::new(part(growth.re), part(growth.im)),
        conditions: conditions / scale,
    })
}

/// ⟨Y, L X⟩ / ⟨Y, M0 X⟩ with the vectors of another state: stationary at the mode itself.
fn quotient_at(setup: &Setup, base: &Arc<BaseState>, pair: &EigenPair) -> Result<C64> {
    let direct = &setup.problem(base)?.direct;
    let operator = direct.blocks(pair.k, Combination::OPERATOR);
    let above = dot(&pair.left, &operator.apply(&pair.right));
    Ok(above / dot(&pair.left, &direct.mass(pair.k).apply(&pair.right)))
}
