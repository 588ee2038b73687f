//! What closes the problem at k = 0: conserved integrals, gauges, unknown numbers.
//!
//! An integral is conserved if some ℓ(y) with M0†ℓ = (its density) obeys L†ℓ = 0 at k = 0 and makes
//! the boundary form vanish: then d/dt ∫ density = 0. The tool finds ℓ, it does not believe. Balances without
//! mass (continuity) leave components of ℓ open; where zero does not do for them, the claim is handed on, and
//! the collocated problem decides.

use super::boundary::{Simplifier, at_zero_wavenumber, demands};
use super::linear::DirectTerm;
use super::wall::{BaseRules, CaseProblem, Walls, at_end};
use super::{Case, Deriver};
use crate::diagnostic::Diagnostic;
use crate::form::Form;
use crate::graph::{
    BalanceId, FieldId, Graph, Id, Jet, LinearSystem, Node, Rational, Table, Variable,
};
use crate::model::{Balance, Closure};
use landau_contract::Id as _;
use num_traits::One;

/// A bordering of the problem at k = 0. Densities are Σ weight(y) · jets.
#[derive(Clone, Debug)]
pub enum CaseClosure {
    /// ∫ density = 0; the multiplier enters the balances with the weights of `column`.
    Conserved {
        /// Jets and weights of the integral.
        density: Vec<(Jet, Id)>,
        /// Balances that the multiplier enters, with weights.
        column: Vec<(BalanceId, Id)>,
    },
    /// The same, claimed by the spec: to be recognised in the collocated problem, or dropped.
    Claimed {
        /// Jets and weights of the integral.
        density: Vec<(Jet, Id)>,
        /// Balances that the multiplier enters, with weights.
        column: Vec<(BalanceId, Id)>,
    },
    /// The constant of a field is arbitrary: ∫ field = 0.
    Gauge {
        /// Which field.
        field: FieldId,
        /// Balances that the multiplier enters, with weights.
        column: Vec<(BalanceId, Id)>,
    },
    /// The constant of a field with a time derivative is arbitrary, and may drift: ∫ field = 0, and the
    /// multiplier, which enters where the time derivative does, is the rate of the drift.
    Drift {
        /// Which field.
        field: FieldId,
        /// Balances that the multiplier enters, with weights.
        column: Vec<(BalanceId, Id)>,
    },
    /// The number `field` is unknown: ∫ density = 0.
    Unknown {
        /// Which field.
        field: FieldId,
        /// Jets and weights of the integral.
        density: Vec<(Jet, Id)>,
    },
}

