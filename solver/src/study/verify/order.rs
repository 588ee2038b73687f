//! Part 1: the residual order.
//!
//! X⁰ plus the series through order N, with the amplitudes moving by their equations, put into the *unexpanded*
//! residual and boundary conditions: the defect must fall as the amplitude to the power N + 1. A wrong factor,
//! shift, mass term, boundary datum or sign in N3 shows here, off criticality too. Every balance and every
//! condition, on integrals too, is judged by itself, where its defect stands clear of what rounding leaves.

mod integrals;

use super::{Check, Verdict};
use crate::error::Result;
use crate::model::{BalanceId, C64, End, Id, Jet, Kernel, ResidualId, WithRounding};
use crate::problem::{Problem, Profile};
use crate::series::Monomial;
use crate::space::{Block, Points};
use crate::study::{Progress, Silent};
use crate::wavevector::WaveVector;
use crate::weakly::{Expansion, LandauPoint, Mode, power};
use integrals::OnIntegrals;

/// Phases at which the defect is sampled, for each power of the amplitude that it falls by.
const PHASES: usize = 3;
/// Steps of the amplitude …
const STEPS: usize = 28;
/// … by which it falls …
const RATIO: f64 = std::f64::consts::SQRT_2;
/// … from this part of where the series ends to make sense.
const START: f64 = 0.2;
/// A defect counts while it stands this far above what the discretisation leaves, which is an estimate …
const ABOVE_FLOOR: f64 = 300.0;
/// … and this far above a bound of the rounding errors.
const ABOVE_ROUNDING: f64 = 100.0;
/// Two slopes one after another that differ by less are those of a power.
const SETTLED: f64 = 0.01;
/// How far below the order a slope may be.
const SLACK: f64 = 0.98;

/// How the defect falls.
pub struct ResidualOrder {
    /// The least power of the amplitude by which a defect falls; nothing where rounding hides all.
    pub slope: Option<f64>,
    /// The amplitude, of all modes, at which it was found.
    pub amplitude: f64,
    /// The balance or condition of the least slope, or of the highest floor where nothing stands clear.
    pub row: String,
}

pub(super) fn check(point: &LandauPoint, order: usize) -> Result<Vec<Check>> {
    let expansion = Expansion::to(&point.problem, vec![point.pair.clone()], order)?;
    Ok(vec![order_check("order of the residual in A", &expansion)])
}

/// The line of the certificate about one expansion.
pub fn order_check(name: &str, expansion: &Expansion) -> Check {
    let found = residual_order(expansion);
    let bound = SLACK * (expansion.order() + 1) as f64;
    let (value, verdict, detail) = match found.slope {
        None => (
            f64::NAN,
            Verdict::LeftOut(format!(
                "rounding hides the slope: the residual of {} never stands clear of it",
                found.row
            )),
            String::new(),
        ),
        Some(slope) => (
            slope,
            Verdict::by(slope >= bound),
            format!(
                "power by which the defect falls at amplitude {:.2e}, {}",
                found.amplitude, found.row
            ),
        ),
    };
    Check {
        part: 1,
        name: name.to_owned(),
        value,
        bound,
        verdict,
        detail,
    }
}

/// What is left of one balance or condition, and what rounding may have left.
#[derive(Clone, Copy, Default)]
struct Defect {
    value: f64,
    rounding: f64,
}

/// Amplitudes at which [`residual_order_told`] looks at the defect.
pub const DEFECTS: usize = STEPS + 2;

/// The order at which the defect of the whole expansion falls.
pub fn residual_order(expansion: &Expansion) -> ResidualOrder {
    residual_order_told(expansion, &Silent)
}

