//! The conditions of the base state in one case.

use super::deriver::Deriver;
use super::wall::{BaseCondition, CaseProblem};
use crate::diagnostic::{Diagnostic, Location};
use crate::graph::{FieldId, Graph, Id, Node};
use crate::model::{Closure, Condition, End};
use std::cmp::Reverse;

/// A condition on base fields in closed form: it cannot be imposed, so the solver checks it.
#[derive(Clone, Debug)]
pub struct BaseCheck {
    /// The end of the interval at which it holds.
    pub end: End,
    /// In terms of the full state.
    pub residual: Id,
    /// Place of its text in the spec.
    pub location: Location,
}

/// The solved field that a condition of the base state is about: the one with the highest derivative in it, and of
/// several the first.
fn solved_field(deriver: &Deriver, problem: &CaseProblem, residual: Id) -> Option<FieldId> {
    let mut highest: Option<(u8, Reverse<FieldId>)> = None;
    for node in deriver.graph.topological(&[residual]) {
        let fields: Vec<(u8, FieldId)> = match deriver.graph.node(node) {
            Node::Base(field, order) => vec![(*order, *field)],
            Node::BaseLaw(atom) => {
                let depends = &deriver.dependence[atom.law];
                let fields = depends.ids().filter(|&f| depends[f]);
                fields.map(|field| (atom.y, field)).collect()
            }
            _ => Vec::new(),
        };
        let solved = fields
            .into_iter()
            .filter(|(_, f)| problem.solved.contains(f));
        highest = highest.max(solved.map(|(order, field)| (order, Reverse(field))).max());
    }
    highest.map(|(_, field)| field.0)
}

/// Base conditions: those of the `base` block, and those of `boundary` about fields that the
/// `base` block leaves alone at that end.
pub(super) fn base_conditions(
    deriver: &mut Deriver,
    problem: &CaseProblem,
    written: &[&Condition],
    written_base: &[&Condition],
    mistakes: &mut Vec<Diagnostic>,
) -> Option<Vec<BaseCondition>> {
    let mut conditions: Vec<BaseCondition> = Vec::new();
    let mut replaced: Vec<(End, FieldId)> = Vec::new();
    for condition in written_base {
        let end = condition.end;
        let residual = deriver.base_part(condition.residual, &condition.location, mistakes)?;
        if let Some(field) = solved_field(deriver, problem, residual) {
            replaced.push((end, field));
            conditions.push(BaseCondition { end, residual });
        }
    }
    for condition in written {
        let end = condition.end;
        let residual = deriver.base_part(condition.residual, &condition.location, mistakes)?;
        let field = solved_field(deriver, problem, residual);
        if field.is_some_and(|field| !replaced.contains(&(end, field))) {
            conditions.push(BaseCondition { end, residual });
        }
    }
    let given = conditions.len() + integral_conditions(deriver, problem);
    if given != problem.base_conditions {
        mistakes.push(miscounted(deriver, problem, &conditions, given));
        return None;
    }
    Some(conditions)
}

/// Number of integral conditions of the base state: prescribed ones, and those of its unknown numbers.
fn integral_conditions(deriver: &Deriver, problem: &CaseProblem) -> usize {
    if problem.solved.is_empty() {
        return 0;
    }
    let model = deriver.model;
    let is_solved = |closure: &&Closure| matches!(closure, Closure::Unknown { field, .. } if problem.solved.contains(field));
    model.base.integrals.len() + model.mean.iter().filter(is_solved).count()
}

/// The mistake of too few or too many conditions of the base state.
fn miscounted(
    deriver: &Deriver,
    problem: &CaseProblem,
    conditions: &[BaseCondition],
    given: usize,
) -> Diagnostic {
    let needed = problem.base_conditions;
    let trouble = if given < needed { "few" } else { "many" };
    let message = format!("the base state has too {trouble} conditions: {given}");
    let expected = format!("{needed} conditions, at the ends and on integrals together");
    let bound: Vec<FieldId> = conditions
        .iter()
        .flat_map(|c| base_fields(deriver, c.residual))
        .collect();
    let hint = match constants(deriver, problem, &bound).as_slice() {
        [name, ..] if given < needed => format!(
            "`{name}` enters the base balances by its derivatives alone: fix its constant by \
             `integral({name}) = 0`, or by its value at an end"
        ),
        _ => "conditions of `boundary` count where the `base` block says nothing of the field"
            .to_owned(),
    };
    Diagnostic::new(deriver.model.base.location.clone(), message, expected).hint(hint)
}

/// Solved fields of which the base balances hold derivatives alone, and no condition of the base anything.
fn constants(deriver: &Deriver, problem: &CaseProblem, bound: &[FieldId]) -> Vec<String> {
    let solved = problem.solved.iter().filter(|&&field| {
        let valued = problem.balances.iter().any(|form| {
            let base = form.terms.get(&Vec::new());
            base.is_some_and(|&id| {
                deriver.graph.any(id, |node| match node {
                    Node::Base(f, order) => *f == field && *order == 0,
                    Node::BaseLaw(atom) => deriver.dependence[atom.law][field],
                    _ => false,
                })
            })
        });
        !valued && !deriver.uniform[field] && !bound.contains(&field)
    });
    solved
        .map(|&f| deriver.model.fields[f].name.clone())
        .collect()
}

/// Conditions of the `base` block, and those of `boundary` that it does not replace, about fields that are all
/// given in closed form.
pub(super) fn base_checks(
    deriver: &mut Deriver,
    problem: &CaseProblem,
    written: &[&Condition],
    written_base: &[&Condition],
    mistakes: &mut Vec<Diagnostic>,
) -> Vec<BaseCheck> {
    let fields = |graph: &Graph, id: Id| -> Vec<FieldId> {
        let nodes = graph.topological(&[id]).into_iter();
        let mut fields: Vec<FieldId> = nodes
            .filter_map(|node| match graph.node(node) {
                Node::Jet(jet) => Some(jet.of),
                _ => None,
            })
            .collect();
        fields.dedup();
        fields
    };
    let mut checks = Vec::new();
    let of_base = written_base.iter().map(|condition| (condition, true));
    let of_boundary = written.iter().map(|condition| (condition, false));
    for (condition, is_of_base) in of_base.chain(of_boundary) {
        let named = fields(deriver.graph, condition.residual);
        let is_replaced = written_base.iter().any(|replacement| {
            replacement.end == condition.end
                && fields(deriver.graph, replacement.residual)
                    .iter()
                    .any(|f| named.contains(f))
        });
        let base = deriver.base_part(condition.residual, &condition.location, mistakes);
        let is_solved = base.is_none_or(|base| {
            let fields = base_fields(deriver, base);
            fields.iter().any(|f| problem.solved.contains(f))
        });
        if !is_solved && (is_of_base || !is_replaced) {
            checks.push(BaseCheck {
                end: condition.end,
                residual: condition.residual,
                location: condition.location.clone(),
            });
        }
    }
    checks
}

/// Fields whose base values an expression holds (through laws too).
fn base_fields(deriver: &Deriver, id: Id) -> Vec<FieldId> {
    let mut fields = Vec::new();
    for node in deriver.graph.topological(&[id]) {
        match deriver.graph.node(node) {
            Node::Base(field, _) => fields.push(*field),
            Node::BaseLaw(atom) => {
                let depends = &deriver.dependence[atom.law];
                fields.extend(depends.ids().filter(|&f| depends[f]));
            }
            _ => {}
        }
    }
    fields.sort_unstable();
    fields.dedup();
    fields
}
