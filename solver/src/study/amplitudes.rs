//! Amplitude equations of any modes, with everything that they rest on: what `amplitudes` prints.

mod size;

use super::accuracy::{stands, unconverged, vanishes};
use super::error_bars::{Companion, Companions};
use super::orders::HIGHEST;
use super::states::States;
use super::verify::{DEFECTS, residual_order_told};
use super::{Progress, Setup};
use crate::error::{Error, Result};
use crate::measured::Measured;
use crate::model::C64;
use crate::numerics::dense::dot;
use crate::problem::Problem;
use crate::series::Monomial;
use crate::spectrum::{self, EigenPair};
use crate::wavevector::WaveVector;
use crate::weakly::{
    self, AmplitudeSystem, CriticalMode, Distance, Expansion, Selection, multiplier_error, power,
    select,
};
use crate::words;
use serde_json::{Map, Value, json};
use std::fmt;
use std::sync::Arc;

/// A solved problem nearer to singularity than this part of the slow rates is a small divisor.
pub const SMALL: f64 = 5e-3;
/// Small divisors that are named in words.
pub const NAMED: usize = 4;
/// Rounding errors of a coefficient at least, relative.
const ROUNDING: f64 = 1e-14;

/// A mode that is asked for.
#[derive(Clone, Copy, Debug)]
pub struct ModeChoice {
    /// Its wavenumber; negative for a wave to the other side.
    pub k: f64,
    /// The eigenvalue that it is nearest to; the leading one otherwise.
    pub near: Option<C64>,
}

/// A term with its absolute error.
#[derive(Clone, Debug)]
pub struct Coefficient {
    /// z^p z̄^s
    pub monomial: Monomial,
    /// Its coefficient.
    pub g: Measured<C64>,
}

/// The amplitude equations of some modes; owns its data.
#[derive(Clone, Debug)]
pub struct AmplitudesReport {
    /// Name of the model.
    pub model: String,
    /// Its title.
    pub title: String,
    /// By name; switches by the name of their choice.
    pub parameters: Value,
    /// M, where there is a cross-stream coordinate.
    pub resolution: usize,
    has_coordinate: bool,
    /// The highest degree of the equations.
    pub order: usize,
    /// Wavenumber and eigenvalue of each mode.
    pub modes: Vec<(f64, C64)>,
    /// What the amplitudes of all modes measure.
    pub normalization: String,
    /// One a mode, linear terms first.
    pub equations: Vec<Vec<Coefficient>>,
    /// Up to phase.
    pub equilibria: States,
    /// One a problem that was solved.
    pub distances: Vec<Distance>,
    /// Rates that distances are small or large against.
    pub slow_rate: f64,
    /// The power of the amplitude by which the defect falls; nothing, and why, where rounding hides it.
    pub residual_order: std::result::Result<f64, String>,
}

impl AmplitudesReport {
    /// The amplitude equations of the chosen modes to an order, their equilibria and certificate.
    ///
    /// The steps of `progress` are the modes, the orders of the expansion, its defect, the companions that the errors come
    /// from, and the equilibria.
    ///
    /// # Errors
    /// Modes that are not found or are one and the same, a resonance, a coefficient that is not converged.
    pub fn compute(
        setup: &Setup,
        choices: &[ModeChoice],
        order: usize,
        progress: &dyn Progress,
    ) -> Result<Self> {
        check(choices, order)?;
        let steps = choices.len() + order + 2 + DEFECTS;
        progress.begin(steps);
        let base = setup.base(None)?;
        let problem = &setup.problem(&base)?;
        let pairs = pairs(problem, choices, progress)?;
        let mut expansion = Expansion::new(problem, pairs.clone())?;
        while expansion.order() < order {
            expansion.advance()?;
            progress.advance(1);
        }
        let defect = residual_order_told(&expansion, progress);
        let residual_order = defect
            .slope
            .ok_or_else(|| format!("rounding hides it, most of all in {}", defect.row));
        let distances = expansion.distances();
        let multipliers = expansion.multipliers.clone();
        let slow_rate = slow_rate(problem, &pairs);
        let modes: Vec<(f64, C64)> = expansion
            .modes
            .iter()
            .map(|m| (m.pair.k.k(), m.pair.c))
            .collect();
        // Two orders more: one of them may have no terms.
        expansion.advance()?;
        progress.advance(1);
        let longer = expansion.last_coefficients();
        progress.advance(1);
        let system = longer.part(1..=order);
        let next = longer.part(order + 1..=usize::MAX);
        let companions = Companions::of(setup, problem, &pairs);
        let computed = companions.iter().filter(|companion| companion.is_ok());
        progress.begin(steps + computed.count());
        let errors = errors(&companions, problem, &pairs, &system, progress)?;
        check_converged(setup, problem, &pairs, &system, &errors)?;
        if let Some(error) = multiplier_error(&multipliers, uncertainty(&system, &errors)) {
            return Err(error);
        }
        let q: Vec<f64> = modes.iter().map(|(q, _)| *q).collect();
        let states = States::of(&system, &errors, &next, &q);
        progress.advance(1);
        progress.end();
        let structure = setup.model.structure();
        Ok(AmplitudesReport {
            model: structure.name.clone(),
            title: structure.title.clone(),
            parameters: base.parameters.json(base.structure()),
            resolution: setup.resolution,
            has_coordinate: structure.coordinate.is_some(),
            order,
            modes,
            normalization: structure.amplitude.description.clone(),
            equilibria: states,
            equations: equations(&system, &errors),
            distances,
            slow_rate,
            residual_order,
        })
    }

