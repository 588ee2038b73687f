//! Base states over the cross-stream coordinate, and spectra over the wavenumber.

use super::super::Workshop;
use super::super::outcome::{Number, Outcome, Table};
use super::super::study::{Axis, Case, Tail, named};
use super::draw::picture;
use super::each;
use crate::figure::{Panel, Style};
use crate::library::expression;
use landau_solver::base::BaseState;
use landau_solver::error::{Error, Result};
use landau_solver::model::{C64, End, Expression};
use landau_solver::problem::Problem;
use landau_solver::spectrum;
use landau_solver::study::Setup;
use landau_solver::study::quadrature::adjoint_mode;

/// Points of a profile.
const POINTS: usize = 401;

pub(super) fn profiles(
    shop: &Workshop,
    figure: &str,
    cases: &[Case],
    fields: &[String],
    logarithmic: bool,
    tail: Option<&Tail>,
) -> Result<Outcome> {
    let mut outcome = Outcome::default();
    let found = each(cases, &mut outcome.failures, |case| {
        let setup = shop.setup(case)?;
        let model = setup.model.as_ref();
        let base = setup.base(None)?;
        // A field is an expression too.
        let wanted = fields.iter().map(|text| expression(model, text));
        let wanted: Vec<Expression> = wanted.collect::<Result<_>>()?;
        let mut columns = vec![Vec::new(); fields.len() + 1];
        for place in base.space.evenly(POINTS) {
            let point = base.at(place, 0.0);
            columns[0].push(base.space.y(place));
            for (column, expression) in columns[1..].iter_mut().zip(&wanted) {
                column.push(expression.at_base(model.structure(), &point));
            }
        }
        let heights = tail.map(|tail| scale_heights(&setup, &base, &columns, tail));
        Ok((columns, heights.transpose()?))
    })?;
    let first = shop.setup(&cases[0])?;
    let vertical = first.model.structure().coordinate.clone();
    let vertical = vertical.unwrap_or_default();
    let mut drawn: Vec<Panel> = fields
        .iter()
        .map(|name| {
            let mut panel = Panel::new(&format!("base state: {name}"), &vertical, name);
            panel.logarithmic[1] = logarithmic;
            panel
        })
        .collect();
    let mut header = vec!["case", vertical.as_str()];
    header.extend(fields.iter().map(String::as_str));
    let mut table = Table::new(&header).with_words(&["label"]);
    for (index, (columns, heights)) in found {
        for (panel, values) in drawn.iter_mut().zip(&columns[1..]) {
            let points = columns[0].iter().copied().zip(values.iter().copied());
            panel.curve(&cases[index].label, Style::Line, points.collect());
        }
        for i in 0..POINTS {
            let mut row = vec![(index + 1) as f64];
            row.extend(columns.iter().map(|column| column[i]));
            table.push(row, &[&cases[index].label]);
        }
        if let Some((fitted, predicted)) = heights {
            let quantity = "scale height of the tail, fitted";
            let label = named(&cases[index], quantity);
            let number = Number::new(figure, &cases[index], quantity, label);
            outcome.numbers.push(Number {
                note: predicted.map_or(String::new(), |h| format!("predicted: {h:.4}")),
                ..number.answered(fitted, None)
            });
        }
    }
    picture(&mut outcome, "", &drawn, table);
    Ok(outcome)
}

/// h of exp(−y/h), fitted, and what it ought to be.
fn scale_heights(
    setup: &Setup,
    base: &BaseState,
    columns: &[Vec<f64>],
    tail: &Tail,
) -> Result<(f64, Option<f64>)> {
    let place = |fraction: f64| ((POINTS - 1) as f64 * fraction).round() as usize;
    let [a, b] = tail.between.map(|fraction| place(fraction.clamp(0.0, 1.0)));
    let fall = (columns[1][a] / columns[1][b]).ln();
    let predicted = tail.predicted.as_ref().map(|text| {
        let expression = expression(setup.model.as_ref(), text)?;
        let top = base.at_end(End::Upper);
        Ok::<f64, Error>(expression.at_base(base.structure(), &top))
    });
    Ok((
        (columns[0][b] - columns[0][a]) / fall,
        predicted.transpose()?,
    ))
}

pub(super) fn spectrum(
    shop: &Workshop,
    figure: &str,
    cases: &[Case],
    over: &Axis,
    resolutions: &[usize],
) -> Result<Outcome> {
    let mut outcome = Outcome::default();
    let all: Vec<Case> = cases
        .iter()
        .flat_map(|case| {
            resolutions.iter().map(|&resolution| Case {
                label: named(case, &format!("M = {resolution}")),
                resolution: Some(resolution),
                ..case.clone()
            })
        })
        .collect();
    let found = each(&all, &mut outcome.failures, |case| {
        let setup = shop.setup(case)?;
        let problem = &setup.problem(&setup.base(None)?)?;
        let mut rows = Vec::new();
        for k in over.values() {
            let mode = spectrum::leading(problem, k)?;
            // Where inverse iteration finds no isolated partner, the nearest of all of L†.
            let adjoint = match adjoint_mode(problem, &mode) {
                Ok(adjoint) => adjoint.c,
                Err(_) => nearest_adjoint(problem, k, mode.c)?,
            };
            let gap = (adjoint.conj() - mode.c).norm();
            rows.push([k, mode.c.re, adjoint.re, gap]);
        }
        Ok(rows)
    })?;
    let mut panel = Panel::new("least stable mode", "k", "growth rate");
    let mut table = Table::new(&["case", "k", "L", "L†", "difference"]).with_words(&["label"]);
    let mut difference = Panel::new("L against L†", "k", "|difference|");
    difference.logarithmic[1] = true;
    for (index, rows) in found {
        let label = &all[index].label;
        let of =
            |column: usize| -> Vec<(f64, f64)> { rows.iter().map(|r| (r[0], r[column])).collect() };
        panel.curve(&format!("L, {label}"), Style::Line, of(1));
        panel.curve(&format!("L†, {label}"), Style::Dots, of(2));
        let quantity = format!("largest |L − L†| over {}", over.name);
        let number = Number::new(
            figure,
            &all[index],
            &quantity,
            format!("{label}: {quantity}"),
        );
        // A gap that is no number is larger than any.
        let wider = |most: f64, row: &[f64; 4]| match row[3].is_nan() || row[3] > most {
            true => row[3],
            false => most,
        };
        outcome
            .numbers
            .push(number.answered(rows.iter().fold(0.0, wider), None));
        difference.curve(label, Style::Line, of(3));
        for row in &rows {
            let [k, direct, adjoint, gap] = *row;
            let row = vec![(index + 1) as f64, k, direct, adjoint, gap];
            table.push(row, &[label]);
        }
    }
    picture(&mut outcome, "", &[panel, difference], table);
    Ok(outcome)
}

/// The eigenvalue of L† whose conjugate is nearest to c.
fn nearest_adjoint(problem: &Problem, k: f64, c: C64) -> Result<C64> {
    let values = spectrum::adjoint_eigenvalues(problem, k)?.values;
    let gap = |d: &C64| (d.conj() - c).norm();
    let nearest = values.into_iter().min_by(|a, b| gap(a).total_cmp(&gap(b)));
    nearest.ok_or_else(|| Error::computation("L† has no finite eigenvalue"))
}
