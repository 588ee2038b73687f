//! A Landau point with everything that it rests on: what `point` prints.

use super::accuracy::{
    Accuracy, Resonance, SINGULAR, accuracy, landau_error, resonance, slow_rate, stands, vanishes,
};
use super::amplitudes::{NAMED, errors, small_divisors};
use super::orders::check_order;
use super::{Setup, check_wavenumber, sensitivity};
use crate::error::{Error, Result};
use crate::model::C64;
use crate::series::Monomial;
use crate::spectrum::mirror_image;
use crate::weakly::{
    AmplitudeEquation, Bifurcation, Distance, Envelope, Expansion, LandauPoint, Selection, Stable,
    Waves, equilibrium, outputs,
};
use crate::words;
use serde_json::{Map, Value, json};
use std::fmt;

/// c0, c2 and what belongs to them at one wavenumber; owns its data.
#[derive(Clone, Debug)]
pub struct PointReport {
    /// Name of the model.
    pub model: String,
    /// Its title.
    pub title: String,
    /// By name; switches by the name of their choice.
    pub parameters: Value,
    /// The wavenumber.
    pub k: f64,
    /// M, where there is a cross-stream coordinate.
    pub resolution: usize,
    has_coordinate: bool,
    /// The eigenvalue: growth rate and frequency.
    pub c0: C64,
    /// The first Landau coefficient.
    pub c2: C64,
    /// A_e
    pub amplitude: Option<f64>,
    /// Side and kind.
    pub bifurcation: Bifurcation,
    /// What the amplitude measures.
    pub normalization: String,
    /// Absolute errors of c0 and c2.
    pub error: Accuracy,
    /// Distances from singularity.
    pub resonance: Resonance,
    /// Name, value at the base state, A² correction.
    pub outputs: Vec<(String, [f64; 2])>,
    /// Name and dc0/d(parameter).
    pub dc0: Vec<(String, C64)>,
    /// dc0/dk and d²c0/dk².
    pub envelope: Envelope,
    /// Whether a conserved mean couples to the envelope, whose equation then is not closed.
    pub conserved_mean: bool,
    /// Self and cross coefficient of a wave in a mirror-symmetric model.
    pub waves: Option<Waves>,
    /// c0, c2, c4, … to the order asked for, with their errors.
    pub equation: AmplitudeEquation,
    /// Solved problems that are as good as singular, in words.
    pub small_divisors: Vec<String>,
    /// What the base state satisfies but nearly, in words.
    pub notes: Vec<String>,
}

impl PointReport {
    /// The Landau point of a selected mode, its errors and resonances.
    ///
    /// # Errors
    /// A mode that is not found, a resonance, a coefficient that is not converged, anything that is no
    /// finite number.
    pub fn compute(setup: &Setup, k: f64, selection: Selection, order: usize) -> Result<Self> {
        check_wavenumber(k)?;
        check_order(order)?;
        let base = setup.base(None)?;
        let point = &setup.point(&base, k, selection)?;
        let structure = setup.model.structure();
        let resonance = resonance(point)?;
        check_distances(point, &resonance)?;
        let error = standing(setup, point, accuracy(setup, point)?)?;
        let mut values = Vec::new();
        for (info, value) in structure.outputs.iter().zip(outputs(point)) {
            if !value.iter().all(|v| v.is_finite()) {
                return Err(Error::computation(format!(
                    "the output `{}` has no value at this base state",
                    info.name
                )));
            }
            values.push((info.name.clone(), value));
        }
        let mut slopes = Vec::new();
        for (id, slope) in sensitivity::parameters(setup, &base, &point.pair) {
            let name = structure.parameters[id].name.clone();
            let slope = slope.map_err(|error| {
                Error::computation(format!("dc0/d{name} cannot be formed: {error}"))
            })?;
            slopes.push((name, slope));
        }
        let (c0, c2) = ((point.c0, error.c0), (point.c2, error.c2));
        let (equation, mut small_divisors) = longer(setup, point, &error, order)?;
        // A resonance of the pair says nothing against the coefficients of the single wave.
        let waves = waves(setup, point).unwrap_or_else(|error| {
            small_divisors.push(format!("left and right waves: {error}"));
            None
        });
        Ok(PointReport {
            envelope: Envelope::of(&point.problem, &point.pair)?,
            conserved_mean: point.problem.conserves_a_mean(),
            waves,
            equation,
            small_divisors,
            model: structure.name.clone(),
            title: structure.title.clone(),
            parameters: base.parameters.json(base.structure()),
            k: point.k(),
            resolution: setup.resolution,
            has_coordinate: structure.coordinate.is_some(),
            c0: point.c0,
            c2: point.c2,
            amplitude: equilibrium(c0, c2),
            bifurcation: Bifurcation::new(c0, c2),
            normalization: structure.amplitude.description.clone(),
            error,
            resonance,
            outputs: values,
            dc0: slopes,
            notes: base.notes.clone(),
        })
    }