    /// The largest absolute error of a coefficient.
    pub fn error(&self) -> f64 {
        let errors = self.equations.iter().flatten().map(|c| c.g.error);
        errors.fold(0.0, f64::max)
    }

    /// Solved problems that are as good as a mode of their own: to be included.
    pub fn small_divisors(&self) -> Vec<&Distance> {
        small_divisors(&self.distances, self.slow_rate)
    }

    /// The object that the command line prints: the keys are a contract.
    pub fn json(&self) -> Value {
        let modes: Vec<Value> = self
            .modes
            .iter()
            .zip(&self.equations)
            .map(|((q, c), terms)| {
                json!({"q": [q], "c": words::complex(*c), "error": words::number(terms[0].g.error),
                       "normalization": self.normalization})
            })
            .collect();
        let term = |c: &Coefficient| json!({"z": c.monomial.z, "conj": c.monomial.conj, "g": words::complex(c.g.value), "error": words::number(c.g.error)});
        let equations: Vec<Vec<Value>> = self
            .equations
            .iter()
            .map(|terms| terms.iter().map(term).collect())
            .collect();
        let equilibria: Vec<Value> = self.equilibria.decided.iter().map(|s| s.json()).collect();
        let mut not_decided = Map::new();
        if let Some(reason) = self.equilibria.reason() {
            not_decided.insert("equilibria".to_owned(), reason.into());
        }
        let distances: Vec<Value> = self
            .distances
            .iter()
            .map(|d| {
                json!({"z": d.monomial.z, "conj": d.monomial.conj, "q": [d.q.k()], "distance": words::number(d.distance)})
            })
            .collect();
        json!({
            "model": self.model,
            "parameters": self.parameters,
            "M": self.resolution,
            "order": self.order,
            "modes": modes,
            "equations": equations,
            "equilibria": equilibria,
            "not_decided": not_decided,
            "error": words::number(self.error()),
            "distances": distances,
            "residual_order": self.residual_order.as_ref().ok(),
        })
    }
}

/// The problems nearer to singularity than a part of the slow rates, one a wavenumber: the nearest.
pub fn small_divisors(distances: &[Distance], slow_rate: f64) -> Vec<&Distance> {
    let mut small: Vec<&Distance> = Vec::new();
    for distance in distances.iter().filter(|d| d.distance <= SMALL * slow_rate) {
        match small.iter_mut().find(|d| d.q == distance.q) {
            Some(known) if known.distance <= distance.distance => {}
            Some(known) => *known = distance,
            None => small.push(distance),
        }
    }
    small.sort_by(|a, b| a.distance.total_cmp(&b.distance));
    small
}

/// Refuses a question that has no answer or takes too long, before any work.
fn check(choices: &[ModeChoice], order: usize) -> Result<()> {
    if choices.is_empty() {
        return Err(Error::input("name at least one mode with --mode k=K"));
    }
    if !(2..=HIGHEST).contains(&order) {
        return Err(Error::input(format!(
            "--order {order} is out of range: it accepts 2 to {HIGHEST}"
        )));
    }
    for choice in choices {
        WaveVector::either_way(choice.k)?;
    }
    size::check(choices.len(), order)
}

/// The terms of the equations with their absolute errors, by equation.
fn equations(system: &AmplitudeSystem, errors: &[Vec<f64>]) -> Vec<Vec<Coefficient>> {
    let coefficient = |(term, error): (&weakly::Term, &f64)| Coefficient {
        monomial: term.monomial.clone(),
        g: Measured::new(term.g, *error),
    };
    let equations = system.equations.iter().zip(errors);
    equations
        .map(|(terms, errors)| terms.iter().zip(errors).map(coefficient).collect())
        .collect()
}

