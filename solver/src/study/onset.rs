//! The envelope equation at the extremum of a neutral curve.
//!
//! τ0 (∂t + v ∂x) A = ε (1 + i s) A + ξ0² (1 + i b) ∂x²A − g (1 + i c) |A|²A
//!
//! with ε = ±(p − p_c)/|p_c|, positive where the base state is unstable (±p where p_c is zero):
//! 1/τ0 = da0/dε,  ξ0² = −½ τ0 Re c0'',  g = −τ0 Re c2 (Newell & Whitehead 1969, Segel 1969).

use super::accuracy::stands;
use super::critical::{Critical, Extremal, Root, RootOn};
use super::{Axis, Setup, sensitivity};
use crate::error::{Error, Result};
use crate::measured::{Decided, Measured};
use crate::model::{C64, ParameterId};
use crate::spectrum;
use crate::weakly::{self, Envelope, LandauPoint};
use crate::words;
use serde_json::{Map, Value, json};

/// A relative change of k, small enough for its effect to be linear, and large against rounding.
const NUDGE: f64 = 1e-6;
/// What rounding leaves undecided of a rate, relative to the unit of rates.
const ROUNDING: f64 = 1e-14;
/// Times by which a difference quotient over the parameter, and one over k, magnify it.
const MAGNIFIED: f64 = 1e3;
/// The same for derivatives over k, which are solved for.
const SOLVED: f64 = 10.0;
/// τ0 with a larger error, relative, is no answer.
const UNCONVERGED: f64 = 0.05;

/// The envelope equation at onset, in terms of the distance from it. What has no value says why.
#[derive(Clone, Debug)]
pub struct Onset {
    /// ε in words.
    pub distance: String,
    /// τ0, in units of time.
    pub tau0: Measured,
    /// ξ0², in units of length².
    pub xi0_squared: Measured,
    /// g with A = 1 as the model's normalisation says.
    pub g: Decided,
    /// v, −Im dc0/dk
    pub group_velocity: Measured,
    /// s = Im/Re of ∂c0/∂p
    pub frequency_shift: Decided,
    /// b = Im/Re of d²c0/dk²
    pub dispersion: Decided,
    /// c = Im/Re of c2
    pub nonlinear_dispersion: Decided,
    /// Whether a conserved mean couples in: the envelope then has a second equation.
    pub conserved_mean: bool,
}

/// What the envelope is made of, at one root on one grid, each with its rounding error.
struct Ingredients {
    /// ∂c0/∂p
    along: Measured<C64>,
    /// dc0/dk
    slope: Measured<C64>,
    /// d²c0/dk²
    curvature: Measured<C64>,
    /// c2
    c2: std::result::Result<Measured<C64>, String>,
    /// What the terms of c2 sum to did they not cancel.
    sum: f64,
}

impl Ingredients {
    /// At a root on one grid of a critical point.
    fn at(setup: &Setup, parameter: ParameterId, root: &Root, critical: &Critical) -> Result<Self> {
        let problem = &root.site.problem;
        let mut moved = setup.moved(Axis::Parameter(parameter), root.x)?;
        moved.resolution = problem.resolution.unwrap_or(setup.resolution);
        let along = sensitivity::parameter(&moved, &root.site.base, &root.pair, parameter)?;
        let default = setup.model.structure().parameters[parameter].default;
        // What the difference quotient steps by a part of: the parameter, or its default where that is as good as zero.
        let size = [root.x, default]
            .into_iter()
            .find(|size| size.abs() > 10.0 * critical.error);
        let rounding = ROUNDING * critical.scale;
        let k = root.pair.k.length();
        let point = weakly::from_pair(problem, root.pair.clone()).and_then(LandauPoint::conserving);
        let sum = point.as_ref().map_or(0.0, LandauPoint::size);
        Ok(Ingredients {
            along: Measured::new(along, MAGNIFIED * rounding / size.map_or(1.0, f64::abs)),
            slope: Measured::new(root.envelope.slope, SOLVED * rounding / k),
            curvature: Measured::new(root.envelope.curvature, SOLVED * rounding / (k * k)),
            c2: point
                .map(|point| Measured::new(point.c2, point.rounding()[1]))
                .map_err(|error| error.to_string()),
            sum,
        })
    }

