//! Output functionals of the state, to second order in the amplitude:
//!
//! F = F⁰ + A² (F1 X[0;2] + 2 F2(X, X̄)) + …

use super::cubic::LandauPoint;
use super::mode::Mode;
use crate::model::layout::{OutputTerms, read_output};
use crate::model::{C64, Jet, KernelId, evaluate};
use crate::space::Place;

/// Every output functional, `[value in the base state, coefficient of A² in its mean over x]`, in the order of the spec.
pub fn outputs(point: &LandauPoint) -> Vec<[f64; 2]> {
    let problem = point.problem.as_ref();
    let (structure, space) = (problem.structure(), problem.space());
    let (fundamental, mean) = (&point.fundamental, &point.mean);
    let conjugate = fundamental.conjugate();
    let terms_at = |index: usize, place: Place| -> OutputTerms<f64> {
        let state = problem.base.at(place, point.pair.k);
        let out = evaluate(problem.model(), KernelId::Outputs, &state);
        read_output(&structure.outputs, index, &out)
    };
    let mut values = Vec::new();
    for (index, output) in structure.outputs.iter().enumerate() {
        // Places with weights: one, or a quadrature.
        let (places, weights): (Vec<Place>, Vec<f64>) = if output.at_point {
            let place = space.place(terms_at(index, Place::MIDDLE).place);
            (vec![place], vec![1.0])
        } else {
            problem.quadrature().nodes.into_iter().unzip()
        };
        let terms: Vec<OutputTerms<f64>> = places.iter().map(|&at| terms_at(index, at)).collect();
        let at = |mode: &Mode, jet: Jet| -> Vec<C64> { mode.at(problem, jet, &places) };
        let mut total = [0.0; 2];
        for (position, monomial) in output.monomials.iter().enumerate() {
            let coefficients = terms.iter().zip(&weights);
            let coefficients = coefficients.map(|(terms, w)| w * terms.coefficients[position]);
            match monomial.as_slice() {
                // F⁰
                [] => total[0] += coefficients.sum::<f64>(),
                // F1 X[0;2]
                [jet] => {
                    let values = at(mean, *jet);
                    total[1] += coefficients.zip(values).map(|(c, v)| c * v.re).sum::<f64>();
                }
                // 2 F2(X, X̄)
                [a, b] => {
                    let pairs = at(fundamental, *a).into_iter().zip(at(&conjugate, *b));
                    let products = coefficients.zip(pairs);
                    total[1] += products
                        .map(|(c, (a, b))| 2.0 * c * (a * b).re)
                        .sum::<f64>();
                }
                // Products of more jets begin at A⁴.
                _ => {}
            }
        }
        values.push(total);
    }
    values
}
