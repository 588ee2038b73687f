//! The certificate: what a coefficient rests on, checked part by part.

mod adjointness;
mod forms;
mod order;

use super::Setup;
use super::accuracy::{Accuracy, SINGULAR, accuracy, resonance, slow_rate};
use super::orders::check_order;
use super::quadrature::{adjoint_mode, second_landau};
use crate::error::{Error, Result};
use crate::problem::{Problem, Profile};
use crate::series::Monomial;
use crate::wavevector::WaveVector;
use crate::weakly::{self, Expansion, LEFT_OVER, LandauPoint, Multiplier, Selection};
use crate::words;
use serde_json::{Value, json};
use std::fmt;

pub use adjointness::duality;
pub use forms::second_route;
pub use order::{DEFECTS, ResidualOrder, residual_order, residual_order_told};

/// What became of a check.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The value is within its bound.
    Passed,
    /// It is not, or is no number.
    Failed,
    /// A value to know, not judged.
    Reported,
    /// Not made, and why.
    LeftOut(String),
}

impl Verdict {
    fn by(passed: bool) -> Self {
        if passed {
            Verdict::Passed
        } else {
            Verdict::Failed
        }
    }

    /// The word for it.
    pub fn word(&self) -> &'static str {
        match self {
            Verdict::Passed => "passed",
            Verdict::Failed => "failed",
            Verdict::Reported => "reported",
            Verdict::LeftOut(_) => "left out",
        }
    }
}

/// One line of the certificate.
#[derive(Clone, Debug)]
pub struct Check {
    /// Part 1 to 5.
    pub part: usize,
    /// What is checked.
    pub name: String,
    /// NaN where the check was left out.
    pub value: f64,
    /// What the value has to stay below (or, for a slope, reach).
    pub bound: f64,
    /// What became of it.
    pub verdict: Verdict,
    /// How, or at what.
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
        Check {
            part,
            name: name.into(),
            value,
            bound,
            verdict: Verdict::by(value.is_finite() && value <= bound),
            detail: detail.into(),
        }
    }

    /// Reported, not judged; what is no number failed all the same.
    fn report(part: usize, name: impl Into<String>, value: f64, detail: impl Into<String>) -> Self {
        let verdict = match value.is_finite() {
            true => Verdict::Reported,
            false => Verdict::Failed,
        };
        Check {
            part,
            name: name.into(),
            value,
            bound: f64::INFINITY,
            verdict,
            detail: detail.into(),
        }
    }

    fn left_out(part: usize, name: impl Into<String>, reason: impl Into<String>) -> Self {
        Check {
            part,
            name: name.into(),
            value: f64::NAN,
            bound: f64::NAN,
            verdict: Verdict::LeftOut(reason.into()),
            detail: String::new(),
        }
    }

    fn json(&self) -> Value {
        let reason = match &self.verdict {
            Verdict::LeftOut(reason) => Some(reason),
            _ => None,
        };
        json!({
            "part": self.part,
            "name": self.name,
            "value": words::number(self.value),
            "bound": words::number(self.bound),
            "verdict": self.verdict.word(),
            "reason": reason,
            "detail": self.detail,
        })
    }
}

impl fmt::Display for Check {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mark = match &self.verdict {
            Verdict::LeftOut(reason) => {
                return write!(f, "  left out {:<48} {reason}", self.name);
            }
            Verdict::Passed => "passed",
            Verdict::Failed => "FAILED",
            Verdict::Reported => "value",
        };
        write!(
            f,
            "  {mark:<8} {:<48} {:>12.4e}   {}",
            self.name, self.value, self.detail
        )
    }
}

/// The certificate of one Landau point; owns its data.
#[derive(Clone, Debug)]
pub struct Certificate {
    /// Name of the model.
    pub model: String,
    /// Its title.
    pub title: String,
    /// The wavenumber.
    pub k: f64,
    /// M
    pub resolution: usize,
    has_coordinate: bool,
    /// In the order of the parts.
    pub checks: Vec<Check>,
    /// Integrals that the balances keep and the spec does not declare, as a spec would name them.
    pub undeclared: Vec<String>,
}

/// What the parts prove.
const PARTS: [&str; 5] = [
    "residual order",
    "duality",
    "two routes",
    "nonlinear forms",
    "convergence",
];