    /// At a wavenumber next to that of a root, with the same derivative along the parameter.
    fn nudged(&self, root: &Root) -> Result<Self> {
        let problem = &root.site.problem;
        let pair = spectrum::follow(problem, (1.0 + NUDGE) * root.pair.k, &root.pair)?;
        let envelope = Envelope::of(problem, &pair)?;
        let exact = |value: C64| Measured::new(value, 0.0);
        Ok(Ingredients {
            along: self.along,
            slope: exact(envelope.slope),
            curvature: exact(envelope.curvature),
            c2: weakly::from_pair(problem, pair)
                .and_then(LandauPoint::conserving)
                .map(|point| exact(point.c2))
                .map_err(|error| error.to_string()),
            sum: self.sum,
        })
    }
}

/// What a distance from onset is measured in, and in words.
struct Distance {
    unit: Measured,
    words: String,
}

/// The numbers of an envelope: τ0, ξ0², g, v, s, b, c in this order.
struct Numbers([Decided; 7]);

impl Numbers {
    /// With the distance from onset in units of the parameter.
    fn of(found: &Ingredients, unit: Measured, parameter: &str) -> Self {
        let one = Measured::new(1.0, 0.0);
        let rises = found.along.re();
        let rises = if rises.value < 0.0 { -rises } else { rises };
        let undecided = || format!("{parameter} does not change the growth rate within its error");
        // τ0 = 1/|∂a0/∂ε|
        let tau0 = one.over(rises * unit).ok_or_else(undecided);
        let with = |number: Measured| tau0.clone().map(|tau0| tau0 * number);
        let ratio = |c: Measured<C64>, name: &str| {
            let zero = || format!("the real part of {name} is zero within its error");
            c.im().over(c.re()).ok_or_else(zero)
        };
        let c2 = || found.c2.clone();
        Numbers([
            tau0.clone(),
            with(found.curvature.re() * -0.5),
            c2().and_then(|c2| with(-c2.re())),
            Ok(-found.slope.im()),
            ratio(found.along, "∂c0/∂p"),
            ratio(found.curvature, "d²c0/dk²"),
            c2().and_then(|c2| ratio(c2, "c2")),
        ])
    }

    /// The onset that they describe at a resolution; `sum` is what the terms of c2 sum to.
    ///
    /// # Errors
    /// Numbers that are not converged.
    fn onset(
        self,
        distance: String,
        sum: f64,
        resolution: Option<usize>,
        conserved_mean: bool,
    ) -> Result<Onset> {
        let decided = |number: Decided| {
            number.and_then(|number| match number.error.is_finite() {
                true => Ok(number),
                false => Err("it is not converged".to_owned()),
            })
        };
        let needed = |number: Decided| decided(number).map_err(Error::Computation);
        let [tau0, xi0_squared, g, velocity, shift, dispersion, nonlinear] = self.0;
        let tau0 = needed(tau0)?;
        if tau0.error > UNCONVERGED * tau0.value {
            let how_far = format!("its error is {:.1e}", tau0.error);
            return Err(Error::unresolved("τ0", resolution, how_far));
        }
        let sum = sum * tau0.value;
        let g = g.and_then(|g| match stands(g.error, g.value.abs(), sum) {
            true => Ok(g),
            false => Err(format!(
                "it is not converged, its error being {:.0e}",
                g.error
            )),
        });
        Ok(Onset {
            distance,
            tau0,
            xi0_squared: needed(xi0_squared)?,
            g,
            group_velocity: needed(velocity)?,
            frequency_shift: decided(shift),
            dispersion: decided(dispersion),
            nonlinear_dispersion: decided(nonlinear),
            conserved_mean,
        })
    }

    /// Errors no smaller than differences from other numbers, times a factor; what these do not have is not known.
    fn widen(&mut self, others: Option<&Numbers>, factor: f64) {
        for (index, number) in self.0.iter_mut().enumerate() {
            let Ok(number) = number else { continue };
            let other = others.and_then(|others| others.0[index].as_ref().ok());
            let difference =
                other.map_or(f64::INFINITY, |other| (other.value - number.value).abs());
            *number = number.widened(factor * difference);
        }
    }
}

