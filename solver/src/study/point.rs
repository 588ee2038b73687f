//! A Landau point with everything that it rests on: what `point` prints.

mod json;
mod text;

use super::accuracy::{
    Accuracy, Resonance, SINGULAR, resonance, slow_rate, standing, stands, unconverged, vanishes,
};
use super::amplitudes::{errors, small_divisors};
use super::error_bars::Companions;
use super::orders::check_order;
use super::{Setup, Silent, sensitivity};
use crate::error::{Error, Result};
use crate::measured::{Decided, Measured};
use crate::model::C64;
use crate::series::Monomial;
use crate::spectrum::mirror_image;
use crate::wavevector::WaveVector;
use crate::weakly::{
    self, AmplitudeEquation, Bifurcation, Distance, Envelope, Expansion, LandauPoint, Selection,
    Waves, benjamin_feir, multiplier_error, outputs,
};
use serde_json::Value;
use std::slice;

/// Rounding errors of a sum over the cross-stream direction at least, relative.
const ROUNDING: f64 = 1e-14;

/// A functional of the state, to second order in the amplitude.
#[derive(Clone, Debug)]
pub struct Output {
    /// Its name.
    pub name: String,
    /// Its value at the base state.
    pub base: Measured,
    /// What A² is multiplied by in its mean.
    pub correction: Measured,
}

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
    /// A_e at cubic order.
    pub amplitude: Decided,
    /// Side and kind.
    pub bifurcation: Bifurcation,
    /// What the amplitude measures.
    pub normalization: String,
    /// Absolute errors of c0 and c2.
    pub error: Accuracy,
    /// Distances from singularity.
    pub resonance: Resonance,
    /// Functionals of the state.
    pub outputs: Vec<Output>,
    /// dc0/d(parameter) by name, or why it cannot be formed.
    pub dc0: Vec<(String, Decided<C64>)>,
    /// dc0/dk
    pub slope: Measured<C64>,
    /// d²c0/dk²
    pub curvature: Measured<C64>,
    /// The Benjamin–Feir–Newell number.
    pub benjamin_feir: Decided,
    /// Whether a conserved mean couples to the envelope, whose equation then is not closed.
    pub conserved_mean: bool,
    /// Integrals that the balances keep and the spec does not declare, as a spec would name them.
    pub undeclared: Vec<String>,
    /// Self and cross coefficient of a wave in a mirror-symmetric model, or why they cannot be formed.
    pub waves: Option<std::result::Result<Waves, String>>,
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
        WaveVector::wave(k)?;
        check_order(order)?;
        let base = setup.base(None)?;
        let point = &setup.point(&base, k, selection)?;
        let companions = &Companions::of(setup, &point.problem, slice::from_ref(&point.pair));
        let Values { error, outputs } = Values::of(point, companions)?;
        let resonance = resonance(point, error.c0)?;
        check_distances(point, &resonance)?;
        let error = standing(setup, point, error)?;
        if let Some(error) = point.multiplier_error(error.c2) {
            return Err(error);
        }
        let [slope, curvature] = envelope(point, companions)?;
        let (equation, small_divisors) = longer(setup, point, companions, &error, order)?;
        let [c0, c2] = [equation.coefficients[0], equation.coefficients[1]];
        let structure = setup.model.structure();
        let name = |id| structure.parameters[id].name.clone();
        let slopes = sensitivity::measured(setup, &point.problem, &point.pair, companions);
        Ok(PointReport {
            conserved_mean: point.problem.conserves_a_mean(),
            undeclared: point.problem.undeclared(),
            waves: waves(setup, point),
            benjamin_feir: benjamin_feir(curvature, c2),
            slope,
            curvature,
            amplitude: equation.equilibrium(3),
            bifurcation: Bifurcation::new((c0.value, c0.error), (c2.value, c2.error)),
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
            normalization: structure.amplitude.description.clone(),
            error,
            resonance,
            outputs,
            dc0: slopes
                .into_iter()
                .map(|(id, slope)| (name(id), slope.map_err(|error| error.to_string())))
                .collect(),
            notes: base.notes.clone(),
        })
    }

    /// The orders of the amplitude equation.
    fn orders(&self) -> impl Iterator<Item = usize> {
        (3..=self.equation.order()).step_by(2)
    }

    /// Whether the state of amplitude A_e attracts: the slope of dA/dt there is negative and, of a wave in a
    /// mirror-symmetric model, the wave to the other side does not grow on it; the reason where it is not decided.
    pub fn stable(&self) -> std::result::Result<bool, String> {
        self.amplitude.as_ref().map_err(Clone::clone)?;
        if self.c0.re < 0.0 {
            return Ok(false);
        }
        match &self.waves {
            None => Ok(true),
            Some(Err(reason)) => Err(reason.clone()),
            Some(Ok(waves)) => waves.resists_the_opposite().ok_or_else(|| {
                "Re cross and Re self of the waves are equal within their errors".to_owned()
            }),
        }
    }
}

/// Quantities of a Landau point with their errors.
struct Values {
    error: Accuracy,
    outputs: Vec<Output>,
}

