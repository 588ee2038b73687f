//! Critical points as an answer: where, and at the extremum of a neutral curve the envelope equation.

use super::super::onset::Onset;
use super::super::{Axis, Progress, Setup};
use super::{Critical, Quantity, Question, Scan, Wavenumber, minimise, scan};
use crate::error::{Error, Result};
use crate::measured::Measured;
use crate::words;
use serde_json::{Value, json};
use std::fmt;

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
    /// The quantity along the interval; nothing where the extremum over k is asked for.
    scan: Option<Scan>,
    normalization: String,
    periodic: String,
}

impl CriticalReport {
    /// The critical points that a question asks for, with the envelope equation where it asks for the extremum over k.
    ///
    /// # Errors
    /// As [`scan`] and [`minimise`], and an interval without a critical point.
    pub fn compute(setup: &Setup, question: &Question, progress: &dyn Progress) -> Result<Self> {
        let structure = setup.model.structure();
        let (found, envelope, kept) = match question.wavenumber() {
            Wavenumber::Range(..) => {
                let extremal = minimise(setup, question, progress)?;
                let onset = Onset::at(setup, question.axis(), &extremal);
                let onset = onset.map_err(|error| error.to_string());
                (vec![extremal.critical], Some(onset), None)
            }
            Wavenumber::Varies | Wavenumber::At(_) => {
                let curve = scan(setup, question, progress)?;
                (curve.clone().critical(question)?, None, Some(curve))
            }
        };
        Ok(CriticalReport {
            parameter: match question.axis() {
                Axis::Wavenumber => "k".to_owned(),
                Axis::Parameter(id) => structure.parameters[id].name.clone(),
            },
            of: question.quantity(),
            found,
            envelope,
            scan: kept,
            normalization: structure.amplitude.description.clone(),
            periodic: structure.periodic.clone(),
        })
    }

    /// What a picture of the answer shows: the quantity along the interval, or at an extremum the growth rate over k
    /// there; places that are not converged have no value.
    ///
    /// # Errors
    /// Modes that are found nowhere.
    pub fn curve(
        &self,
        setup: &Setup,
        question: &Question,
        progress: &dyn Progress,
    ) -> Result<Curve> {
        let of = |scan: &Scan, setup: &Setup, question: &Question| -> Result<Curve> {
            Ok(Curve {
                points: scan.drawn(setup, question)?,
                roots: scan.found.iter().map(|point| point.value).collect(),
            })
        };
        match (&self.scan, question.across(setup, &self.found[0])) {
            (Some(scan), _) => of(scan, setup, question),
            (None, Some(across)) => {
                let (setup, question) = across?;
                let scan = scan(&setup, &question, progress)?;
                Ok(Curve {
                    points: scan.drawn(&setup, &question)?,
                    roots: vec![self.found[0].k],
                })
            }
            (None, None) => Err(Error::computation("there is no curve to draw")),
        }
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
            "k_error": words::number(point.k_error),
            "c0": words::complex(point.c0),
            "c0_error": words::number(point.c0_error),
            "leading_growth": words::number(point.leading_growth),
        });
        if let Some(envelope) = envelope {
            object["envelope"] = envelope;
        }
        object
    }

    fn write_envelope(&self, f: &mut fmt::Formatter<'_>, onset: &Onset, wave: bool) -> fmt::Result {
        let x = &self.periodic;
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
        write!(f, "\n  τ0 = {}, ξ0² = {}", onset.tau0, onset.xi0_squared)?;
        match &onset.g {
            Ok(g) => write!(f, ", g = {g}, A normalised by {}", self.normalization)?,
            Err(reason) => write!(f, "; no g: {reason}")?,
        }
        if onset.g.as_ref().is_ok_and(|g| g.sign().is_none()) {
            write!(
                f,
                "\n  g is zero within its error: it is not decided whether the bifurcation is supercritical"
            )?;
        }
        if onset.conserved_mean {
            write!(
                f,
                "\n  a conserved mean couples in: the envelope needs an equation for it"
            )?;
        }
        if wave {
            write!(f, "\n  v = {}", onset.group_velocity)?;
            let ratios = [
                ("s", &onset.frequency_shift),
                ("b", &onset.dispersion),
                ("c", &onset.nonlinear_dispersion),
            ];
            for (letter, ratio) in ratios {
                match ratio {
                    Ok(ratio) => write!(f, ", {letter} = {ratio}")?,
                    Err(reason) => write!(f, ", {letter} is not decided ({reason})")?,
                }
            }
        }
        Ok(())
    }
}

/// A quantity along an axis and its roots, as a picture shows them.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Places and values; not a number where there is none to trust.
    pub points: Vec<(f64, f64)>,
    /// Places where the quantity vanishes.
    pub roots: Vec<f64>,
}

impl fmt::Display for CriticalReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (name, first) = (&self.parameter, &self.found[0]);
        let k = match first.k_error > 0.0 {
            true => Measured::new(first.k, first.k_error).to_string(),
            false => first.k.to_string(),
        };
        write!(
            f,
            "{name} = {} (of {}) at k = {k}, c0 = {}",
            Measured::new(first.value, first.error),
            self.of.name(),
            Measured::new(first.c0, first.c0_error),
        )?;
        if first.is_overtaken() {
            write!(
                f,
                "\n  another mode grows faster there, at the rate {:.4e}",
                first.leading_growth
            )?;
        }
        match &self.envelope {
            None => Ok(()),
            Some(Err(reason)) => write!(f, "\n  no envelope equation: {reason}"),
            Some(Ok(onset)) => self.write_envelope(f, onset, first.c0.im != 0.0),
        }
    }
}
