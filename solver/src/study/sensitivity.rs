//! dc0/d(parameter): ⟨Y, (∂L − c0 ∂M0) X⟩ / ⟨Y, M0 X⟩, the base state moving along; dc0/dk.

use super::Setup;
use super::error_bars::{Companions, ROUNDINGS, SAFETY};
use crate::base::{BaseState, automatic_conditions};
use crate::error::{Error, Result};
use crate::measured::Measured;
use crate::model::{C64, ParameterId};
use crate::numerics::dense::dot;
use crate::numerics::{Applied, Noise};
use crate::problem::{Combination, Direct, Problem};
use crate::spectrum::EigenPair;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use std::sync::Arc;

/// Relative step of the difference formula, of fourth order and more, for the operators.
const STEP: f64 = 1e-3;
/// Times that another size has to be larger to be tried.
const LARGER: f64 = 1e3;
/// An error that is a larger part of the derivative is reason to try a larger step.
const GOOD: f64 = 1e-7;
/// What rounding leaves of a base state that is solved for anew, relative.
const ROUNDING: f64 = 1e-13;

/// Vectors of a mode at one resolution, between which the operators' derivative is taken.
struct Probe<'a> {
    resolution: Option<usize>,
    pairs: Vec<&'a EigenPair>,
}

/// Derivatives by one parameter, the others fixed: of c0 by every pair of every probe, with what the difference formula
/// leaves undecided of the first; and of the conditions of automatic parameters.
struct Partial {
    growth: Vec<C64>,
    error: f64,
    conditions: DVector<f64>,
}

/// dc0/dp for every parameter that varies continuously and is not determined by the base.
///
/// The operators' derivative is a difference of high order; modes are not differenced. A parameter that L, its
/// conditions and the base state do not hold gives zero exactly. Automatic parameters follow their conditions
/// g = 0: dc0/dp = ∂c0/∂p − ∂c0/∂h (∂g/∂h)⁻¹ ∂g/∂p.
pub fn parameters(
    setup: &Setup,
    base: &BaseState,
    pair: &EigenPair,
) -> Vec<(ParameterId, Result<C64>)> {
    let probe = Probe {
        resolution: setup.effective_resolution(),
        pairs: vec![pair],
    };
    let all = derivatives(setup, base, &[probe], &free(setup)).into_iter();
    all.map(|(id, partial)| (id, partial.map(|p| p.growth[0])))
        .collect()
}

/// The same for one parameter.
///
/// # Errors
/// A parameter that is determined by the base; a base state beside that cannot be found.
pub fn parameter(
    setup: &Setup,
    base: &BaseState,
    pair: &EigenPair,
    parameter: ParameterId,
) -> Result<C64> {
    let probe = Probe {
        resolution: setup.effective_resolution(),
        pairs: vec![pair],
    };
    if !free(setup).contains(&parameter) {
        return Err(Error::computation(
            "the parameter follows from the base state",
        ));
    }
    let partial = derivatives(setup, base, &[probe], &[parameter]).pop();
    let (_, partial) = partial.ok_or_else(|| Error::computation("there is no such parameter"))?;
    Ok(partial?.growth[0])
}

/// Parameters that vary continuously.
fn continuous(setup: &Setup) -> impl Iterator<Item = ParameterId> {
    let structure = setup.model.structure();
    let numbers = structure.parameters.ids();
    numbers.filter(|&id| structure.parameters[id].is_continuous())
}

/// Those of them that are not determined by the base.
fn free(setup: &Setup) -> Vec<ParameterId> {
    let free = continuous(setup).filter(|&id| !setup.parameters.automatic[id]);
    free.collect()
}

/// The same with errors: those of the difference formula, and what the companions of the mode change.
pub fn measured(
    setup: &Setup,
    problem: &Problem,
    pair: &EigenPair,
    companions: &Companions,
) -> Vec<(ParameterId, Result<Measured<C64>>)> {
    // Modes with other rounding are probes of the operators themselves; those elsewhere of operators there.
    let mut probes = vec![Probe {
        resolution: problem.resolution,
        pairs: vec![pair],
    }];
    let mut weights = vec![0.0];
    let mut refined = None;
    let mut missing = false;
    for companion in companions.iter() {
        let Ok(companion) = companion else {
            missing = true;
            continue;
        };
        let (there, moved) = (&companion.problem, &companion.pairs[0]);
        if !Arc::ptr_eq(&there.base, &problem.base) {
            refined = Some((companion, moved));
        } else if there.noise.is_some() {
            probes[0].pairs.push(moved);
            weights.insert(probes[0].pairs.len() - 1, companion.weight);
        } else {
            probes.push(Probe {
                resolution: there.resolution,
                pairs: vec![moved],
            });
            weights.push(companion.weight);
        }
    }
    let free = free(setup);
    let beside = refined.map(|(companion, moved)| {
        let probe = Probe {
            resolution: problem.resolution,
            pairs: vec![moved],
        };
        (
            companion.weight,
            derivatives(setup, &companion.problem.base, &[probe], &free),
        )
    });
    let here = derivatives(setup, &problem.base, &probes, &free).into_iter();
    let measure = |(index, partial): (usize, Partial)| {
        let value = partial.growth[0];
        let differences = partial.growth.iter().zip(&weights);
        let mut error = differences
            .map(|(there, weight)| weight * (there - value).norm())
            .fold(partial.error, f64::max);
        if let Some((weight, all)) = &beside {
            let there = all[index].1.as_ref();
            let difference = there.map_or(f64::INFINITY, |p| (p.growth[0] - value).norm());
            error = error.max(weight * difference);
        }
        Measured::new(value, if missing { f64::INFINITY } else { error })
    };
    here.enumerate()
        .map(|(index, (id, found))| (id, found.map(|partial| measure((index, partial)))))
        .collect()
}