impl Values {
    fn of(point: &LandauPoint, companions: &Companions) -> Result<Self> {
        let quantities = |point: &LandauPoint| -> Vec<C64> {
            let outputs = outputs(point).into_iter().flatten();
            let outputs = outputs.map(|value| C64::new(value, 0.0));
            [point.c0, point.c2].into_iter().chain(outputs).collect()
        };
        let names = point.problem.structure().outputs.iter();
        let here = quantities(point);
        let errors = companions.errors(&here, |companion| {
            let pair = companion.pairs[0].clone();
            Ok(quantities(&weakly::from_pair(&companion.problem, pair)?))
        });
        let [c0, c2] = [errors[0], errors[1]];
        let error = Accuracy { c0, c2 }.beside_the_adjoint(point)?;
        let measured = |index: usize| {
            let value = here[index].re;
            Measured::new(value, errors[index].max(ROUNDING * value.abs()))
        };
        let output = |(index, name): (usize, String)| {
            let [base, correction] = [0, 1].map(|part| measured(2 + 2 * index + part));
            if base.value.is_finite() && correction.value.is_finite() {
                return Ok(Output {
                    name,
                    base,
                    correction,
                });
            }
            Err(Error::computation(format!(
                "the output `{name}` has no value at this base state"
            )))
        };
        let names = names.map(|info| info.name.clone());
        Ok(Values {
            error,
            outputs: names.enumerate().map(output).collect::<Result<_>>()?,
        })
    }
}

/// dc0/dk and d²c0/dk².
fn envelope(point: &LandauPoint, companions: &Companions) -> Result<[Measured<C64>; 2]> {
    let Envelope { slope, curvature } = Envelope::of(&point.problem, &point.pair)?;
    let measured = companions.measured(&[slope, curvature], |companion| {
        let there = Envelope::of(&companion.problem, &companion.pairs[0])?;
        Ok(vec![there.slope, there.curvature])
    });
    Ok([measured[0], measured[1]])
}

/// The amplitude equation to an order, and the solved problems that are as good as singular.
fn longer(
    setup: &Setup,
    point: &LandauPoint,
    companions: &Companions,
    error: &Accuracy,
    order: usize,
) -> Result<(AmplitudeEquation, Vec<String>)> {
    let mut equation = AmplitudeEquation {
        coefficients: vec![
            Measured::new(point.c0, error.c0),
            Measured::new(point.c2, error.c2),
        ],
    };
    let words = |distances: &[Distance]| -> Vec<String> {
        let small = small_divisors(distances, slow_rate(point)).into_iter();
        small.map(|d| d.in_words(&[point.k()])).collect()
    };
    if order == 3 {
        let [mean, second] = point.distances();
        let solved = [
            ([1], [1], WaveVector::MEAN, mean),
            ([2], [0], 2.0 * point.pair.k, second),
        ];
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
    let uncertainty = error.c2 / point.size();
    if let Some(error) = multiplier_error(&expansion.multipliers, uncertainty) {
        return Err(error);
    }
    let words = words(&expansion.distances());
    let system = expansion.last_coefficients();
    let errors = errors(companions, &point.problem, &pairs, &system, &Silent)?;
    for (term, &error) in system.equations[0].iter().zip(&errors[0]).skip(2) {
        let degree = term.monomial.degree();
        let size = term.g.norm();
        // Where it cancels, of the size that c2 and the slow rates give it.
        let order = degree as i32 / 2 - 1;
        let sum = |c2: f64| c2 * (c2 / point.pair.scale).powi(order);
        let known = stands(error, size, sum(point.size()))
            || vanishes(error, size, sum(point.uncancelled()));
        if !known {
            let name = format!("c{}", degree - 1);
            return Err(unconverged(setup, &name, error, size));
        }
        equation.coefficients.push(Measured::new(term.g, error));
    }
    Ok((equation, words))
}

/// Both coefficients of a wave in a mirror-symmetric model, with their errors; a resonance of the pair is the reason
/// why there are none, and says nothing against the coefficients of the single wave.
fn waves(setup: &Setup, point: &LandauPoint) -> Option<std::result::Result<Waves, String>> {
    if !point.problem.is_real() || point.c0.im == 0.0 {
        return None;
    }
    let pairs = [
        point.pair.clone(),
        mirror_image(&point.problem, &point.pair),
    ];
    let both = || -> Result<Waves> {
        let system = Expansion::to(&point.problem, pairs.to_vec(), 2)?.last_coefficients();
        let companions = Companions::of(setup, &point.problem, &pairs);
        let errors = errors(&companions, &point.problem, &pairs, &system, &Silent)?;
        Ok(Waves::of(&system, &errors[0]))
    };
    let reason = |error: Error| format!("left and right waves: {error}");
    Some(both().map_err(reason))
}

/// Second-order problems that are singular to working precision, named.
fn check_distances(point: &LandauPoint, resonance: &Resonance) -> Result<()> {
    let scale = slow_rate(point);
    let [mean_flow, second_harmonic] =
        [resonance.mean_flow, resonance.second_harmonic].map(|d| d.value);
    if mean_flow <= SINGULAR * scale {
        return Err(Error::OpenMean {
            of: "X[0;2]".to_owned(),
            distance: Some(mean_flow),
        });
    }
    if second_harmonic <= SINGULAR * scale {
        return Err(Error::Resonance {
            of: "X[2;2]".to_owned(),
            q: 2.0 * point.k(),
            modes: vec![point.k()],
            distance: Some(second_harmonic),
        });
    }
    Ok(())
}