/// The same; each of the [`DEFECTS`] amplitudes is a step of `progress`.
pub fn residual_order_told(expansion: &Expansion, progress: &dyn Progress) -> ResidualOrder {
    let series = Series::new(expansion);
    let defects = |amplitude: f64| {
        let defects = series.defects(amplitude);
        progress.advance(1);
        defects
    };
    let start = START / series.reach();
    let amplitudes: Vec<f64> = (0..STEPS).map(|i| start / RATIO.powi(i as i32)).collect();
    let measured: Vec<Vec<Defect>> = amplitudes.iter().map(|&a| defects(a)).collect();
    // What the discretisation leaves at A = 0, and for each unit of A (from an amplitude so small that no power
    // of it counts).
    let at_zero = defects(0.0);
    let tiny = start * 1e-5;
    let linear: Vec<f64> = defects(tiny)
        .iter()
        .zip(&at_zero)
        .map(|(d, zero)| (d.value - 2.0 * zero.value).max(0.0) / tiny)
        .collect();
    let floor = |row: usize, i: usize| {
        let left = at_zero[row].value + linear[row] * amplitudes[i] + series.closed(amplitudes[i]);
        (ABOVE_FLOOR * left).max(ABOVE_ROUNDING * measured[i][row].rounding)
    };
    // Over two steps.
    let slope = |row: usize, i: usize| {
        (measured[i - 2][row].value / measured[i][row].value).ln() / (2.0 * RATIO.ln())
    };
    let judged = |row: usize| {
        let clear = |i: &usize| {
            let value = measured[*i][row].value;
            value > floor(row, *i) && value > 0.0
        };
        let settled = |i: &usize| {
            let (own, before) = (slope(row, *i), slope(row, *i - 1));
            (own - before).abs() <= SETTLED * own.abs()
        };
        let last = (3..STEPS).rev().filter(clear).find(settled)?;
        Some((slope(row, last), row, last))
    };
    let judged = (0..at_zero.len()).filter_map(judged);
    let least = judged.min_by(|a, b| a.0.total_cmp(&b.0));
    match least {
        Some((slope, row, i)) => ResidualOrder {
            slope: Some(slope),
            amplitude: amplitudes[i],
            row: name(&expansion.problem, row),
        },
        None => {
            let share = |row: &usize| measured[0][*row].value / floor(*row, 0).max(1e-300);
            let nearest = (0..at_zero.len()).max_by(|a, b| share(a).total_cmp(&share(b)));
            ResidualOrder {
                slope: None,
                amplitude: amplitudes[0],
                row: name(&expansion.problem, nearest.unwrap_or(0)),
            }
        }
    }
}

/// A balance, a condition at an end, or one on an integral.
fn name(problem: &Problem, row: usize) -> String {
    let balances = &problem.structure().balances;
    let walls = &problem.direct.walls;
    if let Some(border) = row
        .checked_sub(balances.len() + walls.len())
        .and_then(|index| problem.borders.get(index))
    {
        return format!("integral condition `{}`", border.name);
    }
    match balances.find(BalanceId::at(row)) {
        Some(balance) => format!("balance `{balance}`"),
        None => {
            let wall = &walls[row - balances.len()];
            let coordinate = problem.structure().coordinate.as_deref().unwrap_or("y");
            let space = problem.space();
            let place = space.y(space.end(wall.end));
            format!(
                "condition {} (at {coordinate} = {place})",
                row - balances.len() + 1
            )
        }
    }
}

/// The series, with the jets of its modes on all grids.
struct Series<'e> {
    expansion: &'e Expansion,
    modes: Vec<(Monomial, Mode)>,
    grids: Vec<OnGrid>,
    integrals: Option<OnIntegrals>,
}

/// Jets at the points of one family.
struct OnGrid {
    points: Points,
    states: Vec<Vec<f64>>,
    base: Vec<Vec<f64>>,
    tables: Vec<Tables>,
}

/// `[point][jet]` of one mode: of X_α, whose rate follows from the amplitudes, and of what drifts besides.
struct Tables {
    plain: Vec<Vec<C64>>,
    drift: Vec<Vec<C64>>,
    rounding: Vec<Vec<f64>>,
}

/// The jets of modes, and of the base state, at the points of a family.
fn on_grid(expansion: &Expansion, modes: &[Mode], points: Points) -> OnGrid {
    let problem = expansion.problem.as_ref();
    let jets = &problem.structure().residual_jets;
    let k = expansion
        .modes
        .first()
        .map_or(WaveVector::MEAN, |mode| mode.pair.k);
    let places = problem.space().places(points).into_iter();
    let states = places.map(|place| problem.base.at(place, k));
    let states: Vec<Vec<f64>> = states.collect();
    let tables = modes
        .iter()
        .map(|mode| Tables::new(problem, mode, jets, points));
    OnGrid {
        points,
        base: states.iter().map(|s| base_jets(problem, s, jets)).collect(),
        tables: tables.collect(),
        states,
    }
}

