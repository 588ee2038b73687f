//! Single numbers beside the printed ones: critical points, Landau points.

use super::super::Workshop;
use super::super::outcome::{Number, Outcome, Table};
use super::super::study::{Asked, Axis, Case, Of};
use super::draw::{named, picture};
use super::{Named, each};
use crate::figure::{Panel, Style};
use landau_solver::error::{Error, Result};
use landau_solver::study::critical::{self, Quantity, Question};
use landau_solver::study::minimise;
use landau_solver::study::{self, Setup, Silent};
use landau_solver::weakly::Selection;

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
    let found = match asked.minimize {
        Some([from, to]) => minimise::minimise(setup, question, (from, to), &Silent)?,
        None => critical::critical(setup, question, &Silent)?.swap_remove(0),
    };
    Ok([found.value, found.k])
}

/// One question about one case.
struct Inquiry {
    case: Case,
    label: String,
    /// Where it stands on the axis of a curve, or the number of the case.
    place: f64,
    question: usize,
}

impl Named for Inquiry {
    fn label(&self) -> &str {
        &self.label
    }
}

/// The cases, each moved along the axis that they are drawn against.
fn along(cases: &[Case], against: Option<&Axis>) -> Vec<(Case, Option<f64>)> {
    let Some(axis) = against else {
        return cases.iter().map(|case| (case.clone(), None)).collect();
    };
    let mut moved = Vec::new();
    for case in cases {
        for value in axis.values() {
            let mut case = case.clone();
            case.label = named(&case, &format!("{} = {value}", axis.name));
            case.set.push(format!("{}={value}", axis.name));
            moved.push((case, Some(value)));
        }
    }
    moved
}

pub(super) fn critical(
    shop: &Workshop,
    figure: &str,
    cases: &[Case],
    asked: &[Asked],
    against: Option<&Axis>,
) -> Result<Outcome> {
    let mut outcome = Outcome::default();
    let mut inquiries: Vec<Inquiry> = Vec::new();
    for (number, (case, place)) in along(cases, against).into_iter().enumerate() {
        for (question, asked) in asked.iter().enumerate() {
            inquiries.push(Inquiry {
                label: named(&case, &asked.name),
                case: case.clone(),
                place: place.unwrap_or((number + 1) as f64),
                question,
            });
        }
    }
    let found = each(&inquiries, &mut outcome.failures, |inquiry| {
        let asked = &asked[inquiry.question];
        shop.with_setup(&inquiry.case, |setup| answer(setup, &inquiry.case, asked))
    })?;
    let mut table = Table::new(&[
        against.map_or("case", |a| a.name.as_str()),
        "question",
        "value",
        "k",
    ]);
    for (index, [value, k]) in found {
        let Inquiry {
            case,
            label,
            place,
            question,
        } = &inquiries[index];
        let number = (question + 1) as f64;
        table.rows.push(vec![*place, number, value, k]);
        outcome.numbers.push(Number {
            figure: figure.to_owned(),
            quantity: label.clone(),
            ours: Some(value),
            printed: case.printed.get(&asked[*question].name).copied(),
            note: case.note.clone(),
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
