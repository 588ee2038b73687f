//! One case: the boundary conditions under one combination of the structural switches, the adjoint conditions that
//! follow from them, and the closures of the problem at k = 0.

use super::base_wall::{BaseCheck, base_checks, base_conditions};
use super::boundary::{Combination, Simplifier, as_condition, conjugate, demands, reduce};
use super::closure::{self, CaseClosure};
use super::deriver::Deriver;
use super::redundant::redundant;
use super::regular;
use super::wall::{
    BaseCondition, BaseRules, CaseProblem, WallCondition, Walls, at_end, base_rules, walls,
};
use crate::diagnostic::{Diagnostic, Location};
use crate::formula::{Arrangement, Mark, plain};
use crate::graph::{BalanceId, Graph, Jet};
use crate::model::{Closure, Condition, End};

/// A condition on the adjoint fields: Σ symbol · jets = 0.
#[derive(Clone, Debug)]
pub struct AdjointCondition {
    /// The end of the interval at which it holds.
    pub end: End,
    /// Coefficients by jet.
    pub combination: Combination<BalanceId>,
    /// The balance whose adjoint field it is solved for.
    pub balance: BalanceId,
}

/// One combination of the structural switches.
#[derive(Clone, Debug)]
pub struct Case {
    /// The choice of each structural switch.
    pub choices: Vec<usize>,
    /// Its conditions.
    pub conditions: Vec<WallCondition>,
    /// Conditions of the base state.
    pub base_conditions: Vec<BaseCondition>,
    /// Conditions that base fields in closed form have to meet; the solver checks them.
    pub base_checks: Vec<BaseCheck>,
    /// The adjoint boundary conditions, or why there are none.
    pub adjoint: Result<Vec<AdjointCondition>, String>,
    /// The closures at k = 0: constraints and multipliers that make the problem of the mean regular.
    pub closures: Vec<CaseClosure>,
    /// Positions in the block `mean` of the conserved integrals among them.
    pub conserved: Vec<usize>,
    /// Integrals that the balances keep and the spec does not declare, as a spec would name them.
    pub undeclared: Vec<String>,
}

/// The case of one combination of choices; `None` after a mistake in its conditions.
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
    let conditions = wall_conditions(deriver, &written, mistakes)?;
    check_count(deriver, problem.needed, &conditions, &written, mistakes)?;
    check_independent(deriver, &conditions, &written, mistakes)?;
    let base_conditions = base_conditions(deriver, &problem, &written, &written_base, mistakes)?;
    let base_checks = base_checks(deriver, &problem, &written, &written_base, mistakes);
    let rules = base_rules(deriver.graph, &base_conditions);
    let problem = CaseProblem {
        walls: &conditions,
        ..problem
    };
    let adjoint = walls(deriver, &problem, &conditions, &rules)
        .and_then(|walls| adjoint_conditions(deriver, &problem, &walls, &rules, conditions.len()));
    let closures = closure::derive(deriver, &problem, &rules, mistakes);
    Some(Case {
        choices,
        conditions,
        base_conditions,
        base_checks,
        adjoint,
        closures: closures.list,
        conserved: closures.conserved,
        undeclared: closures.undeclared,
    })
}

/// The conditions expanded around the base state, without the terms of degree 0, which the base state alone has to
/// satisfy.
fn wall_conditions(
    deriver: &mut Deriver,
    written: &[&Condition],
    mistakes: &mut Vec<Diagnostic>,
) -> Option<Vec<WallCondition>> {
    let mut conditions = Vec::new();
    for condition in written {
        let mut form = deriver.expand(condition.residual, &condition.location, mistakes)?;
        form.terms.remove(&Vec::new());
        let (end, residual) = (condition.end, condition.residual);
        let wall = WallCondition {
            end,
            form,
            residual,
        };
        if wall.about().is_none() {
            let message = "the condition says nothing about a field to lowest order";
            let expected = "a condition that is linear in some field";
            mistakes.push(Diagnostic::new(
                condition.location.clone(),
                message,
                expected,
            ));
            return None;
        }
        conditions.push(wall);
    }
    Some(conditions)
}

/// Refuses a condition that follows from the ones before it.
fn check_independent(
    deriver: &mut Deriver,
    conditions: &[WallCondition],
    written: &[&Condition],
    mistakes: &mut Vec<Diagnostic>,
) -> Option<()> {
    let Some(surplus) = redundant(deriver, conditions) else {
        return Some(());
    };
    let condition = written[surplus];
    let interval = deriver.model.interval.as_ref();
    let place = interval.map_or("", |interval| interval.written(condition.end));
    let message = format!(
        "the conditions before this one at {} = {place} say the same already",
        deriver.model.coordinate()
    );
    let expected = "a condition that does not follow from the ones before it";
    mistakes.push(Diagnostic::new(
        condition.location.clone(),
        message,
        expected,
    ));
    None
}

