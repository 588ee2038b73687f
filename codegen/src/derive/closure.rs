//! What closes the problem at k = 0: conserved integrals, gauges, unknown numbers.
//!
//! An integral is conserved if some ℓ(y) with M0†ℓ = (its density) obeys L†ℓ = 0 at k = 0 and makes
//! the boundary form vanish: then d/dt ∫ density = 0. The tool finds ℓ, it does not believe. Balances without
//! mass (continuity) leave components of ℓ open; where zero does not do for them, the claim is handed on, and
//! the collocated problem decides.

use super::boundary::{Simplifier, at_zero_wavenumber, demands};
use super::form::Form;
use super::linear::Term;
use super::wall::{BaseRules, CaseProblem, Walls, at_end};
use super::{Case, Deriver};
use crate::diagnostic::Diagnostic;
use crate::graph::{Graph, Id, Jet, Node, Rational, Variable};
use crate::model::Closure;
use num_traits::One;

/// A bordering of the problem at k = 0. Densities are Σ weight(y) · jets.
#[derive(Clone, Debug)]
pub enum CaseClosure {
    /// ∫ density = 0; the multiplier enters the balances with the weights of `column`.
    Conserved {
        /// Jets and weights of the integral.
        density: Vec<(Jet, Id)>,
        /// Balances that the multiplier enters, with weights.
        column: Vec<(usize, Id)>,
    },
    /// The same, claimed by the spec: to be recognised in the collocated problem, or dropped.
    Claimed {
        /// Jets and weights of the integral.
        density: Vec<(Jet, Id)>,
        /// Balances that the multiplier enters, with weights.
        column: Vec<(usize, Id)>,
    },
    /// The constant of a field is arbitrary: ∫ field = 0.
    Gauge {
        /// Which field, by position.
        field: usize,
        /// Balances that the multiplier enters, with weights.
        column: Vec<(usize, Id)>,
    },
    /// The constant of a field with a time derivative is arbitrary, and may drift: ∫ field = 0, and the
    /// multiplier, which enters where the time derivative does, is the rate of the drift.
    Drift {
        /// Which field, by position.
        field: usize,
        /// Balances that the multiplier enters, with weights.
        column: Vec<(usize, Id)>,
    },
    /// The number `field` is unknown: ∫ density = 0.
    Unknown {
        /// Which field, by position.
        field: usize,
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
        } else if declared && has_massless(problem.linear, model.balances.len()) {
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
pub(super) fn has_massless(linear: &[Term], balances: usize) -> bool {
    (0..balances).any(|row| !linear.iter().any(|t| t.row == row && t.jet.t > 0))
}

/// The density as the mass matrix carries it into the balances.
fn carried(deriver: &mut Deriver, linear: &[Term], density: &[(Jet, Id)]) -> Vec<(usize, Id)> {
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
    field: usize,
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
    let mass: Vec<(usize, Id)> = problem
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
    let paired = problem
        .pairing
        .iter()
        .position(|f| *f == field)
        .unwrap_or(0);
    let others = (0..model.balances.len()).filter(|&row| row != paired);
    for row in std::iter::once(paired).chain(others) {
        for weight in null_candidates(deriver, problem, row) {
            let column = vec![(row, weight)];
            if conserved(deriver, problem, walls, rules, &column, &[]) {
                return Ok(CaseClosure::Gauge { field, column });
            }
        }
    }
    Err((
        format!(
            "the constant of `{name}` is not free: `{}` does not integrate to zero",
            model.balances[paired].name
        ),
        "a gauge whose balance is a divergence, without flux through the ends",
    ))
}

/// Weights under which a balance may be a divergence: its divisor times powers of what its coefficients are
/// divided by, such as r for ∂r u + u/r.
fn null_candidates(deriver: &mut Deriver, problem: &CaseProblem, row: usize) -> Vec<Id> {
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
            if !deriver.vanishes_opened(total) {
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
