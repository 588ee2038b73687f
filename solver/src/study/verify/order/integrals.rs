//! The defect of the integral conditions: ∫ D(X⁰ + X') − D(X⁰) dy with the full density D, averaged over x.

use super::{OnGrid, PHASES, Series, on_grid};
use crate::model::{C64, Kernel, ResidualId, WithRounding};
use crate::weakly::Expansion;

/// Largest common denominator of the wavenumbers' ratios that is looked for.
const DENOMINATORS: u32 = 48;
/// How far from a whole number a ratio may be, relative.
const WHOLE: f64 = 1e-8;
/// Most modes whose phases are averaged over one by one.
const MOST_PHASES: usize = 3;

/// The integral conditions of a problem on the points of the quadrature.
pub(super) struct OnIntegrals {
    on: OnGrid,
    measures: Vec<f64>,
    translations: Vec<Vec<C64>>,
}

impl OnIntegrals {
    /// Nothing where all densities are linear: the rows of the closures say everything then.
    pub fn new(expansion: &Expansion, modes: &[crate::weakly::Mode]) -> Option<Self> {
        let problem = expansion.problem.as_ref();
        problem
            .model()
            .residual(ResidualId::Integrals(problem.base.case))?;
        let quadrature = problem.quadrature();
        let measures = quadrature.nodes.iter().map(|(_, measure)| *measure);
        Some(OnIntegrals {
            measures: measures.collect(),
            on: on_grid(expansion, modes, quadrature.points),
            translations: translations(expansion)?,
        })
    }
}

impl Series<'_> {
    /// The largest defect of each integral condition at an amplitude, in the order of the problem's borders.
    pub(super) fn integral_defects(&self, amplitude: f64) -> Vec<WithRounding> {
        let problem = self.expansion.problem.as_ref();
        let zero = WithRounding::from(0.0);
        let mut largest = vec![zero; problem.borders.len()];
        let residual = ResidualId::Integrals(problem.base.case);
        let parts = self
            .integrals
            .as_ref()
            .zip(problem.model().residual(residual));
        let Some((integrals, kernel)) = parts else {
            return largest;
        };
        let still = self.integrated(kernel, integrals, &self.samples(0.0)[0]);
        // The translations run through all phases of one mode, and some of several.
        let samples = self.samples(amplitude);
        let step = samples.len() / (PHASES * (self.expansion.modes.len() - 1) + 1);
        for sample in samples.into_iter().step_by(step.max(1)) {
            let moved = self.integrated(kernel, integrals, &sample);
            for (border, largest) in problem.borders.iter().zip(&mut largest) {
                let difference = moved[border.closure] - still[border.closure];
                largest.value = largest.value.max(difference.value.abs());
                largest.size = largest.size.max(difference.size);
            }
        }
        largest
    }

    /// ∫ of every density, averaged over the translations of a state.
    fn integrated(
        &self,
        kernel: &Kernel,
        integrals: &OnIntegrals,
        sample: &[C64],
    ) -> Vec<WithRounding> {
        let turned = integrals.translations.iter().map(|phases| {
            let pairs = sample.iter().zip(phases);
            pairs.map(|(z, phase)| z * phase).collect()
        });
        let states: Vec<Vec<C64>> = turned.collect();
        let values = self.residuals(kernel, &integrals.on, &states);
        let count = states.len() as f64;
        let mut sums = vec![WithRounding::from(0.0); kernel.outputs.len()];
        for (densities, measure) in values.iter().zip(integrals.measures.iter().cycle()) {
            for (sum, density) in sums.iter_mut().zip(densities) {
                sum.value += measure * density.value / count;
                sum.size += measure * density.size / count;
            }
        }
        sums
    }
}

/// Factors e^{i q_j x} of the modes at places over a common period, enough for every power up to twice the order;
/// where the wavenumbers have none, of all phases one by one: the average over x holds for each of them.
fn translations(expansion: &Expansion) -> Option<Vec<Vec<C64>>> {
    let q: Vec<f64> = expansion.modes.iter().map(|mode| mode.pair.k.k()).collect();
    let powers = 2 * (expansion.order() + 1);
    let turn = |part: f64| C64::cis(std::f64::consts::TAU * part);
    let multiples = |denominator: u32| -> Option<Vec<f64>> {
        let ratio = |q_j: &f64| {
            let multiple = q_j / q[0] * f64::from(denominator);
            let whole = multiple.round();
            ((multiple - whole).abs() <= WHOLE * whole.abs()).then_some(whole)
        };
        q.iter().map(ratio).collect()
    };
    if let Some(multiples) = (1..=DENOMINATORS).find_map(multiples) {
        let highest = multiples.iter().fold(1.0_f64, |m, n| m.max(n.abs()));
        let count = powers * highest as usize;
        let at = |i: usize| {
            let place = i as f64 / count as f64;
            multiples.iter().map(|n| turn(n * place)).collect()
        };
        return Some((0..count).map(at).collect());
    }
    if q.len() > MOST_PHASES {
        return None;
    }
    let count = powers.pow(q.len() as u32);
    let at = |i: usize| {
        let phase = |j: usize| (i / powers.pow(j as u32) % powers) as f64 / powers as f64;
        (0..q.len()).map(|j| turn(phase(j))).collect()
    };
    Some((0..count).map(at).collect())
}
