//! Landau coefficients along an axis, the 2:1 resonance, power laws at a bifurcation.

use super::super::outcome::{Number, Outcome};
use super::super::study::{Asked, Axis, Case, Drawn, Of, Reference, Together, named};
use super::super::table::Table;
use super::super::workshop::Workshop;
use super::draw::picture;
use super::each;
use super::points::critical_point;
use super::rows::{nothing_in, rows};
use crate::figure::{Panel, Style};
use landau_solver::error::{Error, Result};
use landau_solver::study::critical::Critical;
use landau_solver::study::row::{Column, NUMBERS, Row, column};
use landau_solver::study::sweep::RowMode;
use rayon::prelude::*;

/// The critical points that are to be marked: those of the first case. They are numbers too, and so are those of any
/// other case that has them printed, whether they come out or not.
fn marked(
    shop: &Workshop,
    figure: &str,
    cases: &[Case],
    marks: &[Asked],
    outcome: &mut Outcome,
) -> Result<Vec<(Asked, Critical)>> {
    for case in &cases[1..] {
        let printed = marks.iter().filter(|m| case.printed.contains_key(&m.name));
        let printed: Vec<Asked> = printed.cloned().collect();
        marked_of(shop, figure, case, &printed, outcome)?;
    }
    marked_of(shop, figure, &cases[0], marks, outcome)
}

fn marked_of(
    shop: &Workshop,
    figure: &str,
    case: &Case,
    marks: &[Asked],
    outcome: &mut Outcome,
) -> Result<Vec<(Asked, Critical)>> {
    let setup = shop.setup(case)?;
    let found: Vec<Result<Critical>> = marks
        .par_iter()
        .map(|asked| critical_point(&setup, case, asked))
        .collect();
    let mut marked = Vec::new();
    for (asked, point) in marks.iter().zip(found) {
        let label = named(case, &asked.name);
        let number = Number::new(figure, case, &asked.name, label.clone());
        outcome.numbers.push(match point {
            Ok(point) => {
                let number = number.answered(point.value, Some(point.error));
                marked.push((asked.clone(), point));
                number
            }
            Err(Error::Input(message)) => return Err(Error::Input(message)),
            Err(error) => {
                outcome.failures.push(format!("{label}: {error}"));
                number.failed(&error.to_string())
            }
        });
    }
    Ok(marked)
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
        let beside = |i: Option<usize>| {
            i.and_then(|i| points.get(i))
                .is_some_and(|p| p.1.is_finite())
        };
        // On the side that has an amplitude; a gap on the other.
        match (beside(at.checked_sub(1)), beside(Some(at))) {
            (true, false) => points.insert(at, (end, 0.0)),
            (false, true) => points.insert(at, (end, 0.0)),
            _ => {}
        }
    }
    points
}

/// What of a sweep is to be shown, and how.
pub(super) struct Wanted<'a> {
    pub figure: &'a str,
    pub over: &'a Axis,
    pub columns: &'a [Together],
    pub mode: RowMode,
    pub marks: &'a [Asked],
    pub logarithmic: [bool; 2],
    pub reference: &'a [Reference],
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

