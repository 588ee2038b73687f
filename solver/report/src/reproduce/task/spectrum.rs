//! The leading eigenvalues of L and of L† over the wavenumber.

use super::super::needs::Needs;
use super::super::outcome::{Number, Outcome};
use super::super::study::kinds::Spectrum;
use super::super::study::{Case, at_each, named};
use super::super::table::Table;
use super::super::workshop::Workshop;
use super::draw::picture;
use super::{Place, Work, each};
use crate::figure::{Panel, Style};
use landau_solver::error::{Error, Result};
use landau_solver::model::C64;
use landau_solver::problem::Problem;
use landau_solver::spectrum;
use landau_solver::study::quadrature::adjoint_mode;
use landau_solver::wavevector::WaveVector;

/// Growth rates at one wavenumber.
struct Rates {
    k: f64,
    direct: f64,
    adjoint: f64,
    /// |c0(L) − conj c0(L†)|
    gap: f64,
}

impl Work for Spectrum {
    fn needs(&self, _: &mut Needs) -> Result<()> {
        Ok(())
    }

    fn run(&self, shop: &Workshop, place: &Place) -> Result<Outcome> {
        let mut outcome = Outcome::default();
        // Of each case after the one before, all resolutions.
        let all = at_each(&self.case, &self.resolutions);
        let answers = each(&all, &mut outcome.failures, |case| self.rates(shop, case))?;
        let panel = |case: &Case| Panel::new(&named(case, "least stable mode"), "k", "a0");
        let mut panels: Vec<Panel> = self.case.iter().map(panel).collect();
        let header = ["case", "k", "L", "L†", "difference"];
        let mut table = Table::new(&header).with_words(&["label"]);
        let mut difference = Panel::new("L against L†", "k", "|c0(L) − conj c0(L†)|");
        difference.logarithmic[1] = true;
        for (index, rates) in answers {
            let (case, count) = (&all[index], self.resolutions.len());
            let label = &case.label;
            let curve = |of: fn(&Rates) -> f64| -> Vec<(f64, f64)> {
                rates.iter().map(|r| (r.k, of(r))).collect()
            };
            let panel = &mut panels[index / count];
            let resolution = format!("M = {}", self.resolutions[index % count]);
            panel.curve(
                &format!("L, {resolution}"),
                Style::Line,
                curve(|r| r.direct),
            );
            panel.curve(
                &format!("L†, {resolution}"),
                Style::Dots,
                curve(|r| r.adjoint),
            );
            difference.curve(label, Style::Line, curve(|r| r.gap));
            let quantity = format!("largest |L − L†| over {}", self.over.name);
            let name = format!("{label}: {quantity}");
            let number = Number::new(place.figure, case, &quantity, name);
            outcome.numbers.push(number.answered(widest(&rates), None));
            for r in &rates {
                let row = vec![(index + 1) as f64, r.k, r.direct, r.adjoint, r.gap];
                table.push(row, &[label]);
            }
        }
        panels.push(difference);
        picture(shop, &mut outcome, "", &panels, table);
        Ok(outcome)
    }
}

impl Spectrum {
    fn rates(&self, shop: &Workshop, case: &Case) -> Result<Vec<Rates>> {
        let setup = shop.setup(case)?;
        let problem = &setup.problem(&setup.base(None)?)?;
        let rates = |k: f64| {
            let q = WaveVector::wave(k)?;
            let mode = spectrum::leading(problem, q)?;
            // Where inverse iteration finds no isolated partner, the nearest of all of L†.
            let adjoint = match adjoint_mode(problem, &mode) {
                Ok(adjoint) => adjoint.c,
                Err(_) => nearest_adjoint(problem, q, mode.c)?,
            };
            Ok(Rates {
                k,
                direct: mode.c.re,
                adjoint: adjoint.re,
                gap: (adjoint.conj() - mode.c).norm(),
            })
        };
        self.over.values().into_iter().map(rates).collect()
    }
}

/// The largest gap; one that is no number is larger than any.
fn widest(rates: &[Rates]) -> f64 {
    rates.iter().fold(0.0, |most, rates| {
        if rates.gap.is_nan() || rates.gap > most {
            rates.gap
        } else {
            most
        }
    })
}

/// The eigenvalue of L† whose conjugate is nearest to c.
fn nearest_adjoint(problem: &Problem, q: WaveVector, c: C64) -> Result<C64> {
    let values = spectrum::adjoint_eigenvalues(problem, q)?.values;
    let gap = |d: &C64| (d.conj() - c).norm();
    let nearest = values.into_iter().min_by(|a, b| gap(a).total_cmp(&gap(b)));
    nearest.ok_or_else(|| Error::computation("L† has no finite eigenvalue"))
}
