//! Single numbers beside the printed ones: critical points, Landau points.

use super::super::Workshop;
use super::super::outcome::{Number, Outcome, Table};
use super::super::study::{Asked, Axis, Case, Of};
use super::curves::{named, picture};
use super::each;
use crate::error::{Error, Result};
use crate::figure::{Panel, Style};
use crate::study::critical::{self, Quantity, Question};
use crate::study::{self, Setup};
use crate::weakly::Selection;
use indicatif::ProgressBar;

/// The question of a study file for one case.
pub(super) fn question(setup: &Setup, case: &Case, asked: &Asked) -> Result<Question> {
    Ok(Question {
        axis: study::Axis::named(setup.model, &asked.vary)?,
        from: asked.between[0],
        to: asked.between[1],
        quantity: match asked.of {
            Of::Growth => Quantity::Growth,
            Of::C2 => Quantity::C2,
            Of::Resonance => Quantity::Resonance,
        },
        k: asked.k.or(case.k).unwrap_or(0.0),
        near: None,
    })
}

fn answer(setup: &Setup, case: &Case, asked: &Asked) -> Result<[f64; 2]> {
    let question = question(setup, case, asked)?;
    let hidden = ProgressBar::hidden();
    let found = match asked.minimize {
        Some([from, to]) => critical::minimise(setup, question, (from, to), &hidden)?,
        None => critical::critical(setup, question, &hidden)?.swap_remove(0),
    };
    Ok([found.value, found.k])
}

pub(super) fn critical(
    shop: &Workshop,
    figure: &str,
    cases: &[Case],
    asked: &[Asked],
    against: Option<&Axis>,
) -> Result<Outcome> {
    let mut outcome = Outcome::default();
    // A curve against a parameter is a row of cases.
    let all: Vec<(Case, Option<f64>)> = match against {
        None => cases.iter().map(|case| (case.clone(), None)).collect(),
        Some(axis) => cases
            .iter()
            .flat_map(|case| {
                axis.values().into_iter().map(|value| {
                    let mut moved = case.clone();
                    moved.set.push(format!("{}={value}", axis.name));
                    moved.label = named(case, &format!("{} = {value}", axis.name));
                    (moved, Some(value))
                })
            })
            .collect(),
    };
    let tasks: Vec<(usize, usize)> = (0..all.len())
        .flat_map(|case| (0..asked.len()).map(move |question| (case, question)))
        .collect();
    let pairs: Vec<Case> = tasks
        .iter()
        .map(|&(case, question)| Case {
            label: named(&all[case].0, &asked[question].name),
            ..all[case].0.clone()
        })
        .collect();
    let lookup = |case: &Case| {
        let position = pairs.iter().position(|p| std::ptr::eq(p, case));
        position.map_or(0, |position| tasks[position].1)
    };
    let found = each(&pairs, &mut outcome.failures, |case| {
        shop.with_setup(case, |setup| answer(setup, case, &asked[lookup(case)]))
    })?;
    let mut table = Table::new(&[
        against.map_or("case", |a| a.name.as_str()),
        "question",
        "value",
        "k",
    ]);
    for (index, [value, k]) in found {
        let (case, question) = tasks[index];
        let quantity = &asked[question].name;
        let place = all[case].1.unwrap_or((case + 1) as f64);
        table
            .rows
            .push(vec![place, (question + 1) as f64, value, k]);
        outcome.numbers.push(Number {
            figure: figure.to_owned(),
            quantity: pairs[index].label.clone(),
            ours: Some(value),
            printed: pairs[index].printed.get(quantity).copied(),
            note: pairs[index].note.clone(),
        });
    }
    if let Some(axis) = against {
        let mut drawn = Vec::new();
        for (position, asked) in asked.iter().enumerate() {
            let mut values = Panel::new(&asked.name, &axis.name, &asked.vary);
            let mut waves = Panel::new("critical wavenumber", &axis.name, "k");
            let of = |column: usize| -> Vec<(f64, f64)> {
                let chosen = table.rows.iter().filter(|r| r[1] == (position + 1) as f64);
                chosen.map(|r| (r[0], r[column])).collect()
            };
            values.curve("", Style::Line, of(2));
            waves.curve("", Style::Line, of(3));
            drawn.push(values);
            if asked.minimize.is_some() {
                drawn.push(waves);
            }
        }
        picture(&mut outcome, "", &drawn, table);
    }
    Ok(outcome)
}

/// a0, a2 and A_e of each case.
pub(super) fn values(shop: &Workshop, figure: &str, cases: &[Case]) -> Result<Outcome> {
    let mut outcome = Outcome::default();
    let found = each(cases, &mut outcome.failures, |case| {
        let missing = || Error::input(format!("the case `{}` needs a wavenumber k", case.label));
        let k = case.k.ok_or_else(missing)?;
        shop.with_setup(case, |setup| {
            let base = setup.base(None)?;
            setup.with_point(&base, k, Selection::Leading, |point| {
                Ok([Some(point.c0.re), Some(point.c2.re), point.amplitude()])
            })
        })
    })?;
    for (index, values) in found {
        for (quantity, ours) in ["a0", "a2", "A_e"].into_iter().zip(values) {
            outcome.numbers.push(Number {
                figure: figure.to_owned(),
                quantity: named(&cases[index], quantity),
                ours,
                printed: cases[index].printed.get(quantity).copied(),
                note: cases[index].note.clone(),
            });
        }
    }
    Ok(outcome)
}
