//! Part 4: the emitted N2 and N3 against a second route that shares nothing with the expansion:
//! the unexpanded residual run on truncated power series.

use super::Check;
use super::adjointness::Random;
use super::order::base_jets;
use crate::error::Result;
use crate::model::{C64, Jet, KernelId, ResidualCall, ResidualId, SERIES_LENGTH, Series, evaluate};
use crate::problem::Problem;

/// All orders of three arguments; the first two entries of some are those of two.
const ORDERS: [[usize; 3]; 6] = [
    [0, 1, 2],
    [1, 0, 2],
    [0, 2, 1],
    [2, 1, 0],
    [1, 2, 0],
    [2, 0, 1],
];
/// Random states tried.
const STATES: usize = 24;

pub(super) fn check(problem: &Problem) -> Result<Vec<Check>> {
    let mut checks = Vec::new();
    let structure = problem.structure();
    for degree in 2..=structure.order.min(SERIES_LENGTH - 1) {
        let (difference, asymmetry) = second_route(problem, degree);
        let name = format!("N{degree} against the series route, relative");
        let detail = format!("{STATES} random states");
        checks.push(Check::below(4, name, difference, 1e-10, detail));
        let name = format!("N{degree} symmetric, relative");
        checks.push(match structure.forms[degree - 2].contains(&true) {
            true => Check::below(4, name, asymmetry, 1e-12, "arguments in every order"),
            false => Check::left_out(4, name, format!("the model has no N{degree}")),
        });
    }
    Ok(checks)
}

/// Largest relative difference from the series route, and between exchanged arguments.
pub fn second_route(problem: &Problem, degree: usize) -> (f64, f64) {
    let structure = problem.structure();
    let mut random = Random(20_260_101 + degree as u64);
    let (mut difference, mut asymmetry) = (0.0_f64, 0.0_f64);
    for _ in 0..STATES {
        let xi = 0.98 * random.number();
        let point = problem.base.point(problem.model, xi, 1.0);
        let c = evaluate(problem.model, KernelId::Nonlinear, &point);
        let divisors = evaluate(problem.model, KernelId::Divisors, &point);
        // Perturbations on the scale of the base, so that no law leaves its domain.
        let state = |random: &mut Random, jets: &[Jet]| -> Vec<C64> {
            jets.iter().map(|_| random.complex()).collect()
        };
        let jets = &structure.residual_jets;
        let x = state(&mut random, jets);
        let y = state(&mut random, jets);
        let z = state(&mut random, jets);
        let in_forms = |x: &[C64]| -> Vec<C64> {
            let find = |jet: &Jet| jets.iter().position(|j| j == jet);
            structure
                .form_jets
                .iter()
                .map(|jet| find(jet).map_or(C64::new(0.0, 0.0), |i| x[i]))
                .collect()
        };
        let base = base_jets(problem, &point, jets);
        let series: Vec<Series> = base
            .iter()
            .zip(&x)
            .map(|(&b, &slope)| Series::line(C64::from(b), slope))
            .collect();
        let mut out = vec![Series::from(0.0); structure.balances.len()];
        problem.model.residual(
            ResidualId::Balances,
            &point,
            ResidualCall::Series(&series, &mut out),
        );
        let diagonal = in_forms(&x);
        let others = [in_forms(&x), in_forms(&y), in_forms(&z)];
        for row in 0..structure.balances.len() {
            if !structure.forms[degree - 2][row] {
                // The form has no terms: the series must not have any either.
                let stray = out[row].0[degree].norm();
                let linear = out[row].0[1].norm().max(1e-300);
                difference = difference.max(if stray > 1e-12 * linear { 1.0 } else { 0.0 });
                continue;
            }
            let arguments: Vec<&[C64]> = (0..degree).map(|_| diagonal.as_slice()).collect();
            let form = problem.model.form(degree, row, &c, &arguments);
            let expected = -out[row].0[degree] / divisors[row];
            let size = form
                .norm()
                .max(expected.norm())
                .max(1e-12 * out[row].0[1].norm() / divisors[row].abs());
            difference = difference.max((form - expected).norm() / size.max(1e-300));
            let value = |order: &[usize]| {
                let arguments: Vec<&[C64]> = order.iter().map(|&i| others[i].as_slice()).collect();
                problem.model.form(degree, row, &c, &arguments)
            };
            let first = value(&ORDERS[0][..degree]);
            for order in ORDERS
                .iter()
                .filter(|order| order[..degree].iter().all(|i| *i < degree))
            {
                let other = value(&order[..degree]);
                let size = first.norm().max(form.norm()).max(1e-300);
                asymmetry = asymmetry.max((first - other).norm() / size);
            }
        }
    }
    (difference, asymmetry)
}