    /// The object that the command line prints: the keys are a contract.
    pub fn json(&self) -> Value {
        let outputs: Map<String, Value> = self
            .outputs
            .iter()
            .map(|(name, v)| (name.clone(), json!([v[0], v[1]])))
            .collect();
        let slopes: Map<String, Value> = self
            .dc0
            .iter()
            .map(|(name, slope)| (name.clone(), words::complex(*slope)))
            .collect();
        let mut object = json!({
            "model": self.model,
            "parameters": self.parameters,
            "k": self.k,
            "M": self.resolution,
            "c0": words::complex(self.c0),
            "c2": words::complex(self.c2),
            "amplitude": self.amplitude,
            "bifurcation": self.bifurcation.to_string(),
            "normalization": self.normalization,
            "error": {"c0": self.error.c0, "c2": self.error.c2},
            "resonance": {
                "mean_flow": words::number(self.resonance.mean_flow),
                "second_harmonic": words::number(self.resonance.second_harmonic),
            },
            "outputs": outputs,
            "dc0": slopes,
            "stable": self.stable(),
            "radius": self.equation.radius(),
            "small_divisors": self.small_divisors,
            "notes": self.notes,
            "envelope": {
                "dc0_dk": words::complex(self.envelope.slope),
                "d2c0_dk2": words::complex(self.envelope.curvature),
                "group_velocity": words::number(self.envelope.group_velocity()),
                "benjamin_feir": words::number(self.envelope.benjamin_feir(self.c2)),
            },
        });
        let higher = self.equation.coefficients.iter().zip(&self.equation.errors);
        for (n, (c, error)) in higher.enumerate().skip(2) {
            object[format!("c{}", 2 * n)] = words::complex(*c);
            object["error"][format!("c{}", 2 * n)] = words::number(*error);
        }
        let mut amplitudes: Map<String, Value> = self
            .orders()
            .map(|order| (order.to_string(), json!(self.equation.equilibrium(order))))
            .collect();
        amplitudes.insert("pade".to_owned(), json!(self.equation.pade()));
        object["amplitudes"] = Value::Object(amplitudes);
        if let Some(waves) = &self.waves {
            object["waves"] = json!({
                "self": words::complex(waves.own),
                "cross": words::complex(waves.cross),
                "error": words::number(waves.error),
                "stable": waves.stable(),
            });
        }
        object
    }

    /// The orders of the amplitude equation.
    fn orders(&self) -> impl Iterator<Item = usize> {
        (3..=self.equation.order()).step_by(2)
    }

    /// Whether A_e attracts the amplitude: the slope of dA/dt there is negative.
    fn stable(&self) -> Option<bool> {
        self.amplitude.map(|_| self.c0.re > 0.0)
    }
}

