//! Conditions at the two ends: those of the base state as rules for its atoms, those of the perturbation reduced.

use super::boundary::{
    BoundaryForm, Combination, Reduced, Simplifier, boundary_form, reduce, split,
};
use super::deriver::Deriver;
use super::linear::{AdjointTerm, DirectTerm};
use crate::form::Form;
use crate::graph::{BalanceId, FieldId, Graph, Id, Node, ParameterId, Rational, Table, Variable};
use crate::model::End;
use num_traits::One;

/// A condition on the perturbation: B(X⁰ + X') − B(X⁰) = 0.
#[derive(Clone, Debug)]
pub struct WallCondition {
    /// The end of the interval at which it holds.
    pub end: End,
    /// Terms of degree 1 and higher.
    pub form: Form,
    /// The condition in the full state, unexpanded.
    pub residual: Id,
}

impl WallCondition {
    /// The field of the highest y-derivative in the linear part.
    pub fn about(&self) -> Option<FieldId> {
        let linear = self.form.degree(1);
        let jets = linear.terms.keys().map(|m| m[0]);
        jets.max_by_key(|j| (j.y, std::cmp::Reverse((j.absx, j.x, j.of))))
            .map(|j| j.of)
    }
}

/// A condition on the base state.
#[derive(Clone, Debug)]
pub struct BaseCondition {
    /// The end of the interval at which it holds.
    pub end: End,
    /// Vanishes at that end; laws opaque.
    pub residual: Id,
}

/// The operators and tables that the derivation of a case reads.
#[derive(Clone, Copy)]
pub(super) struct CaseProblem<'a> {
    /// The balances expanded, not divided.
    pub balances: &'a Table<BalanceId, Form>,
    /// The conditions of this case.
    pub walls: &'a [WallCondition],
    pub linear: &'a [DirectTerm],
    pub adjoint: &'a [AdjointTerm],
    pub divisors: &'a Table<BalanceId, Id>,
    /// Number of boundary conditions that the balances need.
    pub needed: usize,
    pub pairing: &'a Table<BalanceId, FieldId>,
    pub solved: &'a [FieldId],
    pub switches: &'a [ParameterId],
    /// Number of conditions that the base state needs.
    pub base_conditions: usize,
}

/// The boundary form, and the reduced conditions of each end.
pub(super) struct Walls {
    pub form: BoundaryForm,
    pub reduced: Vec<(End, Reduced<FieldId>)>,
}

/// The values that boundary conditions of the base state give its atoms at each end: (end, atom, expression).
pub(super) type BaseRules = Vec<(End, (FieldId, u8), Id)>;

/// Solves each base condition that is linear in its highest base derivative for it.
pub(super) fn base_rules(graph: &mut Graph, conditions: &[BaseCondition]) -> BaseRules {
    let mut rules = BaseRules::new();
    for condition in conditions {
        let mut atoms: Vec<(u8, FieldId)> = Vec::new();
        for node in graph.topological(&[condition.residual]) {
            if let Node::Base(field, order) = graph.node(node) {
                atoms.push((*order, *field));
            }
        }
        atoms.sort_unstable();
        let Some(&(order, field)) = atoms.last() else {
            continue;
        };
        // A law depends on the values of fields, so that beside a derivative it is a coefficient. A law that may hide
        // the atom itself leaves the condition unsolved.
        let hides = |n: &Node| matches!(n, Node::BaseLaw(atom) if order == 0 || atom.y > 0);
        if graph.any(condition.residual, hides) {
            continue;
        }
        let slope = graph.differentiate(condition.residual, Variable::Base(field, order));
        let curvature = graph.differentiate(slope, Variable::Base(field, order));
        if !graph.vanishes(curvature) || graph.vanishes(slope) {
            continue;
        }
        // residual = slope · atom + remainder, so that the condition says atom = −remainder/slope
        let atom = graph.base(field, order);
        let product = graph.mul(slope, atom);
        let remainder = graph.sub(condition.residual, product);
        let remainder = if graph.vanishes(remainder) {
            graph.zero()
        } else {
            remainder
        };
        let solution = graph.product([(remainder, Rational::one()), (slope, -Rational::one())]);
        let solution = graph.neg(solution);
        rules.push((condition.end, (field, order), solution));
    }
    rules
}

/// An expression at one end: the coordinate replaced by its value, base atoms by the values that the base conditions
/// give them.
pub(super) fn at_end(graph: &mut Graph, place: Id, end: End, rules: &BaseRules, id: Id) -> Id {
    graph.substitute(id, &mut |_, node| match node {
        Node::Coordinate => Some(place),
        Node::Base(field, order) => rules
            .iter()
            .find(|(e, atom, _)| *e == end && *atom == (*field, *order))
            .map(|(_, _, solution)| *solution),
        _ => None,
    })
}

impl Deriver<'_> {
    /// The coordinate of an end.
    pub(super) fn place(&mut self, end: End) -> Id {
        match (&self.model.interval, end) {
            (Some(interval), End::Lower) => interval.lower,
            (Some(interval), End::Upper) => interval.upper,
            (None, _) => self.graph.zero(),
        }
    }
}

pub(super) fn walls(
    deriver: &mut Deriver,
    problem: &CaseProblem,
    conditions: &[WallCondition],
    rules: &BaseRules,
) -> Result<Walls, String> {
    // The conditions would depend on the eigenvalue.
    let under = |term: &&DirectTerm| term.jet.t > 0 && term.jet.y > 0;
    if let Some(term) = problem.linear.iter().find(under) {
        let balance = &deriver.model.balances[term.row].name;
        return Err(format!(
            "the balance `{balance}` holds a time derivative under a cross-stream derivative: the adjoint boundary conditions would depend on the eigenvalue"
        ));
    }
    let form = boundary_form(deriver.graph, problem.linear);
    let reduced = reduced(deriver, conditions, rules)?;
    Ok(Walls { form, reduced })
}

/// The conditions of each end solved for derivatives without ∂x, or why they cannot be.
pub(super) fn reduced(
    deriver: &mut Deriver,
    conditions: &[WallCondition],
    rules: &BaseRules,
) -> Result<Vec<(End, Reduced<FieldId>)>, String> {
    let mut reduced = Vec::new();
    for end in End::BOTH {
        let rows = conditions.iter().filter(|c| c.end == end).map(linear_row);
        let solved = solved_at(deriver, end, rows.collect(), rules)?;
        reduced.push((end, solved));
    }
    Ok(reduced)
}

/// The linear part of a condition.
pub(super) fn linear_row(condition: &WallCondition) -> Combination<FieldId> {
    let mut row = Combination::new();
    for (monomial, &coefficient) in &condition.form.degree(1).terms {
        let (jet, symbol) = split(monomial[0], coefficient);
        row.entry(jet).or_default().extend(symbol);
    }
    row
}

/// Conditions of one end solved for derivatives without ∂x, or why they cannot be.
pub(super) fn solved_at(
    deriver: &mut Deriver,
    end: End,
    rows: Vec<Combination<FieldId>>,
    rules: &BaseRules,
) -> Result<Reduced<FieldId>, String> {
    let place = deriver.place(end);
    let mut simplify = |graph: &mut Graph, id| at_end(graph, place, end, rules, id);
    let mut simplifier = Simplifier {
        at_end: &mut simplify,
    };
    reduce(deriver.graph, rows, &mut simplifier).map_err(|_| {
        "the boundary conditions cannot be solved for derivatives without x in them".to_owned()
    })
}