impl<'e> Series<'e> {
    fn new(expansion: &'e Expansion) -> Self {
        let problem = expansion.problem.as_ref();
        // One of each pair of conjugates.
        let coefficients = expansion.coefficients().into_iter();
        let modes: Vec<(Monomial, Mode)> = coefficients
            .filter(|(monomial, _)| monomial.z >= monomial.conj)
            .collect();
        let mut kinds: Vec<Points> = Vec::new();
        let groups = problem.direct.layout.groups().into_iter();
        let walls = problem.direct.walls.iter();
        let walls = walls.map(|wall| Points::end(wall.end));
        for points in groups.map(|(points, _)| points).chain(walls) {
            if !kinds.contains(&points) {
                kinds.push(points);
            }
        }
        let profiles: Vec<Mode> = modes.iter().map(|(_, mode)| mode.clone()).collect();
        let on = |points: Points| on_grid(expansion, &profiles, points);
        Series {
            grids: kinds.into_iter().map(on).collect(),
            integrals: OnIntegrals::new(expansion, &profiles),
            expansion,
            modes,
        }
    }

    /// 1 / (an amplitude at which some order catches up with the first), in the fields that have a time derivative
    /// (a pressure has a scale of its own) or in the amplitude equations.
    fn reach(&self) -> f64 {
        let expansion = self.expansion;
        let structure = expansion.problem.structure();
        let columns = &expansion.problem.direct.layout.columns;
        let moving = columns.ids().filter(|&field| {
            let mut terms = structure.linear.iter();
            terms.any(|t| t.jet.t > 0 && t.jet.of == field)
        });
        let size = |mode: &Mode, block: &Block| {
            let values = block.of(&mode.values).iter();
            values.map(|v| v.norm()).fold(0.0, f64::max)
        };
        let sum = |degree: usize, block: &Block| -> f64 {
            let own = self.modes.iter().filter(|(m, _)| m.degree() == degree);
            own.map(|(_, mode)| size(mode, block)).sum()
        };
        let all = columns
            .iter()
            .map(|block| sum(1, block))
            .fold(0.0, f64::max);
        let mut reach = 0.0_f64;
        // Field by field: units do not matter. One that the modes leave alone but for rounding says nothing.
        for block in moving.map(|field| &columns[field]) {
            let first = sum(1, block);
            for degree in (2..=expansion.order()).filter(|_| first > 1e-10 * all) {
                let ratio = sum(degree, block) / first;
                reach = reach.max(ratio.powf(1.0 / (degree - 1) as f64));
            }
        }
        // The terms of the amplitude equations beside the slow rates.
        for (equation, mode) in expansion.system.equations.iter().zip(&expansion.modes) {
            for term in equation.iter().filter(|t| t.monomial.degree() > 1) {
                let ratio = term.g.norm() / mode.pair.scale;
                reach = reach.max(ratio.powf(1.0 / (term.monomial.degree() - 1) as f64));
            }
        }
        if reach > 0.0 && reach.is_finite() {
            reach
        } else {
            all.max(1e-300)
        }
    }

    /// What the multipliers of closures that ought to vanish leave in the balances: how far the collocated problem
    /// is from keeping what it conserves.
    fn closed(&self, amplitude: f64) -> f64 {
        let multipliers = self.expansion.multipliers.iter().filter(|m| m.vanishes);
        let left = multipliers.map(|m| 2.0 * m.size * amplitude.powi(m.order as i32));
        left.sum()
    }

    /// The amplitudes at which the defect is looked at: of one size, at phases that have nothing to do with
    /// one another.
    fn samples(&self, amplitude: f64) -> Vec<Vec<C64>> {
        let n = self.expansion.modes.len();
        let count = PHASES * (self.expansion.order() + 1) * n;
        let sample = |i: usize| {
            let phase = |j: usize| {
                let turns = (i as f64 + 0.25) * ((j + 1) as f64).sqrt() / count as f64;
                C64::from_polar(amplitude, 2.0 * std::f64::consts::PI * turns)
            };
            (0..n).map(phase).collect()
        };
        (0..count).map(sample).collect()
    }

    /// The largest residual of every balance (at its own points), of every boundary condition and of every condition on
    /// an integral.
    fn defects(&self, amplitude: f64) -> Vec<Defect> {
        let mut found = self.local_defects(amplitude);
        let integrals = self.integral_defects(amplitude).into_iter();
        found.extend(integrals.map(|defect| Defect {
            value: defect.value,
            rounding: f64::EPSILON * defect.size,
        }));
        found
    }

