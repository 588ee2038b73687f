//! Single numbers beside the printed ones: critical points, Landau points.

use super::super::outcome::{Number, Outcome, Table};
use super::super::study::{Asked, Axis, Case, Of, named};
use super::super::workshop::Workshop;
use super::draw::picture;
use super::rows::rows;
use super::{Named, each};
use crate::figure::{Panel, Style};
use landau_solver::error::{Error, Result};
use landau_solver::study::accuracy::accuracy;
use landau_solver::study::critical::{self, Critical, Quantity, Question};
use landau_solver::study::minimise;
use landau_solver::study::{self, Setup, Silent};
use landau_solver::weakly::Selection;

/// The question of a study file for one case.
pub(super) fn question(setup: &Setup, case: &Case, asked: &Asked) -> Result<Question> {
    Ok(Question {
        axis: study::Axis::named(setup.model.as_ref(), &asked.vary)?,
        from: asked.between[0],
        to: asked.between[1],
        quantity: match asked.of {
            Of::Growth => Quantity::Growth,
            Of::C2 => Quantity::C2,
            Of::Resonance => Quantity::Resonance,
        },
        k: asked.k.or(case.k),
        near: None,
    })
}

/// The first answer of a question.
pub(super) fn critical_point(setup: &Setup, case: &Case, asked: &Asked) -> Result<Critical> {
    let question = question(setup, case, asked)?;
    match asked.minimize {
        Some([from, to]) => minimise::minimise(setup, question, (from, to), &Silent),
        None => Ok(critical::critical(setup, question, &Silent)?.swap_remove(0)),
    }
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
            // Without the last digits of a step.
            let shown = format!("{value:.10}");
            let shown = shown.trim_end_matches('0').trim_end_matches('.');
            case.label = named(&case, &format!("{} = {shown}", axis.name));
            match axis.name.as_str() {
                "k" => case.k = Some(value),
                name => case.set.push(format!("{name}={value}")),
            }
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
        critical_point(&shop.setup(&inquiry.case)?, &inquiry.case, asked)
    })?;
    let first = against.map_or("case", |a| a.name.as_str());
    let mut table =
        Table::new(&[first, "question", "value", "error", "k"]).with_words(&["label", "status"]);
    let mut found = found.into_iter().peekable();
    let mut extrema = Vec::new();
    for (index, inquiry) in inquiries.iter().enumerate() {
        let Inquiry {
            case,
            label,
            place,
            question,
        } = inquiry;
        let position = (question + 1) as f64;
        let number = Number::new(figure, case, &asked[*question].name, label.clone());
        // What did not come out stays where its number would stand.
        let number = match found.next_if(|(found, _)| *found == index) {
            Some((_, point)) => {
                let row = vec![*place, position, point.value, point.error, point.k];
                table.push(row, &[label, "ok"]);
                // Where it is an extremum, the wavenumber is an answer too.
                if asked[*question].minimize.is_some() {
                    let name = format!("k of {}", asked[*question].name);
                    let of = Number::new(figure, case, &name, named(case, &name));
                    extrema.push(of.answered(point.k, None));
                }
                number.answered(point.value, Some(point.error))
            }
            None => {
                let reason = outcome.reason(label);
                let gap = f64::NAN;
                table.push(vec![*place, position, gap, gap, gap], &[label, &reason]);
                number.failed(&reason)
            }
        };
        outcome.numbers.push(number);
    }
    outcome.numbers.extend(extrema);
    if let Some(axis) = against {
        let mut drawn = Vec::new();
        for (position, asked) in asked.iter().enumerate() {
            let mut values = Panel::new(&asked.name, &axis.name, &asked.vary);
            let mut waves = Panel::new("critical wavenumber", &axis.name, "k");
            let own = table.rows.iter().filter(|r| r[1] == (position + 1) as f64);
            let own: Vec<&Vec<f64>> = own.collect();
            // One curve a case, along the axis.
            for (case, rows) in cases.iter().zip(own.chunks(axis.values().len())) {
                let of = |column: usize| rows.iter().map(|r| (r[0], r[column])).collect();
                let label = if cases.len() > 1 { &case.label } else { "" };
                values.curve(label, Style::Line, of(2));
                waves.curve(label, Style::Line, of(4));
            }
            drawn.push(values);
            if asked.minimize.is_some() {
                drawn.push(waves);
            }
        }
        picture(shop, &mut outcome, "", &drawn, table);
    }
    Ok(outcome)
}

/// a0, a2, A_e and derived columns of each case.
pub(super) fn values(
    shop: &Workshop,
    figure: &str,
    cases: &[Case],
    columns: &[String],
) -> Result<Outcome> {
    let mut outcome = Outcome::default();
    let found = each(cases, &mut outcome.failures, |case| {
        let missing = || Error::input(format!("the case `{}` needs a wavenumber k", case.label));
        let k = case.k.ok_or_else(missing)?;
        let setup = shop.setup(case)?;
        let point = setup.point(&setup.base(None)?, k, Selection::Leading)?;
        let error = accuracy(&setup, &point)?;
        let mut values = vec![
            (Some(point.c0.re), Some(error.c0)),
            (Some(point.c2.re), Some(error.c2)),
            (point.amplitude(), None),
        ];
        if !columns.is_empty() {
            let row = rows(&setup, None, "k", vec![k], columns)?.remove(0);
            values.extend(row.derived.into_iter().map(|value| (value, None)));
        }
        Ok(values)
    })?;
    let mut found = found.into_iter().peekable();
    for (index, case) in cases.iter().enumerate() {
        let own = found.next_if(|(found, _)| *found == index);
        let quantities = ["a0", "a2", "A_e"].into_iter();
        let quantities = quantities.chain(columns.iter().map(String::as_str));
        for (position, quantity) in quantities.enumerate() {
            let number = Number::new(figure, case, quantity, named(case, quantity));
            outcome.numbers.push(match &own {
                Some((_, values)) => match values[position] {
                    (Some(value), error) => number.answered(value, error),
                    (None, _) => number.failed("no equilibrium at cubic order"),
                },
                None => number.failed(&outcome.reason(&case.label)),
            });
        }
    }
    Ok(outcome)
}
