//! Equilibria of amplitude equations with the errors that those of the coefficients leave them.

use super::amplitudes::next_order;
use crate::measured::Measured;
use crate::model::C64;
use crate::weakly::{AmplitudeSystem, Equilibrium, equilibria};
use crate::words;
use serde_json::{Value, json};
use std::fmt;

/// An equilibrium whose error is a larger part of it is not decided.
const UNDECIDED: f64 = 0.5;

/// What becomes of small perturbations of an equilibrium.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stability {
    /// All decay.
    Stable,
    /// One grows.
    Unstable,
    /// A growth rate is zero within its error, and no other one is positive.
    Undecided,
    /// The linearisation changes with time.
    Varying,
}

impl fmt::Display for Stability {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Stability::Stable => "stable",
            Stability::Unstable => "unstable",
            Stability::Undecided => "stability not decided within the errors",
            Stability::Varying => "stability varies in time",
        })
    }
}

/// An equilibrium with its errors and a measure of trust.
#[derive(Clone, Debug)]
pub struct State {
    /// The amplitudes.
    pub z: Vec<Measured<C64>>,
    /// (dz_j/dt)/(i z_j)
    pub frequencies: Vec<Measured>,
    /// Of the linearised equations; nothing where these change with time.
    pub eigenvalues: Option<Vec<Measured<C64>>>,
    /// Speed of a pattern that travels as a whole.
    pub drift: Option<Measured>,
    /// The terms of the next order at it, relative to the largest there.
    pub next_order: f64,
}

/// All equilibria that the errors of the coefficients leave decided.
#[derive(Clone, Debug, Default)]
pub struct States {
    /// By the modes present, then by size.
    pub decided: Vec<State>,
    /// How many more the equations have whose existence the errors leave open.
    pub undecided: usize,
}

impl States {
    /// The equilibria of `system`, whose terms have the absolute `errors`, with modes at the wavenumbers `q`; `next` are
    /// the terms of the next orders.
    ///
    /// The error of an equilibrium is the sum over all terms of what a change of the coefficient by its error, real and
    /// imaginary part, does to it.
    pub fn of(
        system: &AmplitudeSystem,
        errors: &[Vec<f64>],
        next: &AmplitudeSystem,
        q: &[f64],
    ) -> Self {
        let settled = settled(system, errors);
        let mut states = States::default();
        for equilibrium in equilibria(&settled) {
            let share = next_order(system, next, &equilibrium.z);
            match State::measured(&settled, errors, &equilibrium, q) {
                Some(state) => states.decided.push(State {
                    next_order: share,
                    ..state
                }),
                None => states.undecided += 1,
            }
        }
        let is_open = states.decided.is_empty() && states.undecided == 0;
        if is_open && neutral_within_errors(&settled, errors) {
            states.undecided = 1;
        }
        states
    }

    /// What is not decided, in words.
    pub fn reason(&self) -> Option<String> {
        let more = match (self.undecided, self.decided.is_empty()) {
            (0, _) => return None,
            (_, true) => "whether there are equilibria",
            (_, false) => "whether there are more equilibria",
        };
        Some(format!(
            "{more} is not decided: the errors of the coefficients leave it open"
        ))
    }
}

impl State {
    /// An equilibrium with its errors; nothing where a change of a coefficient within its error makes it vanish.
    fn measured(
        system: &AmplitudeSystem,
        errors: &[Vec<f64>],
        equilibrium: &Equilibrium,
        q: &[f64],
    ) -> Option<Self> {
        // The state itself once more: what the iteration leaves of it.
        let mut spread = Spread::new(equilibrium, q);
        spread.add(&equilibrium.continued(system)?, q);
        for (j, terms) in system.equations.iter().enumerate() {
            for (position, term) in terms.iter().enumerate() {
                let error = errors[j][position];
                if term.g == C64::new(0.0, 0.0) || error == 0.0 {
                    continue;
                }
                let is_real = term.g.im == 0.0;
                let steps = [C64::new(error, 0.0), C64::new(0.0, error)];
                for step in steps.into_iter().take(if is_real { 1 } else { 2 }) {
                    let mut changed = system.clone();
                    changed.equations[j][position].g += step;
                    let above = equilibrium.continued(&changed)?;
                    changed.equations[j][position].g -= 2.0 * step;
                    let below = equilibrium.continued(&changed)?;
                    spread.add_larger(&above, &below, q);
                }
            }
        }
        spread.state(equilibrium, q)
    }

    /// What becomes of small perturbations.
    pub fn stability(&self) -> Stability {
        let Some(values) = &self.eigenvalues else {
            return Stability::Varying;
        };
        if values.iter().any(|c| c.re().is_positive()) {
            Stability::Unstable
        } else if values.iter().all(|c| c.re().is_negative()) {
            Stability::Stable
        } else {
            Stability::Undecided
        }
    }

    /// An element of `equilibria`: the keys are a contract.
    pub fn json(&self) -> Value {
        let complex = |values: &[Measured<C64>]| -> Vec<Value> {
            values.iter().map(|c| words::complex(c.value)).collect()
        };
        let errors = |values: &[Measured<C64>]| -> Vec<Value> {
            values.iter().map(|c| words::number(c.error)).collect()
        };
        let stability = self.stability();
        let mut object = json!({
            "z": complex(&self.z),
            "drift": self.drift.map(|d| words::number(d.value)),
            "frequencies": self.frequencies.iter().map(|f| words::number(f.value)).collect::<Vec<_>>(),
            "eigenvalues": self.eigenvalues.as_ref().map(|values| complex(values)),
            "stable": match stability {
                Stability::Stable => Some(true),
                Stability::Unstable => Some(false),
                Stability::Undecided | Stability::Varying => None,
            },
            "next_order": words::number(self.next_order),
            "error": {
                "z": errors(&self.z),
                "drift": self.drift.map(|d| words::number(d.error)),
                "frequencies": self.frequencies.iter().map(|f| words::number(f.error)).collect::<Vec<_>>(),
                "eigenvalues": self.eigenvalues.as_ref().map(|values| errors(values)),
            },
        });
        if let Stability::Undecided | Stability::Varying = stability {
            object["not_decided"] = json!({"stable": stability.to_string()});
        }
        object
    }
}

