//! What closes the problem at k = 0: conserved integrals, gauges, unknown numbers.
//!
//! An integral is conserved if some ℓ(y) with M0†ℓ = (its density) obeys L†ℓ = 0 at k = 0 and makes
//! the boundary form vanish: then d/dt ∫ density = 0. The tool finds ℓ, it does not believe.

use super::Deriver;
use super::boundary::{Simplifier, at_zero_wavenumber, demands};
use super::form::Form;
use super::linear::Term;
use super::wall::{BaseRules, CaseProblem, Walls, at_end};
use crate::diagnostic::Diagnostic;
use crate::graph::{Graph, Id, Jet, Rational, Variable};
use crate::model::Closure;
use num_traits::One;

/// A bordering of the problem at k = 0. Densities are Σ weight(y) · jets.
#[derive(Clone, Debug)]
pub enum CaseClosure {
    /// ∫ density = 0; the multiplier enters the balances with the weights of `column`.
    Conserved {
        density: Vec<(Jet, Id)>,
        column: Vec<(usize, Id)>,
    },
    /// The constant of a field is arbitrary: ∫ field = 0.
    Gauge {
        field: usize,
        column: Vec<(usize, Id)>,
    },
    /// The number `field` is unknown: ∫ density = 0.
    Unknown {
        field: usize,
        density: Vec<(Jet, Id)>,
    },
}

/// The closures of one case.
pub(super) fn derive(
    deriver: &mut Deriver,
    problem: &CaseProblem,
    walls: &Walls,
    rules: &BaseRules,
    mistakes: &mut Vec<Diagnostic>,
) -> Vec<CaseClosure> {
    let model = deriver.model;
    let mut closures = Vec::new();
    // An integral that fixes the base is a candidate for a conserved one.
    let candidates = model
        .base
        .integrals
        .iter()
        .map(|i| (i.integrand, &i.location));
    let declared = model.mean.iter().filter_map(|closure| match closure {
        Closure::Conserved {
            integrand,
            location,
        } => Some((*integrand, location)),
        _ => None,
    });
    for (integrand, location) in candidates.chain(declared) {
        let Some(form) = deriver.expand(integrand, location, mistakes) else {
            continue;
        };
        let density = density(&form);
        let Some(column) = multiplier(deriver, problem.linear, &density) else {
            continue;
        };
        if conserved(deriver, problem, walls, rules, &column, &closures) {
            closures.push(CaseClosure::Conserved { density, column });
        }
    }
    for closure in &model.mean {
        match closure {
            Closure::Conserved { .. } => {}
            Closure::Gauge { field, location } => {
                let fixed = problem.linear.iter().find(|t| {
                    usize::from(t.jet.field) == *field
                        && t.jet.x == 0
                        && t.jet.absx == 0
                        && t.jet.y == 0
                });
                if let Some(term) = fixed {
                    let name = &model.fields[*field].name;
                    let message = format!(
                        "`{name}` is no gauge: its value enters `{}`",
                        model.balances[term.row].name
                    );
                    let expected = "a field of which only derivatives enter the balances";
                    mistakes.push(Diagnostic::new(location.clone(), message, expected));
                    continue;
                }
                let row = problem.pairing.iter().position(|f| f == field).unwrap_or(0);
                let column = vec![(row, problem.divisors[row])];
                if conserved(deriver, problem, walls, rules, &column, &[]) {
                    closures.push(CaseClosure::Gauge {
                        field: *field,
                        column,
                    });
                } else {
                    let name = &model.fields[*field].name;
                    let message = format!(
                        "the constant of `{name}` is not free: `{}` does not integrate to zero",
                        model.balances[row].name
                    );
                    let expected =
                        "a gauge whose balance is a divergence, without flux through the ends";
                    mistakes.push(Diagnostic::new(location.clone(), message, expected));
                }
            }
            Closure::Unknown { field, integral } => {
                let expanded = deriver.expand(integral.integrand, &integral.location, mistakes);
                if let Some(form) = expanded {
                    closures.push(CaseClosure::Unknown {
                        field: *field,
                        density: density(&form),
                    });
                }
            }
        }
    }
    closures
}

/// The linear part at k = 0.
fn density(form: &Form) -> Vec<(Jet, Id)> {
    let linear = form.degree(1);
    linear
        .terms
        .iter()
        .map(|(m, &c)| (m[0], c))
        .filter(|(j, _)| j.is_base())
        .collect()
}

