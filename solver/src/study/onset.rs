//! Critical points as an answer: where, and at the extremum of a neutral curve the envelope equation.
//!
//! τ0 (∂t + v ∂x) A = ε (1 + i s) A + ξ0² (1 + i b) ∂x²A − g (1 + i c) |A|²A
//!
//! with ε = ±(p − p_c)/|p_c|, positive where the base state is unstable (±p where p_c is zero):
//! 1/τ0 = da0/dε,  ξ0² = −½ τ0 Re c0'',  g = −τ0 Re c2 (Newell & Whitehead 1969, Segel 1969).

use super::critical::{Critical, Quantity, Question};
use super::{Axis, Setup, sensitivity};
use crate::error::{Error, Result};
use crate::model::C64;
use crate::weakly::{self, Envelope, LandauPoint, Selection};
use crate::words;
use serde_json::{Value, json};
use std::fmt;

/// The envelope equation at onset, in terms of the distance from it.
#[derive(Clone, Debug)]
pub struct Onset {
    /// ε in words.
    pub distance: String,
    /// τ0, in units of time.
    pub tau0: f64,
    /// ξ0², in units of length².
    pub xi0_squared: f64,
    /// g with A = 1 as the model's normalisation says, or why there is none.
    pub g: std::result::Result<f64, String>,
    /// v, −Im dc0/dk
    pub group_velocity: f64,
    /// s = Im/Re of ∂c0/∂p
    pub frequency_shift: f64,
    /// b = Im/Re of d²c0/dk²
    pub dispersion: f64,
    /// c = Im/Re of c2
    pub nonlinear_dispersion: Option<f64>,
    /// Whether a conserved mean couples in: the envelope then has a second equation.
    pub conserved_mean: bool,
}

impl Onset {
    /// At a critical point of the growth rate that is the largest over k.
    ///
    /// # Errors
    /// A parameter that does not change the growth rate, or follows from the base state; a mode that is not found.
    pub fn at(setup: &Setup, axis: Axis, critical: &Critical) -> Result<Self> {
        let Axis::Parameter(parameter) = axis else {
            return Err(Error::input("no parameter is named"));
        };
        let moved = setup.moved(axis, critical.value)?;
        let base = moved.base(None)?;
        let problem = moved.problem(&base)?;
        let pair = weakly::select(&problem, critical.k, Selection::Near(critical.c0))?;
        let envelope = Envelope::of(&problem, &pair)?;
        let slopes = sensitivity::parameters(&moved, &base, &pair).into_iter();
        let missing = || Error::computation("the parameter follows from the base state");
        let mut own = slopes.filter(|(id, _)| *id == parameter);
        let slope = own.next().ok_or_else(missing)?.1?;
        let name = &moved.model.structure().parameters[parameter].name;
        if slope.re == 0.0 {
            let reason = format!("{name} does not change the growth rate");
            return Err(Error::computation(reason));
        }
        let (unit, distance) = distance(name, critical, slope.re > 0.0);
        let tau0 = 1.0 / (slope.re.abs() * unit);
        let c2 = weakly::from_pair(&problem, pair)
            .and_then(LandauPoint::conserving)
            .map(|point| point.c2);
        let ratio = |c: C64| if c.im == 0.0 { 0.0 } else { c.im / c.re };
        Ok(Onset {
            distance,
            tau0,
            xi0_squared: -0.5 * tau0 * envelope.curvature.re,
            group_velocity: envelope.group_velocity(),
            frequency_shift: ratio(slope),
            dispersion: ratio(envelope.curvature),
            nonlinear_dispersion: c2.as_ref().ok().map(|c2| ratio(*c2)),
            conserved_mean: problem.conserves_a_mean(),
            g: c2.map(|c2| -tau0 * c2.re).map_err(|e| e.to_string()),
        })
    }

    /// The object that the command line prints: the keys are a contract.
    pub fn json(&self) -> Value {
        json!({
            "epsilon": self.distance,
            "tau0": words::number(self.tau0),
            "xi0_squared": words::number(self.xi0_squared),
            "g": self.g.as_ref().ok().map(|g| words::number(*g)),
            "group_velocity": words::number(self.group_velocity),
            "frequency_shift": words::number(self.frequency_shift),
            "dispersion": words::number(self.dispersion),
            "nonlinear_dispersion": self.nonlinear_dispersion.map(words::number),
        })
    }
}

