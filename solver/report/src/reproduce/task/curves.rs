//! Landau coefficients along an axis.

use super::super::needs::{Needs, derived};
use super::super::outcome::Outcome;
use super::super::study::kinds::Sweep;
use super::super::study::{Asked, Case, Drawn, Of, Reference, Together, named};
use super::super::table::Table;
use super::super::workshop::Workshop;
use super::draw::picture;
use super::marks::marked;
use super::rows::{nothing_in, rows};
use super::{Place, Work, each};
use crate::figure::{Panel, Style};
use landau_solver::error::{Error, Result};
use landau_solver::study::critical::Critical;
use landau_solver::study::row::{Column, NUMBERS, Row, column};
use landau_solver::study::sweep::RowMode;

impl Work for Sweep {
    fn needs(&self, of: &mut Needs) -> Result<()> {
        of.axis("over", &self.over)?;
        for (index, text) in derived(&self.columns) {
            let spot = of.spot.entry("columns", index, "columns".to_owned());
            of.column(&spot, text)?;
        }
        of.questions("mark", &self.mark)
    }

    fn run(&self, shop: &Workshop, place: &Place) -> Result<Outcome> {
        let mut outcome = Outcome::default();
        let mode = if self.follow {
            RowMode::Followed(None)
        } else {
            RowMode::Leading
        };
        let (over, derived) = (&self.over, self.derived());
        let rows_of_cases = each(&self.case, &mut outcome.failures, |case| {
            let setup = shop.setup(case)?;
            rows(&setup, case.k, &over.name, over.values(), mode, &derived)
        })?;
        let marks = marked(shop, place.figure, &self.case, &self.mark, &mut outcome)?;
        let ends = marks.iter().filter(|(asked, _)| asked.of != Of::C2);
        let ends: Vec<f64> = ends.map(|(_, point)| point.value).collect();
        let mut panels = self.panels(&marks);
        for (index, rows) in &rows_of_cases {
            let case = &self.case[*index];
            outcome.failures.extend(nothing_in(&case.label, rows));
            // The marks are those of the first case.
            let ends = if *index == 0 { ends.as_slice() } else { &[] };
            self.draw(&mut panels, case, rows, ends);
        }
        self.draw_printed(shop, &mut panels)?;
        let caption = caption(rows_of_cases.iter().flat_map(|(_, rows)| rows));
        let table = self.table(&rows_of_cases);
        picture(shop, &mut outcome, &caption, &panels, table);
        Ok(outcome)
    }
}

impl Sweep {
    /// Derived columns, of all panels.
    fn derived(&self) -> Vec<String> {
        let drawn = self.columns.iter().flat_map(Together::drawn);
        drawn.filter_map(Drawn::derived).collect()
    }

    /// The panels, still without curves.
    fn panels(&self, marks: &[(Asked, Critical)]) -> Vec<Panel> {
        let panel = |together: &Together| {
            let (titles, ys): (Vec<String>, Vec<String>) =
                together.drawn().iter().map(names).unzip();
            let mut panel = Panel::new(&titles.join(", "), &self.over.name, &ys.join(", "));
            let marks = marks.iter();
            panel.marks = marks
                .map(|(asked, point)| (point.value, asked.name.clone()))
                .collect();
            panel.range = Some([self.over.from, self.over.to]);
            panel.logarithmic = self.logarithmic;
            panel
        };
        self.columns.iter().map(panel).collect()
    }

    /// The curves of a case; its amplitude ends at `ends`.
    fn draw(&self, panels: &mut [Panel], case: &Case, rows: &[Row], ends: &[f64]) {
        let derived = self.derived();
        for (panel, together) in panels.iter_mut().zip(&self.columns) {
            for quantity in together.drawn() {
                // In a panel of several quantities, each by its name.
                let label = match together.drawn() {
                    [_] => case.label.clone(),
                    _ => named(case, &names(quantity).1),
                };
                match quantity {
                    Drawn::Point(Column::A0) => {
                        panel.curve(&label, Style::Line, column(rows, Column::A0));
                    }
                    Drawn::Point(Column::Amplitude) => {
                        let points = ended(column(rows, Column::Amplitude), ends);
                        panel.curve_with_poles(&label, Style::Line, points);
                    }
                    Drawn::Point(quantity) => {
                        panel.curve_with_poles(&label, Style::Line, column(rows, *quantity));
                    }
                    Drawn::Derived(text) => {
                        let index = derived.iter().position(|d| d == text);
                        let value = |row: &Row| index.and_then(|i| row.derived[i]);
                        let points = rows
                            .iter()
                            .map(|row| (row.coordinates[0], value(row).unwrap_or(f64::NAN)));
                        panel.curve(&label, Style::Line, points.collect());
                    }
                }
            }
        }
    }

