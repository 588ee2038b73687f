//! What the names of a spec are declared as: coordinates, parameters, fields, definitions.

use super::context::Context;
use super::mistake::{beginning, twice};
use super::scope::Names;
use super::statement::keep;
use super::*;
use crate::diagnostic::Diagnostic;
use crate::syntax::tree::*;

/// More fields than any model needs (jets count them in a byte).
const MOST_FIELDS: usize = 14;
/// More parameters than any model needs.
const MOST_PARAMETERS: usize = 500;

pub(super) fn coordinate_names(
    tree: &ModelTree,
    names: &mut Names,
    mistakes: &mut Vec<Diagnostic>,
) {
    let (periodic, bounded): (Vec<_>, Vec<_>) =
        tree.coordinates.iter().partition(|c| c.interval.is_none());
    match periodic.as_slice() {
        [one] => names.periodic = one.name.text.clone(),
        [] => mistakes.push(Diagnostic::new(
            beginning(),
            "there is no periodic coordinate",
            "`coordinates { x: periodic; }`",
        )),
        [first, second, ..] => {
            names.periodic = first.name.text.clone();
            mistakes.push(
                Diagnostic::new(
                    second.name.location.clone(),
                    "there are two periodic coordinates",
                    "one periodic coordinate",
                )
                .hint(format!(
                    "a wave along both is a wave along one: turn the axes so that `{}` is along it",
                    first.name.text
                )),
            );
        }
    }
    if let Some(first) = bounded.first() {
        names.coordinate = Some(first.name.text.clone());
    }
    if let Some(second) = bounded.get(1) {
        let message = "there are two cross-stream coordinates";
        mistakes.push(Diagnostic::new(
            second.name.location.clone(),
            message,
            "at most one",
        ));
    }
}

pub(super) fn interval(
    tree: &ModelTree,
    names: &mut Names,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<Interval> {
    let item = tree.coordinates.iter().find(|c| c.interval.is_some())?;
    let (lower, upper) = item.interval.as_ref()?;
    let written = [names.written(lower), names.written(upper)];
    let lower = keep(names.resolve(lower, Context::Constant), mistakes)?;
    let upper = keep(names.resolve(upper, Context::Constant), mistakes)?;
    if lower == upper {
        let message = "the interval is empty";
        mistakes.push(Diagnostic::new(
            item.name.location.clone(),
            message,
            "two different ends",
        ));
    }
    Some(Interval {
        name: item.name.text.clone(),
        lower,
        upper,
        written,
        location: item.name.location.clone(),
    })
}

pub(super) fn parameters(tree: &ModelTree, names: &mut Names, mistakes: &mut Vec<Diagnostic>) {
    if let Some(surplus) = tree.parameters.get(MOST_PARAMETERS) {
        mistakes.push(Diagnostic::new(
            surplus.name.location.clone(),
            format!("the model has {} parameters", tree.parameters.len()),
            format!("at most {MOST_PARAMETERS}"),
        ));
        return;
    }
    for item in &tree.parameters {
        keep(names.check_name(&item.name), mistakes);
        if names.parameters.iter().any(|p| p.name == item.name.text) {
            mistakes.push(twice(&item.name));
            continue;
        }
        let parameter = keep(names.parameter(item), mistakes);
        // Kept by name where its declaration is wrong, so that its uses are not reported too.
        names
            .parameters
            .push(parameter.unwrap_or_else(|| Parameter {
                name: item.name.text.clone(),
                doc: String::new(),
                default: 0.0,
                lower: f64::NEG_INFINITY,
                upper: f64::INFINITY,
                choices: Vec::new(),
                whole: false,
                location: item.name.location.clone(),
            }));
        names.used.push(false);
    }
}

pub(super) fn fields(
    tree: &ModelTree,
    names: &mut Names,
    mistakes: &mut Vec<Diagnostic>,
) -> Table<FieldId, Field> {
    let mut fields = Table::default();
    let unknowns = tree.mean.iter().filter_map(|item| match item {
        MeanItem::Unknown(name, _) => Some((name, true, None, String::new())),
        _ => None,
    });
    let profiles = tree
        .fields
        .iter()
        .map(|f| (&f.name, false, f.range.as_ref(), f.doc.clone()));
    for (name, uniform, range, doc) in profiles.chain(unknowns) {
        keep(names.check_name(name), mistakes);
        let taken = names.parameters.iter().any(|p| p.name == name.text)
            || names.fields.contains_key(&name.text)
            || names.coordinate.as_deref() == Some(&name.text)
            || names.periodic == name.text;
        if taken {
            mistakes.push(twice(name));
            continue;
        }
        let (mut lower, mut upper) = (f64::NEG_INFINITY, f64::INFINITY);
        if let Some((from, to)) = range {
            if let Some(from) = from {
                lower = keep(names.constant(from), mistakes).unwrap_or(lower);
            }
            if let Some(to) = to {
                upper = keep(names.constant(to), mistakes).unwrap_or(upper);
            }
        }
        let location = name.location.clone();
        let field = fields.push(Field {
            name: name.text.clone(),
            doc,
            lower,
            upper,
            uniform,
            location,
        });
        names.fields.insert(name.text.clone(), field);
    }
    names.field_count = fields.len();
    if fields.is_empty() || fields.len() > MOST_FIELDS {
        let message = format!("the model has {} fields", fields.len());
        mistakes.push(Diagnostic::new(
            beginning(),
            message,
            "1 to 14 fields: `fields { u; v; }`",
        ));
    }
    fields
}

/// Declares every definition that is not a law.
pub(super) fn definitions(tree: &ModelTree, names: &mut Names, mistakes: &mut Vec<Diagnostic>) {
    for definition in tree.definitions.iter().filter(|d| !d.is_law) {
        declare(definition, names, mistakes);
    }
}

fn declare(definition: &Definition, names: &mut Names, mistakes: &mut Vec<Diagnostic>) {
    keep(names.check_name(&definition.name), mistakes);
    let text = &definition.name.text;
    let taken = names.fields.contains_key(text) || names.parameters.iter().any(|p| &p.name == text);
    let previous = names.scopes[0]
        .definitions
        .insert(text.clone(), definition.clone());
    if taken || previous.is_some() {
        mistakes.push(twice(&definition.name));
    }
}