impl CaseClosure {
    fn is_about(&self, other: &[(Jet, Id)]) -> bool {
        match self {
            CaseClosure::Conserved { density, .. } | CaseClosure::Claimed { density, .. } => {
                density == other
            }
            _ => false,
        }
    }
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
    let mut closures: Vec<CaseClosure> = Vec::new();
    // An integral that fixes the base is a candidate for a conserved one.
    let candidates = model
        .base
        .integrals
        .iter()
        .map(|i| (i.integrand, &i.location, false));
    let declared = model.mean.iter().filter_map(|closure| match closure {
        Closure::Conserved {
            integrand,
            location,
        } => Some((*integrand, location, true)),
        _ => None,
    });
    for (integrand, location, declared) in candidates.chain(declared) {
        let Some(form) = deriver.expand(integrand, location, mistakes) else {
            continue;
        };
        let density = density(&form);
        let column = multiplier(deriver, problem.linear, &density);
        // An integral of the base that is declared as conserved too is one closure.
        if closures.iter().any(|c| c.is_about(&density)) {
            continue;
        }
        let proved = column.filter(|c| conserved(deriver, problem, walls, rules, c, &closures));
        if let Some(column) = proved {
            closures.push(CaseClosure::Conserved { density, column });
        } else if declared && has_massless(problem.linear, &model.balances) {
            let column = carried(deriver, problem.linear, &density);
            closures.push(CaseClosure::Claimed { density, column });
        }
    }
    for closure in &model.mean {
        match closure {
            Closure::Conserved { .. } => {}
            Closure::Gauge { field, location } => {
                match gauge(deriver, problem, walls, rules, *field) {
                    Ok(closure) => closures.push(closure),
                    Err((message, expected)) => {
                        mistakes.push(Diagnostic::new(location.clone(), message, expected));
                    }
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

/// A claim that is proved for other choices of the switches does not hold where it is not.
pub(super) fn drop_refuted(cases: &mut [Case]) {
    let proved: Vec<CaseClosure> = cases
        .iter()
        .flat_map(|case| &case.closures)
        .filter(|closure| matches!(closure, CaseClosure::Conserved { .. }))
        .cloned()
        .collect();
    for case in cases {
        case.closures.retain(|closure| match closure {
            CaseClosure::Claimed { density, .. } => !proved.iter().any(|c| c.is_about(density)),
            _ => true,
        });
    }
}

/// Whether some balance holds no time derivative.
pub(super) fn has_massless(linear: &[DirectTerm], balances: &Table<BalanceId, Balance>) -> bool {
    balances
        .ids()
        .any(|row| !linear.iter().any(|t| t.row == row && t.jet.t > 0))
}

/// The density as the mass matrix carries it into the balances.
fn carried(
    deriver: &mut Deriver,
    linear: &[DirectTerm],
    density: &[(Jet, Id)],
) -> Vec<(BalanceId, Id)> {
    let mut column = Vec::new();
    for (jet, weight) in density {
        let time = Jet { t: 1, ..*jet };
        for term in linear.iter().filter(|t| t.jet == time) {
            column.push((term.row, deriver.graph.mul(term.coefficient, *weight)));
        }
    }
    column
}

/// The closure of a field of which only derivatives matter, or why it is none: message and expectation.
fn gauge(
    deriver: &mut Deriver,
    problem: &CaseProblem,
    walls: &Walls,
    rules: &BaseRules,
    field: FieldId,
) -> Result<CaseClosure, (String, &'static str)> {
    let model = deriver.model;
    let name = &model.fields[field].name;
    let valued = |form: &Form| {
        form.terms
            .keys()
            .flatten()
            .any(|jet| *jet == Jet::value(field))
    };
    let balances = problem.balances.iter().zip(&model.balances);
    let holder = balances
        .filter(|(form, _)| valued(form))
        .map(|(_, balance)| format!("`{}`", balance.name))
        .next();
    let wall = || problem.walls.iter().any(|w| valued(&w.form));
    let holder = holder.or_else(|| wall().then(|| "a boundary condition".to_owned()));
    if let Some(holder) = holder {
        return Err((
            format!("`{name}` is no gauge: its value enters {holder}"),
            "a field of which only derivatives enter the balances",
        ));
    }
    let mass: Vec<(BalanceId, Id)> = problem
        .linear
        .iter()
        .filter(|t| {
            t.jet
                == Jet {
                    t: 1,
                    ..Jet::value(field)
                }
        })
        .map(|t| (t.row, t.coefficient))
        .collect();
    if !mass.is_empty() {
        return Ok(CaseClosure::Drift {
            field,
            column: mass,
        });
    }
    let paired = problem.pairing.position(|f| *f == field);
    let others = model.balances.ids().filter(|row| Some(*row) != paired);
    for row in paired.into_iter().chain(others) {
        for weight in null_candidates(deriver, problem, row) {
            let column = vec![(row, weight)];
            if conserved(deriver, problem, walls, rules, &column, &[]) {
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

/// Weights under which a balance may be a divergence: its divisor times powers of what its coefficients are
/// divided by, such as r for ∂r u + u/r.
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
    linear: &[DirectTerm],
    density: &[(Jet, Id)],
) -> Option<Vec<(BalanceId, Id)>> {
    let graph = &mut *deriver.graph;
    if density.is_empty() || density.iter().any(|(j, _)| j.y > 0) {
        return None;
    }
    let mut fields: Vec<FieldId> = linear
        .iter()
        .filter(|t| t.jet.t == 1)
        .map(|t| t.jet.of)
        .chain(density.iter().map(|(jet, _)| jet.of))
        .collect();
    fields.sort_unstable();
    fields.dedup();
    // One equation for each field: Σ_i m_ij ℓ_i = w_j.
    let mut system = LinearSystem::new(graph, deriver.model.balances.len());
    for field in fields {
        let mass = linear.iter().filter(|t| t.jet.of == field && t.jet.t == 1);
        let plain = mass.filter(|t| t.jet.x == 0 && t.jet.absx == 0 && t.jet.y == 0);
        let coefficients = plain.map(|t| (t.row.index(), t.coefficient)).collect();
        let weight = density.iter().find(|(jet, _)| jet.of == field);
        system.equation(graph, coefficients, weight.map(|(_, weight)| *weight));
    }
    let solution = system.solve(graph)?.into_iter();
    Some(
        solution
            .filter(|(_, weight)| !graph.vanishes(*weight))
            .map(|(row, weight)| (BalanceId::at(row), weight))
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
    column: &[(BalanceId, Id)],
    known: &[CaseClosure],
) -> bool {
    let mut image: Table<FieldId, Id> = Table::default();
    for field in deriver.model.profiles() {
        let mut total = deriver.graph.zero();
        for term in problem
            .adjoint
            .iter()
            .filter(|t| t.row == field && t.jet.is_base())
        {
            let Some((_, weight)) = column.iter().find(|(row, _)| *row == term.jet.of) else {
                continue;
            };
            let derivative = along_base(deriver.graph, *weight, term.jet.y);
            let product = deriver.graph.mul(term.coefficient, derivative);
            total = deriver.graph.add(total, product);
        }
        image.push(total);
    }
    let null = image.iter().all(|&id| deriver.vanishes_opened(id));
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
                let Some((_, weight)) = column.iter().find(|(row, _)| *row == jet.of) else {
                    continue;
                };
                let derivative = along_base(deriver.graph, *weight, jet.y);
                parts.push((deriver.graph.mul(id, derivative), Rational::one()));
            }
            let total = deriver.graph.sum(parts);
            let total = at_end(deriver.graph, place, *end, rules, total);
            if !deriver.vanishes_opened(total) {
                return false;
            }
        }
    }
    true
}

/// Whether Σ image_f q_f is a constant times the density of a conserved integral.
fn is_multiple(graph: &mut Graph, image: &Table<FieldId, Id>, closure: &CaseClosure) -> bool {
    let CaseClosure::Conserved { density, .. } = closure else {
        return false;
    };
    let Some((first, weight)) = density.first() else {
        return false;
    };
    let factor = graph.divide_terms(image[first.of], *weight);
    let slope = graph.differentiate(factor, Variable::AlongBase);
    if !graph.vanishes(slope) {
        return false;
    }
    image.ids().all(|field| {
        let own = density.iter().find(|(jet, _)| jet.of == field);
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