impl fmt::Display for State {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let z: Vec<String> = self.z.iter().map(|z| z.to_string()).collect();
        write!(f, "z = ({}), {}", z.join(", "), self.stability())?;
        if let Some(drift) = self.drift.filter(|d| d.value != 0.0) {
            match drift.sign() {
                Some(_) => write!(f, ", travels at {drift}")?,
                None => write!(f, ", drift {drift}")?,
            }
        }
        write!(
            f,
            "; the next order adds {:.1e} of the largest term",
            self.next_order
        )
    }
}

/// Whether the errors leave open if some mode grows or decays: then they leave open an equilibrium of small amplitude.
fn neutral_within_errors(system: &AmplitudeSystem, errors: &[Vec<f64>]) -> bool {
    let mut linear = system.equations.iter().zip(errors);
    linear.any(|(terms, errors)| errors[0] > 0.0 && terms[0].g.re.abs() <= errors[0])
}

/// The system with nonlinear terms that are zero within their errors put to zero, and so the parts of others.
fn settled(system: &AmplitudeSystem, errors: &[Vec<f64>]) -> AmplitudeSystem {
    let mut settled = system.clone();
    for (terms, errors) in settled.equations.iter_mut().zip(errors) {
        let nonlinear = terms.iter_mut().zip(errors);
        for (term, &error) in nonlinear.filter(|(term, _)| term.monomial.degree() > 1) {
            let part = |x: f64| if x.abs() <= error { 0.0 } else { x };
            term.g = C64::new(part(term.g.re), part(term.g.im));
        }
    }
    settled
}

/// Sums of changes of everything that is known of an equilibrium.
struct Spread {
    z: Vec<C64>,
    values: Vec<C64>,
    errors: Vec<f64>,
}

/// Amplitudes, frequencies, the drift and eigenvalues, one after another.
fn quantities(equilibrium: &Equilibrium, q: &[f64]) -> Vec<C64> {
    let real = |x: f64| C64::new(x, 0.0);
    let mut values = equilibrium.z.clone();
    values.extend(equilibrium.frequencies.iter().map(|&f| real(f)));
    values.push(real(equilibrium.drift(q).unwrap_or(f64::NAN)));
    values.extend(equilibrium.eigenvalues.iter().flatten());
    values
}

impl Spread {
    fn new(equilibrium: &Equilibrium, q: &[f64]) -> Self {
        let values = quantities(equilibrium, q);
        Spread {
            z: equilibrium.z.clone(),
            errors: values.iter().map(|v| 1e-15 * v.norm()).collect(),
            values,
        }
    }

    /// Changes from the equilibrium; eigenvalues are compared with the nearest that is left.
    fn changes(&self, moved: &Equilibrium, q: &[f64]) -> Vec<f64> {
        let first = 2 * self.z.len() + 1;
        let mut there = quantities(moved, q);
        let mut changes = Vec::with_capacity(self.values.len());
        for (index, here) in self.values.iter().enumerate() {
            if index >= first {
                let distance = |c: &C64| (c - here).norm();
                let candidates = there[index.min(there.len())..].iter().enumerate();
                let nearest = candidates.min_by(|a, b| distance(a.1).total_cmp(&distance(b.1)));
                if let Some((offset, _)) = nearest {
                    there.swap(index, index + offset);
                }
            }
            let change = there
                .get(index)
                .map_or(f64::INFINITY, |c| (c - here).norm());
            changes.push(change);
        }
        changes
    }

    fn add(&mut self, moved: &Equilibrium, q: &[f64]) {
        let changes = self.changes(moved, q);
        self.errors
            .iter_mut()
            .zip(changes)
            .for_each(|(e, c)| *e += c);
    }

    fn add_larger(&mut self, above: &Equilibrium, below: &Equilibrium, q: &[f64]) {
        let both = self
            .changes(above, q)
            .into_iter()
            .zip(self.changes(below, q));
        let larger = both.map(|(a, b)| a.max(b));
        self.errors
            .iter_mut()
            .zip(larger)
            .for_each(|(e, c)| *e += c);
    }

    /// The equilibrium with its errors; nothing where these are as large as itself.
    fn state(&self, equilibrium: &Equilibrium, q: &[f64]) -> Option<State> {
        let n = self.z.len();
        let all = self.values.iter().zip(&self.errors);
        let mut measured = all.map(|(&value, &error)| Measured::new(value, error));
        let z: Vec<Measured<C64>> = measured.by_ref().take(n).collect();
        let frequencies = measured.by_ref().take(n).map(|f| f.re()).collect();
        let drift = measured.next().map(|d| d.re());
        let eigenvalues: Vec<Measured<C64>> = measured.collect();
        let size = z.iter().map(|z| z.value.norm()).fold(0.0, f64::max);
        let error = z.iter().map(|z| z.error).fold(0.0, f64::max);
        (error <= UNDECIDED * size).then(|| State {
            z,
            frequencies,
            drift: drift.filter(|_| equilibrium.drift(q).is_some()),
            eigenvalues: equilibrium.eigenvalues.is_some().then_some(eigenvalues),
            next_order: f64::NAN,
        })
    }
}
