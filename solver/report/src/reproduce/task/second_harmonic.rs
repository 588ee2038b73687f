//! A mode with its second harmonic, through their resonance.

use super::super::needs::Needs;
use super::super::outcome::Outcome;
use super::super::study::kinds::SecondHarmonic;
use super::super::study::{Case, named};
use super::super::table::Table;
use super::super::workshop::Workshop;
use super::draw::picture;
use super::follow::{along, nothing_in};
use super::{Place, Work, each};
use crate::figure::{Panel, Style};
use landau_solver::error::Result;
use landau_solver::problem::Problem;
use landau_solver::series::Monomial;
use landau_solver::spectrum::EigenPair;
use landau_solver::study::amplitudes::next_order;
use landau_solver::weakly::{AmplitudeSystem, Equilibrium, Expansion, equilibria};
use std::sync::Arc;

/// The terms of the next order, relative to the largest there, up to which an equilibrium is drawn as trusted.
const TRUSTED: f64 = 0.3;

/// One place of a pair: its equations to third order, its equilibria with the next order's share.
struct Pair {
    system: AmplitudeSystem,
    states: Vec<(Equilibrium, f64)>,
}

/// The pair of modes at one place.
fn pair(problem: &Arc<Problem>, pairs: Vec<EigenPair>) -> Result<Pair> {
    let longer = Expansion::to(problem, pairs, 4)?.last_coefficients();
    let (system, next) = (longer.part(1..=3), longer.part(4..=5));
    let states = equilibria(&system).into_iter().map(|state| {
        let share = next_order(&system, &next, &state.z);
        (state, share)
    });
    Ok(Pair {
        states: states.collect(),
        system,
    })
}

/// Real parts of coefficients in the equation of z1; gaps where the pair did not come out.
struct Coefficients {
    k: f64,
    /// Of z1² z̄1.
    itself: f64,
    /// Of z1 z2 z̄2.
    harmonic: f64,
    /// (z2 z̄1)(z1²)
    product: f64,
    /// c2 of the single mode.
    single: f64,
}

impl Coefficients {
    fn new(k: f64, pair: Option<&Pair>) -> Self {
        let Some(Pair { system, .. }) = pair else {
            let gap = f64::NAN;
            return Coefficients {
                k,
                itself: gap,
                harmonic: gap,
                product: gap,
                single: gap,
            };
        };
        let g = |j: usize, z: [u8; 2], conj: [u8; 2]| {
            let monomial = Monomial {
                z: z.to_vec(),
                conj: conj.to_vec(),
            };
            system.coefficient(j, &monomial).unwrap_or_default()
        };
        let linear = |j: usize| {
            let monomial = Monomial::amplitude(2, j);
            system.coefficient(j, &monomial).unwrap_or_default()
        };
        let itself = g(0, [2, 0], [1, 0]);
        // c2 = g(z1² z̄1) + g(z2 z̄1) g(z1²)/(2 c1 − c2)
        let product = g(0, [0, 1], [1, 0]) * g(1, [2, 0], [0, 0]);
        let single = itself + product / (2.0 * linear(0) - linear(1));
        Coefficients {
            k,
            itself: itself.re,
            harmonic: g(0, [1, 1], [0, 1]).re,
            product: product.re,
            single: single.re,
        }
    }
}

/// An equilibrium of the pair at one place.
struct State {
    k: f64,
    /// |z1|, |z2|
    sizes: [f64; 2],
    stable: Option<bool>,
    next_order: f64,
}

impl State {
    fn new(k: f64, (state, next_order): &(Equilibrium, f64)) -> Self {
        State {
            k,
            sizes: [0, 1].map(|j| state.z[j].norm()),
            stable: state.stable(),
            next_order: *next_order,
        }
    }

    fn is_trusted(&self) -> bool {
        self.next_order <= TRUSTED
    }
}

impl Work for SecondHarmonic {
    fn needs(&self, _: &mut Needs) -> Result<()> {
        Ok(())
    }

