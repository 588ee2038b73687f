//! How a0 and a2 come nearer with the number of collocation points.

use super::super::needs::Needs;
use super::super::outcome::{Number, Outcome};
use super::super::study::kinds::Convergence;
use super::super::study::{at_each, named};
use super::super::table::Table;
use super::super::workshop::Workshop;
use super::draw::picture;
use super::rows::{nothing_in, rows};
use super::{Place, Work, each};
use crate::figure::{Panel, Style};
use landau_solver::error::Result;
use landau_solver::study::row::{Column, Row, column};
use landau_solver::study::sweep::RowMode;

impl Work for Convergence {
    fn needs(&self, of: &mut Needs) -> Result<()> {
        of.axis("over", &self.over)
    }

    /// a0 over k at several M, and how far a0 and a2 are from those of the last M.
    fn run(&self, shop: &Workshop, place: &Place) -> Result<Outcome> {
        let (over, count) = (&self.over, self.resolutions.len());
        let mut outcome = Outcome::default();
        // Of each case after the one before, all resolutions.
        let all = at_each(&self.case, &self.resolutions);
        let followed = RowMode::Followed(None);
        let answers = each(&all, &mut outcome.failures, |case| {
            let setup = shop.setup(case)?;
            rows(&setup, case.k, &over.name, over.values(), followed, &[])
        })?;
        let mut rows_at: Vec<Vec<Row>> = vec![Vec::new(); all.len()];
        for (index, rows) in answers {
            rows_at[index] = rows;
        }
        let header = ["case", &over.name, "M", "a0", "a2", "a0 error", "a2 error"];
        let mut table = Table::new(&header).with_words(&["label", "status"]);
        let mut panels = self.panels();
        let groups = all.chunks(count).zip(rows_at.chunks(count));
        for (position, (cases, rows_at)) in groups.enumerate() {
            for (index, (case, rows)) in cases.iter().zip(rows_at).enumerate() {
                let (label, resolution) = (&case.label, self.resolutions[index]);
                outcome.failures.extend(nothing_in(label, rows));
                let is_finest = index + 1 == count;
                let style = if is_finest { Style::Line } else { Style::Dots };
                panels[0].curve(label, style, column(rows, Column::A0));
                let distances = distances(rows, &rows_at[count - 1]);
                for (row, [a0, a2]) in rows.iter().zip(&distances) {
                    let place = [(position + 1) as f64, row.coordinates[0], resolution as f64];
                    let values = [real(row.c0), real(row.c2), *a0, *a2];
                    let numbers = place.into_iter().chain(values);
                    table.push(numbers.collect(), &[label, &row.status]);
                }
                if is_finest {
                    continue;
                }
                let names = ["largest distance of a0", "largest distance of a2"];
                for (quantity, (panel, name)) in panels[1..].iter_mut().zip(names).enumerate() {
                    let places = rows.iter().map(|row| row.coordinates[0]);
                    let values = distances.iter().map(|distance| distance[quantity]);
                    panel.curve(label, Style::Line, places.zip(values.clone()).collect());
                    let number = Number::new(place.figure, case, name, named(case, name));
                    outcome.numbers.push(number.answered(largest(values), None));
                }
            }
        }
        picture(shop, &mut outcome, "", &panels, table);
        Ok(outcome)
    }
}

impl Convergence {
    /// Of a0, and of the distances of a0 and of a2; still without curves.
    fn panels(&self) -> Vec<Panel> {
        let mut panels = vec![Panel::new("least stable mode", &self.over.name, "a0")];
        for quantity in ["a0, relative to its largest", "a2, relative"] {
            let mut panel = Panel::new("distance from the finest M", &self.over.name, quantity);
            panel.logarithmic[1] = true;
            panels.push(panel);
        }
        panels
    }
}

/// The real part of a coefficient; a gap where it has no value.
fn real(c: Option<[f64; 2]>) -> f64 {
    c.map_or(f64::NAN, |c| c[0])
}

/// How far a0 of each row, relative to the largest of the finest, and a2, relative to its size there, are from those of the
/// finest.
fn distances(rows: &[Row], finest: &[Row]) -> Vec<[f64; 2]> {
    let scale = finest
        .iter()
        .map(|row| real(row.c0).abs())
        .fold(0.0, f64::max);
    let gap = |a: Option<[f64; 2]>, b: Option<[f64; 2]>| match (a, b) {
        (Some(a), Some(b)) => (a[0] - b[0]).abs(),
        _ => f64::NAN,
    };
    let distance = |(row, fine): (&Row, &Row)| {
        let size = fine.c2.map_or(f64::NAN, |c| c[0].abs());
        [gap(row.c0, fine.c0) / scale, gap(row.c2, fine.c2) / size]
    };
    rows.iter().zip(finest).map(distance).collect()
}

/// The largest distance; one that is no number is larger than any.
fn largest(distances: impl Iterator<Item = f64>) -> f64 {
    distances.fold(0.0, |most, distance| {
        if distance.is_nan() || distance > most {
            distance
        } else {
            most
        }
    })
}