/// The modes that are asked for; one at −k goes with the one at k that has been named before it.
fn pairs(
    problem: &Problem,
    choices: &[ModeChoice],
    progress: &dyn Progress,
) -> Result<Vec<EigenPair>> {
    let mut pairs: Vec<EigenPair> = Vec::new();
    for choice in choices {
        let k = WaveVector::either_way(choice.k)?;
        let opposite = pairs.iter().find(|pair| pair.k == -k);
        let pair = match (choice.near, opposite) {
            (Some(target), _) => select(problem, k, Selection::Near(target))?,
            (None, Some(pair)) if problem.is_real() => spectrum::mirror_image(problem, pair),
            (None, _) => select(problem, k, Selection::Leading)?,
        };
        pairs.push(pair);
        progress.advance(1);
    }
    Ok(pairs)
}

/// What distances from singularity are small or large against.
fn slow_rate(problem: &Problem, pairs: &[EigenPair]) -> f64 {
    let rates = pairs.iter().map(|pair| {
        let rate = problem.rate(pair.k);
        let floor = if rate.is_finite() { rate } else { 0.0 };
        pair.scale.max(pair.c.norm()).max(floor)
    });
    rates.fold(0.0, f64::max)
}

/// The largest error of a nonlinear coefficient, relative to the largest of them.
fn uncertainty(system: &AmplitudeSystem, errors: &[Vec<f64>]) -> f64 {
    let terms = system
        .equations
        .iter()
        .flatten()
        .zip(errors.iter().flatten());
    let nonlinear = terms.filter(|(term, _)| term.monomial.degree() > 1);
    let (largest, error) = nonlinear.fold((0.0_f64, 0.0_f64), |(size, error), (term, own)| {
        (size.max(term.g.norm()), error.max(*own))
    });
    if error > 0.0 { error / largest } else { 0.0 }
}

/// A measure of trust: the largest over the equations of |Σ next terms| / the largest term.
pub fn next_order(system: &AmplitudeSystem, next: &AmplitudeSystem, z: &[C64]) -> f64 {
    let rates = next.rates(z);
    let largest = |j: usize| {
        let terms = system.equations[j].iter();
        terms
            .map(|t| (t.g * power(&t.monomial, z)).norm())
            .fold(0.0, f64::max)
    };
    let present = (0..z.len()).filter(|&j| z[j] != C64::new(0.0, 0.0));
    present
        .map(|j| rates[j].norm() / largest(j))
        .fold(0.0, f64::max)
}

/// Absolute errors of all coefficients, by equation and term.
///
/// # Errors
/// Modes that the spec's normalisation does not fit.
pub(super) fn errors(
    companions: &Companions,
    problem: &Arc<Problem>,
    pairs: &[EigenPair],
    system: &AmplitudeSystem,
    progress: &dyn Progress,
) -> Result<Vec<Vec<f64>>> {
    let here = Expansion::new(problem, pairs.to_vec())?.modes;
    let flat: Vec<C64> = system.equations.iter().flatten().map(|t| t.g).collect();
    let order = system.order();
    let all = companions.errors(&flat, |companion| {
        let there = beside(problem, &here, companion, order);
        progress.advance(1);
        let there = there?;
        let missing = C64::new(f64::NAN, 0.0);
        let mut values = Vec::with_capacity(flat.len());
        for (j, terms) in system.equations.iter().enumerate() {
            let coefficient = |term: &weakly::Term| there.coefficient(j, &term.monomial);
            values.extend(terms.iter().map(|t| coefficient(t).unwrap_or(missing)));
        }
        Ok(values)
    });
    let mut all = all.into_iter();
    let row = |terms: &Vec<weakly::Term>| -> Vec<f64> {
        let errors = terms.iter().zip(all.by_ref());
        errors
            .map(|(t, error)| {
                // A coefficient of degree d rests on d/2 orders, each with rounding errors of its own.
                let orders = (t.monomial.degree() / 2).max(1) as f64;
                orders * error.max(ROUNDING * t.g.norm())
            })
            .collect()
    };
    Ok(system.equations.iter().map(row).collect())
}