    /// Those of the balances and of the boundary conditions.
    fn local_defects(&self, amplitude: f64) -> Vec<Defect> {
        let problem = self.expansion.problem.as_ref();
        let balances = problem.structure().balances.len();
        let mut found = vec![Defect::default(); balances + problem.direct.walls.len()];
        let mut widen = |row: usize, value: f64, size: f64| {
            let defect: &mut Defect = &mut found[row];
            defect.value = defect.value.max(value.abs());
            defect.rounding = defect.rounding.max(f64::EPSILON * size);
        };
        let samples = self.samples(amplitude);
        if let Some(kernel) = problem.model().residual(ResidualId::Balances) {
            for (points, rows) in problem.direct.layout.groups() {
                for on in self.grids.iter().filter(|on| on.points == points) {
                    for value in self.residuals(kernel, on, &samples) {
                        for row in rows.iter().map(|row| row.index()) {
                            widen(row, value[row].value, value[row].size);
                        }
                    }
                }
            }
        }
        let case = ResidualId::Conditions(problem.base.case);
        let Some(kernel) = problem.model().residual(case) else {
            return found;
        };
        let still = self.samples(0.0);
        for end in End::BOTH {
            let points = Points::end(end);
            for on in self.grids.iter().filter(|on| on.points == points) {
                // The perturbation obeys B(X⁰ + X') − B(X⁰) = 0.
                let with = self.residuals(kernel, on, &samples);
                let without = self.residuals(kernel, on, &still);
                for (a, b) in with.iter().zip(&without) {
                    let walls = problem.direct.walls.iter().enumerate();
                    for (index, _) in walls.filter(|(_, wall)| wall.end == end) {
                        let difference = a[index] - b[index];
                        widen(balances + index, difference.value, difference.size);
                    }
                }
            }
        }
        found
    }

    /// Residuals at all points of a grid and all samples.
    fn residuals(
        &self,
        kernel: &Kernel,
        on: &OnGrid,
        samples: &[Vec<C64>],
    ) -> Vec<Vec<WithRounding>> {
        let jets = &self.expansion.problem.structure().residual_jets;
        let mut all = Vec::new();
        for z in samples {
            let moving = self.expansion.system.rates(z);
            // z^p z̄^s stands with its conjugate, where that is another one.
            let factors: Vec<(C64, C64, f64)> = self
                .modes
                .iter()
                .map(|(m, _)| {
                    let weight = if m.is_real() { 1.0 } else { 2.0 };
                    (power(m, z), power_rate(m, z, &moving), weight)
                })
                .collect();
            for (i, base) in on.base.iter().enumerate() {
                let mut x: Vec<WithRounding> = base.iter().map(|&b| b.into()).collect();
                for (tables, (value, rate, weight)) in on.tables.iter().zip(&factors) {
                    for (j, (x, jet)) in x.iter_mut().zip(jets).enumerate() {
                        let factor = if jet.t == 0 { value } else { rate };
                        let drift = tables.drift.get(i).map_or(C64::new(0.0, 0.0), |d| d[j]);
                        let own = tables.plain[i][j] * factor + drift * value;
                        x.value += weight * own.re;
                        x.size += weight
                            * (tables.rounding[i][j] * factor.norm() + drift.norm() * value.norm());
                    }
                }
                all.push(kernel.evaluate(&on.states[i], &x));
            }
        }
        all
    }
}

impl Tables {
    fn new(problem: &Problem, mode: &Mode, jets: &[Jet], points: Points) -> Self {
        let table = |mode: &Mode| -> Vec<Vec<C64>> {
            let table = mode.jets(problem, jets, points);
            (0..points.count()).map(|i| table.at(i).to_vec()).collect()
        };
        let mut own = mode.clone();
        own.rate.clone_from(&mode.values);
        let drifting = mode.drift.as_ref().map(|drift| {
            let still = Profile::zero(mode.values.len());
            table(&Mode::new(mode.q, still, drift.clone()))
        });
        Tables {
            plain: table(&own),
            rounding: own.rounding(problem, jets, points),
            drift: drifting.unwrap_or_default(),
        }
    }
}

/// d/dt z^p z̄^s
fn power_rate(monomial: &Monomial, z: &[C64], rates: &[C64]) -> C64 {
    let n = z.len();
    let mut total = C64::new(0.0, 0.0);
    for (j, rate) in rates.iter().enumerate() {
        let one = Monomial::amplitude(n, j);
        if let Some(quotient) = monomial.over(&one) {
            total += f64::from(monomial.z[j]) * power(&quotient, z) * rate;
        }
        if let Some(quotient) = monomial.over(&one.conjugate()) {
            total += f64::from(monomial.conj[j]) * power(&quotient, z) * rate.conj();
        }
    }
    total
}

/// The base state in the jets of the residual.
pub(super) fn base_jets(problem: &Problem, point: &[f64], jets: &[Jet]) -> Vec<f64> {
    let structure = problem.structure();
    let value = |jet: &Jet| structure.base_jet(*jet, point);
    jets.iter().map(value).collect()
}