impl Onset {
    /// At the extremum of a neutral curve; errors are differences from the extrema on other grids, each with its numbers,
    /// and what rounding and the error of k change.
    ///
    /// # Errors
    /// A parameter that does not change the growth rate, or follows from the base state; numbers that are not converged.
    pub fn at(setup: &Setup, axis: Axis, extremal: &Extremal) -> Result<Self> {
        let Axis::Parameter(parameter) = axis else {
            return Err(Error::input("no parameter is named"));
        };
        let Extremal {
            critical,
            root,
            beside,
        } = extremal;
        let found = Ingredients::at(setup, parameter, root, critical)?;
        let name = &setup.model.structure().parameters[parameter].name;
        if found.along.re().sign().is_none() {
            return Err(Error::computation(format!(
                "{name} does not change the growth rate within its error"
            )));
        }
        let distance = distance(name, critical, found.along.value.re > 0.0);
        let mut numbers = Numbers::of(&found, distance.unit, name);
        for RootOn { factor, root } in beside {
            let there = root.as_ref().ok().and_then(|root| {
                let found = Ingredients::at(setup, parameter, root, critical).ok()?;
                // Where the parameter is the distance itself, it is so on every grid.
                let size = if distance.unit.error == 0.0 {
                    1.0
                } else {
                    root.x.abs()
                };
                Some(Numbers::of(&found, Measured::new(size, 0.0), name))
            });
            numbers.widen(there.as_ref(), *factor);
        }
        let nudged = found.nudged(root).ok();
        let nudged = nudged.map(|nudged| Numbers::of(&nudged, distance.unit, name));
        let moves = (critical.k_error / critical.k).max(32.0 * f64::EPSILON) / NUDGE;
        numbers.widen(nudged.as_ref(), moves);
        let m = setup.effective_resolution();
        let mean = root.site.problem.conserves_a_mean();
        numbers.onset(distance.words, found.sum, m, mean)
    }

    /// The numbers by their keys.
    fn numbers(&self) -> [(&'static str, Option<Measured>); 7] {
        let decided = |number: &Decided| number.as_ref().ok().copied();
        [
            ("tau0", Some(self.tau0)),
            ("xi0_squared", Some(self.xi0_squared)),
            ("g", decided(&self.g)),
            ("group_velocity", Some(self.group_velocity)),
            ("frequency_shift", decided(&self.frequency_shift)),
            ("dispersion", decided(&self.dispersion)),
            ("nonlinear_dispersion", decided(&self.nonlinear_dispersion)),
        ]
    }

    /// The object that the command line prints: the keys are a contract.
    pub fn json(&self) -> Value {
        let mut object = json!({ "epsilon": self.distance });
        let mut errors = Map::new();
        for (name, number) in self.numbers() {
            object[name] = number.map_or(Value::Null, |n| words::number(n.value));
            let error = number.map_or(Value::Null, |n| words::number(n.error));
            errors.insert(name.to_owned(), error);
        }
        object["error"] = Value::Object(errors);
        object
    }
}

/// The distance from onset.
fn distance(name: &str, critical: &Critical, rises: bool) -> Distance {
    let value = critical.value;
    // A parameter that is measured from onset itself.
    if value.abs() <= 10.0 * critical.error {
        let sign = if rises { "" } else { "−" };
        return Distance {
            unit: Measured::new(1.0, 0.0),
            words: format!("{sign}{name}"),
        };
    }
    let shown = match value.abs() < 1e-4 {
        true => words::short(value),
        false => Measured::new(value, critical.error.max(1e-7)).digits(6),
    };
    let shown = match shown.contains(['.', 'e']) {
        true if !shown.contains('e') => shown.trim_end_matches('0').trim_end_matches('.'),
        _ => &shown,
    };
    let words = match rises == (value > 0.0) {
        true => format!("{name}/{shown} − 1"),
        false => format!("1 − {name}/{shown}"),
    };
    Distance {
        unit: Measured::new(value.abs(), critical.error),
        words,
    }
}