/// The coefficients of the same modes on a companion, with the phases that the modes have here.
fn beside(
    problem: &Problem,
    here: &[CriticalMode],
    companion: &Companion,
    order: usize,
) -> Result<AmplitudeSystem> {
    let there = Expansion::to(&companion.problem, companion.pairs.clone(), order - 1)?;
    let turns: Vec<f64> = here
        .iter()
        .zip(&there.modes)
        .map(|(a, b)| {
            let shape = problem.direct.turned(&a.profile.values);
            let shape = spectrum::interpolated(problem, &shape, &companion.problem);
            let moved = companion.problem.direct.turned(&b.profile.values);
            dot(&shape, &moved).arg()
        })
        .collect();
    let mut system = there.last_coefficients();
    // φ' = φ e^{iθ}: g' = g e^{iΣ θ (p − s)} e^{−iθ_j}
    for (equation, turn) in system.equations.iter_mut().zip(&turns) {
        for term in equation {
            let differences = term.monomial.differences().zip(&turns);
            let angle: f64 = differences.map(|(d, t)| d * t).sum();
            term.g *= C64::cis(turn - angle);
        }
    }
    Ok(system)
}

/// Refuses coefficients that are not converged, by the rule that a single mode's are held to: the error is a small part
/// of the coefficient, or of what its terms have the size of.
fn check_converged(
    setup: &Setup,
    problem: &Arc<Problem>,
    pairs: &[EigenPair],
    system: &AmplitudeSystem,
    errors: &[Vec<f64>],
) -> Result<()> {
    let rate = slow_rate(problem, pairs);
    let largest = |degree: usize| {
        let terms = system.equations.iter().flatten();
        let sizes = terms.filter(|t| t.monomial.degree() == degree);
        sizes.map(|t| t.g.norm()).fold(0.0, f64::max)
    };
    let (quadratic, cubic) = (largest(2), largest(3));
    // The amplitude at which terms of second or third degree balance the slow rates: A^{1−d} times the rates is the size
    // of terms of degree d.
    let sum = |degree: usize, cubic: f64| {
        let inverse_amplitude = (quadratic / rate).max((cubic / rate).sqrt());
        rate * inverse_amplitude.powi(degree as i32 - 1)
    };
    let uncancelled = || {
        let sizes = pairs.iter().filter_map(|pair| {
            let point = weakly::from_pair(problem, pair.clone()).ok()?;
            Some(point.uncancelled())
        });
        sizes.fold(cubic, f64::max)
    };
    for (j, (terms, errors)) in system.equations.iter().zip(errors).enumerate() {
        for (term, &error) in terms.iter().zip(errors) {
            let (size, degree) = (term.g.norm(), term.monomial.degree());
            let known = stands(error, size, sum(degree, cubic))
                || vanishes(error, size, sum(degree, uncancelled()));
            if !known {
                let name = match degree {
                    1 => format!("the eigenvalue of z{}", j + 1),
                    _ => format!(
                        "the coefficient of {} in dz{}/dt",
                        term.monomial.name(),
                        j + 1
                    ),
                };
                return Err(unconverged(setup, &name, error, size));
            }
        }
    }
    Ok(())
}

impl fmt::Display for AmplitudesReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{}, amplitude equations to order {}",
            self.title, self.order
        )?;
        match self.has_coordinate {
            true => writeln!(f, ", M = {}", self.resolution)?,
            false => writeln!(f)?,
        }
        for (j, ((q, _), terms)) in self.modes.iter().zip(&self.equations).enumerate() {
            let (wave, c) = (format!("e^(i {q} x)"), terms[0].g);
            let by = &self.normalization;
            writeln!(f, "  z{}: {wave}, c = {c}, normalised by {by}", j + 1)?;
        }
        for (j, equation) in self.equations.iter().enumerate() {
            writeln!(f, "  dz{}/dt =", j + 1)?;
            for term in equation {
                writeln!(f, "    {:<16} {}", term.monomial.name(), term.g)?;
            }
        }
        let States { decided, .. } = &self.equilibria;
        let reason = self.equilibria.reason();
        match (decided.is_empty(), &reason) {
            (true, None) => writeln!(f, "  no equilibrium but zero")?,
            (true, Some(_)) => {}
            (false, _) => writeln!(f, "  equilibria, up to phase:")?,
        }
        for state in decided {
            writeln!(f, "    {state}")?;
        }
        if let Some(reason) = reason {
            writeln!(f, "  {reason}")?;
        }
        let q: Vec<f64> = self.modes.iter().map(|(q, _)| *q).collect();
        let small = self.small_divisors();
        for divisor in small.iter().take(NAMED) {
            writeln!(f, "  {}", divisor.in_words(&q))?;
        }
        if small.len() > NAMED {
            writeln!(f, "  and {} more of them", small.len() - NAMED)?;
        }
        match &self.residual_order {
            Ok(order) => write!(
                f,
                "  certificate: the defect falls as the amplitude to the power {order:.3}"
            ),
            Err(reason) => write!(f, "  certificate: {reason}"),
        }
    }
}