/// What ε is a unit of in the parameter, and ε in words.
fn distance(name: &str, critical: &Critical, rises: bool) -> (f64, String) {
    let value = critical.value;
    // A parameter that is measured from onset itself.
    if value.abs() <= 10.0 * critical.error {
        let sign = if rises { "" } else { "−" };
        return (1.0, format!("{sign}{name}"));
    }
    let text = match rises == (value > 0.0) {
        true => format!("{name}/{} − 1", words::short(value)),
        false => format!("1 − {name}/{}", words::short(value)),
    };
    (value.abs(), text)
}

/// All critical points of an interval, and the envelope at the first where it is an extremum; owns its data.
#[derive(Clone, Debug)]
pub struct CriticalReport {
    /// What varied.
    pub parameter: String,
    /// What changed sign.
    pub of: Quantity,
    /// In order along the interval; at least one.
    pub found: Vec<Critical>,
    /// Where the growth rate is the largest over k, the envelope equation or why there is none.
    pub envelope: Option<std::result::Result<Onset, String>>,
    normalization: String,
    periodic: String,
}

impl CriticalReport {
    /// What was found, the first critical point first.
    ///
    /// # Errors
    /// Nothing found.
    pub fn new(setup: &Setup, question: &Question, found: Vec<Critical>) -> Result<Self> {
        if found.is_empty() {
            return Err(Error::computation("there is no critical point"));
        }
        let structure = setup.model.structure();
        Ok(CriticalReport {
            parameter: match question.axis {
                Axis::Wavenumber => "k".to_owned(),
                Axis::Parameter(id) => structure.parameters[id].name.clone(),
            },
            of: question.quantity,
            envelope: None,
            normalization: structure.amplitude.description.clone(),
            periodic: structure.periodic.clone(),
            found,
        })
    }

    /// The critical point at which the growth rate is the largest over k, with the envelope equation there.
    pub fn at_extremum(setup: &Setup, question: &Question, found: Critical) -> Result<Self> {
        let onset = Onset::at(setup, question.axis, &found).map_err(|e| e.to_string());
        Ok(CriticalReport {
            envelope: Some(onset),
            ..CriticalReport::new(setup, question, vec![found])?
        })
    }

    /// The object that the command line prints, of one of the points: the keys are a contract.
    pub fn json(&self, point: &Critical) -> Value {
        let envelope = self.envelope.as_ref().map(|envelope| match envelope {
            Ok(onset) => onset.json(),
            Err(_) => Value::Null,
        });
        let mut object = json!({
            "parameter": self.parameter,
            "of": self.of.name(),
            "value": words::number(point.value),
            "error": words::number(point.error),
            "k": words::number(point.k),
            "c0": words::complex(point.c0),
        });
        if let Some(envelope) = envelope {
            object["envelope"] = envelope;
        }
        object
    }
}

impl fmt::Display for CriticalReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (name, first) = (&self.parameter, &self.found[0]);
        write!(
            f,
            "{name} = {} (of {}) at k = {:.10}, c0 = {}",
            words::with_error(first.value, first.error),
            self.of.name(),
            first.k,
            words::shown(first.c0)
        )?;
        let onset = match &self.envelope {
            None => return Ok(()),
            Some(Err(reason)) => return write!(f, "\n  no envelope equation: {reason}"),
            Some(Ok(onset)) => onset,
        };
        let (x, wave) = (&self.periodic, first.c0.im != 0.0);
        let factor = |letter: &str| match wave {
            true => format!(" (1 + i {letter})"),
            false => String::new(),
        };
        let time = match wave {
            true => format!("(∂A/∂t + v ∂A/∂{x})"),
            false => "∂A/∂t".to_owned(),
        };
        write!(
            f,
            "\n  envelope: τ0 {time} = ε{} A + ξ0²{} ∂²A/∂{x}² − g{} |A|²A, ε = {}",
            factor("s"),
            factor("b"),
            factor("c"),
            onset.distance
        )?;
        write!(
            f,
            "\n  τ0 = {:.9}, ξ0² = {:.9}",
            onset.tau0, onset.xi0_squared
        )?;
        match &onset.g {
            Ok(g) => write!(f, ", g = {g:.9}, A normalised by {}", self.normalization)?,
            Err(reason) => write!(f, "; no g: {reason}")?,
        }
        if onset.conserved_mean {
            write!(
                f,
                "\n  a conserved mean couples in: the envelope needs an equation for it"
            )?;
        }
        if wave {
            write!(
                f,
                "\n  v = {:.9}, s = {:.9}, b = {:.9}",
                onset.group_velocity, onset.frequency_shift, onset.dispersion
            )?;
            if let Some(c) = onset.nonlinear_dispersion {
                write!(f, ", c = {c:.9}")?;
            }
        }
        Ok(())
    }
}