    /// A mode at k with the one at 2k: the single mode's c2 beside the pair's coefficients, and the pair's equilibria.
    fn run(&self, shop: &Workshop, _: &Place) -> Result<Outcome> {
        let mut outcome = Outcome::default();
        let places = self.over.values();
        let answers = each(&self.case, &mut outcome.failures, |case| {
            let setup = shop.setup(case)?;
            let problem = setup.problem(&setup.base(None)?)?;
            let value = |pairs| pair(&problem, pairs);
            Ok(along(&problem, &places, value, &[1.0, 2.0]))
        })?;
        let mut coefficients_panel = Panel::new("coefficients of z1'", "k", "g");
        let mut sizes = [
            Panel::new("the mode at k", "k", "|z1|"),
            Panel::new("the mode at 2k", "k", "|z2|"),
        ];
        let mut tables = tables();
        for (index, pairs) in &answers {
            let (case, number) = (&self.case[*index], (index + 1) as f64);
            outcome.failures.extend(nothing_in(&case.label, pairs));
            let (mut coefficients, mut states) = (Vec::new(), Vec::new());
            for (&k, pair) in places.iter().zip(pairs) {
                let pair = pair.as_ref().ok();
                coefficients.push(Coefficients::new(k, pair));
                let states_here = pair.iter().flat_map(|pair| &pair.states);
                states.extend(states_here.map(|state| State::new(k, state)));
            }
            tables[0].rows.extend(
                coefficients
                    .iter()
                    .map(|c| vec![number, c.k, c.itself, c.harmonic, c.product, c.single]),
            );
            tables[1].rows.extend(states.iter().map(|s| {
                let stable = s
                    .stable
                    .map_or(f64::NAN, |stable| f64::from(u8::from(stable)));
                vec![number, s.k, s.sizes[0], s.sizes[1], stable, s.next_order]
            }));
            draw_coefficients(&mut coefficients_panel, case, &coefficients);
            for (mode, panel) in sizes.iter_mut().enumerate() {
                draw_states(panel, case, &states, mode);
            }
        }
        let [coefficients, states] = tables;
        let caption = "coefficients through the resonance";
        picture(
            shop,
            &mut outcome,
            caption,
            &[coefficients_panel],
            coefficients,
        );
        picture(shop, &mut outcome, "equilibria of the pair", &sizes, states);
        Ok(outcome)
    }
}

/// The tables of coefficients and of equilibria, without rows.
fn tables() -> [Table; 2] {
    let coefficients = [
        "case",
        "k",
        "z1² z̄1",
        "z1 z2 z̄2",
        "(z2 z̄1)(z1²)",
        "c2 of the single mode",
    ];
    let states = ["case", "k", "|z1|", "|z2|", "stable", "next order"];
    [Table::new(&coefficients), Table::new(&states)]
}

fn draw_coefficients(panel: &mut Panel, case: &Case, rows: &[Coefficients]) {
    let curve = |of: fn(&Coefficients) -> f64| rows.iter().map(|c| (c.k, of(c))).collect();
    let label = named(case, "c2 of the single mode");
    panel.curve_with_poles(&label, Style::Dashed, curve(|c| c.single));
    let label = named(case, "z1² z̄1 of the pair");
    panel.curve(&label, Style::Line, curve(|c| c.itself));
    let label = named(case, "z1 z2 z̄2 of the pair");
    panel.curve(&label, Style::Line, curve(|c| c.harmonic));
}

/// The size of a mode in the equilibria: stable ones, unstable ones, and those that the next order would change.
fn draw_states(panel: &mut Panel, case: &Case, states: &[State], mode: usize) {
    let points = |is_drawn: fn(&State) -> bool| -> Vec<(f64, f64)> {
        let drawn = states.iter().filter(|state| is_drawn(state));
        drawn.map(|state| (state.k, state.sizes[mode])).collect()
    };
    let stable = points(|state| state.is_trusted() && state.stable == Some(true));
    let unstable = points(|state| state.is_trusted() && state.stable != Some(true));
    let beyond = points(|state| !state.is_trusted());
    panel.curve(&named(case, "stable"), Style::Dots, stable);
    panel.curve(&named(case, "unstable"), Style::Dots, unstable);
    panel.curve(&named(case, "next order above 0.3"), Style::Dots, beyond);
}
