//! Fields that are determined up to a constant, such as a pressure.

use super::closure::CaseClosure;
use super::deriver::Deriver;
use super::mean::{MeanWalls, conserved};
use super::wall::CaseProblem;
use crate::diagnostic::Diagnostic;
use crate::form::Form;
use crate::graph::{BalanceId, FieldId, Graph, Id, Jet, Node, Rational};
use crate::model::Closure;
use num_traits::One;

/// Whether a form holds the field itself, not only its derivatives.
fn holds_value(form: &Form, field: FieldId) -> bool {
    let mut jets = form.terms.keys().flatten();
    jets.any(|jet| *jet == Jet::value(field))
}

/// The closure of a field of which only derivatives enter the balances. `Err` says why the field is no gauge: the message
/// of a diagnostic, and what it expects.
pub(super) fn gauge(
    deriver: &mut Deriver,
    problem: &CaseProblem,
    walls: &MeanWalls,
    field: FieldId,
) -> Result<CaseClosure, (String, &'static str)> {
    let model = deriver.model;
    let name = &model.fields[field].name;
    let balances = problem.balances.iter().zip(&model.balances);
    let holder = balances
        .filter(|(form, _)| holds_value(form, field))
        .map(|(_, balance)| format!("`{}`", balance.name))
        .next();
    let wall = || problem.walls.iter().any(|w| holds_value(&w.form, field));
    let holder = holder.or_else(|| wall().then(|| "a boundary condition".to_owned()));
    if let Some(holder) = holder {
        return Err((
            format!("`{name}` is no gauge: its value enters {holder}"),
            "a field of which only derivatives enter the balances",
        ));
    }
    // ∂t field enters with the mass m_i: the multiplier μ in m_i (∂t field + μ) is the rate of a drift.
    let rate = Jet {
        t: 1,
        ..Jet::value(field)
    };
    let rates = problem.linear.iter().filter(|term| term.jet == rate);
    let mass: Vec<(BalanceId, Id)> = rates.map(|term| (term.row, term.coefficient)).collect();
    if !mass.is_empty() {
        return Ok(CaseClosure::Drift {
            field,
            column: mass,
        });
    }
    // Without mass, some balance times a weight ℓ is a divergence: L†ℓ = 0, M0†ℓ = 0, and no flux at the ends.
    let paired = problem.pairing.position(|f| *f == field);
    let unpaired = model.balances.ids().filter(|row| Some(*row) != paired);
    for row in paired.into_iter().chain(unpaired) {
        for weight in null_candidates(deriver, problem, row) {
            let column = vec![(row, weight)];
            let is_null = deriver.aside(|deriver| walls.carries(deriver, problem, &column, &[]));
            if is_null && conserved(deriver, problem, walls, &column, &[]) {
                return Ok(CaseClosure::Gauge { field, column });
            }
        }
    }
    let balance = paired.map_or("no balance", |row| model.balances[row].name.as_str());
    Err((
        format!("the constant of `{name}` is not free: `{balance}` does not integrate to zero"),
        "a gauge whose balance is a divergence, without flux through the ends",
    ))
}

/// Refuses a field that needs a gauge and has none: a constant added to it changes no balance, no condition and no
/// integral, so the problem at k = 0 has no unique solution.
pub(super) fn check_declared(
    deriver: &mut Deriver,
    problem: &CaseProblem,
    walls: &MeanWalls,
    closures: &[CaseClosure],
    mistakes: &mut Vec<Diagnostic>,
) {
    let model = deriver.model;
    for field in model.profiles() {
        let is_declared = model.mean.iter().any(
            |closure| matches!(closure, Closure::Gauge { field: gauge, .. } if *gauge == field),
        );
        let densities = closures.iter().filter_map(CaseClosure::density);
        let is_integrated = densities
            .flat_map(|density| &density.linear)
            .any(|(jet, _)| jet.of == field);
        if is_declared || is_integrated {
            continue;
        }
        let closure = deriver.aside(|deriver| gauge(deriver, problem, walls, field));
        if matches!(closure, Ok(CaseClosure::Gauge { .. })) {
            let declaration = &model.fields[field];
            let name = &declaration.name;
            let message = format!(
                "the constant of `{name}` is not determined: only derivatives of `{name}` enter the balances and the conditions"
            );
            let expected = "a field whose value enters, or one that `mean` names as a gauge";
            mistakes.push(
                Diagnostic::new(declaration.location.clone(), message, expected)
                    .hint(format!("add `mean {{ gauge {name}; }}`")),
            );
        }
    }
}

/// Weights under which a balance may be a divergence: its divisor times powers of the factors of its coefficients that
/// vary with y, such as r for ∂r u + u/r.
fn null_candidates(deriver: &mut Deriver, problem: &CaseProblem, row: BalanceId) -> Vec<Id> {
    let graph = &mut *deriver.graph;
    let mut bases: Vec<Id> = Vec::new();
    let coefficients = problem
        .linear
        .iter()
        .filter(|t| t.row == row && t.jet.t == 0);
    for term in coefficients {
        for node in graph.topological(&[term.coefficient]) {
            match graph.node(node) {
                Node::Product(factors) => bases.extend(factors.iter().map(|(base, _)| *base)),
                Node::Base(..) | Node::BaseLaw(_) | Node::Coordinate => bases.push(node),
                _ => {}
            }
        }
    }
    let varies = |graph: &Graph, id| {
        graph.any(id, |n| {
            matches!(n, Node::Base(..) | Node::BaseLaw(_) | Node::Coordinate)
        })
    };
    bases.sort_unstable();
    bases.dedup();
    bases.retain(|&base| varies(graph, base));
    let divisor = problem.divisors[row];
    let mut candidates = vec![divisor];
    for base in bases {
        for exponent in [1, -1, 2, -2, 3, -3] {
            let exponent = Rational::from_integer(exponent.into());
            let parts = [(divisor, Rational::one()), (base, exponent)];
            candidates.push(graph.product(parts));
        }
    }
    candidates
}
