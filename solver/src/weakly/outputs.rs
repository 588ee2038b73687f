//! Output functionals of the state, to second order in the amplitude.

use super::cubic::LandauPoint;
use super::mode::Mode;
use crate::model::layout::read_output;
use crate::model::{C64, Jet, KernelId, evaluate};
use crate::space::Place;

/// The value of an output functional: at the base, and the A² correction of its mean.
pub fn outputs(point: &LandauPoint) -> Vec<[f64; 2]> {
    let problem = point.problem.as_ref();
    let structure = problem.structure();
    let (fundamental, mean) = (&point.fundamental, &point.mean);
    let conjugate = fundamental.conjugate();
    let k = point.k();
    let space = problem.space();
    let terms_at = |index: usize, place: Place| {
        let state = problem.base.at(place, k);
        let out = evaluate(problem.model(), KernelId::Outputs, &state);
        read_output(&structure.outputs, index, &out)
    };
    let mut values = Vec::new();
    for (index, output) in structure.outputs.iter().enumerate() {
        // Places with weights: one, or a quadrature.
        let nodes = match output.at_point {
            true => vec![(space.place(terms_at(index, Place::MIDDLE).place), 1.0)],
            false => problem.quadrature().nodes,
        };
        let mut total = [0.0; 2];
        for (place, weight) in nodes {
            let coefficients = terms_at(index, place).coefficients;
            let at = |mode: &Mode, jet: Jet| -> C64 { mode.at(problem, jet, &[place])[0] };
            for (monomial, coefficient) in output.monomials.iter().zip(coefficients) {
                let coefficient = weight * coefficient;
                match monomial.as_slice() {
                    [] => total[0] += coefficient,
                    [jet] => total[1] += coefficient * at(mean, *jet).re,
                    [a, b] => {
                        let product = at(fundamental, *a) * at(&conjugate, *b);
                        total[1] += coefficient * 2.0 * product.re;
                    }
                    _ => {}
                }
            }
        }
        values.push(total);
    }
    values
}
