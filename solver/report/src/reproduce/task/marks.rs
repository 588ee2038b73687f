//! Critical points that are marked in a picture, and the 2:1 resonance.

use super::super::needs::Needs;
use super::super::outcome::{Number, Outcome};
use super::super::study::kinds::Resonance;
use super::super::study::{Asked, Case, named};
use super::super::table::Table;
use super::super::workshop::Workshop;
use super::draw::picture;
use super::points::critical_point;
use super::rows::{nothing_in, rows};
use super::{Place, Work, each};
use crate::figure::{Panel, Style};
use landau_solver::error::{Error, Result};
use landau_solver::study::critical::Critical;
use landau_solver::study::row::Row;
use landau_solver::study::sweep::RowMode;
use rayon::prelude::*;

/// The critical points that are to be marked: those of the first case. They are numbers too, and so are those of every
/// later case that has them printed, whether they come out or not.
pub(super) fn marked(
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
    let points: Vec<Result<Critical>> = marks
        .par_iter()
        .map(|asked| critical_point(&setup, case, asked))
        .collect();
    let mut marked = Vec::new();
    for (asked, point) in marks.iter().zip(points) {
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

impl Work for Resonance {
    fn needs(&self, of: &mut Needs) -> Result<()> {
        of.questions("mark", &self.mark)
    }

    fn run(&self, shop: &Workshop, place: &Place) -> Result<Outcome> {
        let mut outcome = Outcome::default();
        let rows_of_cases = each(&self.case, &mut outcome.failures, |case| {
            let (setup, values) = (shop.setup(case)?, self.over.values());
            let followed = RowMode::Followed(None);
            let doubled = values.iter().map(|k| 2.0 * k).collect();
            let at_k = rows(&setup, None, "k", values, followed, &[])?;
            Ok((at_k, rows(&setup, None, "k", doubled, followed, &[])?))
        })?;
        let mut panel = Panel::new("2:1 resonance", "k", "a0");
        for (asked, point) in marked(shop, place.figure, &self.case, &self.mark, &mut outcome)? {
            panel.marks.push((point.value, asked.name.clone()));
        }
        let mut table = Table::new(&["case", "k", "a0(k)", "a0(2k)/2"]).with_words(&["label"]);
        for (index, (at_k, at_2k)) in &rows_of_cases {
            let label = &self.case[*index].label;
            for rows in [at_k, at_2k] {
                outcome.failures.extend(nothing_in(label, rows));
            }
            let growth = |row: &Row| row.c0.map_or(f64::NAN, |c| c[0]);
            let first = at_k.iter().map(|r| (r.coordinates[0], growth(r)));
            let second = at_k.iter().zip(at_2k);
            let second = second.map(|(r, d)| (r.coordinates[0], 0.5 * growth(d)));
            let (first, second): (Vec<_>, Vec<_>) = (first.collect(), second.collect());
            for ((k, a0), (_, half)) in first.iter().zip(&second) {
                table.push(vec![(index + 1) as f64, *k, *a0, *half], &[label]);
            }
            panel.curve(&format!("{label} a0(k)"), Style::Line, first);
            panel.curve(&format!("{label} a0(2k)/2"), Style::Dashed, second);
        }
        picture(shop, &mut outcome, "", &[panel], table);
        Ok(outcome)
    }
}
