//! Statements of the source, decided by numbers: holds, fails (where, by how much), or undecided.

use super::super::outcome::{Claim, Number, Outcome, Verdict};
use super::super::study::{Case, Quantity, Statement, Trend, named};
use super::super::workshop::Workshop;
use super::each;
use super::planes::crest;
use super::points::critical_point;
use super::rows::rows;
use crate::library::column as derived_column;
use landau_solver::base::BaseState;
use landau_solver::error::{Error, Result};
use landau_solver::study::Setup;
use landau_solver::study::point::PointReport;
use landau_solver::study::row::{Column, column};
use landau_solver::weakly::Selection;
use std::sync::Arc;

/// A number with its error.
type Value = (f64, f64);

/// Relative error of a number that nothing else limits.
const ROUNDING: f64 = 1e-12;

/// What decides a statement in one case.
fn value(setup: &Setup, case: &Case, statement: &Statement) -> Result<Value> {
    let found = match &statement.at {
        Some(asked) => Some(critical_point(setup, case, asked)?),
        None => None,
    };
    if statement.quantity == Quantity::Place {
        let missing = || Error::input("a statement about a place needs `at`: a critical point");
        let place = found.ok_or_else(missing)?;
        return Ok((place.value, place.error));
    }
    let largest = match statement.quantity {
        Quantity::LargestAmplitude => Some(Column::Amplitude),
        Quantity::LargestGrowth => Some(Column::A0),
        _ => None,
    };
    if let Some(quantity) = largest {
        return where_largest(setup, case, statement, quantity);
    }
    // The critical point may lie along k, or along a parameter.
    let (mut setup, mut k) = (setup.clone(), case.k);
    if let (Some(point), Some(asked)) = (&found, &statement.at) {
        k = Some(point.k);
        if asked.vary != "k" {
            setup.set(&[format!("{}={:e}", asked.vary, point.value)])?;
        }
    }
    let missing = || Error::input(format!("the case `{}` needs a wavenumber k", case.label));
    let k = k.ok_or_else(missing)?;
    if statement.quantity == Quantity::A0 {
        // Growth rates converge where c2 does not yet.
        let row = rows(&setup, None, "k", vec![k], &[])?.remove(0);
        let c0 = row.c0.ok_or_else(|| Error::computation(row.status))?;
        return Ok((c0[0], row.c0_error.unwrap_or(f64::INFINITY)));
    }
    if statement.quantity == Quantity::Column {
        return column_value(&setup, k, statement);
    }
    let point = PointReport::compute(&setup, k, Selection::Leading, 3)?;
    let amplitude_error = |a: f64| {
        // A² = −a0/a2
        let relative = point.error.c0 / point.c0.re.abs() + point.error.c2 / point.c2.re.abs();
        0.5 * a * relative
    };
    match statement.quantity {
        Quantity::A2 => Ok((point.c2.re, point.error.c2)),
        Quantity::Amplitude => {
            let a = point
                .amplitude
                .ok_or_else(|| Error::computation("there is no equilibrium at cubic order"))?;
            Ok((a, amplitude_error(a)))
        }
        Quantity::Place
        | Quantity::A0
        | Quantity::Column
        | Quantity::LargestAmplitude
        | Quantity::LargestGrowth => unreachable!("answered above"),
    }
}

/// A derived column, and how far the base state at another degree puts it.
fn column_value(setup: &Setup, k: f64, statement: &Statement) -> Result<Value> {
    let missing = || Error::input("a statement about a column needs `column`");
    let text = statement.column.as_ref().ok_or_else(missing)?;
    let derived = derived_column(setup.model.as_ref(), text)?;
    let value = |base: &Arc<BaseState>| -> Result<f64> {
        let point = setup.point(base, k, Selection::Leading)?;
        let none = || Error::computation(format!("`{text}` has no value there"));
        derived.value(&point, point.amplitude()).ok_or_else(none)
    };
    let base = setup.base(None)?;
    let own = value(&base)?;
    let other = base
        .refined()
        .map(|base| value(&Arc::new(base)))
        .transpose()?;
    let error = other.map_or(0.0, |other| (other - own).abs());
    Ok((own, error.max(ROUNDING * own.abs())))
}

/// Where a quantity is largest along an axis, to half a step of it.
fn where_largest(
    setup: &Setup,
    case: &Case,
    statement: &Statement,
    quantity: Column,
) -> Result<Value> {
    let missing = || Error::input("a statement about a largest value needs `over`: an axis");
    let over = statement.over.as_ref().ok_or_else(missing)?;
    let rows = rows(setup, case.k, &over.name, over.values(), &[])?;
    let mut points = column(&rows, quantity);
    points.retain(|p| p.1.is_finite());
    let (places, values): (Vec<f64>, Vec<f64>) = points.into_iter().unzip();
    let inside = || {
        Error::computation(format!(
            "it is largest at an end of the range of {}",
            over.name
        ))
    };
    let [place, _] = crest(&values, &places).ok_or_else(inside)?;
    let steps = over.values();
    let step = steps
        .windows(2)
        .map(|w| (w[1] - w[0]).abs())
        .fold(0.0, f64::max);
    Ok((place, 0.5 * step))
}