/// The amplitude equation to an order, and the solved problems that are as good as singular.
fn longer(
    setup: &Setup,
    point: &LandauPoint,
    error: &Accuracy,
    order: usize,
) -> Result<(AmplitudeEquation, Vec<String>)> {
    let mut equation = AmplitudeEquation {
        coefficients: vec![point.c0, point.c2],
        errors: vec![error.c0, error.c2],
    };
    let words = |distances: &[Distance]| -> Vec<String> {
        let small = small_divisors(distances, slow_rate(point)).into_iter();
        small.map(|d| d.in_words(&[point.k()])).collect()
    };
    if order == 3 {
        let [mean, second] = point.distances();
        let solved = [([1], [1], 0.0, mean), ([2], [0], 2.0 * point.k(), second)];
        let distances = solved.map(|(z, conj, q, distance)| Distance {
            monomial: Monomial {
                z: z.to_vec(),
                conj: conj.to_vec(),
            },
            q,
            shift: 2.0 * point.c0,
            distance,
        });
        return Ok((equation, words(&distances)));
    }
    let pairs = [point.pair.clone()];
    let expansion = Expansion::to(&point.problem, pairs.to_vec(), order - 1)?;
    let words = words(&expansion.distances());
    let system = expansion.last_coefficients();
    let errors = errors(setup, &point.problem, &pairs, &system)?;
    for (term, error) in system.equations[0].iter().zip(&errors[0]).skip(2) {
        let degree = term.monomial.degree();
        let name = format!("c{}", degree - 1);
        let size = term.g.norm();
        // Where it cancels, of the size that c2 and the slow rates give it.
        let order = degree as i32 / 2 - 1;
        let sum = |c2: f64| c2 * (c2 / point.pair.scale).powi(order);
        let known = stands(*error, size, sum(point.size()))
            || vanishes(*error, size, sum(point.uncancelled()));
        if !known {
            return Err(unconverged(setup, &name, *error, size));
        }
        equation.coefficients.push(term.g);
        equation.errors.push(*error);
    }
    Ok((equation, words))
}

/// Both coefficients of a wave in a mirror-symmetric model, with their error.
fn waves(setup: &Setup, point: &LandauPoint) -> Result<Option<Waves>> {
    if !point.problem.is_real() || point.c0.im == 0.0 {
        return Ok(None);
    }
    let pairs = [
        point.pair.clone(),
        mirror_image(&point.problem, &point.pair),
    ];
    let system = Expansion::to(&point.problem, pairs.to_vec(), 2)?.last_coefficients();
    let errors = errors(setup, &point.problem, &pairs, &system)?;
    Ok(Some(Waves::of(&system, &errors[0])))
}

/// Second-order problems that are singular to working precision, named.
fn check_distances(point: &LandauPoint, resonance: &Resonance) -> Result<()> {
    let scale = slow_rate(point);
    if resonance.mean_flow <= SINGULAR * scale {
        return Err(Error::OpenMean {
            of: "X[0;2]".to_owned(),
            distance: Some(resonance.mean_flow),
        });
    }
    if resonance.second_harmonic <= SINGULAR * scale {
        return Err(Error::Resonance {
            of: "X[2;2]".to_owned(),
            q: 2.0 * point.k(),
            modes: vec![point.k()],
            distance: Some(resonance.second_harmonic),
        });
    }
    Ok(())
}

/// The errors of coefficients that they leave standing.
fn standing(setup: &Setup, point: &LandauPoint, error: Accuracy) -> Result<Accuracy> {
    let size = point.c0.norm();
    if !stands(error.c0, size, point.pair.scale) {
        return Err(unconverged(setup, "c0", error.c0, size));
    }
    match landau_error(point, error.c2) {
        Some(c2) => Ok(Accuracy { c2, ..error }),
        None => Err(unconverged(setup, "c2", error.c2, point.c2.norm())),
    }
}

/// What to say of a coefficient that is not converged.
fn unconverged(setup: &Setup, name: &str, error: f64, size: f64) -> Error {
    let how_far = match error.is_finite() {
        true => format!(
            "its error is {:.1} times its size",
            error / size.max(1e-300)
        ),
        false => "another resolution has no such mode".to_owned(),
    };
    let mut found = Error::unresolved(name, setup.effective_resolution(), how_far);
    if let Error::Unresolved {
        advice,
        resolution: Some(_),
        ..
    } = &mut found
        && error > 0.5 * size
    {
        *advice += "; where that does not help, another mode (--near): one that changes with every M is singular at a \
                    wall, or one of a continuous spectrum";
    }
    found
}

