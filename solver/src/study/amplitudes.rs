//! Amplitude equations of any modes, with everything that they rest on: what `amplitudes` prints.

use super::orders::HIGHEST;
use super::verify::residual_order;
use super::{Setup, check_wavenumber};
use crate::base::BaseState;
use crate::error::{Error, Result};
use crate::model::C64;
use crate::numerics::dense::dot;
use crate::problem::Problem;
use crate::series::Monomial;
use crate::spectrum::{self, EigenPair};
use crate::weakly::{
    AmplitudeSystem, Distance, Equilibrium, Expansion, Selection, equilibria, power, select,
};
use crate::words;
use serde_json::{Value, json};
use std::fmt;
use std::sync::Arc;

/// A solved problem nearer to singularity than this part of the slow rates is a small divisor.
pub const SMALL: f64 = 5e-3;
/// Small divisors that are named in words.
pub const NAMED: usize = 4;
/// Rounding errors of the data that a result is allowed to be wrong by, and the change of k that shows them.
const ROUNDING: (f64, f64) = (32.0 * f64::EPSILON, 1e-6);
/// The safety factor of differences that show rounding.
const SAFETY: f64 = 5.0;

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
    pub g: C64,
    /// Absolute error of the coefficient.
    pub error: f64,
}

/// An equilibrium with a measure of trust.
#[derive(Clone, Debug)]
pub struct State {
    /// The state.
    pub equilibrium: Equilibrium,
    /// Speed of a pattern that travels as a whole.
    pub drift: Option<f64>,
    /// The terms of the next order at it, relative to the largest there.
    pub next_order: f64,
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
    pub equilibria: Vec<State>,
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
    /// # Errors
    /// Modes that are not found or are one and the same, a resonance, a coefficient that is not converged.
    pub fn compute(setup: &Setup, choices: &[ModeChoice], order: usize) -> Result<Self> {
        if choices.is_empty() {
            return Err(Error::input("name at least one mode with --mode k=K"));
        }
        if !(2..=HIGHEST).contains(&order) {
            return Err(Error::input(format!(
                "--order {order} is out of range: it accepts 2 to {HIGHEST}"
            )));
        }
        for choice in choices {
            check_wavenumber(choice.k.abs())?;
        }
        let base = setup.base(None)?;
        let problem = &setup.problem(&base)?;
        let pairs = pairs(problem, choices)?;
        let mut expansion = Expansion::to(problem, pairs.clone(), order)?;
        let found = residual_order(&expansion);
        let residual_order = found
            .slope
            .ok_or_else(|| format!("rounding hides it, most of all in {}", found.row));
        let distances = expansion.distances();
        let slow_rate = slow_rate(problem, &pairs);
        let modes: Vec<(f64, C64)> = expansion
            .modes
            .iter()
            .map(|m| (m.pair.k, m.pair.c))
            .collect();
        // Two orders more: one of them may have no terms.
        expansion.advance()?;
        let longer = expansion.last_coefficients();
        let system = longer.part(1..=order);
        let next = longer.part(order + 1..=usize::MAX);
        let errors = errors(setup, problem, &pairs, &system)?;
        let equations: Vec<Vec<Coefficient>> = system
            .equations
            .iter()
            .zip(errors)
            .map(|(terms, errors)| {
                let terms = terms.iter().zip(errors);
                let own = terms.map(|(term, error)| Coefficient {
                    monomial: term.monomial.clone(),
                    g: term.g,
                    error,
                });
                own.collect()
            })
            .collect();
        let q: Vec<f64> = modes.iter().map(|(q, _)| *q).collect();
        let states = equilibria(&settled(&equations))
            .into_iter()
            .map(|equilibrium| State {
                drift: equilibrium.drift(&q),
                next_order: next_order(&system, &next, &equilibrium.z),
                equilibrium,
            });
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
            equilibria: states.collect(),
            equations,
            distances,
            slow_rate,
            residual_order,
        })
    }

    /// The largest absolute error of a coefficient.
    pub fn error(&self) -> f64 {
        let errors = self.equations.iter().flatten().map(|c| c.error);
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
            .map(|(q, c)| json!({"q": [q], "c": words::complex(*c), "normalization": self.normalization}))
            .collect();
        let term = |c: &Coefficient| json!({"z": c.monomial.z, "conj": c.monomial.conj, "g": words::complex(c.g), "error": words::number(c.error)});
        let equations: Vec<Vec<Value>> = self
            .equations
            .iter()
            .map(|terms| terms.iter().map(term).collect())
            .collect();
        let complex =
            |values: &[C64]| -> Vec<Value> { values.iter().map(|c| words::complex(*c)).collect() };
        let equilibria: Vec<Value> = self
            .equilibria
            .iter()
            .map(|state| {
                let e = &state.equilibrium;
                json!({
                    "z": complex(&e.z),
                    "drift": state.drift.map(words::number),
                    "frequencies": e.frequencies,
                    "eigenvalues": e.eigenvalues.as_ref().map(|values| complex(values)),
                    "stable": e.stable(),
                    "next_order": words::number(state.next_order),
                })
            })
            .collect();
        let distances: Vec<Value> = self
            .distances
            .iter()
            .map(|d| {
                json!({"z": d.monomial.z, "conj": d.monomial.conj, "q": [d.q], "distance": words::number(d.distance)})
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

/// The modes that are asked for; one at −k goes with the one at k that has been named before it.
fn pairs(problem: &Problem, choices: &[ModeChoice]) -> Result<Vec<EigenPair>> {
    let mut pairs: Vec<EigenPair> = Vec::new();
    for choice in choices {
        let opposite = pairs.iter().find(|pair| pair.k == -choice.k);
        let pair = match (choice.near, opposite) {
            (Some(target), _) => select(problem, choice.k, Selection::Near(target))?,
            (None, Some(pair)) if problem.is_real() => spectrum::mirror_image(problem, pair),
            (None, _) => select(problem, choice.k, Selection::Leading)?,
        };
        pairs.push(pair);
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

/// The system without what errors leave nothing of.
fn settled(equations: &[Vec<Coefficient>]) -> AmplitudeSystem {
    let term = |c: &Coefficient| crate::weakly::Term {
        monomial: c.monomial.clone(),
        g: words::settled(c.g, 1e2 * c.error),
    };
    AmplitudeSystem {
        equations: equations
            .iter()
            .map(|e| e.iter().map(term).collect())
            .collect(),
    }
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

/// Absolute errors of all coefficients: what truncation, rounding and the base state's own error show.
pub(super) fn errors(
    setup: &Setup,
    problem: &Arc<Problem>,
    pairs: &[EigenPair],
    system: &AmplitudeSystem,
) -> Result<Vec<Vec<f64>>> {
    let mut errors: Vec<Vec<f64>> = system
        .equations
        .iter()
        .map(|terms| terms.iter().map(|t| 1e-14 * t.g.norm()).collect())
        .collect();
    let mut widen = |factor: f64, other: Result<AmplitudeSystem>| {
        for (j, terms) in system.equations.iter().enumerate() {
            for (error, term) in errors[j].iter_mut().zip(terms) {
                let found = other
                    .as_ref()
                    .ok()
                    .and_then(|o| o.coefficient(j, &term.monomial));
                let difference = found.map_or(f64::INFINITY, |g| factor * (g - term.g).norm());
                *error = error.max(difference);
            }
        }
    };
    let order = system.order();
    let (roundings, nudge) = ROUNDING;
    let nudged: Result<Vec<EigenPair>> = pairs
        .iter()
        .map(|pair| spectrum::follow(problem, pair.k * (1.0 + nudge), pair))
        .collect();
    widen(
        roundings / nudge,
        nudged.and_then(|own| beside(problem, pairs, problem, own, order)),
    );
    let elsewhere = |base: &Arc<BaseState>, m: Option<usize>| -> Result<AmplitudeSystem> {
        let other = Arc::new(Problem::new(base, m)?);
        let found = pairs
            .iter()
            .map(|pair| spectrum::transferred(problem, pair, &other));
        let found: Result<Vec<EigenPair>> = found.collect();
        beside(problem, pairs, &other, found?, order)
    };
    let (m, base) = (setup.effective_resolution(), &problem.base);
    if let Some((m, finer)) = m.zip(setup.finer_resolution()) {
        widen(SAFETY, elsewhere(base, Some(m + 1)));
        widen(1.0, elsewhere(base, Some(finer)));
    }
    if let Some(refined) = base.refined() {
        widen(SAFETY, elsewhere(&Arc::new(refined), m));
    }
    Ok(errors)
}

/// The coefficients of the same modes found elsewhere, with the phases that the modes have here.
fn beside(
    problem: &Arc<Problem>,
    pairs: &[EigenPair],
    other: &Arc<Problem>,
    found: Vec<EigenPair>,
    order: usize,
) -> Result<AmplitudeSystem> {
    let here = Expansion::new(problem, pairs.to_vec())?;
    let there = Expansion::to(other, found, order - 1)?;
    let turns: Vec<f64> = here
        .modes
        .iter()
        .zip(&there.modes)
        .map(|(a, b)| {
            let shape = problem.direct.turned(&a.profile.values);
            let shape = spectrum::interpolated(problem, &shape, other);
            dot(&shape, &other.direct.turned(&b.profile.values)).arg()
        })
        .collect();
    let mut system = there.last_coefficients();
    // φ' = φ e^{iθ}: g' = g e^{iΣ θ (p − s)} e^{−iθ_j}
    for (equation, own) in system.equations.iter_mut().zip(&turns) {
        for term in equation {
            let angle: f64 = term
                .monomial
                .differences()
                .zip(&turns)
                .map(|(d, t)| d * t)
                .sum();
            term.g *= C64::cis(own - angle);
        }
    }
    Ok(system)
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
        for (j, (q, c)) in self.modes.iter().enumerate() {
            let wave = format!("e^(i {q} x)");
            writeln!(
                f,
                "  z{}: {wave}, c = {}, normalised by {}",
                j + 1,
                words::shown(*c),
                self.normalization
            )?;
        }
        for (j, equation) in self.equations.iter().enumerate() {
            writeln!(f, "  dz{}/dt =", j + 1)?;
            for term in equation {
                let g = words::settled(term.g, term.error);
                let name = term.monomial.name();
                writeln!(
                    f,
                    "    {name:<16} {}   ± {:.1e}",
                    words::shown(g),
                    term.error
                )?;
            }
        }
        if self.equilibria.is_empty() {
            writeln!(f, "  no equilibrium but zero")?;
        } else {
            writeln!(f, "  equilibria, up to phase:")?;
        }
        for state in &self.equilibria {
            let z = state.equilibrium.z.iter().map(|z| words::shown(*z));
            let verdict = match state.equilibrium.stable() {
                Some(true) => "stable",
                Some(false) => "unstable",
                None => "stability varies in time",
            };
            write!(
                f,
                "    z = ({}), {verdict}",
                z.collect::<Vec<_>>().join(", ")
            )?;
            if let Some(drift) = state.drift.filter(|d| *d != 0.0) {
                write!(f, ", travels at {drift:.6e}")?;
            }
            writeln!(
                f,
                "; the next order adds {:.1e} of the largest term",
                state.next_order
            )?;
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