/// Whether a value meets the statement; nothing where its error leaves that open.
fn meets(
    statement: &Statement,
    first: Option<Value>,
    before: Option<Value>,
    (value, error): Value,
) -> Option<bool> {
    let beyond = |distance: f64| match distance.abs() > error {
        true => Some(distance > 0.0),
        false => None,
    };
    let mut demands: Vec<Option<bool>> = Vec::new();
    demands.extend(statement.above.map(|bound| beyond(value - bound)));
    demands.extend(statement.below.map(|bound| beyond(bound - value)));
    if let (Some(share), Some((reference, _))) = (statement.as_first_within, first) {
        demands.push(beyond(share * reference.abs() - (value - reference).abs()));
    }
    // The first is the one that the others are apart from.
    if let (Some(share), Some((reference, _))) = (statement.apart_from_first, first)
        && value != reference
    {
        demands.push(beyond((value - reference).abs() - share * reference.abs()));
    }
    if let (Some(trend), Some((last, also))) = (statement.trend, before) {
        let gain = match trend {
            Trend::Rising => value - last,
            Trend::Falling => last - value,
        };
        demands.push(match gain.abs() > error + also {
            true => Some(gain > 0.0),
            false => None,
        });
    }
    if demands.contains(&Some(false)) {
        return Some(false);
    }
    demands
        .into_iter()
        .collect::<Option<Vec<bool>>>()
        .map(|_| true)
}

pub(super) fn claims(
    shop: &Workshop,
    figure: &str,
    cases: &[Case],
    statements: &[Statement],
) -> Result<Outcome> {
    let mut outcome = Outcome::default();
    for statement in statements {
        // What has no answer leaves the statement undecided: said there, not as a failure of the study.
        let mut missing = Vec::new();
        let found = each(cases, &mut missing, |case| {
            value(&shop.setup(case)?, case, statement)
        })?;
        let first = found.iter().find(|(index, _)| *index == 0).map(|(_, v)| *v);
        let mut verdicts = Vec::new();
        let mut evidence = missing.clone();
        for (index, value) in &found {
            // The case before, where that has an answer.
            let earlier = found.iter().find(|(other, _)| other + 1 == *index);
            let verdict = meets(statement, first, earlier.map(|(_, v)| *v), *value);
            let word = match verdict {
                Some(true) => "holds",
                Some(false) => "fails",
                None => "undecided",
            };
            let label = named(&cases[*index], &statement.name);
            evidence.push(format!(
                "{label} = {:.6} ± {:.1e}: {word}",
                value.0, value.1
            ));
            verdicts.push(verdict);
            let number = Number::new(figure, &cases[*index], &statement.name, label);
            outcome.numbers.push(Number {
                decides: Some(statement.says.clone()),
                ..number.answered(value.0, Some(value.1))
            });
        }
        let verdict = if verdicts.contains(&Some(false)) {
            Verdict::Fails
        } else if missing.is_empty() && verdicts.iter().all(|v| *v == Some(true)) {
            Verdict::Holds
        } else {
            Verdict::Undecided
        };
        outcome.claims.push(Claim {
            figure: figure.to_owned(),
            says: statement.says.clone(),
            verdict,
            evidence,
        });
    }
    Ok(outcome)
}

#[cfg(test)]
mod tests {
    use super::{Quantity, Statement, Trend, meets};

    fn statement(above: Option<f64>, below: Option<f64>, within: Option<f64>) -> Statement {
        Statement {
            says: String::new(),
            name: String::new(),
            quantity: Quantity::A0,
            at: None,
            over: None,
            above,
            below,
            as_first_within: within,
            apart_from_first: None,
            column: None,
            trend: None,
        }
    }

    #[test]
    fn what_an_error_leaves_open_is_open() {
        let above = statement(Some(1.0), None, None);
        assert_eq!(meets(&above, None, None, (1.5, 0.1)), Some(true));
        assert_eq!(meets(&above, None, None, (0.5, 0.1)), Some(false));
        assert_eq!(meets(&above, None, None, (1.05, 0.1)), None);
        let band = statement(Some(0.0), Some(1.0), None);
        assert_eq!(meets(&band, None, None, (0.5, 0.1)), Some(true));
        assert_eq!(meets(&band, None, None, (2.0, 0.1)), Some(false));
        let rising = Statement {
            trend: Some(Trend::Rising),
            ..statement(None, None, None)
        };
        let step = |last, value| meets(&rising, None, Some((last, 0.1)), (value, 0.1));
        assert_eq!(
            [step(1.0, 2.0), step(2.0, 1.0), step(1.0, 1.15)],
            [Some(true), Some(false), None]
        );
        let same = statement(None, None, Some(0.01));
        assert_eq!(
            meets(&same, Some((2.0, 0.0)), None, (2.01, 1e-3)),
            Some(true)
        );
        assert_eq!(
            meets(&same, Some((2.0, 0.0)), None, (2.1, 1e-3)),
            Some(false)
        );
    }
}
