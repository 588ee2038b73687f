//! Power laws at a bifurcation.

use super::super::needs::Needs;
use super::super::outcome::{Number, Outcome};
use super::super::study::kinds::PowerLaw;
use super::super::study::{Case, named};
use super::super::table::Table;
use super::super::workshop::Workshop;
use super::draw::picture;
use super::points::critical_point;
use super::rows::rows;
use super::{Place, Work, each};
use crate::figure::{Panel, Style};
use landau_solver::error::{Error, Result};
use landau_solver::study::critical::Critical;
use landau_solver::study::sweep::RowMode;

impl Work for PowerLaw {
    fn needs(&self, of: &mut Needs) -> Result<()> {
        of.question(&of.spot.key("critical"), &self.critical)
    }

    /// A_e at given relative distances from a critical point, and the slope of log A_e.
    fn run(&self, shop: &Workshop, place: &Place) -> Result<Outcome> {
        let mut outcome = Outcome::default();
        let laws = each(&self.case, &mut outcome.failures, |case| {
            self.amplitudes(shop, case)
        })?;
        let vary = &self.critical.vary;
        let mut panel = Panel::new(
            "distance from the bifurcation",
            &format!("|{vary} − {vary}_c|/{vary}_c"),
            "A_e",
        );
        panel.logarithmic = [true, true];
        let mut table = Table::new(&["case", "distance", "A_e"]);
        for (index, (critical, points)) in laws {
            let case = &self.case[index];
            let slope = slope(&points);
            for &(distance, amplitude) in &points {
                let row = vec![(index + 1) as f64, distance, amplitude];
                table.rows.push(row);
            }
            let label = format!("{} slope {slope:.4}", case.label);
            // The law itself, through the nearest point.
            let (d, a) = points[0];
            let law = points.iter().map(|p| (p.0, a * (p.0 / d).sqrt())).collect();
            panel.curve(&label, Style::Dots, points);
            panel.curve("slope 1/2", Style::Dashed, law);
            for (quantity, ours, error) in [
                (
                    self.critical.name.as_str(),
                    critical.value,
                    Some(critical.error),
                ),
                ("exponent", slope, None),
            ] {
                let number = Number::new(place.figure, case, quantity, named(case, quantity));
                outcome.numbers.push(number.answered(ours, error));
            }
        }
        picture(shop, &mut outcome, "", &[panel], table);
        Ok(outcome)
    }
}

impl PowerLaw {
    /// The critical point of a case, and relative distances from it with the amplitudes there.
    fn amplitudes(&self, shop: &Workshop, case: &Case) -> Result<(Critical, Vec<(f64, f64)>)> {
        let (setup, asked) = (shop.setup(case)?, &self.critical);
        let critical = critical_point(&setup, case, asked)?;
        let [near, far] = self.distances.map(f64::abs);
        let (side, steps) = (self.distances[0].signum(), (self.count - 1) as f64);
        let distance = |i: usize| side * near * (far / near).powf(i as f64 / steps);
        let relative: Vec<f64> = (0..self.count).map(distance).collect();
        let values = relative
            .iter()
            .map(|d| critical.value * (1.0 + d))
            .collect();
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
        Ok((critical, points))
    }
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
