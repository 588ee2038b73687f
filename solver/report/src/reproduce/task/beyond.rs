//! Amplitudes beyond cubic order of one mode.

use super::super::needs::Needs;
use super::super::outcome::{Beside, Number, Outcome};
use super::super::study::kinds::Orders;
use super::super::study::{Case, named};
use super::super::table::Table;
use super::super::workshop::Workshop;
use super::draw::picture;
use super::follow::{along, nothing_in};
use super::{Place, Work, each};
use crate::figure::{Panel, Style};
use landau_solver::error::Result;
use landau_solver::measured::{Decided, Measured};
use landau_solver::spectrum::EigenPair;
use landau_solver::weakly::{AmplitudeEquation, Expansion};

/// What the amplitude equation at one place gives; a gap where it gives nothing.
struct Row {
    k: f64,
    /// A_e at every order.
    by_order: Vec<f64>,
    pade: f64,
    /// Beyond the radius of convergence an order says nothing.
    radius: f64,
}

impl Work for Orders {
    fn needs(&self, _: &mut Needs) -> Result<()> {
        Ok(())
    }

    /// A_e over k at every order, and of the Padé approximant, as far as the series converges.
    fn run(&self, shop: &Workshop, place: &Place) -> Result<Outcome> {
        let mut outcome = Outcome::default();
        let answers = each(&self.case, &mut outcome.failures, |case| {
            self.equations(shop, case)
        })?;
        let mut table = self.table();
        let mut panel = Panel::new("equilibrium amplitude by order", "k", "A_e");
        for (index, equations) in &answers {
            let case = &self.case[*index];
            outcome.failures.extend(nothing_in(&case.label, equations));
            let rows: Vec<Row> = self.rows(equations);
            for row in &rows {
                let place = [(index + 1) as f64, row.k].into_iter();
                let values = row.by_order.iter().chain([&row.pade, &row.radius]);
                table.rows.push(place.chain(values.copied()).collect());
            }
            self.draw(&mut panel, case, &rows);
            let numbers = self.numbers(place.figure, case, &rows);
            outcome.numbers.extend(numbers);
        }
        let full = self.reference.iter().map(|[k, a]| (*k, *a)).collect();
        if !self.reference.is_empty() {
            panel.curve("fully nonlinear", Style::Dots, full);
        }
        picture(shop, &mut outcome, "", &[panel], table);
        Ok(outcome)
    }
}

impl Orders {
    fn orders(&self) -> impl Iterator<Item = usize> + use<> {
        (3..=self.highest).step_by(2)
    }

    /// The amplitude equation at each place.
    fn equations(&self, shop: &Workshop, case: &Case) -> Result<Vec<Result<AmplitudeEquation>>> {
        let setup = shop.setup(case)?;
        let problem = setup.problem(&setup.base(None)?)?;
        let equation = |pairs: Vec<EigenPair>| {
            let expansion = Expansion::to(&problem, pairs, self.highest - 1)?;
            let terms = expansion.last_coefficients().equations.remove(0);
            let coefficients = terms.iter().map(|term| Measured::new(term.g, 0.0));
            Ok(AmplitudeEquation {
                coefficients: coefficients.collect(),
            })
        };
        Ok(along(&problem, &self.over.values(), equation, &[1.0]))
    }

    fn table(&self) -> Table {
        let mut header = vec!["case".to_owned(), "k".to_owned()];
        header.extend(self.orders().map(|order| format!("A_e order {order}")));
        header.extend(["A_e Padé".to_owned(), "radius".to_owned()]);
        let header: Vec<&str> = header.iter().map(String::as_str).collect();
        Table::new(&header)
    }

    fn rows(&self, equations: &[Result<AmplitudeEquation>]) -> Vec<Row> {
        let row = |(k, equation): (f64, &Result<AmplitudeEquation>)| {
            let value = |of: &dyn Fn(&AmplitudeEquation) -> Decided| {
                let answer = equation.as_ref().ok().and_then(|e| of(e).ok());
                answer.map_or(f64::NAN, |amplitude| amplitude.value)
            };
            Row {
                k,
                by_order: self
                    .orders()
                    .map(|order| value(&|e| e.equilibrium(order)))
                    .collect(),
                pade: value(&|e| e.pade()),
                radius: value(&|e| e.radius()),
            }
        };
        self.over
            .values()
            .into_iter()
            .zip(equations)
            .map(row)
            .collect()
    }

    /// A curve an order, and that of the approximant, each within the radius of convergence.
    fn draw(&self, panel: &mut Panel, case: &Case, rows: &[Row]) {
        let curve = |of: &dyn Fn(&Row) -> f64| -> Vec<(f64, f64)> {
            let within = |row: &Row| {
                let amplitude = of(row);
                let is_within = amplitude <= row.radius;
                (row.k, if is_within { amplitude } else { f64::NAN })
            };
            rows.iter().map(within).collect()
        };
        for (position, order) in self.orders().enumerate() {
            let label = named(case, &format!("order {order}"));
            panel.curve(&label, Style::Line, curve(&|row| row.by_order[position]));
        }
        panel.curve(&named(case, "Padé"), Style::Dashed, curve(&|row| row.pade));
    }

    /// The approximant beside the full solution, at the nearest place.
    fn numbers(&self, figure: &str, case: &Case, rows: &[Row]) -> Vec<Number> {
        let number = |&[k, amplitude]: &[f64; 2]| {
            let distance = |row: &&Row| (row.k - k).abs();
            let nearest = rows
                .iter()
                .min_by(|a, b| distance(a).total_cmp(&distance(b)));
            let quantity = format!("A_e of the Padé approximant at k = {k}");
            let number = Number::new(figure, case, &quantity, named(case, &quantity));
            let number = Number {
                reference: Some(Beside {
                    label: "fully nonlinear".to_owned(),
                    value: amplitude,
                }),
                ..number
            };
            match nearest.filter(|row| distance(row) < 1e-9) {
                Some(row) => number.answered(row.pade, None),
                None => number.failed("the axis does not pass there"),
            }
        };
        self.reference.iter().map(number).collect()
    }
}
