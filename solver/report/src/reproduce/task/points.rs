//! Single numbers beside the printed ones: critical points, Landau points.

use super::super::outcome::{Number, Outcome};
use super::super::study::{Asked, Axis, Case, Of, named};
use super::super::table::Table;
use super::super::workshop::Workshop;
use super::draw::picture;
use super::rows::{amplitude, converged, rows};
use super::{Named, each};
use crate::figure::{Panel, Style};
use landau_solver::error::{Error, Result};
use landau_solver::study::critical::{self, Critical, Quantity, Question, Request, Tracking};
use landau_solver::study::sweep::RowMode;
use landau_solver::study::{Setup, Silent};

/// The first answer to a question of a study file for one case.
pub(super) fn critical_point(setup: &Setup, case: &Case, asked: &Asked) -> Result<Critical> {
    let of_case = asked.vary != "k" && asked.minimize.is_none();
    let request = Request {
        vary: &asked.vary,
        between: asked.between,
        of: match asked.of {
            Of::Growth => Quantity::Growth,
            Of::C2 => Quantity::C2,
            Of::Resonance => Quantity::Resonance,
        },
        k: asked.k.or(case.k.filter(|_| of_case)),
        minimize: asked.minimize,
        tracking: match asked.follow {
            true => Tracking::Fastest,
            false => Tracking::Leading,
        },
    };
    let question = Question::new(setup, &request)?;
    Ok(critical::critical(setup, &question, &Silent)?.swap_remove(0))
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
            // Without the last digits of a step.
            let shown = format!("{value:.10}");
            let shown = shown.trim_end_matches('0').trim_end_matches('.');
            let mut case = case.moved(&format!("{} = {shown}", axis.name));
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

/// A quantity of a Landau point: its value and error, or why it has none.
type Answer = std::result::Result<(f64, Option<f64>), String>;

/// a0, a2, A_e and derived columns of a case.
fn landau_point(setup: &Setup, k: f64, columns: &[String]) -> Result<Vec<Answer>> {
    let none = || "no equilibrium at cubic order".to_owned();
    // The row answers for what the point leaves open: where c2 is not converged, a0 may be.
    let row = rows(setup, None, "k", vec![k], RowMode::Leading, columns)?.remove(0);
    let mut answers: Vec<Answer> = match converged(setup, k) {
        Ok(answer) => vec![
            Ok((answer.point.c0.re, Some(answer.error.c0))),
            Ok((answer.point.c2.re, Some(answer.error.c2))),
            amplitude(&answer).map(|a| (a, None)).ok_or_else(none),
        ],
        Err(Error::Input(message)) => return Err(Error::Input(message)),
        Err(error) => {
            let reason = error.to_string();
            let a0 = row.c0.map(|c0| (c0[0], row.c0_error));
            vec![
                a0.ok_or_else(|| reason.clone()),
                Err(reason.clone()),
                Err(reason),
            ]
        }
    };
    let open = answers[1].as_ref().err().cloned();
    answers.extend(row.derived.into_iter().map(|value| match (&open, value) {
        (Some(reason), _) => Err(reason.clone()),
        (None, Some(value)) => Ok((value, None)),
        (None, None) => Err(none()),
    }));
    Ok(answers)
}

/// a0, a2, A_e and derived columns of each case.
pub(super) fn values(
    shop: &Workshop,
    figure: &str,
    cases: &[Case],
    columns: &[String],
) -> Result<Outcome> {
    let mut outcome = Outcome::default();
    let points = each(cases, &mut outcome.failures, |case| {
        let missing = || Error::input(format!("the case `{}` needs a wavenumber k", case.label));
        let k = case.k.ok_or_else(missing)?;
        landau_point(&shop.setup(case)?, k, columns)
    })?;
    let mut points = points.into_iter().peekable();
    for (index, case) in cases.iter().enumerate() {
        let answers = points.next_if(|(answered, _)| *answered == index);
        let quantities = ["a0", "a2", "A_e"].into_iter();
        let quantities = quantities.chain(columns.iter().map(String::as_str));
        for (position, quantity) in quantities.enumerate() {
            let label = named(case, quantity);
            let number = Number::new(figure, case, quantity, label.clone());
            let answer = match &answers {
                Some((_, answers)) => answers[position].clone(),
                None => Err(outcome.reason(&case.label)),
            };
            // A growth rate or a coefficient that is missing is a failure; a stable base state has no amplitude.
            if let (Err(reason), true) = (&answer, position < 2 && answers.is_some()) {
                outcome.failures.push(format!("{label}: {reason}"));
            }
            outcome.numbers.push(match answer {
                Ok((value, error)) => number.answered(value, error),
                Err(reason) => number.failed(&reason),
            });
        }
    }
    Ok(outcome)
}
