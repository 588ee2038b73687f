//! How a0 and a2 come nearer with the number of collocation points.

use super::super::outcome::{Number, Outcome};
use super::super::study::{Axis, Case, at_each, named};
use super::super::table::Table;
use super::super::workshop::Workshop;
use super::draw::picture;
use super::each;
use super::rows::{nothing_in, rows};
use crate::figure::{Panel, Style};
use landau_solver::error::Result;
use landau_solver::study::row::{Column, Row, column};
use landau_solver::study::sweep::RowMode;

/// a0 over k at several M, and how far a0 and a2 are from those of the last M.
pub(super) fn convergence(
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
        rows(
            &setup,
            case.k,
            &over.name,
            over.values(),
            RowMode::Followed(None),
            &[],
        )
    })?;
    let mut table = Table::new(&["case", &over.name, "M", "a0", "a2", "a0 error", "a2 error"])
        .with_words(&["label", "status"]);
    let mut drawn = vec![Panel::new("least stable mode", &over.name, "a0")];
    for quantity in ["a0, relative to its largest", "a2, relative"] {
        let mut panel = Panel::new("distance from the finest M", &over.name, quantity);
        panel.logarithmic[1] = true;
        drawn.push(panel);
    }
    let of_case = |index: usize| -> &[Row] {
        let own = found.iter().find(|(i, _)| *i == index);
        own.map_or(&[], |(_, rows)| rows.as_slice())
    };
    for position in 0..cases.len() {
        let first = position * resolutions.len();
        let finest = of_case(first + resolutions.len() - 1);
        for (index, resolution) in resolutions.iter().enumerate() {
            let (own, label) = (of_case(first + index), &all[first + index].label);
            outcome.failures.extend(nothing_in(label, own));
            let style = if index + 1 == resolutions.len() {
                Style::Line
            } else {
                Style::Dots
            };
            drawn[0].curve(label, style, column(own, Column::A0));
            let part = |c: Option<[f64; 2]>| c.map_or(f64::NAN, |c| c[0]);
            let scale = finest
                .iter()
                .map(|row| part(row.c0).abs())
                .fold(0.0, f64::max);
            let mut largest = [0.0_f64; 2];
            let mut errors: [Vec<(f64, f64)>; 2] = [Vec::new(), Vec::new()];
            for (row, fine) in own.iter().zip(finest) {
                let gap = |a: Option<[f64; 2]>, b: Option<[f64; 2]>| match (a, b) {
                    (Some(a), Some(b)) => (a[0] - b[0]).abs(),
                    _ => f64::NAN,
                };
                let size = fine.c2.map_or(f64::NAN, |c| c[0].abs());
                let both = [gap(row.c0, fine.c0) / scale, gap(row.c2, fine.c2) / size];
                let x = row.coordinates[0];
                for ((list, most), error) in errors.iter_mut().zip(&mut largest).zip(both) {
                    list.push((x, error));
                    // A gap that is no number is larger than any.
                    if error.is_nan() || error > *most {
                        *most = error;
                    }
                }
                let numbers = vec![
                    (position + 1) as f64,
                    x,
                    *resolution as f64,
                    part(row.c0),
                    part(row.c2),
                    both[0],
                    both[1],
                ];
                table.push(numbers, &[label, &row.status]);
            }
            if index + 1 == resolutions.len() {
                continue;
            }
            let names = ["largest distance of a0", "largest distance of a2"];
            for (panel, ((list, most), name)) in drawn[1..]
                .iter_mut()
                .zip(errors.into_iter().zip(largest).zip(names))
            {
                panel.curve(label, Style::Line, list);
                let own = &all[first + index];
                let number = Number::new(figure, own, name, named(own, name));
                outcome.numbers.push(number.answered(most, None));
            }
        }
    }
    picture(shop, &mut outcome, "", &drawn, table);
    Ok(outcome)
}
