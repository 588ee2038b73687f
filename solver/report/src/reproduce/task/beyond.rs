//! Beyond cubic order of one mode: amplitudes by order, and a mode with its second harmonic.

use super::super::outcome::{Beside, Number, Outcome};
use super::super::study::{Axis, Case, named};
use super::super::table::Table;
use super::super::workshop::Workshop;
use super::draw::picture;
use super::{called, each};
use crate::figure::{Panel, Style};
use landau_solver::error::Result;
use landau_solver::measured::{Decided, Measured};
use landau_solver::problem::Problem;
use landau_solver::series::Monomial;
use landau_solver::spectrum::EigenPair;
use landau_solver::study::amplitudes::next_order;
use landau_solver::weakly::{
    AmplitudeEquation, AmplitudeSystem, Equilibrium, Expansion, Selection, equilibria, select,
};
use std::sync::Arc;

/// The terms of the next order, relative to the largest there, up to which an equilibrium is drawn as trusted.
const TRUSTED: f64 = 0.3;

/// A study of orders: which are wanted, and what is known of the full solution.
pub(super) struct Orders<'a> {
    pub figure: &'a str,
    pub over: &'a Axis,
    pub highest: usize,
    /// Place and amplitude of states that were found without an expansion.
    pub reference: &'a [[f64; 2]],
}

/// The value at each place of an axis, the mode being followed along it; why there is none where there is none.
fn along<R>(
    problem: &Problem,
    places: &[f64],
    value: impl Fn(Vec<EigenPair>) -> Result<R>,
    multiples: &[f64],
) -> Vec<Result<R>> {
    let mut last: Option<Vec<EigenPair>> = None;
    let mut found = Vec::new();
    for &k in places {
        let pairs: Result<Vec<EigenPair>> = multiples
            .iter()
            .enumerate()
            .map(|(j, multiple)| {
                let near = last.as_ref().map(|pairs| Selection::Like(&pairs[j]));
                select(problem, multiple * k, near.unwrap_or(Selection::Leading))
            })
            .collect();
        found.push(pairs.and_then(|pairs| {
            last = Some(pairs.clone());
            value(pairs)
        }));
    }
    found
}

/// Why a case has no place at all with a value: the reason of its first.
fn nothing_in<R>(label: &str, values: &[Result<R>]) -> Option<String> {
    let first = values.first().and_then(|value| value.as_ref().err())?;
    let count = values.len();
    let none = values.iter().all(Result::is_err);
    let label = called(label);
    none.then(|| format!("{label}: none of {count} places came out; the first: {first}"))
}