    /// What the source prints on the axis, and the points of others.
    fn draw_printed(&self, shop: &Workshop, panels: &mut [Panel]) -> Result<()> {
        let printed = printed(&self.case[0], &self.mark);
        if !printed.is_empty() && !self.logarithmic[1] {
            panels[0].curve("printed", Style::Dots, printed);
        }
        let count = panels.len();
        for asked in &self.reference {
            let points = reference(shop, asked)?;
            let panel = asked.panel.checked_sub(1).and_then(|i| panels.get_mut(i));
            let none = || {
                Error::input(format!(
                    "reference {}: panel = {} of {count}",
                    asked.file, asked.panel
                ))
            };
            panel
                .ok_or_else(none)?
                .curve(&asked.label, Style::Dots, points);
        }
        Ok(())
    }

    /// All rows, with the names of a sweep's own table.
    fn table(&self, rows_of_cases: &[(usize, Vec<Row>)]) -> Table {
        let derived = self.derived();
        let header = ["case", &self.over.name].into_iter().chain(NUMBERS);
        let header: Vec<&str> = header.chain(derived.iter().map(String::as_str)).collect();
        let mut table = Table::new(&header).with_words(&["label", "bifurcation", "status"]);
        for (index, rows) in rows_of_cases {
            let label = &self.case[*index].label;
            for row in rows {
                let place = [(index + 1) as f64, row.coordinates[0]];
                let values = row.numbers().into_iter().chain(row.derived.iter().copied());
                let values = values.map(|x| x.unwrap_or(f64::NAN));
                let numbers = place.into_iter().chain(values);
                table.push(numbers.collect(), &[label, &row.bifurcation, &row.status]);
            }
        }
        table
    }
}

/// The title of a column's panel, and the name of its values.
fn names(column: &Drawn) -> (String, String) {
    let (title, name) = match column {
        Drawn::Point(Column::A0) => ("growth rate", "a0"),
        Drawn::Point(Column::A2) => ("first Landau coefficient", "a2"),
        Drawn::Point(Column::Amplitude) => ("equilibrium amplitude", "A_e"),
        Drawn::Point(Column::Threshold) => ("threshold amplitude", "A_e"),
        Drawn::Derived(text) => (text.as_str(), text.as_str()),
    };
    (title.to_owned(), name.to_owned())
}

/// How many rows have no curve, in words.
fn caption<'r>(rows: impl Iterator<Item = &'r Row>) -> String {
    match rows.filter(|row| row.c2.is_none()).count() {
        0 => String::new(),
        1 => "1 point without a converged c2 is left out: the column `status` says why".to_owned(),
        count => {
            format!(
                "{count} points without a converged c2 are left out: the column `status` says why"
            )
        }
    }
}

/// Where the source prints critical points of a case, on the axis.
fn printed(case: &Case, marks: &[Asked]) -> Vec<(f64, f64)> {
    let printed = marks
        .iter()
        .filter_map(|asked| case.printed.get(&asked.name));
    printed.map(|printed| (printed.value, 0.0)).collect()
}

/// A curve that ends on the points where it vanishes, as A_e does on a bifurcation and on a resonance.
fn ended(mut points: Vec<(f64, f64)>, ends: &[f64]) -> Vec<(f64, f64)> {
    for &end in ends {
        let at = points.partition_point(|p| p.0 < end);
        let has_amplitude = |i: Option<usize>| {
            i.and_then(|i| points.get(i))
                .is_some_and(|p| p.1.is_finite())
        };
        // On the side that has an amplitude; a gap on the opposite one.
        match (has_amplitude(at.checked_sub(1)), has_amplitude(Some(at))) {
            (true, false) | (false, true) => points.insert(at, (end, 0.0)),
            _ => {}
        }
    }
    points
}

/// The points of somebody else's curve.
fn reference(shop: &Workshop, asked: &Reference) -> Result<Vec<(f64, f64)>> {
    let wrong = |what: String| Error::input(format!("{}: {what}", asked.file));
    let text = shop.study.read_beside(&asked.file)?;
    let point = |(index, line): (usize, &str)| {
        let mut cells = line.split(',').map(|cell| cell.trim().parse::<f64>());
        match (cells.next(), cells.next(), cells.next()) {
            (Some(Ok(x)), Some(Ok(y)), None) if x.is_finite() && y.is_finite() => Ok((x, y)),
            _ => Err(wrong(format!(
                "line {} is not two numbers with a comma between",
                index + 1
            ))),
        }
    };
    let lines = text.lines().enumerate().skip(1);
    lines
        .filter(|(_, line)| !line.trim().is_empty())
        .map(point)
        .collect()
}