/// Checks that there are `needed` conditions, the total order of the balances in ∂y.
fn check_count(
    deriver: &Deriver,
    needed: usize,
    conditions: &[WallCondition],
    written: &[&Condition],
    mistakes: &mut Vec<Diagnostic>,
) -> Option<()> {
    let model = deriver.model;
    let place = match (written.last(), model.balances.first()) {
        (Some(condition), _) => condition.location.clone(),
        (None, Some(balance)) => balance.location.clone(),
        (None, None) => Location {
            file: 0,
            range: 0..0,
        },
    };
    if conditions.len() == needed {
        return Some(());
    }
    let counts: Vec<String> = model
        .profiles()
        .map(|field| {
            let fields = conditions.iter().filter_map(WallCondition::about);
            let count = fields.filter(|f| *f == field).count();
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

/// The adjoint conditions, as many as the direct ones, or why no such set exists that is independent of the eigenvalue.
///
/// They make the boundary form [⟨Y, B X⟩] vanish at each end for every X that obeys the direct conditions.
fn adjoint_conditions(
    deriver: &mut Deriver,
    problem: &CaseProblem,
    walls: &Walls,
    rules: &BaseRules,
    needed: usize,
) -> Result<Vec<AdjointCondition>, String> {
    let mut rows: Vec<(End, Vec<Combination<BalanceId>>)> = Vec::new();
    let mut reasons = Vec::new();
    for (end, direct) in &walls.reduced {
        let place = deriver.place(*end);
        let mut simplify = |graph: &mut Graph, id| at_end(graph, place, *end, rules, id);
        let mut simplifier = Simplifier {
            at_end: &mut simplify,
        };
        // [⟨Y, B X⟩] = Σ over free X-jets of X-jet · (combination of conj(Y)-jets): each combination must vanish.
        let demanded = demands(deriver.graph, &walls.form, direct, &mut simplifier);
        let mut conditions = Vec::new();
        for (jet, combination) in &demanded {
            let mut coefficients = combination.values().flat_map(|symbol| symbol.values());
            if coefficients.any(|&id| deriver.graph.is_undefined(id)) {
                return Err(singular_end(deriver, *end));
            }
            conditions.push(conjugate(deriver.graph, combination));
            reasons.push((*end, *jet, combination.clone()));
        }
        rows.push((*end, conditions));
    }
    let mut conditions = solved(deriver, &rows, rules)?;
    // Where the coefficient of the highest derivative vanishes at an end, the boundary form asks for less there. The
    // missing conditions say that the adjoint fields are regular; each is kept that is independent of those before.
    for index in 0..rows.len() {
        let end = rows[index].0;
        for condition in regular::conditions(deriver, problem.adjoint, end, rules) {
            if conditions.len() >= needed {
                break;
            }
            let mut longer = rows.clone();
            longer[index].1.push(condition);
            let more = solved(deriver, &longer, rules)?;
            if more.len() > conditions.len() {
                (rows, conditions) = (longer, more);
            }
        }
    }
    if conditions.len() == needed {
        return Ok(conditions);
    }
    let mut text = format!(
        "no adjoint boundary conditions independent of the eigenvalue exist: the boundary form asks for {} where {needed} are needed;",
        conditions.len()
    );
    for (end, jet, combination) in reasons {
        text += &describe_demand(deriver, problem, end, jet, &combination);
    }
    Err(text.trim_end_matches(',').to_owned())
}

/// The conditions of both ends, each solved for the highest derivative in it; conditions that follow from the ones
/// before them are gone.
fn solved(
    deriver: &mut Deriver,
    rows: &[(End, Vec<Combination<BalanceId>>)],
    rules: &BaseRules,
) -> Result<Vec<AdjointCondition>, String> {
    let mut conditions = Vec::new();
    for (end, demanded) in rows {
        let place = deriver.place(*end);
        let mut simplify = |graph: &mut Graph, id| at_end(graph, place, *end, rules, id);
        let mut simplifier = Simplifier {
            at_end: &mut simplify,
        };
        let reduced = reduce(deriver.graph, demanded.clone(), &mut simplifier)
            .map_err(|_| "a condition on the adjoint field holds x-derivatives alone".to_owned())?;
        for (jet, rule) in reduced.rules {
            conditions.push(AdjointCondition {
                end: *end,
                combination: as_condition(deriver.graph, jet, &rule),
                balance: jet.of,
            });
        }
    }
    Ok(conditions)
}

/// The advice for an end where dividing by the highest coefficient gives 1/0.
fn singular_end(deriver: &Deriver, end: End) -> String {
    let interval = deriver.model.interval.as_ref();
    let (name, place) = interval.map_or(("y", ""), |i| (i.name.as_str(), i.written(end)));
    let distance = match place {
        "0" => name.to_owned(),
        _ => format!("({name} - {place})"),
    };
    format!(
        "no adjoint boundary conditions at {name} = {place}: the coefficients of the balances are singular there; \
         multiply each balance by {distance}, or the power of it by which it is divided"
    )
}

/// ` at y = H: n' is free and asks for a condition on v†,`
fn describe_demand(
    deriver: &Deriver,
    problem: &CaseProblem,
    end: End,
    jet: Jet,
    combination: &Combination<BalanceId>,
) -> String {
    let letters = deriver.model.letters(Arrangement::Flat);
    let interval = deriver.model.interval.as_ref();
    let place = interval.map_or("", |i| i.written(end));
    let mut asked: Vec<String> = combination
        .keys()
        .map(|y| format!("{}†", letters.fields[problem.pairing[y.of]]))
        .collect();
    asked.dedup();
    format!(
        " at {} = {place}: {} is free and asks for a condition on {},",
        deriver.model.coordinate(),
        plain(&letters.jet(jet, Mark::Prime)),
        asked.join(", ")
    )
}

/// A declared conserved integral must be conserved in some case.
pub(super) fn check_conserved(deriver: &Deriver, cases: &[Case], mistakes: &mut Vec<Diagnostic>) {
    for (index, closure) in deriver.model.mean.iter().enumerate() {
        let Closure::Conserved { location, .. } = closure else {
            continue;
        };
        if !cases.iter().any(|case| case.conserved.contains(&index)) {
            mistakes.push(
                Diagnostic::new(
                    location.clone(),
                    "this integral is not conserved",
                    "an integral that the balances and the walls keep constant",
                )
                .hint("its density must change by a flux that vanishes at both ends"),
            );
        }
    }
}