/// A_e over k at every order, and of the Padé approximant, as far as the series converges.
pub(super) fn orders(shop: &Workshop, cases: &[Case], asked: &Orders) -> Result<Outcome> {
    let mut outcome = Outcome::default();
    let places = asked.over.values();
    let found = each(cases, &mut outcome.failures, |case| {
        let setup = shop.setup(case)?;
        let problem = setup.problem(&setup.base(None)?)?;
        let equation = |pairs: Vec<EigenPair>| {
            let expansion = Expansion::to(&problem, pairs, asked.highest - 1)?;
            let terms = expansion.last_coefficients().equations.remove(0);
            let coefficients = terms.iter().map(|term| Measured::new(term.g, 0.0));
            Ok(AmplitudeEquation {
                coefficients: coefficients.collect(),
            })
        };
        Ok(along(&problem, &places, equation, &[1.0]))
    })?;
    let orders: Vec<usize> = (3..=asked.highest).step_by(2).collect();
    let mut header = vec!["case".to_owned(), "k".to_owned()];
    header.extend(orders.iter().map(|order| format!("A_e order {order}")));
    header.extend(["A_e Padé".to_owned(), "radius".to_owned()]);
    let header: Vec<&str> = header.iter().map(String::as_str).collect();
    let mut table = Table::new(&header);
    let mut panel = Panel::new("equilibrium amplitude by order", "k", "A_e");
    for (index, equations) in &found {
        let case = &cases[*index];
        outcome.failures.extend(nothing_in(&case.label, equations));
        let first = table.rows.len();
        for (k, equation) in places.iter().zip(equations) {
            let value = |of: &dyn Fn(&AmplitudeEquation) -> Decided| {
                let answer = equation.as_ref().ok().and_then(|e| of(e).ok());
                answer.map_or(f64::NAN, |amplitude| amplitude.value)
            };
            let mut row = vec![(*index + 1) as f64, *k];
            row.extend(orders.iter().map(|&order| value(&|e| e.equilibrium(order))));
            row.push(value(&|e| e.pade()));
            row.push(value(&|e| e.radius()));
            table.rows.push(row);
        }
        let rows = &table.rows[first..];
        // Beyond the radius of convergence an order says nothing.
        let curve = |column: usize| -> Vec<(f64, f64)> {
            let within = |row: &Vec<f64>| {
                let (amplitude, radius) = (row[column], row[row.len() - 1]);
                let kept = amplitude <= radius;
                (row[1], if kept { amplitude } else { f64::NAN })
            };
            rows.iter().map(within).collect()
        };
        for (position, order) in orders.iter().enumerate() {
            let label = named(case, &format!("order {order}"));
            panel.curve(&label, Style::Line, curve(2 + position));
        }
        let label = named(case, "Padé");
        panel.curve(&label, Style::Dashed, curve(2 + orders.len()));
        // Beside the full solution, at the nearest place.
        for [k, amplitude] in asked.reference {
            let near = rows
                .iter()
                .min_by(|a, b| (a[1] - k).abs().total_cmp(&(b[1] - k).abs()));
            let quantity = format!("A_e of the Padé approximant at k = {k}");
            let number = Number::new(asked.figure, case, &quantity, named(case, &quantity));
            let number = Number {
                reference: Some(Beside {
                    label: "fully nonlinear".to_owned(),
                    value: *amplitude,
                }),
                ..number
            };
            outcome
                .numbers
                .push(match near.filter(|row| (row[1] - k).abs() < 1e-9) {
                    Some(row) => number.answered(row[2 + orders.len()], None),
                    None => number.failed("the axis does not pass there"),
                });
        }
    }
    let known = asked.reference.iter().map(|[k, a]| (*k, *a)).collect();
    if !asked.reference.is_empty() {
        panel.curve("fully nonlinear", Style::Dots, known);
    }
    picture(shop, &mut outcome, "", &[panel], table);
    Ok(outcome)
}

/// One place of a pair: its equations to third order, its equilibria with the next order's share.
struct Pair {
    system: AmplitudeSystem,
    states: Vec<(Equilibrium, f64)>,
}

fn pair(problem: &Arc<Problem>, pairs: Vec<EigenPair>) -> Result<Pair> {
    let longer = Expansion::to(problem, pairs, 4)?.last_coefficients();
    let (system, next) = (longer.part(1..=3), longer.part(4..=5));
    let states = equilibria(&system).into_iter().map(|state| {
        let share = next_order(&system, &next, &state.z);
        (state, share)
    });
    Ok(Pair {
        states: states.collect(),
        system,
    })
}