impl fmt::Display for PointReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} at k = {}", self.title, self.k)?;
        match self.has_coordinate {
            true => writeln!(f, ", M = {}", self.resolution)?,
            false => writeln!(f)?,
        }
        let c0 = words::settled(self.c0, self.error.c0);
        let c2 = words::settled(self.c2, self.error.c2);
        writeln!(f, "  {}", words::amplitude_equation(c0, c2))?;
        let shown = words::shown;
        writeln!(f, "  c0 = {}   ± {:.1e}", shown(c0), self.error.c0)?;
        writeln!(f, "  c2 = {}   ± {:.1e}", shown(c2), self.error.c2)?;
        writeln!(f, "  {}", self.bifurcation)?;
        let by = &self.normalization;
        if let Some(amplitude) = self.amplitude {
            writeln!(f, "  A_e = {amplitude:.8}, normalised by {by}")?;
        } else if self.c0.re.abs() <= self.error.c0 {
            writeln!(f, "  neutral within the error of c0; normalised by {by}")?;
        } else {
            writeln!(f, "  no equilibrium at cubic order; normalised by {by}")?;
        }
        self.write_orders(f)?;
        write!(f, "  distance to resonance: ")?;
        if self.resonance.mean_flow.is_finite() {
            write!(f, "mean flow {:.3e}, ", self.resonance.mean_flow)?;
        }
        write!(f, "2:1 {:.3e}", self.resonance.second_harmonic)?;
        for (name, value) in &self.outputs {
            write!(f, "\n  {name} = {:.8} + {:.8} A²", value[0], value[1])?;
        }
        for (name, slope) in &self.dc0 {
            write!(f, "\n  dc0/d{name} = {}", shown(*slope))?;
        }
        self.write_envelope(f)?;
        if let Some(waves) = &self.waves {
            let verdict = match waves.stable() {
                Stable::Neither => {
                    "neither travelling nor standing waves are stable at cubic order".to_owned()
                }
                stable => format!("{stable} waves are stable"),
            };
            write!(
                f,
                "\n  waves: c2 is that of travelling waves; self {}, cross {}: {verdict}",
                shown(waves.own),
                shown(waves.cross)
            )?;
        }
        for divisor in self.small_divisors.iter().take(NAMED) {
            write!(f, "\n  {divisor}")?;
        }
        if self.small_divisors.len() > NAMED {
            write!(
                f,
                "\n  and {} more of them",
                self.small_divisors.len() - NAMED
            )?;
        }
        for note in &self.notes {
            write!(f, "\n  note: {note}")?;
        }
        Ok(())
    }
}

impl PointReport {
    /// Coefficients and amplitudes beyond third order.
    fn write_orders(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.equation.order() == 3 {
            return Ok(());
        }
        let higher = self.equation.coefficients.iter().zip(&self.equation.errors);
        for (n, (c, error)) in higher.enumerate().skip(2) {
            let c = words::shown(words::settled(*c, *error));
            writeln!(f, "  c{} = {c}   ± {error:.1e}", 2 * n)?;
        }
        let radius = self.equation.radius();
        let judged = |amplitude: Option<f64>| match (amplitude, radius) {
            (None, _) => "none".to_owned(),
            (Some(a), Some(radius)) if a > radius => {
                format!("{a:.8} (beyond the radius of convergence)")
            }
            (Some(a), _) => format!("{a:.8}"),
        };
        for order in self.orders() {
            let amplitude = judged(self.equation.equilibrium(order));
            writeln!(f, "  A_e at order {order}: {amplitude}")?;
        }
        writeln!(
            f,
            "  A_e of the Padé approximant: {}",
            judged(self.equation.pade())
        )?;
        if let Some(radius) = radius {
            writeln!(f, "  the series converges to about A = {radius:.4}")?;
        }
        Ok(())
    }

    fn write_envelope(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Envelope { slope, curvature } = self.envelope;
        write!(
            f,
            "\n  envelope: dc0/dk = {}, d²c0/dk² = {}",
            words::shown(slope),
            words::shown(curvature)
        )?;
        if self.c0.im != 0.0 {
            write!(
                f,
                "; group velocity {:.8}, Benjamin–Feir number {:.8}",
                self.envelope.group_velocity(),
                self.envelope.benjamin_feir(self.c2)
            )?;
        }
        if self.conserved_mean {
            write!(
                f,
                " (a conserved mean couples in: the envelope needs an equation for it)"
            )?;
        }
        Ok(())
    }
}