fn derivatives(
    setup: &Setup,
    base: &BaseState,
    probes: &[Probe],
    free: &[ParameterId],
) -> Vec<(ParameterId, Result<Partial>)> {
    let automatic = continuous(setup).filter(|&id| setup.parameters.automatic[id]);
    let automatic: Vec<ParameterId> = automatic.collect();
    let difference = Difference {
        setup,
        base,
        probes,
        automatic: &automatic,
    };
    let partial = |&id: &ParameterId| difference.by(id);
    let own: Result<Vec<Partial>> = automatic.par_iter().map(partial).collect();
    let follow = |found: Result<Partial>| -> Result<Partial> {
        let mut found = found?;
        if automatic.is_empty() {
            return Ok(found);
        }
        let own = own.as_ref().map_err(Clone::clone)?;
        let columns: Vec<_> = own.iter().map(|p| p.conditions.clone()).collect();
        let moved = DMatrix::from_columns(&columns)
            .lu()
            .solve(&found.conditions)
            .ok_or_else(|| Error::computation("an automatic parameter is not determined"))?;
        for (p, m) in own.iter().zip(moved.iter()) {
            let pairs = found.growth.iter_mut().zip(&p.growth);
            pairs.for_each(|(growth, along)| *growth -= along * *m);
            found.error += p.error * m.abs();
        }
        Ok(found)
    };
    let found: Vec<(ParameterId, Result<Partial>)> =
        free.par_iter().map(|id| (*id, partial(id))).collect();
    found.into_iter().map(|(id, p)| (id, follow(p))).collect()
}

/// A difference formula: places in units of the step, weights of fourth order and of a higher one.
struct Formula {
    places: Vec<f64>,
    fourth: Vec<f64>,
    higher: Vec<f64>,
}

/// (f(−2h) − 8 f(−h) + 8 f(h) − f(2h)) / 12h and (−f(−3h) + 9 f(−2h) − 45 f(−h) + 45 f(h) − …) / 60h
fn central() -> Formula {
    let over = |weights: [f64; 6], divisor: f64| weights.map(|w| w / divisor).to_vec();
    Formula {
        places: vec![-3.0, -2.0, -1.0, 1.0, 2.0, 3.0],
        fourth: over([0.0, 1.0, -8.0, 8.0, -1.0, 0.0], 12.0),
        higher: over([-1.0, 9.0, -45.0, 45.0, -9.0, 1.0], 60.0),
    }
}

/// (−25 f0 + 48 f1 − 36 f2 + 16 f3 − 3 f4) / 12h and (−137 f0 + 300 f1 − 300 f2 + 200 f3 − 75 f4 + 12 f5) / 60h,
/// h half a step to one side.
fn one_sided(side: f64) -> Formula {
    let h = 0.5 * side;
    let over = |weights: [f64; 6], divisor: f64| weights.map(|w| w / (divisor * h)).to_vec();
    Formula {
        places: (0..6).map(|i| h * f64::from(i)).collect(),
        fourth: over([-25.0, 48.0, -36.0, 16.0, -3.0, 0.0], 12.0),
        higher: over([-137.0, 300.0, -300.0, 200.0, -75.0, 12.0], 60.0),
    }
}

/// Derivatives of the quotients of some probes.
struct Difference<'a> {
    setup: &'a Setup,
    base: &'a BaseState,
    probes: &'a [Probe<'a>],
    automatic: &'a [ParameterId],
}