/// A mode at k with the one at 2k, through their resonance: the single mode's c2 beside the pair's coefficients, and
/// the pair's equilibria.
pub(super) fn second_harmonic(shop: &Workshop, cases: &[Case], over: &Axis) -> Result<Outcome> {
    let mut outcome = Outcome::default();
    let places = over.values();
    let found = each(cases, &mut outcome.failures, |case| {
        let setup = shop.setup(case)?;
        let problem = setup.problem(&setup.base(None)?)?;
        let value = |own| pair(&problem, own);
        Ok(along(&problem, &places, value, &[1.0, 2.0]))
    })?;
    let [own, other, up, down] = [
        ([2, 0], [1, 0]),
        ([1, 1], [0, 1]),
        ([0, 1], [1, 0]),
        ([2, 0], [0, 0]),
    ]
    .map(|(z, conj)| Monomial {
        z: z.to_vec(),
        conj: conj.to_vec(),
    });
    let mut coefficients = Panel::new("coefficients of z1'", "k", "g");
    let mut sizes = [
        Panel::new("the mode at k", "k", "|z1|"),
        Panel::new("the mode at 2k", "k", "|z2|"),
    ];
    let mut table = Table::new(&[
        "case",
        "k",
        "z1² z̄1",
        "z1 z2 z̄2",
        "(z2 z̄1)(z1²)",
        "c2 of the single mode",
    ]);
    let mut states = Table::new(&["case", "k", "|z1|", "|z2|", "stable", "next order"]);
    for (index, rows) in &found {
        let number = (*index + 1) as f64;
        outcome
            .failures
            .extend(nothing_in(&cases[*index].label, rows));
        for (k, found) in places.iter().zip(rows) {
            let Ok(Pair {
                system,
                states: own_states,
            }) = found
            else {
                table
                    .rows
                    .push(vec![number, *k, f64::NAN, f64::NAN, f64::NAN, f64::NAN]);
                continue;
            };
            let g = |j: usize, m: &Monomial| system.coefficient(j, m).unwrap_or_default();
            let linear = |j: usize| g(j, &Monomial::amplitude(2, j));
            // c2 = g(z1² z̄1) + g(z2 z̄1) g(z1²)/(2 c1 − c2)
            let product = g(0, &up) * g(1, &down);
            let single = g(0, &own) + product / (2.0 * linear(0) - linear(1));
            let line = [g(0, &own), g(0, &other), product, single].map(|g| g.re);
            table
                .rows
                .push([number, *k].into_iter().chain(line).collect());
            for (state, share) in own_states {
                let [a, b] = [0, 1].map(|j| state.z[j].norm());
                let stable = state.stable().map_or(f64::NAN, |s| f64::from(u8::from(s)));
                states.rows.push(vec![number, *k, a, b, stable, *share]);
            }
        }
        let own_rows = || table.rows.iter().filter(|row| row[0] == number);
        let curve = |column: usize| own_rows().map(|row| (row[1], row[column])).collect();
        let case = &cases[*index];
        coefficients.curve_with_poles(
            &named(case, "c2 of the single mode"),
            Style::Dashed,
            curve(5),
        );
        coefficients.curve(&named(case, "z1² z̄1 of the pair"), Style::Line, curve(2));
        coefficients.curve(&named(case, "z1 z2 z̄2 of the pair"), Style::Line, curve(3));
        for (position, panel) in sizes.iter_mut().enumerate() {
            let chosen = |wanted: &dyn Fn(&Vec<f64>) -> bool| -> Vec<(f64, f64)> {
                let own = states
                    .rows
                    .iter()
                    .filter(|row| row[0] == number && wanted(row));
                own.map(|row| (row[1], row[2 + position])).collect()
            };
            let trusted = |row: &Vec<f64>| row[5] <= TRUSTED;
            let stable = chosen(&|row| trusted(row) && row[4] == 1.0);
            let unstable = chosen(&|row| trusted(row) && row[4] != 1.0);
            let beyond = chosen(&|row| !trusted(row));
            panel.curve(&named(case, "stable"), Style::Dots, stable);
            panel.curve(&named(case, "unstable"), Style::Dots, unstable);
            panel.curve(&named(case, "next order above 0.3"), Style::Dots, beyond);
        }
    }
    picture(
        shop,
        &mut outcome,
        "coefficients through the resonance",
        &[coefficients],
        table,
    );
    picture(shop, &mut outcome, "equilibria of the pair", &sizes, states);
    Ok(outcome)
}
