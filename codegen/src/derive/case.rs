//! One case: the boundary conditions under one combination of the structural switches, the adjoint
//! conditions that follow from them, and what closes the problem at k = 0.

use super::boundary::{
    Combination, Reduced, Simplifier, as_condition, boundary_form, conjugate, demands, reduce,
    split,
};
use super::closure::{self, CaseClosure};
use super::form::Form;
use super::linear::Term;
use super::{Deriver, pairing};
use crate::diagnostic::{Diagnostic, Location};
use crate::graph::{Graph, Id, Jet, Node, Printer, Rational, Variable};
use crate::model::{Condition, End};
use num_traits::One;
use std::collections::BTreeMap;

/// A condition on the perturbation: B(X⁰ + X') − B(X⁰) = 0.
#[derive(Clone, Debug)]
pub struct WallCondition {
    pub end: End,
    /// Terms of degree 1 and higher.
    pub form: Form,
    /// The condition in the full state, unexpanded.
    pub residual: Id,
    /// The field whose collocation row it replaces.
    pub field: usize,
}

/// A condition on the base state.
#[derive(Clone, Debug)]
pub struct BaseCondition {
    pub end: End,
    /// Vanishes at that end; laws opaque.
    pub residual: Id,
}

/// A condition on the adjoint field: Σ symbol · jets = 0, `jet.field` being a balance.
#[derive(Clone, Debug)]
pub struct AdjointCondition {
    pub end: End,
    pub combination: Combination,
    /// The balance whose adjoint field's row it replaces.
    pub balance: usize,
}

#[derive(Clone, Debug)]
pub struct Case {
    /// The choice of each structural switch.
    pub choices: Vec<usize>,
    pub conditions: Vec<WallCondition>,
    pub base_conditions: Vec<BaseCondition>,
    /// The adjoint boundary conditions, or why there are none.
    pub adjoint: Result<Vec<AdjointCondition>, String>,
    pub closures: Vec<CaseClosure>,
}

/// What a case is derived from.
pub(super) struct CaseProblem<'a> {
    pub linear: &'a [Term],
    pub adjoint: &'a [Term],
    pub divisors: &'a [Id],
    pub pairing: &'a [usize],
    pub solved: &'a [usize],
    pub switches: &'a [usize],
    /// How many conditions the base state needs.
    pub base_conditions: usize,
}

/// The boundary form and what each end makes of it.
pub(super) struct Walls {
    pub form: BTreeMap<Jet, Combination>,
    pub reduced: Vec<(End, Reduced)>,
}