/// ℓ with M0†ℓ = density, by Gaussian elimination on the mass matrix.
fn multiplier(
    deriver: &mut Deriver,
    linear: &[Term],
    density: &[(Jet, Id)],
) -> Option<Vec<(usize, Id)>> {
    let graph = &mut *deriver.graph;
    if density.is_empty() || density.iter().any(|(j, _)| j.y > 0) {
        return None;
    }
    let rows = linear.iter().map(|t| t.row + 1).max().unwrap_or(0);
    let zero = graph.zero();
    let fields: Vec<usize> = {
        let mut fields: Vec<usize> = linear
            .iter()
            .filter(|t| t.jet.t == 1)
            .map(|t| usize::from(t.jet.field))
            .collect();
        fields.extend(density.iter().map(|(j, _)| usize::from(j.field)));
        fields.sort_unstable();
        fields.dedup();
        fields
    };
    // One equation for each field: Σ_i m_ij ℓ_i = w_j.
    let mut system: Vec<Vec<Id>> = Vec::new();
    for &field in &fields {
        let mut equation = vec![zero; rows + 1];
        for term in linear
            .iter()
            .filter(|t| usize::from(t.jet.field) == field && t.jet.t == 1)
        {
            if term.jet.x == 0 && term.jet.absx == 0 && term.jet.y == 0 {
                equation[term.row] = term.coefficient;
            }
        }
        for (jet, weight) in density
            .iter()
            .filter(|(j, _)| usize::from(j.field) == field)
        {
            debug_assert!(jet.y == 0);
            equation[rows] = *weight;
        }
        system.push(equation);
    }
    let mut pivots = Vec::new();
    let mut rank = 0;
    for column in 0..rows {
        let Some(found) = (rank..system.len()).find(|&r| !graph.vanishes(system[r][column])) else {
            continue;
        };
        system.swap(rank, found);
        let pivot = system[rank][column];
        for entry in &mut system[rank] {
            *entry = graph.divide_terms(*entry, pivot);
        }
        let row = system[rank].clone();
        for (r, other) in system.iter_mut().enumerate() {
            let factor = other[column];
            if r == rank || graph.vanishes(factor) {
                continue;
            }
            for (entry, &by) in other.iter_mut().zip(&row) {
                let product = graph.mul(factor, by);
                *entry = graph.sub(*entry, product);
            }
        }
        pivots.push((rank, column));
        rank += 1;
    }
    if system[rank..]
        .iter()
        .any(|equation| !graph.vanishes(equation[rows]))
    {
        return None;
    }
    let solution = pivots
        .into_iter()
        .map(|(r, column)| (column, system[r][rows]));
    Some(
        solution
            .filter(|(_, weight)| !graph.vanishes(*weight))
            .collect(),
    )
}

/// Whether L†ℓ = 0 and the boundary form vanishes, at k = 0; or L†ℓ is a multiple of the density of
/// an integral already known to be conserved (a Jordan block: ∫u changes by ∫v, which stays zero).
fn conserved(
    deriver: &mut Deriver,
    problem: &CaseProblem,
    walls: &Walls,
    rules: &BaseRules,
    column: &[(usize, Id)],
    known: &[CaseClosure],
) -> bool {
    let profiles = deriver.uniform.iter().filter(|u| !**u).count();
    let mut image = Vec::with_capacity(profiles);
    for field in 0..profiles {
        let mut total = deriver.graph.zero();
        for term in problem
            .adjoint
            .iter()
            .filter(|t| t.row == field && t.jet.is_base())
        {
            let Some((_, weight)) = column
                .iter()
                .find(|(row, _)| *row == usize::from(term.jet.field))
            else {
                continue;
            };
            let derivative = along_base(deriver.graph, *weight, term.jet.y);
            let product = deriver.graph.mul(term.coefficient, derivative);
            total = deriver.graph.add(total, product);
        }
        image.push(total);
    }
    let null = image.iter().all(|&id| deriver.graph.vanishes(id));
    if !null
        && !known
            .iter()
            .any(|closure| is_multiple(deriver.graph, &image, closure))
    {
        return false;
    }
    for (end, direct) in &walls.reduced {
        let place = deriver.place(*end);
        let mut simplify = |graph: &mut Graph, id| at_end(graph, place, *end, rules, id);
        let demanded = demands(
            deriver.graph,
            &walls.form,
            direct,
            &mut Simplifier {
                at_end: &mut simplify,
            },
        );
        for combination in demanded.values() {
            let mut parts = Vec::new();
            for (jet, id) in at_zero_wavenumber(combination) {
                let Some((_, weight)) = column
                    .iter()
                    .find(|(row, _)| *row == usize::from(jet.field))
                else {
                    continue;
                };
                let derivative = along_base(deriver.graph, *weight, jet.y);
                parts.push((deriver.graph.mul(id, derivative), Rational::one()));
            }
            let total = deriver.graph.sum(parts);
            let total = at_end(deriver.graph, place, *end, rules, total);
            if !deriver.graph.vanishes(total) {
                return false;
            }
        }
    }
    true
}

/// Whether Σ image_f q_f is a constant times the density of a conserved integral.
fn is_multiple(graph: &mut Graph, image: &[Id], closure: &CaseClosure) -> bool {
    let CaseClosure::Conserved { density, .. } = closure else {
        return false;
    };
    let Some((first, weight)) = density.first() else {
        return false;
    };
    let factor = graph.divide_terms(image[usize::from(first.field)], *weight);
    let slope = graph.differentiate(factor, Variable::AlongBase);
    if !graph.vanishes(slope) {
        return false;
    }
    (0..image.len()).all(|field| {
        let own = density
            .iter()
            .find(|(jet, _)| usize::from(jet.field) == field);
        let expected = match own {
            Some((_, weight)) => graph.mul(factor, *weight),
            None => graph.zero(),
        };
        let rest = graph.sub(image[field], expected);
        graph.vanishes(rest)
    })
}

fn along_base(graph: &mut Graph, mut id: Id, order: u8) -> Id {
    for _ in 0..order {
        id = graph.differentiate(id, Variable::AlongBase);
    }
    id
}