impl Difference<'_> {
    /// With a step that belongs to the parameter's value; where rounding hides what the step does, as at a value that
    /// is as good as zero, with one that belongs to its default, or to one.
    fn by(&self, parameter: ParameterId) -> Result<Partial> {
        let info = &self.setup.model.structure().parameters[parameter];
        let mut sizes: Vec<f64> = Vec::new();
        for size in [self.base.parameters.values[parameter], info.default, 1.0] {
            let larger = sizes.last().is_none_or(|last| size.abs() > LARGER * last);
            if size != 0.0 && larger {
                sizes.push(size.abs());
            }
        }
        let (own, larger) = sizes.split_first().unwrap_or((&1.0, &[]));
        let mut best = self.by_step(parameter, STEP * own)?;
        for size in larger {
            let acts =
                best.growth[0] != C64::new(0.0, 0.0) || best.conditions.iter().any(|c| *c != 0.0);
            if acts && best.error <= GOOD * best.growth[0].norm() {
                break;
            }
            // A larger step may leave where the model makes sense.
            if let Ok(next) = self.by_step(parameter, STEP * size)
                && (!acts || next.error < best.error)
            {
                best = next;
            }
        }
        Ok(best)
    }

    fn by_step(&self, parameter: ParameterId, step: f64) -> Result<Partial> {
        let info = &self.setup.model.structure().parameters[parameter];
        let value = self.base.parameters.values[parameter];
        // Inside the range if need be: one-sided where a bound is near.
        let room = |side: f64| {
            let reach = value + side * 3.0 * step;
            reach >= info.lower && reach <= info.upper
        };
        let formula = match (room(-1.0), room(1.0)) {
            (true, true) => central(),
            (_, true) => one_sided(1.0),
            (_, false) => one_sided(-1.0),
        };
        let at = |place: &f64| self.at(parameter, value + place * step);
        let points: Vec<Partial> = formula.places.iter().map(at).collect::<Result<_>>()?;
        // The weights of a formula sum to zero, so that differences from one of its points do.
        let growth = |weights: &[f64], index: usize| -> C64 {
            let first = points[0].growth[index];
            let terms = points.iter().zip(weights);
            let sum: C64 = terms.map(|(p, w)| (p.growth[index] - first) * *w).sum();
            sum / step
        };
        let mut conditions = points[0].conditions.clone() * 0.0;
        for (point, weight) in points.iter().zip(&formula.higher) {
            conditions += (&point.conditions - &points[0].conditions) * (*weight / step);
        }
        let count = points[0].growth.len();
        let values: Vec<C64> = (0..count).map(|i| growth(&formula.higher, i)).collect();
        if points.iter().all(|p| p.growth[0] == points[0].growth[0]) {
            return Ok(Partial {
                growth: values,
                error: 0.0,
                conditions,
            });
        }
        let rounding = self.rounding(parameter, step)?;
        // A base state that is solved for anew differs by rounding where the parameter does nothing.
        let part = |x: f64| if x.abs() <= rounding { 0.0 } else { x };
        let settled = |c: C64| C64::new(part(c.re), part(c.im));
        let truncation = (growth(&formula.fourth, 0) - values[0]).norm();
        Ok(Partial {
            growth: values.into_iter().map(settled).collect(),
            error: truncation.max(rounding),
            conditions,
        })
    }

    /// What rounding of the quotients makes of a difference quotient.
    fn rounding(&self, parameter: ParameterId, step: f64) -> Result<f64> {
        let probe = &self.probes[0];
        let pair = probe.pairs[0];
        let direct = Problem::linear(self.base, probe.resolution)?;
        let exact = quotient(&direct, pair);
        let disturbed = quotient(&direct.disturbed(Noise::new(0)), pair);
        let evaluated = ROUNDINGS * f64::EPSILON / Noise::SIZE * (disturbed - exact).norm();
        // The base state solved once more at the parameters that it has.
        let value = self.base.parameters.values[parameter];
        let again = self.at(parameter, value)?.growth[0];
        let mut solved = SAFETY * (again - exact).norm();
        if solved > 0.0 {
            solved = solved.max(ROUNDING * pair.c.norm().max(pair.scale));
        }
        Ok(evaluated.max(solved) / step)
    }

    /// The quotients of all probes, and the conditions, at a value of the parameter.
    fn at(&self, parameter: ParameterId, value: f64) -> Result<Partial> {
        // The formula may reach past a declared range.
        let mut moved = self.base.parameters.clone();
        moved.automatic.fill(false);
        moved.values[parameter] = value;
        let state = self.base.moved(&moved)?;
        let mut growth = Vec::new();
        for probe in self.probes {
            let direct = Problem::linear(&state, probe.resolution)?;
            growth.extend(probe.pairs.iter().map(|pair| quotient(&direct, pair)));
        }
        Ok(Partial {
            growth,
            error: 0.0,
            conditions: automatic_conditions(&state, self.automatic),
        })
    }
}

/// ⟨Y, L X⟩ / ⟨Y, M0 X⟩ with the vectors of another state: stationary at the mode itself.
fn quotient(direct: &Direct, pair: &EigenPair) -> C64 {
    let operator = direct.blocks(pair.k, Combination::OPERATOR);
    let above = dot(&pair.left, &operator.apply(&pair.right));
    above / dot(&pair.left, &direct.mass(pair.k).apply(&pair.right))
}
