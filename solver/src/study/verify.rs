//! The certificate: what a coefficient rests on, checked part by part.

mod adjointness;
mod forms;
mod order;

use super::accuracy::{accuracy, resonance};
use super::quadrature::{adjoint_mode, second_landau};
use super::{Setup, check_wavenumber};
use crate::base::BaseState;
use crate::collocation::coefficients;
use crate::error::{Error, Result};
use crate::model::C64;
use crate::weakly::{LandauPoint, Selection};
use serde::Serialize;

pub use adjointness::duality;
pub use forms::second_route;
pub use order::{defects, floor, slope};

/// One line of the certificate.
#[derive(Clone, Debug, Serialize)]
pub struct Check {
    /// Part 1 to 5.
    pub part: usize,
    pub name: String,
    pub value: f64,
    /// What the value has to stay below (or, for a slope, reach).
    pub bound: f64,
    pub passed: bool,
    pub detail: String,
}

impl Check {
    fn below(
        part: usize,
        name: impl Into<String>,
        value: f64,
        bound: f64,
        detail: impl Into<String>,
    ) -> Self {
        let passed = value.is_finite() && value <= bound;
        Check {
            part,
            name: name.into(),
            value,
            bound,
            passed,
            detail: detail.into(),
        }
    }

    /// Reported, not judged.
    fn report(part: usize, name: impl Into<String>, value: f64, detail: impl Into<String>) -> Self {
        let passed = value.is_finite();
        Check {
            part,
            name: name.into(),
            value,
            bound: f64::INFINITY,
            passed,
            detail: detail.into(),
        }
    }
}

/// All five parts at one wavenumber.
///
/// # Errors
/// A point that cannot be computed at all.
pub fn verify(setup: &Setup, k: f64, selection: Selection) -> Result<Vec<Check>> {
    check_wavenumber(k)?;
    let base = setup.base(None)?;
    let mut checks = Vec::new();
    setup.with_point(&base, k, selection, |point| {
        checks.extend(order::check(point)?);
        checks.extend(adjointness::check(setup, &base, point)?);
        checks.extend(routes(point)?);
        checks.extend(forms::check(point.expansion.problem)?);
        checks.extend(convergence(setup, &base, point)?);
        Ok(())
    })?;
    Ok(checks)
}

/// Part 3: both routes to c2, biorthogonality.
fn routes(point: &LandauPoint) -> Result<Vec<Check>> {
    let problem = point.expansion.problem;
    if let Err(reason) = problem.adjoint() {
        return Ok(vec![Check::report(
            3,
            "continuous adjoint",
            0.0,
            format!("left out: {reason}"),
        )]);
    }
    let adjoint = adjoint_mode(problem, point.expansion.k, point.c0)?;
    let mut checks = Vec::new();
    let tolerance = if problem.resolution == 0 { 1e-10 } else { 1e-4 };
    match second_landau(point, &adjoint)? {
        Some(c2) => {
            let difference = (c2 - point.c2).norm() / point.c2.norm().max(1e-300);
            checks.push(Check::below(
                3,
                "c2 by two routes, relative",
                difference,
                tolerance,
                "discrete left vector against quadrature with the continuous adjoint",
            ));
        }
        None => checks.push(Check::report(
            3,
            "c2 by two routes",
            0.0,
            "left out: nonlinear boundary conditions",
        )),
    }
    let expansion = point.third_order()?;
    let bordered = (expansion.landau[1] - point.c2).norm() / point.c2.norm().max(1e-300);
    checks.push(Check::below(
        3,
        "c2 of the bordered problem, relative",
        bordered,
        1e-6,
        "multiplier against projection",
    ));
    Ok(checks)
}

/// Part 5: M against 3M/2, tails, distances from singularity, multipliers.
fn convergence(setup: &Setup, base: &BaseState, point: &LandauPoint) -> Result<Vec<Check>> {
    let mut checks = Vec::new();
    let error = accuracy(setup, base, point)?;
    let m = setup.effective_resolution();
    let detail = format!(
        "M = {m} against {}, and one route against the other",
        m + m.div_ceil(2)
    );
    let growth = point.c0.norm().max(1e-6);
    checks.push(Check::below(
        5,
        "error of c0, relative",
        error.c0 / growth,
        1e-3,
        detail.clone(),
    ));
    checks.push(Check::below(
        5,
        "error of c2, relative",
        error.c2 / point.c2.norm(),
        1e-3,
        detail,
    ));
    checks.push(Check::below(
        5,
        "tail of the base state",
        base.tail(),
        1e-9,
        format!("degree {}", base.degree),
    ));
    for (key, mode) in &point.expansion.modes {
        checks.push(Check::below(
            5,
            format!("tail of X[{};{}]", key.0, key.1),
            tail(point, &mode.values),
            1e-3,
            "last Chebyshev coefficients over the largest",
        ));
    }
    let resonance = resonance(point)?;
    let far = "distance of the k = 0 problem from singularity";
    if resonance.mean_flow.is_finite() {
        checks.push(Check::report(
            5,
            "distance to mean-flow resonance",
            resonance.mean_flow,
            far,
        ));
    }
    checks.push(Check::report(
        5,
        "distance to 2:1 resonance",
        resonance.second_harmonic,
        "distance of the 2k problem from singularity",
    ));
    for (kind, order, value) in &point.expansion.multipliers {
        checks.push(Check::below(
            5,
            format!("multiplier of the {kind:?} closure at order {order}"),
            *value,
            1e-6,
            "vanishes where the model keeps what it claims to conserve",
        ));
    }
    Ok(checks)
}

/// Size of the last Chebyshev coefficients of the worst field.
fn tail(point: &LandauPoint, values: &[C64]) -> f64 {
    let problem = point.expansion.problem;
    if problem.resolution == 0 {
        return 0.0;
    }
    let largest = values.iter().map(|v| v.norm()).fold(1e-300, f64::max);
    let mut worst = 0.0_f64;
    for block in &problem.direct.layout.columns {
        let own = &values[block.offset..block.offset + block.len];
        let fine = crate::collocation::GridKind::Lobatto(block.len);
        let on_extrema = super::quadrature::on_grid(problem, block.grid, fine, own);
        for part in [|v: &C64| v.re, |v: &C64| v.im] {
            let series = coefficients(&on_extrema.iter().map(part).collect::<Vec<f64>>());
            let last = series
                .iter()
                .rev()
                .take(3)
                .map(|c| c.abs())
                .fold(0.0, f64::max);
            worst = worst.max(last / largest);
        }
    }
    worst
}

/// The certificate fails as a whole if one check does.
///
/// # Errors
/// Names the checks that failed.
pub fn judge(checks: &[Check]) -> Result<()> {
    let failed: Vec<&str> = checks
        .iter()
        .filter(|c| !c.passed)
        .map(|c| c.name.as_str())
        .collect();
    if failed.is_empty() {
        return Ok(());
    }
    Err(Error::computation(format!(
        "the certificate does not hold: {}",
        failed.join("; ")
    )))
}
