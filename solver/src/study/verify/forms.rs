//! Part 4: the emitted N2 and N3 against a second route that shares nothing with the expansion:
//! the unexpanded residual run on truncated polynomials, z^d being N_d(x, …, x) for the perturbation z x + z̄ x̄.

use super::Check;
use super::adjointness::Random;
use super::order::base_jets;
use crate::error::Result;
use crate::model::{C64, Jet, KernelId, ResidualId, evaluate};
use crate::problem::Problem;
use crate::series::{Levels, Monomials, Program};
use crate::space::Place;
use crate::wavevector::WaveVector;

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
    for degree in 2..=structure.order {
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

/// A random state: a place, and three perturbations in the jets of the residual.
struct State {
    point: Vec<f64>,
    directions: [Vec<C64>; 3],
}

impl State {
    /// Perturbations on the scale of the base, so that no law leaves its domain.
    fn random(problem: &Problem, random: &mut Random) -> Self {
        let place = Place::at(0.5 + 0.49 * random.number());
        let jets = problem.structure().residual_jets.len();
        let mut direction = || (0..jets).map(|_| random.complex()).collect();
        State {
            point: problem.base.at(place, WaveVector::along_x(1.0)),
            directions: [direction(), direction(), direction()],
        }
    }
}

/// The residual's coefficients of z and z^degree, `[row][state]`.
fn by_series(problem: &Problem, states: &[State], degree: usize) -> [Vec<Vec<C64>>; 2] {
    let structure = problem.structure();
    let Some(kernel) = problem.model().residual(ResidualId::Balances) else {
        return [Vec::new(), Vec::new()];
    };
    let rows: Vec<usize> = (0..structure.balances.len()).collect();
    let points: Vec<Vec<f64>> = states.iter().map(|s| s.point.clone()).collect();
    let jets = points
        .iter()
        .map(|p| base_jets(problem, p, &structure.residual_jets));
    let program = Program::new(kernel, &rows, &points[0], None);
    let mut levels = Levels::new(&program, &points, &jets.collect::<Vec<_>>());
    let mut monomials = Monomials::new(1);
    let mut found = [Vec::new(), Vec::new()];
    for current in 1..=degree {
        monomials.extend();
        let all: Vec<usize> = (0..monomials.of(current).len()).collect();
        levels.begin(&program, &monomials, current, &all);
        let line = |jet: usize, _: usize| {
            let direction = |s: &State| s.directions[0][jet];
            (current == 1).then(|| states.iter().map(direction).collect())
        };
        // z^current is the first monomial of its degree.
        let powers =
            |rows: Vec<Vec<Vec<C64>>>| rows.into_iter().map(|row| row[0].clone()).collect();
        if current == 1 || current == degree {
            let outputs = levels.outputs(&program, &monomials, current, &line);
            found[usize::from(current > 1)] = powers(outputs);
        }
        levels.complete(&program, &monomials, current, &line);
    }
    found
}

/// Largest relative difference from the series route, and between exchanged arguments.
pub fn second_route(problem: &Problem, degree: usize) -> (f64, f64) {
    let structure = problem.structure();
    let mut random = Random(20_260_101 + degree as u64);
    let (mut difference, mut asymmetry) = (0.0_f64, 0.0_f64);
    let states: Vec<State> = (0..STATES)
        .map(|_| State::random(problem, &mut random))
        .collect();
    let [first_order, series] = by_series(problem, &states, degree);
    let position = |jet: &Jet| structure.residual_jets.iter().position(|j| j == jet);
    let in_forms = |x: &Vec<C64>| -> Vec<C64> {
        let jets = structure.form_jets.iter();
        jets.map(|jet| position(jet).map_or(C64::new(0.0, 0.0), |i| x[i]))
            .collect()
    };
    for (index, state) in states.iter().enumerate() {
        let c = evaluate(problem.model(), KernelId::Nonlinear, &state.point);
        let divisors = evaluate(problem.model(), KernelId::Divisors, &state.point);
        let directions = state.directions.each_ref().map(in_forms);
        for (row, balance) in structure.balances.ids().enumerate() {
            let linear = first_order[row][index].norm();
            if !structure.forms[degree - 2][balance] {
                // The form has no terms: the series must not have any either.
                let stray = series[row][index].norm() > 1e-12 * linear.max(1e-300);
                difference = difference.max(if stray { 1.0 } else { 0.0 });
                continue;
            }
            let value = |order: &[usize]| {
                let arguments: Vec<&[C64]> =
                    order.iter().map(|&i| directions[i].as_slice()).collect();
                problem.model().form(degree, balance, &c, &arguments)
            };
            let form = value(&[0, 0, 0][..degree]);
            let expected = -series[row][index] / divisors[row];
            let least = 1e-12 * linear / divisors[row].abs();
            let size = form.norm().max(expected.norm()).max(least);
            difference = difference.max((form - expected).norm() / size.max(1e-300));
            let first = value(&ORDERS[0][..degree]);
            let orders = ORDERS.iter().map(|order| &order[..degree]);
            for order in orders.filter(|order| order.iter().all(|i| *i < degree)) {
                let other = value(order);
                let size = first.norm().max(form.norm()).max(1e-300);
                asymmetry = asymmetry.max((first - other).norm() / size);
            }
        }
    }
    (difference, asymmetry)
}