impl Certificate {
    /// All five parts at one wavenumber, the first of them for the expansion to an odd order from 3 on.
    ///
    /// # Errors
    /// A point that cannot be computed at all.
    pub fn compute(setup: &Setup, k: f64, selection: Selection, order: usize) -> Result<Self> {
        let k = WaveVector::wave(k)?;
        check_order(order)?;
        let base = setup.base(None)?;
        let mut checks = Vec::new();
        // A multiplier that does not vanish is a line of the certificate.
        let point = &weakly::point(&setup.problem(&base)?, k, selection)?;
        checks.extend(order::check(point, order)?);
        checks.extend(adjointness::check(setup, point)?);
        checks.extend(routes(point)?);
        checks.extend(forms::check(&point.problem)?);
        checks.extend(convergence(setup, point)?);
        let structure = setup.model.structure();
        Ok(Certificate {
            model: structure.name.clone(),
            title: structure.title.clone(),
            k: k.k(),
            resolution: setup.resolution,
            has_coordinate: structure.coordinate.is_some(),
            checks,
            undeclared: point.problem.undeclared(),
        })
    }

    /// The object that the command line prints.
    pub fn json(&self) -> Value {
        let checks: Vec<Value> = self.checks.iter().map(Check::json).collect();
        json!({"model": self.model, "k": self.k, "M": self.resolution, "checks": checks, "undeclared": self.undeclared})
    }

    /// The certificate fails as a whole if one check does.
    ///
    /// # Errors
    /// Names the checks that failed.
    pub fn judge(&self) -> Result<()> {
        let failed = self.checks.iter();
        let failed = failed.filter(|c| c.verdict == Verdict::Failed);
        let failed: Vec<String> = failed.map(|c| c.name.clone()).collect();
        match failed.is_empty() {
            true => Ok(()),
            false => Err(Error::Certificate(failed)),
        }
    }
}

impl fmt::Display for Certificate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} at k = {}", self.title, self.k)?;
        if self.has_coordinate {
            write!(f, ", M = {}", self.resolution)?;
        }
        for (index, title) in PARTS.iter().enumerate() {
            write!(f, "\n{}. {title}", index + 1)?;
            for check in self.checks.iter().filter(|c| c.part == index + 1) {
                write!(f, "\n{check}")?;
            }
        }
        for integral in &self.undeclared {
            write!(f, "\n{}", words::undeclared(integral))?;
        }
        Ok(())
    }
}

/// Part 3: both routes to c2, biorthogonality.
fn routes(point: &LandauPoint) -> Result<Vec<Check>> {
    let problem = &point.problem;
    if let Err(reason) = problem.adjoint() {
        return Ok(vec![Check::left_out(
            3,
            "c2 by two routes",
            reason.to_string(),
        )]);
    }
    let adjoint = adjoint_mode(problem, &point.pair)?;
    let mut checks = Vec::new();
    let tolerance = if problem.space().is_point() {
        1e-10
    } else {
        1e-4
    };
    let size = landau_size(point);
    match second_landau(point, &adjoint)? {
        Some(c2) => {
            let difference = (c2 - point.c2).norm() / size;
            checks.push(Check::below(
                3,
                "c2 by two routes, relative",
                difference,
                tolerance,
                "discrete left vector against quadrature with the continuous adjoint",
            ));
        }
        None => checks.push(Check::left_out(
            3,
            "c2 by two routes",
            "the quadrature does not take the data of nonlinear boundary conditions",
        )),
    }
    let expansion = Expansion::to(problem, vec![point.pair.clone()], 2)?.last_coefficients();
    let cubic = Monomial {
        z: vec![2],
        conj: vec![1],
    };
    let series = expansion.coefficient(0, &cubic);
    let bordered = series.map_or(f64::NAN, |c2| (c2 - point.c2).norm() / size);
    checks.push(Check::below(
        3,
        "c2 by the residual's own series, relative",
        bordered,
        1e-6,
        "the unexpanded residual on truncated polynomials against N2 and N3",
    ));
    Ok(checks)
}

