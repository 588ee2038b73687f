//! Single numbers beside the printed ones: critical points, Landau points.

use super::super::needs::Needs;
use super::super::outcome::{Number, Outcome};
use super::super::study::kinds::{self, Values};
use super::super::study::{Asked, Axis, Case, Of, named};
use super::super::table::Table;
use super::super::workshop::Workshop;
use super::draw::picture;
use super::rows::{amplitude, converged, rows};
use super::{Named, Place, Work, each};
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
        tracking: if asked.follow {
            Tracking::Fastest
        } else {
            Tracking::Leading
        },
    };
    let question = Question::new(setup, &request)?;
    Ok(critical::critical(setup, &question, &Silent)?.swap_remove(0))
}

/// One question about one case.
struct Inquiry<'a> {
    case: Case,
    label: String,
    /// Where it stands on the axis of a curve, or the number of the case.
    place: f64,
    question: usize,
    asked: &'a Asked,
}

impl Named for Inquiry<'_> {
    fn label(&self) -> &str {
        &self.label
    }
}

/// The answer to an inquiry, or why there is none.
type Found = std::result::Result<Critical, String>;

impl Work for kinds::Critical {
    fn needs(&self, of: &mut Needs) -> Result<()> {
        if let Some(over) = &self.against {
            of.axis("against", over)?;
        }
        of.questions("asked", &self.asked)
    }

    fn run(&self, shop: &Workshop, place: &Place) -> Result<Outcome> {
        let mut outcome = Outcome::default();
        let inquiries = self.inquiries();
        let points = each(&inquiries, &mut outcome.failures, |inquiry| {
            critical_point(&shop.setup(&inquiry.case)?, &inquiry.case, inquiry.asked)
        })?;
        let mut points = points.into_iter().peekable();
        let mut answers: Vec<(&Inquiry, Found)> = Vec::new();
        for (index, inquiry) in inquiries.iter().enumerate() {
            // What did not come out stays where its number would stand.
            let point = match points.next_if(|(answered, _)| *answered == index) {
                Some((_, point)) => Ok(point),
                None => Err(outcome.reason(&inquiry.label)),
            };
            answers.push((inquiry, point));
        }
        outcome.numbers = numbers(place.figure, &answers);
        if let Some(axis) = &self.against {
            let panels = self.panels(axis, &answers);
            let table = table(&axis.name, &answers);
            picture(shop, &mut outcome, "", &panels, table);
        }
        Ok(outcome)
    }
}

impl kinds::Critical {
    /// Every question about every case, each case moved along the axis that it is drawn against.
    fn inquiries(&self) -> Vec<Inquiry<'_>> {
        let mut inquiries = Vec::new();
        for (number, (case, place)) in along(&self.case, self.against.as_ref())
            .into_iter()
            .enumerate()
        {
            for (question, asked) in self.asked.iter().enumerate() {
                inquiries.push(Inquiry {
                    label: named(&case, &asked.name),
                    case: case.clone(),
                    place: place.unwrap_or((number + 1) as f64),
                    question,
                    asked,
                });
            }
        }
        inquiries
    }

    /// A panel a question, and one of the wavenumber where it is an extremum; a curve a case.
    fn panels(&self, axis: &Axis, answers: &[(&Inquiry, Found)]) -> Vec<Panel> {
        let mut panels = Vec::new();
        for (question, asked) in self.asked.iter().enumerate() {
            let mut values = Panel::new(&asked.name, &axis.name, &asked.vary);
            let mut waves = Panel::new("critical wavenumber", &axis.name, "k");
            let to_question = answers.iter().filter(|(i, _)| i.question == question);
            let to_question: Vec<&(&Inquiry, Found)> = to_question.collect();
            // One curve a case, along the axis.
            for (case, answers) in self.case.iter().zip(to_question.chunks(axis.count)) {
                let curve = |of: fn(&Critical) -> f64| {
                    let value = |answer: &Found| answer.as_ref().map_or(f64::NAN, of);
                    let points = answers.iter().map(|(i, answer)| (i.place, value(answer)));
                    points.collect()
                };
                let label = if self.case.len() > 1 { &case.label } else { "" };
                values.curve(label, Style::Line, curve(|point| point.value));
                waves.curve(label, Style::Line, curve(|point| point.k));
            }
            panels.push(values);
            if asked.minimize.is_some() {
                panels.push(waves);
            }
        }
        panels
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

/// The number of every inquiry; then, where it is an extremum, the wavenumber, which is an answer too.
fn numbers(figure: &str, answers: &[(&Inquiry, Found)]) -> Vec<Number> {
    let (mut numbers, mut extrema) = (Vec::new(), Vec::new());
    for (inquiry, answer) in answers {
        let (case, asked) = (&inquiry.case, inquiry.asked);
        let number = Number::new(figure, case, &asked.name, inquiry.label.clone());
        numbers.push(match answer {
            Ok(point) => number.answered(point.value, Some(point.error)),
            Err(reason) => number.failed(reason),
        });
        if let (Ok(point), true) = (answer, asked.minimize.is_some()) {
            let name = format!("k of {}", asked.name);
            let number = Number::new(figure, case, &name, named(case, &name));
            extrema.push(number.answered(point.k, None));
        }
    }
    numbers.extend(extrema);
    numbers
}

/// A row an inquiry.
fn table(axis: &str, answers: &[(&Inquiry, Found)]) -> Table {
    let header = [axis, "question", "value", "error", "k"];
    let mut table = Table::new(&header).with_words(&["label", "status"]);
    for (inquiry, answer) in answers {
        let (values, status) = match answer {
            Ok(point) => ([point.value, point.error, point.k], "ok"),
            Err(reason) => ([f64::NAN; 3], reason.as_str()),
        };
        let place = [inquiry.place, (inquiry.question + 1) as f64];
        let row = place.into_iter().chain(values);
        table.push(row.collect(), &[&inquiry.label, status]);
    }
    table
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

impl Work for Values {
    fn needs(&self, of: &mut Needs) -> Result<()> {
        for (index, text) in self.columns.iter().enumerate() {
            let spot = of.spot.entry("columns", index, "columns".to_owned());
            of.column(&spot, text)?;
        }
        Ok(())
    }

    /// a0, a2, A_e and derived columns of each case.
    fn run(&self, shop: &Workshop, place: &Place) -> Result<Outcome> {
        let mut outcome = Outcome::default();
        let points = each(&self.case, &mut outcome.failures, |case| {
            let missing =
                || Error::input(format!("the case `{}` needs a wavenumber k", case.label));
            let k = case.k.ok_or_else(missing)?;
            landau_point(&shop.setup(case)?, k, &self.columns)
        })?;
        let mut points = points.into_iter().peekable();
        for (index, case) in self.case.iter().enumerate() {
            let answers = points.next_if(|(answered, _)| *answered == index);
            let quantities = ["a0", "a2", "A_e"].into_iter();
            let quantities = quantities.chain(self.columns.iter().map(String::as_str));
            for (position, quantity) in quantities.enumerate() {
                let label = named(case, quantity);
                let number = Number::new(place.figure, case, quantity, label.clone());
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
}
