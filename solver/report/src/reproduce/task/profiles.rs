//! Base states over the cross-stream coordinate, and spectra over the wavenumber.

use super::super::outcome::{Number, Outcome};
use super::super::study::{Axis, Case, Mark, PanelOf, Tail, at_each, named};
use super::super::table::Table;
use super::super::workshop::Workshop;
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

/// What of base states is to be shown, and how.
pub(super) struct Wanted<'a> {
    pub figure: &'a str,
    pub fields: &'a [String],
    pub logarithmic: bool,
    pub tail: Option<&'a Tail>,
    pub panel: PanelOf,
    pub marks: &'a [Mark],
}

pub(super) fn profiles(shop: &Workshop, cases: &[Case], wanted: &Wanted) -> Result<Outcome> {
    let (figure, fields) = (wanted.figure, wanted.fields);
    let mut outcome = Outcome::default();
    let found = each(cases, &mut outcome.failures, |case| {
        let setup = shop.setup(case)?;
        let model = setup.model.as_ref();
        let base = setup.base(None)?;
        // A field is an expression too.
        let expressions = fields.iter().map(|text| expression(model, text));
        let expressions: Vec<Expression> = expressions.collect::<Result<_>>()?;
        let mut columns = vec![Vec::new(); fields.len() + 1];
        for place in base.space.evenly(POINTS) {
            let point = base.at(place, 0.0);
            columns[0].push(base.space.y(place));
            for (column, expression) in columns[1..].iter_mut().zip(&expressions) {
                column.push(expression.at_base(model.structure(), &point));
            }
        }
        let tail = wanted.tail;
        let heights = tail.map(|tail| scale_heights(&setup, &base, &columns, tail));
        Ok((columns, heights.transpose()?))
    })?;
    let first = shop.setup(&cases[0])?;
    let vertical = first.model.structure().coordinate.clone();
    let vertical = vertical.unwrap_or_default();
    let panel = |title: &str, y: &str| {
        let mut panel = Panel::new(title, &vertical, y);
        panel.logarithmic[1] = wanted.logarithmic;
        let marks = wanted.marks.iter();
        panel.marks = marks.map(|mark| (mark.at, mark.name.clone())).collect();
        panel
    };
    let mut drawn: Vec<Panel> = match wanted.panel {
        PanelOf::Field => fields.iter().map(|name| panel("", name)).collect(),
        PanelOf::Case => {
            let title = |(index, _): &(usize, _)| panel(&cases[*index].label, &fields.join(", "));
            found.iter().map(title).collect()
        }
    };
    let mut header = vec!["case", vertical.as_str()];
    header.extend(fields.iter().map(String::as_str));
    let mut table = Table::new(&header).with_words(&["label"]);
    for (position, (index, (columns, heights))) in found.into_iter().enumerate() {
        for (field, values) in columns[1..].iter().enumerate() {
            let points = columns[0].iter().copied().zip(values.iter().copied());
            let (panel, label, style) = match (wanted.panel, field) {
                (PanelOf::Field, _) => (field, &cases[index].label, Style::Line),
                (PanelOf::Case, 0) => (position, &fields[field], Style::Line),
                (PanelOf::Case, _) => (position, &fields[field], Style::Dashed),
            };
            drawn[panel].curve(label, style, points.collect());
        }
        for i in 0..POINTS {
            let mut row = vec![(index + 1) as f64];
            row.extend(columns.iter().map(|column| column[i]));
            table.push(row, &[&cases[index].label]);
        }
        if let Some((fitted, predicted)) = heights {
            let both = [
                ("scale height of the tail, fitted", Some(fitted)),
                ("predicted", predicted),
            ];
            for (quantity, value) in both {
                let label = named(&cases[index], quantity);
                let number = Number::new(figure, &cases[index], quantity, label);
                outcome
                    .numbers
                    .extend(value.map(|value| number.answered(value, None)));
            }
        }
    }
    picture(shop, &mut outcome, "", &drawn, table);
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
    let all = at_each(cases, resolutions);
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
    let panel = |case: &Case| Panel::new(&named(case, "least stable mode"), "k", "a0");
    let mut drawn: Vec<Panel> = cases.iter().map(panel).collect();
    let mut table = Table::new(&["case", "k", "L", "L†", "difference"]).with_words(&["label"]);
    let mut difference = Panel::new("L against L†", "k", "|c0(L) − conj c0(L†)|");
    difference.logarithmic[1] = true;
    for (index, rows) in found {
        let label = &all[index].label;
        let of =
            |column: usize| -> Vec<(f64, f64)> { rows.iter().map(|r| (r[0], r[column])).collect() };
        // Of one case after another, all resolutions.
        let panel = &mut drawn[index / resolutions.len()];
        let resolution = format!("M = {}", resolutions[index % resolutions.len()]);
        panel.curve(&format!("L, {resolution}"), Style::Line, of(1));
        panel.curve(&format!("L†, {resolution}"), Style::Dots, of(2));
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
    drawn.push(difference);
    picture(shop, &mut outcome, "", &drawn, table);
    Ok(outcome)
}

/// The eigenvalue of L† whose conjugate is nearest to c.
fn nearest_adjoint(problem: &Problem, k: f64, c: C64) -> Result<C64> {
    let values = spectrum::adjoint_eigenvalues(problem, k)?.values;
    let gap = |d: &C64| (d.conj() - c).norm();
    let nearest = values.into_iter().min_by(|a, b| gap(a).total_cmp(&gap(b)));
    nearest.ok_or_else(|| Error::computation("L† has no finite eigenvalue"))
}
