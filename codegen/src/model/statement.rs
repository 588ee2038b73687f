//! Each block of the spec, checked and made part of the model.

use super::context::Context;
use super::import::{Imported, bind_imports};
use super::mistake::{beginning, twice};
use super::place::{end, place_inside};
use super::scope::{Declared, Names, Resolved};
use super::*;
use crate::diagnostic::{Diagnostic, nearest};
use crate::graph::{Graph, Jet, Node, Operator};
use crate::syntax::tree::*;
use std::collections::BTreeSet;

/// Mistakes after which no more are looked for.
const MOST_MISTAKES: usize = 100;

/// Laws that a model declares: more than any needs.
const MOST_LAWS: usize = 1000;

/// Collects mistakes and goes on.
pub(super) fn keep<T>(result: Resolved<T>, mistakes: &mut Vec<Diagnostic>) -> Option<T> {
    result.map_err(|mistake| mistakes.push(mistake)).ok()
}

/// The model that a spec without mistakes of syntax declares; its expressions go into `graph`. `None` if a mistake
/// leaves a block without a meaning.
pub(super) fn model(
    tree: &ModelTree,
    imported: &[Imported],
    graph: &mut Graph,
    mut declared: Declared,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<Model> {
    let Some(name) = &tree.name else {
        mistakes.push(nameless());
        return None;
    };
    let names = &mut Names::new(graph, &mut declared);
    declaration::coordinate_names(tree, names, mistakes);
    declaration::parameters(tree, names, mistakes);
    let fields = declaration::fields(tree, names, mistakes);
    declaration::definitions(tree, names, mistakes);
    let laws = laws(tree, imported, names, mistakes)?;
    let interval = declaration::interval(tree, names, mistakes);
    each_once(tree.balances.iter().map(|b| &b.name), mistakes);
    each_once(tree.outputs.iter().map(|o| &o.name), mistakes);
    let balances: Table<BalanceId, Balance> = each(&tree.balances, names, mistakes, balance);
    let ends = interval.as_ref().map(|i| (i.lower, i.upper));
    let base = base(&tree.base, fields.len(), ends, names, mistakes);
    let boundary = walls(&tree.boundary, ends, names, mistakes);
    let mean: Vec<Closure> = each(&tree.mean, names, mistakes, mean);
    different_closures(&mean, mistakes);
    let amplitude = match &tree.amplitude {
        Some(item) => {
            let amplitude = amplitude::amplitude(item, interval.as_ref(), names);
            keep(amplitude, mistakes)
        }
        None => Some(amplitude::default_amplitude(
            &fields, &balances, &mean, &laws, names,
        )),
    };
    let outputs = each(&tree.outputs, names, mistakes, |item, names| {
        output(item, interval.as_ref(), names)
    });
    let typical = tree.typical.as_ref();
    let typical = typical.and_then(|item| keep(typical_of(item, names), mistakes));
    check_names(names, mistakes);
    Some(Model {
        name: name.text.clone(),
        title: tree.title.clone(),
        periodic: declared.periodic.clone(),
        interval,
        parameters: declared.parameters.clone(),
        fields,
        laws,
        balances,
        base,
        boundary,
        mean,
        amplitude: amplitude?,
        outputs,
        typical,
        sources: declared.files.clone(),
        declared,
    })
}

/// Checks what is not read with the blocks: definitions, further mistakes of an expression, unused parameters.
fn check_names(names: &mut Names, mistakes: &mut Vec<Diagnostic>) {
    check_definitions(names, mistakes);
    mistakes.append(&mut names.further);
    check_used(names, mistakes);
}

fn nameless() -> Diagnostic {
    let message = "the model has no name";
    Diagnostic::new(beginning(), message, "`model name \"title\";`")
}

/// The conditions of all walls, in the order of the spec.
fn walls(
    items: &[WallItem],
    ends: Option<(Id, Id)>,
    names: &mut Names,
    mistakes: &mut Vec<Diagnostic>,
) -> Vec<Condition> {
    let mut conditions = Vec::new();
    for wall in items {
        wall_conditions(wall, ends, names, mistakes, &mut conditions);
    }
    conditions
}

/// What each item of a list means; those with mistakes are left out.
fn each<Item, Meaning, List: FromIterator<Meaning>>(
    items: &[Item],
    names: &mut Names,
    mistakes: &mut Vec<Diagnostic>,
    meaning: impl Fn(&Item, &mut Names) -> Resolved<Meaning>,
) -> List {
    let meanings = items.iter();
    meanings
        .filter_map(|item| keep(meaning(item, names), mistakes))
        .collect()
}

/// The laws of the imports, then those of the model.
fn laws(
    tree: &ModelTree,
    imported: &[Imported],
    names: &mut Names,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<Table<LawId, Law>> {
    let mut laws = bind_imports(imported, names, mistakes);
    let definitions = tree.definitions.iter().filter(|d| d.is_law);
    if let Some(surplus) = definitions.clone().nth(MOST_LAWS) {
        mistakes.push(Diagnostic::new(
            surplus.name.location.clone(),
            format!("the model has {} laws", definitions.count()),
            format!("at most {MOST_LAWS}"),
        ));
        return None;
    }
    for definition in definitions {
        if let Some(law) = law(definition, names, mistakes) {
            names.graph.declare_law(law.body);
            names.laws.insert(law.name.clone(), laws.push(law));
        }
    }
    Some(laws)
}

/// Reports parameters that no expression uses. A broken statement may have used one, so nothing is reported beside
/// mistakes.
fn check_used(names: &Names, mistakes: &mut Vec<Diagnostic>) {
    if !mistakes.is_empty() {
        return;
    }
    for (parameter, used) in names.parameters.iter().zip(&names.used) {
        if !used {
            let message = format!("the parameter `{}` is never used", parameter.name);
            let expected = "a parameter that some expression uses";
            mistakes.push(Diagnostic::new(
                parameter.location.clone(),
                message,
                expected,
            ));
        }
    }
}

/// Reports names that stand twice in one list.
fn each_once<'a>(names: impl Iterator<Item = &'a Name>, mistakes: &mut Vec<Diagnostic>) {
    let mut taken = BTreeSet::new();
    let repeated = names.filter(|name| !taken.insert(name.text.as_str()));
    mistakes.extend(repeated.map(twice));
}

fn law(definition: &Definition, names: &mut Names, mistakes: &mut Vec<Diagnostic>) -> Option<Law> {
    keep(names.check_name(&definition.name), mistakes);
    let text = definition.name.text.clone();
    if names.laws.contains_key(&text) || names.fields.contains_key(&text) {
        mistakes.push(twice(&definition.name));
        return None;
    }
    if definition.arguments.is_some() {
        let message = "a law of the model is a function of its fields";
        let expected = format!("`law {text} = …`");
        mistakes.push(
            Diagnostic::new(definition.name.location.clone(), message, expected)
                .hint("laws with arguments stand in a .law file"),
        );
        return None;
    }
    let body = keep(names.resolve(&definition.body, Context::Law), mistakes);
    let body = body.unwrap_or_else(|| names.graph.zero());
    Some(Law {
        name: text,
        doc: definition.doc.clone(),
        body,
    })
}

/// Reads every definition, so that mistakes show in those that no balance uses too. The expressions go into a graph
/// that is dropped, so that they leave no trace in the model.
fn check_definitions(names: &mut Names, mistakes: &mut Vec<Diagnostic>) {
    let definitions: Vec<Definition> = names.scopes[0].definitions.values().cloned().collect();
    names.on_scratch_graph(|names| {
        for definition in &definitions {
            // So many mistakes have one cause.
            if mistakes.len() >= MOST_MISTAKES {
                break;
            }
            let count = definition.arguments.as_deref().unwrap_or_default().len();
            let stand_in = names.graph.jet(Jet::value(FieldId(0)));
            let place = definition.name.location.clone();
            let values = vec![stand_in; count];
            keep(
                names.expand(0, definition, &values, &place, Context::State),
                mistakes,
            );
        }
    });
}

fn difference(equation: &Equation, names: &mut Names) -> Resolved<Id> {
    let left = names.resolve(&equation.left, Context::State);
    let right = names.resolve(&equation.right, Context::State);
    let (left, right) = names.both(left, right)?;
    Ok(names.graph.sub(left, right))
}

pub(super) fn field_index(name: &Name, names: &Names) -> Resolved<FieldId> {
    names.fields.get(&name.text).copied().ok_or_else(|| {
        let mut fields: Vec<&str> = names.fields.keys().map(String::as_str).collect();
        fields.sort_unstable();
        let near = nearest(&name.text, fields.iter().copied());
        let message = format!("`{}` is not a field", name.text);
        Diagnostic::new(
            name.location.clone(),
            message,
            format!("one of {}", fields.join(", ")),
        )
        .about_unknown(&name.text)
        .maybe_hint(near.map(|n| format!("did you mean `{n}`?")))
    })
}

fn balance(item: &BalanceItem, names: &mut Names) -> Resolved<Balance> {
    let residual = difference(&item.equation, names)?;
    let divisor = match &item.divide_by {
        Some(divisor) => Some(names.resolve(divisor, Context::Law)?),
        None => None,
    };
    let paired_field = match &item.paired_field {
        Some(field) => Some(field_index(field, names)?),
        None => None,
    };
    let (name, doc) = (item.name.text.clone(), item.doc.clone());
    let location = Location {
        file: 0,
        range: item.name.location.range.clone(),
    };
    Ok(Balance {
        name,
        doc,
        residual,
        divisor,
        paired_field,
        location,
    })
}

fn base(
    block: &BaseBlock,
    fields: usize,
    ends: Option<(Id, Id)>,
    names: &mut Names,
    mistakes: &mut Vec<Diagnostic>,
) -> Base {
    let profiles = |items: &[(Name, Expression)], names: &mut Names, mistakes: &mut Vec<_>| {
        let mut values = Table::filled(fields, None);
        for (name, expression) in items {
            let Some(field) = keep(field_index(name, names), mistakes) else {
                continue;
            };
            if values[field].is_some() {
                mistakes.push(twice(name));
            }
            values[field] = keep(names.resolve(expression, Context::Profile), mistakes);
        }
        values
    };
    let closed = profiles(&block.closed, names, mistakes);
    let guesses = profiles(&block.guesses, names, mistakes);
    let conditions = walls(&block.walls, ends, names, mistakes);
    let integrals = block
        .integrals
        .iter()
        .filter_map(|i| keep(integral(i, names), mistakes))
        .collect();
    let mut automatic = Vec::new();
    for item in &block.automatic {
        let condition = automatic_condition(item, ends, names);
        automatic.extend(keep(condition, mistakes));
    }
    let location = block.location.clone().unwrap_or_else(beginning);
    Base {
        closed,
        guesses,
        conditions,
        integrals,
        automatic,
        location,
    }
}

/// The parameter that a condition of the base state determines, and the condition.
fn automatic_condition(
    item: &AutomaticItem,
    ends: Option<(Id, Id)>,
    names: &mut Names,
) -> Resolved<(ParameterId, Condition)> {
    let (name, place) = (&item.parameter.text, item.parameter.location.clone());
    let Some(parameter) = names.find_parameter(name, 0) else {
        let message = format!("`{name}` is not a parameter");
        return Err(Diagnostic::new(place, message, "the name of a parameter"));
    };
    if names.parameters[parameter].whole {
        let message = format!("`{name}` takes whole numbers");
        let expected = "a parameter that varies continuously";
        return Err(Diagnostic::new(place, message, expected));
    }
    let condition = Condition {
        end: end(&item.place, ends, names)?,
        residual: difference(&item.equation, names)?,
        guard: Vec::new(),
        location: item.equation.location.clone(),
    };
    Ok((parameter, condition))
}

fn integral(item: &IntegralCondition, names: &mut Names) -> Resolved<Integral> {
    let integrand = names.resolve(&item.integrand, Context::State)?;
    let value = names.resolve(&item.value, Context::Constant)?;
    Ok(Integral {
        integrand,
        value,
        location: item.location.clone(),
    })
}

fn wall_conditions(
    wall: &WallItem,
    ends: Option<(Id, Id)>,
    names: &mut Names,
    mistakes: &mut Vec<Diagnostic>,
    list: &mut Vec<Condition>,
) {
    if let Some(expected) = names
        .coordinate
        .clone()
        .filter(|c| *c != wall.coordinate.text)
    {
        let message = format!(
            "`{}` is not the cross-stream coordinate",
            wall.coordinate.text
        );
        let place = wall.coordinate.location.clone();
        mistakes.push(Diagnostic::new(place, message, format!("`{expected}`")));
        return;
    }
    if let Some(end) = keep(end(&wall.place, ends, names), mistakes) {
        conditions(&wall.conditions, end, &[], names, mistakes, list);
    }
}

fn conditions(
    items: &[ConditionItem],
    end: End,
    guard: &[(ParameterId, usize)],
    names: &mut Names,
    mistakes: &mut Vec<Diagnostic>,
    list: &mut Vec<Condition>,
) {
    for item in items {
        match item {
            ConditionItem::Equation(equation) => {
                let Some(residual) = keep(difference(equation, names), mistakes) else {
                    continue;
                };
                let location = equation.location.clone();
                if names
                    .graph
                    .any(residual, |n| matches!(n, Node::Derivative(Operator::Dt, _)))
                {
                    let message = "`dt` has no place in a boundary condition";
                    mistakes.push(Diagnostic::new(
                        location,
                        message,
                        "a condition without `dt`",
                    ));
                    continue;
                }
                list.push(Condition {
                    end,
                    residual,
                    guard: guard.to_vec(),
                    location,
                });
            }
            ConditionItem::Select(switch, branches) => {
                let place = switch.location.clone();
                let resolved = names.branches(switch, branches, 0, &place);
                let Some((parameter, order)) = keep(resolved, mistakes) else {
                    continue;
                };
                for (choice, branch) in order.into_iter().enumerate() {
                    let mut guard = guard.to_vec();
                    guard.push((parameter, choice));
                    conditions(&branches[branch].1, end, &guard, names, mistakes, list);
                }
            }
        }
    }
}

/// Refuses a gauge or an integral that is named twice.
fn different_closures(closures: &[Closure], mistakes: &mut Vec<Diagnostic>) {
    for (index, closure) in closures.iter().enumerate() {
        let repeats = |before: &Closure| match (before, closure) {
            (Closure::Gauge { field: a, .. }, Closure::Gauge { field: b, .. }) => a == b,
            (Closure::Conserved { integrand: a, .. }, Closure::Conserved { integrand: b, .. }) => {
                a == b
            }
            _ => false,
        };
        if closures[..index].iter().any(repeats)
            && let Closure::Gauge { location, .. } | Closure::Conserved { location, .. } = closure
        {
            mistakes.push(Diagnostic::new(
                location.clone(),
                "the block `mean` names this twice",
                "one of them alone",
            ));
        }
    }
}

fn mean(item: &MeanItem, names: &mut Names) -> Resolved<Closure> {
    Ok(match item {
        MeanItem::Conserved(integrand) => Closure::Conserved {
            location: integrand.location.clone(),
            integrand: names.resolve(integrand, Context::State)?,
        },
        MeanItem::Gauge(name) => Closure::Gauge {
            field: field_index(name, names)?,
            location: name.location.clone(),
        },
        MeanItem::Unknown(name, condition) => Closure::Unknown {
            field: field_index(name, names)?,
            integral: integral(condition, names)?,
        },
    })
}

fn typical_of(item: &TypicalItem, names: &mut Names) -> Resolved<Typical> {
    let k = names.constant(&item.k)?;
    if k <= 0.0 {
        let message = "this is not a wavenumber";
        let place = item.k.location.clone();
        return Err(Diagnostic::new(place, message, "a positive number"));
    }
    let near = match &item.near {
        None => None,
        Some((real, imaginary)) => Some([
            names.constant(real)?,
            imaginary.as_ref().map_or(Ok(0.0), |i| names.constant(i))?,
        ]),
    };
    Ok(Typical { k, near })
}

fn output(item: &OutputItem, interval: Option<&Interval>, names: &mut Names) -> Resolved<Output> {
    let place = match &item.place {
        Some(place) => Some(place_inside(place, interval, names)?),
        None => None,
    };
    let body = names.resolve(&item.body, Context::State)?;
    Ok(Output {
        name: item.name.text.clone(),
        doc: item.doc.clone(),
        place,
        body,
        location: item.name.location.clone(),
    })
}