pub(super) fn derive(
    deriver: &mut Deriver,
    problem: CaseProblem,
    choices: Vec<usize>,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<Case> {
    let model = deriver.model;
    let holds = |condition: &&Condition| {
        condition.guard.iter().all(|(switch, choice)| {
            problem
                .switches
                .iter()
                .zip(&choices)
                .any(|(s, c)| s == switch && c == choice)
        })
    };
    let written: Vec<&Condition> = model.boundary.iter().filter(holds).collect();
    let written_base: Vec<&Condition> = model.base.conditions.iter().filter(holds).collect();
    let mut conditions = Vec::new();
    for condition in &written {
        let mut form = deriver.expand(condition.residual, &condition.location, mistakes)?;
        form.terms.remove(&Vec::new());
        let Some(field) = attributed(&form) else {
            let message = "the condition says nothing about a field to lowest order";
            let expected = "a condition that is linear in some field";
            mistakes.push(Diagnostic::new(
                condition.location.clone(),
                message,
                expected,
            ));
            return None;
        };
        let (end, residual) = (condition.end, condition.residual);
        conditions.push(WallCondition {
            end,
            form,
            residual,
            field,
        });
    }
    check_count(deriver, problem.linear, &conditions, &written, mistakes)?;
    let base_conditions = base_conditions(deriver, &problem, &written, &written_base, mistakes)?;
    let rules = base_rules(deriver.graph, &base_conditions);
    let walls = match walls(deriver, &problem, &conditions, &rules) {
        Ok(walls) => walls,
        Err(reason) => {
            let adjoint = Err(reason);
            return Some(Case {
                choices,
                conditions,
                base_conditions,
                adjoint,
                closures: Vec::new(),
            });
        }
    };
    let adjoint = adjoint_conditions(deriver, &problem, &walls, &rules, conditions.len());
    let closures = closure::derive(deriver, &problem, &walls, &rules, mistakes);
    Some(Case {
        choices,
        conditions,
        base_conditions,
        adjoint,
        closures,
    })
}

/// The field of the highest y-derivative in the linear part.
fn attributed(form: &Form) -> Option<usize> {
    let linear = form.degree(1);
    let jets = linear.terms.keys().map(|m| m[0]);
    jets.max_by_key(|j| (j.y, std::cmp::Reverse((j.absx, j.x, j.field))))
        .map(|j| usize::from(j.field))
}

fn check_count(
    deriver: &Deriver,
    linear: &[Term],
    conditions: &[WallCondition],
    written: &[&Condition],
    mistakes: &mut Vec<Diagnostic>,
) -> Option<()> {
    let model = deriver.model;
    let profiles = deriver.uniform.iter().filter(|u| !**u).count();
    let place = match (written.last(), model.balances.first()) {
        (Some(condition), _) => condition.location.clone(),
        (None, Some(balance)) => balance.location.clone(),
        (None, None) => Location {
            file: 0,
            range: 0..0,
        },
    };
    let Some(needed) = pairing::total_order(linear, model.balances.len(), profiles) else {
        let message = "the balances do not determine the fields";
        let expected = "balances that can be solved for one field each";
        mistakes.push(Diagnostic::new(
            model.balances[0].location.clone(),
            message,
            expected,
        ));
        return None;
    };
    if conditions.len() == needed {
        return Some(());
    }
    let counts: Vec<String> = (0..profiles)
        .map(|field| {
            let count = conditions.iter().filter(|c| c.field == field).count();
            format!("{} {count}", model.fields[field].name)
        })
        .collect();
    let trouble = if conditions.len() < needed {
        "too few"
    } else {
        "too many"
    };
    let message = format!(
        "{trouble} boundary conditions: {} for derivatives of total order {needed}",
        conditions.len()
    );
    mistakes.push(
        Diagnostic::new(
            place,
            message,
            format!("{needed} conditions at the two ends together"),
        )
        .hint(format!(
            "conditions counted by field: {}",
            counts.join(", ")
        )),
    );
    None
}

/// Base conditions: those of the `base` block, and those of `boundary` about fields that the
/// `base` block leaves alone at that end.
fn base_conditions(
    deriver: &mut Deriver,
    problem: &CaseProblem,
    written: &[&Condition],
    written_base: &[&Condition],
    mistakes: &mut Vec<Diagnostic>,
) -> Option<Vec<BaseCondition>> {
    let mut found: Vec<(BaseCondition, Vec<usize>)> = Vec::new();
    for (condition, own) in written_base
        .iter()
        .map(|c| (c, true))
        .chain(written.iter().map(|c| (c, false)))
    {
        let residual = deriver.base_part(condition.residual)?;
        let fields = base_fields(deriver, residual);
        let solved: Vec<usize> = fields
            .into_iter()
            .filter(|f| problem.solved.contains(f))
            .collect();
        if solved.is_empty() {
            continue;
        }
        let overridden = found.iter().any(|(other, known)| {
            other.end == condition.end && known.iter().any(|f| solved.contains(f))
        });
        if own || !overridden {
            found.push((
                BaseCondition {
                    end: condition.end,
                    residual,
                },
                solved,
            ));
        }
    }
    let found: Vec<BaseCondition> = found.into_iter().map(|(c, _)| c).collect();
    let integrals = deriver.model.base.integrals.len()
        + deriver.model.mean.iter().filter(|closure| {
            matches!(closure, crate::model::Closure::Unknown { field, .. } if problem.solved.contains(field))
        }).count();
    let given = found.len()
        + if problem.solved.is_empty() {
            0
        } else {
            integrals
        };
    if given != problem.base_conditions {
        let trouble = if given < problem.base_conditions {
            "few"
        } else {
            "many"
        };
        let message = format!("the base state has too {trouble} conditions: {given}");
        let expected = format!(
            "{} conditions, at the ends and on integrals together",
            problem.base_conditions
        );
        mistakes.push(
            Diagnostic::new(deriver.model.base.location.clone(), message, expected).hint(
                "conditions of `boundary` count where the `base` block says nothing of the field",
            ),
        );
        return None;
    }
    Some(found)
}

/// Fields whose base values an expression holds (through laws too).
fn base_fields(deriver: &Deriver, id: Id) -> Vec<usize> {
    let mut fields = Vec::new();
    for node in deriver.graph.topological(&[id]) {
        match deriver.graph.node(node) {
            Node::Base(field, _) => fields.push(*field),
            Node::BaseLaw(atom) => {
                fields.extend(
                    (0..deriver.uniform.len()).filter(|&f| deriver.dependence[atom.law][f]),
                );
            }
            _ => {}
        }
    }
    fields.sort_unstable();
    fields.dedup();
    fields
}

/// What the base's own boundary conditions say at each end: base atom → expression.
pub(super) type BaseRules = Vec<(End, (usize, u8), Id)>;

/// Solves each base condition that is linear in its highest base derivative for it.
fn base_rules(graph: &mut Graph, conditions: &[BaseCondition]) -> BaseRules {
    let mut rules = BaseRules::new();
    for condition in conditions {
        let mut atoms: Vec<(u8, usize)> = Vec::new();
        for node in graph.topological(&[condition.residual]) {
            if let Node::Base(field, order) = graph.node(node) {
                atoms.push((*order, *field));
            }
        }
        atoms.sort_unstable();
        let Some(&(order, field)) = atoms.last() else {
            continue;
        };
        // A law depends on values of the fields, so it is a coefficient beside a derivative; where
        // it could hide a further dependence the condition is left alone.
        let hides = |n: &Node| matches!(n, Node::BaseLaw(atom) if order == 0 || atom.y > 0);
        if graph.any(condition.residual, hides) {
            continue;
        }
        let slope = graph.differentiate(condition.residual, Variable::Base(field, order));
        let curvature = graph.differentiate(slope, Variable::Base(field, order));
        if !graph.vanishes(curvature) || graph.vanishes(slope) {
            continue;
        }
        // residual = slope · atom + rest
        let atom = graph.base(field, order);
        let product = graph.mul(slope, atom);
        let rest = graph.sub(condition.residual, product);
        let rest = if graph.vanishes(rest) {
            graph.zero()
        } else {
            rest
        };
        let solution = graph.product([(rest, Rational::one()), (slope, -Rational::one())]);
        let solution = graph.neg(solution);
        rules.push((condition.end, (field, order), solution));
    }
    rules
}

/// An expression at one end: the coordinate's value put in, base conditions used.
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

fn walls(
    deriver: &mut Deriver,
    problem: &CaseProblem,
    conditions: &[WallCondition],
    rules: &BaseRules,
) -> Result<Walls, String> {
    let form = boundary_form(deriver.graph, problem.linear).map_err(|term| {
        let balance = &deriver.model.balances[term.row].name;
        format!("the balance `{balance}` holds a time derivative under a cross-stream derivative: the adjoint boundary conditions would depend on the eigenvalue")
    })?;
    let mut reduced = Vec::new();
    for end in End::BOTH {
        let place = deriver.place(end);
        let rows = conditions.iter().filter(|c| c.end == end).map(|condition| {
            let mut row = Combination::new();
            for (monomial, &coefficient) in &condition.form.degree(1).terms {
                let (jet, symbol) = split(monomial[0], coefficient);
                row.entry(jet).or_default().extend(symbol);
            }
            row
        });
        let rows: Vec<_> = rows.collect();
        let mut simplify = |graph: &mut Graph, id| at_end(graph, place, end, rules, id);
        let mut simplifier = Simplifier {
            at_end: &mut simplify,
        };
        let solved = reduce(deriver.graph, rows, &mut simplifier).map_err(|_| {
            "the boundary conditions cannot be solved for derivatives without x in them".to_owned()
        })?;
        reduced.push((end, solved));
    }
    Ok(Walls { form, reduced })
}

/// The adjoint conditions, or why no set of them independent of the eigenvalue exists.
fn adjoint_conditions(
    deriver: &mut Deriver,
    problem: &CaseProblem,
    walls: &Walls,
    rules: &BaseRules,
    needed: usize,
) -> Result<Vec<AdjointCondition>, String> {
    let mut found = Vec::new();
    let mut reasons = Vec::new();
    for (end, direct) in &walls.reduced {
        let place = deriver.place(*end);
        let mut simplify = |graph: &mut Graph, id| at_end(graph, place, *end, rules, id);
        let mut simplifier = Simplifier {
            at_end: &mut simplify,
        };
        let demanded = demands(deriver.graph, &walls.form, direct, &mut simplifier);
        let mut rows = Vec::new();
        for (jet, combination) in &demanded {
            rows.push(conjugate(deriver.graph, combination));
            reasons.push((*end, *jet, combination.clone()));
        }
        let reduced = reduce(deriver.graph, rows, &mut simplifier)
            .map_err(|_| "a condition on the adjoint field holds x-derivatives alone".to_owned())?;
        for (jet, rule) in reduced.rules {
            let combination = as_condition(deriver.graph, jet, &rule);
            found.push(AdjointCondition {
                end: *end,
                combination,
                balance: usize::from(jet.field),
            });
        }
    }
    if found.len() == needed {
        return Ok(found);
    }
    let mut text = format!(
        "no adjoint boundary conditions independent of the eigenvalue exist: the boundary form asks for {} where {needed} are needed;",
        found.len()
    );
    for (end, jet, combination) in reasons {
        text += &describe_demand(deriver, problem, end, jet, &combination);
    }
    Err(text.trim_end_matches(',').to_owned())
}

/// ` at y = H: n' is free and asks for a condition on v†,`
fn describe_demand(
    deriver: &Deriver,
    problem: &CaseProblem,
    end: End,
    jet: Jet,
    combination: &Combination,
) -> String {
    let fields = deriver.model.field_names();
    let parameters: Vec<String> = deriver
        .model
        .parameters
        .iter()
        .map(|p| p.name.clone())
        .collect();
    let printer = Printer {
        graph: deriver.graph,
        fields: &fields,
        parameters: &parameters,
        laws: &[],
        coordinate: deriver.model.coordinate(),
        slots: &[],
    };
    let place = deriver.model.interval.as_ref().map(|i| match end {
        End::Lower => i.lower,
        End::Upper => i.upper,
    });
    let place = place.map_or(String::new(), |p| printer.print(p));
    let mut asked: Vec<String> = combination
        .keys()
        .map(|y| format!("{}†", fields[problem.pairing[usize::from(y.field)]]))
        .collect();
    asked.dedup();
    format!(
        " at {} = {place}: {} is free and asks for a condition on {},",
        deriver.model.coordinate(),
        printer.jet(jet, "'"),
        asked.join(", ")
    )
}
