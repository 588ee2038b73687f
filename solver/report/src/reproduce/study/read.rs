//! The text of a study as a [`Study`]. Every task is read from its own table: a reader that looks at `kind` first would lose
//! the places of all other keys.

use super::place::{Fault, fault_of};
use super::{Study, Task};
use serde::Deserialize;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Deserializer, ValueDeserializer};

/// A value with its place.
type Value<'t> = Spanned<DeValue<'t>>;

/// What the keys accept that every task, case or section has to have, and that others are often given wrongly.
const ACCEPTED: [(&str, &str); 36] = [
    ("title", "a text"),
    ("source", "a citation"),
    (
        "model",
        "the name of a built model, or the path of a .model file",
    ),
    ("resolution", "a whole number"),
    ("figure", "one section or more, as [[figure]]"),
    ("id", "letters, digits and hyphens"),
    ("task", "one or more, as [[figure.task]]"),
    ("case", "one or more, as [[figure.task.case]]"),
    ("label", "a text"),
    ("set", "texts NAME=VALUE in brackets"),
    ("fields", "names of fields, or expressions, in brackets"),
    ("expressions", "expressions in brackets"),
    (
        "over",
        "an axis, as { name = \"k\", from = 0.1, to = 0.2, count = 11 }",
    ),
    (
        "against",
        "an axis, as { name = \"k\", from = 0.1, to = 0.2, count = 11 }",
    ),
    ("name", "a text"),
    ("from", "a number"),
    ("to", "a number"),
    ("count", "a whole number"),
    ("resolutions", "whole numbers in brackets"),
    (
        "columns",
        "columns in brackets; those of one panel in brackets of their own",
    ),
    ("highest", "an odd number from 5 on"),
    (
        "asked",
        "questions in brackets, as { name = \"k_u\", vary = \"k\", between = [0.1, 0.2] }",
    ),
    (
        "critical",
        "a question, as { name = \"k_u\", vary = \"k\", between = [0.1, 0.2] }",
    ),
    ("vary", "`k` or the name of a parameter"),
    ("between", "two numbers, the lower first"),
    ("minimize", "two wavenumbers, the lower first"),
    ("claim", "one or more, as [[figure.task.claim]]"),
    (
        "distances",
        "two relative distances of one sign, the nearer first",
    ),
    ("shade", "the name of a field, or an expression"),
    ("arrows", "the names of two fields"),
    ("k", "a positive number"),
    ("side", "a part of the wavelength, above 0 up to 1"),
    ("wavelengths", "a positive number"),
    ("file", "the path of a CSV"),
    (
        "printed",
        "numbers, or texts with their digits such as \"0.1790\"",
    ),
    ("errata", "the path of a file of printed formulas"),
];

/// What a key accepts, as far as it is the same wherever the key stands.
pub(super) fn accepted(key: &str) -> Option<&'static str> {
    let entry = ACCEPTED.iter().find(|(name, _)| *name == key);
    entry.map(|(_, words)| *words)
}

/// The study that a text says.
///
/// # Errors
/// The place and the key of the first mistake, and what the key accepts.
pub(super) fn study(text: &str) -> Result<Study, Fault> {
    let wrong = |error: toml::de::Error| fault_of(text, &error);
    let mut top = DeTable::parse(text).map_err(wrong)?;
    let tasks = tasks(top.get_mut())?;
    let mut study = Study::deserialize(Deserializer::from(top)).map_err(wrong)?;
    for (figure, tasks) in study.figure.iter_mut().zip(tasks) {
        let read = tasks.into_iter().map(|table| task(table, text));
        figure.task = read.collect::<Result<_, _>>()?;
    }
    Ok(study)
}

/// Takes the tasks out of the tables of their sections.
fn tasks<'t>(top: &mut DeTable<'t>) -> Result<Vec<Vec<Value<'t>>>, Fault> {
    let figures = top.get_mut("figure").map(Spanned::get_mut);
    let Some(DeValue::Array(figures)) = figures else {
        return Ok(Vec::new());
    };
    let mut taken = Vec::new();
    for figure in figures.iter_mut() {
        let span = figure.span();
        let DeValue::Table(figure) = figure.get_mut() else {
            return Ok(Vec::new());
        };
        let (span, tasks) = match figure.remove("task") {
            Some(tasks) => (tasks.span(), Some(tasks.into_inner())),
            None => (span, None),
        };
        taken.push(match tasks {
            Some(DeValue::Array(tasks)) => tasks.into_iter().collect(),
            Some(_) => return Err(of_key(span, "task", "no list")),
            None => return Err(of_key(span, "task", "missing")),
        });
    }
    Ok(taken)
}

/// What is wrong with a key, and what it accepts.
fn of_key(span: Range<usize>, key: &str, what: &str) -> Fault {
    let accepted = accepted(key).unwrap_or("something else");
    Fault {
        range: Some(span),
        message: format!("`{key}` is {what}: it accepts {accepted}"),
    }
}

/// The task of a table.
fn task(table: Value, text: &str) -> Result<Task, Fault> {
    let span = table.span();
    let of_kind = |range: Range<usize>, what: &str| {
        let kinds: Vec<String> = Task::KINDS.iter().map(|kind| format!("`{kind}`")).collect();
        Err(Fault {
            range: Some(range),
            message: format!("{what}: it accepts {}", kinds.join(", ")),
        })
    };
    let DeValue::Table(mut keys) = table.into_inner() else {
        return Err(of_key(span, "task", "no table"));
    };
    let Some(kind) = keys.remove("kind") else {
        return of_kind(span, "`kind` is missing");
    };
    let place = kind.span();
    let DeValue::String(name) = kind.get_ref() else {
        return of_kind(place.clone(), &format!("kind = {}", &text[place]));
    };
    let reader = ValueDeserializer::from(Spanned::new(span, DeValue::Table(keys)));
    match Task::read(name, reader) {
        Some(task) => task.map_err(|error| fault_of(text, &error)),
        None => of_kind(place, &format!("kind = `{name}`")),
    }
}