/// What differences of c2 are relative to: what it is the sum of, for it may vanish itself; where that vanishes too, a
/// part of what it would be did products not cancel.
fn landau_size(point: &LandauPoint) -> f64 {
    let uncancelled = 1e-8 * point.uncancelled();
    point.size().max(uncancelled).max(f64::MIN_POSITIVE)
}

/// Part 5: errors of c0 and c2, tails, distances from singularity, multipliers.
fn convergence(setup: &Setup, point: &LandauPoint) -> Result<Vec<Check>> {
    let error = accuracy(setup, point)?;
    let mut checks = errors(setup, point, &error);
    if setup.effective_resolution().is_some() {
        checks.extend(tails(setup, point));
    }
    checks.extend(distances(point, error.c0)?);
    checks.extend(point.multipliers.iter().map(multiplier));
    Ok(checks)
}

/// Errors of c0 and c2, relative to their sizes.
fn errors(setup: &Setup, point: &LandauPoint, error: &Accuracy) -> Vec<Check> {
    let detail = match setup.effective_resolution() {
        None => "rounding, and one route against the other".to_owned(),
        Some(m) => format!(
            "M = {m} against {} and {}, and one route against the other",
            m + 1,
            m + m.div_ceil(2)
        ),
    };
    let growth = point.c0.norm().max(1e-3 * point.pair.scale);
    let [c0, c2] = [error.c0 / growth, error.c2 / landau_size(point)];
    vec![
        Check::below(5, "error of c0, relative", c0, 1e-3, detail.clone()),
        Check::below(5, "error of c2, relative", c2, 1e-3, detail),
    ]
}

/// Last Chebyshev coefficients of the base state, where it was solved for, and of the modes.
fn tails(setup: &Setup, point: &LandauPoint) -> Vec<Check> {
    let mut checks = Vec::new();
    if !setup.model.structure().base.solved.is_empty() {
        let base = &point.problem.base;
        let degree = format!("degree {}", base.degree);
        checks.push(Check::below(
            5,
            "tail of the base state",
            base.tail(),
            1e-9,
            degree,
        ));
    }
    for (name, mode) in [
        ("X[0;2]", &point.mean),
        ("X[1;1]", &point.fundamental),
        ("X[2;2]", &point.second),
    ] {
        checks.push(Check::below(
            5,
            format!("tail of {name}"),
            tail(&point.problem, &mode.values),
            1e-3,
            "last Chebyshev coefficients over the largest",
        ));
    }
    checks
}

/// Distances of the problems at k = 0 and 2k from singularity; `c0_error` is the error of the eigenvalue.
fn distances(point: &LandauPoint, c0_error: f64) -> Result<Vec<Check>> {
    let resonance = resonance(point, c0_error)?;
    let scale = slow_rate(point);
    let check = |name: &str, value: f64, detail: &str| {
        if value > SINGULAR * scale {
            return Check::report(5, name, value, detail);
        }
        Check {
            verdict: Verdict::Failed,
            ..Check::report(5, name, value, format!("{detail}: as good as singular"))
        }
    };
    let mut checks = Vec::new();
    if resonance.mean_flow.value.is_finite() {
        checks.push(check(
            "distance to mean-flow resonance",
            resonance.mean_flow.value,
            "distance of the k = 0 problem from singularity",
        ));
    }
    checks.push(check(
        "distance to 2:1 resonance",
        resonance.second_harmonic.value,
        "distance of the 2k problem from singularity",
    ));
    Ok(checks)
}

/// A multiplier: it vanishes, or is a result.
fn multiplier(multiplier: &Multiplier) -> Check {
    let name = format!(
        "multiplier of {} at order {}",
        multiplier.closure, multiplier.order
    );
    if !multiplier.vanishes {
        return Check::report(5, name, multiplier.relative, "relative to the forcing");
    }
    Check::below(
        5,
        name,
        multiplier.relative,
        LEFT_OVER,
        "vanishes where the model keeps what it claims to conserve",
    )
}

/// Size of the last Chebyshev coefficients of the worst field.
fn tail(problem: &Problem, values: &Profile) -> f64 {
    let largest = values.largest().max(1e-300);
    let tails = problem.direct.layout.columns.iter();
    let tails = tails.map(|block| problem.space().tail(block.points, block.of(values)));
    tails.fold(0.0, f64::max) / largest
}
