//! Statements: whether something decides them.

use super::{Checked, Spot, axis, critical, each_has_k, not_set};
use crate::reproduce::study::{Case, Quantity, Statement};

/// A statement of a task, its bound and the number that decides it.
pub(super) fn statement(
    task: &Spot,
    index: usize,
    statement: &Statement,
    cases: &[Case],
) -> Checked {
    let spot = task.entry("claim", index, format!("claim {}", index + 1));
    words(&spot, statement)?;
    bounds(&spot, statement, cases)?;
    number(&spot, statement, cases)?;
    if let Some(over) = &statement.over {
        not_set(task, cases, &over.name)?;
    }
    match needs_k(statement) {
        Some(why) => each_has_k(task, cases, &why),
        None => Ok(()),
    }
}

/// The words, of the source or of the study.
fn words(spot: &Spot, statement: &Statement) -> Checked {
    let one = statement.quote.is_some() != statement.says.is_some();
    spot.key("quote").demand(one, || {
        "a statement accepts either `quote`, words of the source, or `says`, words of the study"
            .to_owned()
    })?;
    let placed = statement.quote.is_none() || statement.section.is_some();
    spot.key("section").demand(placed, || {
        "`section` is missing: a quote accepts the place at which the source has it".to_owned()
    })?;
    spot.key("name").demand(!statement.name.is_empty(), || {
        "name = \"\": it accepts what the number is called".to_owned()
    })
}

/// The bounds: at least one, each of them a number that something can meet.
fn bounds(spot: &Spot, statement: &Statement, cases: &[Case]) -> Checked {
    let numbers = [
        ("above", statement.above),
        ("below", statement.below),
        ("as_first_within", statement.as_first_within),
        ("apart_from_first", statement.apart_from_first),
    ];
    let given = || {
        numbers
            .iter()
            .filter_map(|(key, value)| Some((*key, (*value)?)))
    };
    spot.demand(given().next().is_some() || statement.trend.is_some(), || {
        "nothing decides the statement: it accepts `above`, `below`, `as_first_within`, `apart_from_first` or `trend`"
            .to_owned()
    })?;
    for (key, value) in given() {
        spot.finite(key, value)?;
    }
    for (key, share) in &numbers[2..] {
        let so = share.is_none_or(|share| share > 0.0);
        spot.key(key).demand(so, || {
            format!(
                "{key} = {}: it accepts a share above zero",
                share.unwrap_or(0.0)
            )
        })?;
    }
    if let (Some(above), Some(below)) = (statement.above, statement.below) {
        spot.key("below").demand(above < below, || {
            format!("no number lies above {above} and below {below}: it accepts above < below")
        })?;
    }
    let compares = [
        ("as_first_within", statement.as_first_within.is_some()),
        ("apart_from_first", statement.apart_from_first.is_some()),
        ("trend", statement.trend.is_some()),
    ];
    for (key, given) in compares {
        spot.key(key).demand(!given || cases.len() > 1, || {
            format!("{key} compares cases with one another: it accepts two or more cases")
        })?;
    }
    Ok(())
}

/// The number, with what it needs and without what it has no use for.
fn number(spot: &Spot, statement: &Statement, cases: &[Case]) -> Checked {
    let quantity = statement.quantity;
    let largest = matches!(
        quantity,
        Quantity::LargestAmplitude | Quantity::LargestGrowth
    );
    let needs = |key: &str, so: bool, given: bool, what: &str| -> Checked {
        spot.key(key).demand(!so || given, || {
            format!("`{key}` is missing: a statement about {what} accepts one")
        })?;
        spot.key(key).demand(so || !given, || {
            format!("`{key}` stands beside a quantity that has no use for it: it accepts {what}")
        })
    };
    needs("over", largest, statement.over.is_some(), "a largest value")?;
    let column = quantity == Quantity::Column;
    needs("column", column, statement.column.is_some(), "a column")?;
    if quantity == Quantity::Place || largest {
        let so = quantity == Quantity::Place;
        needs("at", so, statement.at.is_some(), "a place")?;
    }
    if let Some(over) = &statement.over {
        axis(spot, "over", over)?;
    }
    match &statement.at {
        Some(asked) => critical::asked(&spot.key("at"), asked, cases),
        None => Ok(()),
    }
}

/// Why every case has to say at which wavenumber, where it has to.
fn needs_k(statement: &Statement) -> Option<String> {
    let name = &statement.name;
    match (&statement.at, &statement.over) {
        (Some(_), _) => None,
        (None, Some(over)) if over.name == "k" => None,
        (None, Some(over)) => Some(format!(
            "`{name}` is sought along `{}` at a wavenumber",
            over.name
        )),
        (None, None) => Some(format!("`{name}` is a number at a wavenumber")),
    }
}