pub(super) fn sweep(shop: &Workshop, cases: &[Case], wanted: &Wanted) -> Result<Outcome> {
    let Wanted {
        over,
        columns,
        mode,
        marks,
        ..
    } = *wanted;
    let all = || columns.iter().flat_map(Together::drawn);
    let derived: Vec<String> = all().filter_map(Drawn::derived).collect();
    let mut outcome = Outcome::default();
    let found = each(cases, &mut outcome.failures, |case| {
        let setup = shop.setup(case)?;
        rows(&setup, case.k, &over.name, over.values(), mode, &derived)
    })?;
    let printed = printed(&cases[0], marks);
    let marks = marked(shop, wanted.figure, cases, marks, &mut outcome)?;
    let ends = marks.iter().filter(|(asked, _)| asked.of != Of::C2);
    let ends: Vec<f64> = ends.map(|(_, point)| point.value).collect();
    let names = |column: &Drawn| -> (String, String) {
        let known = |title: &str, y: &str| (title.to_owned(), y.to_owned());
        match column {
            Drawn::Point(Column::A0) => known("growth rate", "a0"),
            Drawn::Point(Column::A2) => known("first Landau coefficient", "a2"),
            Drawn::Point(Column::Amplitude) => known("equilibrium amplitude", "A_e"),
            Drawn::Point(Column::Threshold) => known("threshold amplitude", "A_e"),
            Drawn::Derived(text) => known(text, text),
        }
    };
    let panel = |together: &Together| {
        let (titles, ys): (Vec<String>, Vec<String>) = together.drawn().iter().map(names).unzip();
        let mut panel = Panel::new(&titles.join(", "), &over.name, &ys.join(", "));
        let marks = marks.iter();
        panel.marks = marks
            .map(|(asked, point)| (point.value, asked.name.clone()))
            .collect();
        panel.range = Some([over.from, over.to]);
        panel.logarithmic = wanted.logarithmic;
        panel
    };
    let mut drawn: Vec<Panel> = columns.iter().map(panel).collect();
    // The names of a sweep's own table.
    let header = ["case", &over.name].into_iter().chain(NUMBERS);
    let header: Vec<&str> = header.chain(derived.iter().map(String::as_str)).collect();
    let mut table = Table::new(&header).with_words(&["label", "bifurcation", "status"]);
    let mut unconverged = 0;
    for (index, rows) in &found {
        let label = &cases[*index].label;
        outcome.failures.extend(nothing_in(label, rows));
        for (panel, together) in drawn.iter_mut().zip(columns) {
            for quantity in together.drawn() {
                // In a panel of several quantities, each by its name.
                let label = match together.drawn() {
                    [_] => label.clone(),
                    _ => named(&cases[*index], &names(quantity).1),
                };
                match quantity {
                    Drawn::Point(Column::A0) => {
                        panel.curve(&label, Style::Line, column(rows, Column::A0));
                    }
                    Drawn::Point(Column::Amplitude) => {
                        let points = column(rows, Column::Amplitude);
                        let points = if *index == 0 {
                            ended(points, &ends)
                        } else {
                            points
                        };
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
        for row in rows {
            let own = row.numbers().into_iter().chain(row.derived.iter().copied());
            let own = own.map(|x| x.unwrap_or(f64::NAN));
            let numbers = [(*index + 1) as f64, row.coordinates[0]]
                .into_iter()
                .chain(own);
            table.push(numbers.collect(), &[label, &row.bifurcation, &row.status]);
            unconverged += usize::from(row.c2.is_none());
        }
    }
    if !printed.is_empty() && !wanted.logarithmic[1] {
        drawn[0].curve("printed", Style::Dots, printed);
    }
    for asked in wanted.reference {
        let points = reference(shop, asked)?;
        let count = drawn.len();
        let panel = asked.panel.checked_sub(1).and_then(|i| drawn.get_mut(i));
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
    let caption = match unconverged {
        0 => String::new(),
        1 => "1 point without a converged c2 is left out: the column `status` says why".to_owned(),
        count => {
            format!(
                "{count} points without a converged c2 are left out: the column `status` says why"
            )
        }
    };
    picture(shop, &mut outcome, &caption, &drawn, table);
    Ok(outcome)
}

pub(super) fn resonance(
    shop: &Workshop,
    figure: &str,
    cases: &[Case],
    over: &Axis,
    marks: &[Asked],
) -> Result<Outcome> {
    let mut outcome = Outcome::default();
    let found = each(cases, &mut outcome.failures, |case| {
        let (setup, values) = (shop.setup(case)?, over.values());
        let followed = RowMode::Followed(None);
        let doubled = values.iter().map(|k| 2.0 * k).collect();
        let one = rows(&setup, None, "k", values, followed, &[])?;
        Ok((one, rows(&setup, None, "k", doubled, followed, &[])?))
    })?;
    let mut panel = Panel::new("2:1 resonance", "k", "a0");
    for (asked, point) in marked(shop, figure, cases, marks, &mut outcome)? {
        panel.marks.push((point.value, asked.name.clone()));
    }
    let mut table = Table::new(&["case", "k", "a0(k)", "a0(2k)/2"]).with_words(&["label"]);
    for (index, (one, two)) in &found {
        let label = &cases[*index].label;
        for rows in [one, two] {
            outcome.failures.extend(nothing_in(label, rows));
        }
        let value = |row: &Row| row.c0.map_or(f64::NAN, |c| c[0]);
        let first = one.iter().map(|r| (r.coordinates[0], value(r)));
        let second = one.iter().zip(two);
        let second = second.map(|(r, d)| (r.coordinates[0], 0.5 * value(d)));
        let (first, second): (Vec<_>, Vec<_>) = (first.collect(), second.collect());
        for (a, b) in first.iter().zip(&second) {
            table.push(vec![(*index + 1) as f64, a.0, a.1, b.1], &[label]);
        }
        panel.curve(&format!("{label} a0(k)"), Style::Line, first);
        panel.curve(&format!("{label} a0(2k)/2"), Style::Dashed, second);
    }
    picture(shop, &mut outcome, "", &[panel], table);
    Ok(outcome)
}

/// A_e at given relative distances from a critical point, and the slope of log A_e.
pub(super) fn power_law(
    shop: &Workshop,
    figure: &str,
    cases: &[Case],
    asked: &Asked,
    distances: [f64; 2],
    count: usize,
) -> Result<Outcome> {
    let mut outcome = Outcome::default();
    let found = each(cases, &mut outcome.failures, |case| {
        let setup = shop.setup(case)?;
        let critical = critical_point(&setup, case, asked)?;
        let (place, error) = (critical.value, critical.error);
        let [near, far] = distances.map(f64::abs);
        let steps = (count - 1) as f64;
        let relative: Vec<f64> = (0..count)
            .map(|i| distances[0].signum() * near * (far / near).powf(i as f64 / steps))
            .collect();
        let values = relative.iter().map(|d| place * (1.0 + d)).collect();
        let k = asked.k.or(case.k).filter(|_| asked.vary != "k");
        let rows = rows(&setup, k, &asked.vary, values, RowMode::Leading, &[])?;
        let points: Vec<(f64, f64)> = relative
            .iter()
            .zip(&rows)
            .filter_map(|(d, row)| Some((d.abs(), row.amplitude?)))
            .collect();
        if points.len() < 3 {
            return Err(Error::computation("too few equilibria for a fit"));
        }
        Ok((place, error, points))
    })?;
    let mut panel = Panel::new(
        "distance from the bifurcation",
        &format!("|{0} − {0}_c|/{0}_c", asked.vary),
        "A_e",
    );
    panel.logarithmic = [true, true];
    let mut table = Table::new(&["case", "distance", "A_e"]);
    for (index, (place, error, points)) in found {
        let case = &cases[index];
        let slope = slope(&points);
        for &(distance, amplitude) in &points {
            table
                .rows
                .push(vec![(index + 1) as f64, distance, amplitude]);
        }
        let label = format!("{} slope {slope:.4}", case.label);
        // The law itself, through the nearest point.
        let (d, a) = points[0];
        let law = points.iter().map(|p| (p.0, a * (p.0 / d).sqrt())).collect();
        panel.curve(&label, Style::Dots, points);
        panel.curve("slope 1/2", Style::Dashed, law);
        for (quantity, ours, error) in [
            (asked.name.as_str(), place, Some(error)),
            ("exponent", slope, None),
        ] {
            let number = Number::new(figure, case, quantity, named(case, quantity));
            outcome.numbers.push(number.answered(ours, error));
        }
    }
    picture(shop, &mut outcome, "", &[panel], table);
    Ok(outcome)
}

/// Least squares in logarithms.
fn slope(points: &[(f64, f64)]) -> f64 {
    let logs: Vec<(f64, f64)> = points.iter().map(|(x, y)| (x.ln(), y.ln())).collect();
    let count = logs.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| logs.iter().map(of).sum::<f64>() / count;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let above: f64 = logs.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    above / logs.iter().map(|p| (p.0 - x).powi(2)).sum::<f64>()
}
