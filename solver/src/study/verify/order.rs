//! Part 1: the residual order.
//!
//! X⁰ plus the series through X[3;3], with dA/dt = a0 A + a2 A³ and dθ/dt = b0 + b2 A², put into the
//! *unexpanded* residual and boundary conditions: the defect must fall as A⁴. A wrong factor, shift,
//! mass term, boundary datum or sign in N3 shows here, off criticality too. Every balance and every
//! condition is judged by itself, where its defect stands clear of what rounding leaves.

use super::{Check, Verdict};
use crate::collocation::{Grid, GridKind};
use crate::error::Result;
use crate::model::{C64, End, Jet, ResidualCall, ResidualId, WithRounding};
use crate::problem::Problem;
use crate::weakly::{Expansion, LandauPoint};

/// Phases of the fundamental at which the defect is sampled: enough for the harmonics of A⁴.
const PHASES: usize = 12;
/// Halvings of the amplitude.
const HALVINGS: usize = 14;
/// A defect counts while it stands this far above what the discretisation leaves, which is an estimate …
const ABOVE_FLOOR: f64 = 300.0;
/// … and this far above a bound of the rounding errors.
const ABOVE_ROUNDING: f64 = 10.0;
/// Halvings before a defect counts as falling by its leading power.
const ASYMPTOTIC: usize = 2;
/// The slope, within 2%.
const SLOPE: f64 = 4.0;

/// How the defect falls.
pub struct ResidualOrder {
    /// The least log2 of the ratio of a defect at A and at A/2; nothing where rounding hides all.
    pub slope: Option<f64>,
    /// That A.
    pub amplitude: f64,
    /// The balance or condition of the least slope, or of the highest floor where nothing stands clear.
    pub row: String,
}

pub(super) fn check(point: &LandauPoint) -> Result<Vec<Check>> {
    let found = residual_order(&point.third_order()?);
    let bound = SLOPE * 0.98;
    let name = "order of the residual in A".to_owned();
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
                "log2 of the ratio of defects at A = {:.2e} and its half, {}",
                found.amplitude, found.row
            ),
        ),
    };
    Ok(vec![Check {
        part: 1,
        name,
        value,
        bound,
        verdict,
        detail,
    }])
}

/// What is left of one balance or condition, and what rounding may have left.
#[derive(Clone, Copy, Default)]
struct Defect {
    value: f64,
    rounding: f64,
}

/// The order at which the defect of the whole expansion falls.
pub fn residual_order(expansion: &Expansion) -> ResidualOrder {
    let start = start(expansion);
    let at = |amplitude: f64| defects(expansion, amplitude);
    let amplitudes: Vec<f64> = (0..HALVINGS)
        .map(|i| start / f64::powi(2.0, i as i32))
        .collect();
    let measured: Vec<Vec<Defect>> = amplitudes.iter().map(|&a| at(a)).collect();
    // What the discretisation leaves at A = 0, and for each unit of A (from an amplitude so small that A⁴
    // is nothing).
    let rest = at(0.0);
    let tiny = start * 1e-5;
    let linear: Vec<f64> = at(tiny)
        .iter()
        .zip(&rest)
        .map(|(d, r)| (d.value - 2.0 * r.value).max(0.0) / tiny)
        .collect();
    let floor = |row: usize, i: usize| {
        let left = rest[row].value + linear[row] * amplitudes[i];
        (ABOVE_FLOOR * left).max(ABOVE_ROUNDING * measured[i][row].rounding)
    };
    let judged = |row: usize| {
        let clear = |i: &usize| {
            let value = measured[*i][row].value;
            value > floor(row, *i) && value > 0.0
        };
        let last = (ASYMPTOTIC + 1..HALVINGS).rev().find(clear)?;
        let slope = (measured[last - 1][row].value / measured[last][row].value).log2();
        Some((slope, row, last - 1))
    };
    let judged = (0..rest.len()).filter_map(judged);
    let least = judged.min_by(|a, b| a.0.total_cmp(&b.0));
    match least {
        Some((slope, row, i)) => ResidualOrder {
            slope: Some(slope),
            amplitude: amplitudes[i],
            row: name(expansion.problem, row),
        },
        None => {
            let share = |row: &usize| measured[0][*row].value / floor(*row, 0).max(1e-300);
            let nearest = (0..rest.len()).max_by(|a, b| share(a).total_cmp(&share(b)));
            ResidualOrder {
                slope: None,
                amplitude: amplitudes[0],
                row: name(expansion.problem, nearest.unwrap_or(0)),
            }
        }
    }
}

/// A balance, or a condition at an end.
fn name(problem: &Problem, row: usize) -> String {
    let balances = &problem.structure().balances;
    match balances.get(row) {
        Some(balance) => format!("balance `{balance}`"),
        None => {
            let wall = &problem.direct.walls[row - balances.len()];
            let coordinate = problem.structure().coordinate.as_deref().unwrap_or("y");
            let place = match wall.end {
                End::Lower => problem.base.lower,
                End::Upper => problem.base.upper,
            };
            format!(
                "condition {} (at {coordinate} = {place})",
                row - balances.len() + 1
            )
        }
    }
}

/// An amplitude at which the series still makes sense: a tenth of where second or third order catches up
/// with the first, in the fields that have a time derivative (a pressure has a scale of its own) or in the
/// amplitude equation.
fn start(expansion: &Expansion) -> f64 {
    let structure = expansion.problem.structure();
    let columns = &expansion.problem.direct.layout.columns;
    let moving = (0..columns.len()).filter(|&field| {
        structure
            .linear
            .iter()
            .any(|t| t.jet.t > 0 && usize::from(t.jet.field) == field)
    });
    let moving: Vec<_> = moving.map(|field| &columns[field]).collect();
    // The largest ratio of a later mode to the fundamental, field by field: units do not matter.
    let ratio = |keys: [(usize, usize); 2]| {
        let size = |key: &(usize, usize), block: &crate::collocation::Block| {
            let values = &expansion.modes[key].values[block.offset..][..block.len];
            values.iter().map(|v| v.norm()).fold(0.0, f64::max)
        };
        // A field that the fundamental leaves alone but for rounding has no such ratio.
        let first = expansion.modes[&(1, 1)].values.iter().map(|v| v.norm());
        let least = 1e-10 * first.fold(0.0, f64::max);
        let present = moving.iter().filter(|block| size(&(1, 1), block) > least);
        let ratios = present.map(|block| {
            let later = keys.iter().map(|key| size(key, block)).fold(0.0, f64::max);
            later / size(&(1, 1), block)
        });
        ratios.fold(0.0, f64::max)
    };
    let (second, third) = (ratio([(0, 2), (2, 2)]), ratio([(1, 3), (3, 3)]));
    // The cubic term of the amplitude equation beside the slow rates.
    let cubic = (expansion.landau[1].norm() / expansion.pair.scale).sqrt();
    let reach = second.max(third.sqrt()).max(cubic);
    if reach > 0.0 {
        return 0.1 / reach;
    }
    let first = expansion.modes[&(1, 1)].values.iter().map(|v| v.norm());
    0.1 / first.fold(1e-300, f64::max)
}

/// The largest residual of every balance (at its own points) and of every boundary condition.
fn defects(expansion: &Expansion, amplitude: f64) -> Vec<Defect> {
    let problem = expansion.problem;
    let balances = problem.structure().balances.len();
    let mut found = vec![Defect::default(); balances + problem.direct.walls.len()];
    let mut widen = |row: usize, value: f64, size: f64| {
        let defect: &mut Defect = &mut found[row];
        defect.value = defect.value.max(value.abs());
        defect.rounding = defect.rounding.max(f64::EPSILON * size);
    };
    let layout = &problem.direct.layout;
    for (row, block) in layout.rows.iter().enumerate() {
        let twin = layout.rows[..row].iter().any(|b| b.grid == block.grid);
        if twin {
            continue;
        }
        let id = ResidualId::Balances;
        for value in residuals(expansion, amplitude, block.grid, id, balances) {
            let same = layout.rows.iter().enumerate();
            for (row, _) in same.filter(|(_, b)| b.grid == block.grid) {
                widen(row, value[row].value, value[row].size);
            }
        }
    }
    for (end, grid) in [(End::Lower, GridKind::Lower), (End::Upper, GridKind::Upper)] {
        let id = ResidualId::Conditions(problem.base.case);
        let count = problem.direct.walls.len();
        if !problem.direct.walls.iter().any(|w| w.end == end) {
            continue;
        }
        // The perturbation obeys B(X⁰ + X') − B(X⁰) = 0.
        let with = residuals(expansion, amplitude, grid, id, count);
        let without = residuals(expansion, 0.0, grid, id, count);
        for (a, b) in with.iter().zip(&without) {
            for (index, wall) in problem.direct.walls.iter().enumerate() {
                if wall.end == end {
                    let difference = a[index] - b[index];
                    widen(balances + index, difference.value, difference.size);
                }
            }
        }
    }
    found
}

/// Residuals at all points of a grid and all phases.
fn residuals(
    expansion: &Expansion,
    amplitude: f64,
    grid: GridKind,
    id: ResidualId,
    count: usize,
) -> Vec<Vec<WithRounding>> {
    let problem = expansion.problem;
    let jets = &problem.structure().residual_jets;
    let points = Grid::new(grid).nodes;
    let base: Vec<Vec<f64>> = points
        .iter()
        .map(|&xi| problem.base.point(problem.model, xi, expansion.k))
        .collect();
    // Each mode with the factor of its time derivative, A-dependence of the rates included.
    let mut tables = Vec::new();
    for (&(harmonic, order), mode) in &expansion.modes {
        let rate = instantaneous_rate(expansion, amplitude, harmonic, order);
        let mut moving = mode.clone();
        moving.rate = mode.values.iter().map(|v| v * rate).collect();
        let drifting = moving.rate.iter_mut().zip(&mode.drift);
        drifting.for_each(|(rate, drift)| *rate += drift);
        tables.push((
            harmonic,
            order,
            moving.jets(problem, expansion.k, jets, grid),
            moving.rounding(problem, expansion.k, jets, grid),
        ));
    }
    let mut all = Vec::new();
    for phase in 0..PHASES {
        let theta = 2.0 * std::f64::consts::PI * (phase as f64 + 0.25) / PHASES as f64;
        for (i, point) in base.iter().enumerate() {
            let base = base_jets(problem, point, jets);
            let mut x: Vec<WithRounding> = base.into_iter().map(WithRounding::from).collect();
            for (harmonic, order, table, rounding) in &tables {
                let size = amplitude.powi(*order as i32);
                let turn = C64::from_polar(1.0, *harmonic as f64 * theta);
                // X[0;m] stands once, the others with their conjugates.
                let weight = if *harmonic == 0 { size } else { 2.0 * size };
                for ((x, jet), size) in x.iter_mut().zip(table.at(i)).zip(&rounding[i]) {
                    x.value += weight * (jet * turn).re;
                    x.size += weight.abs() * size;
                }
            }
            let mut out = vec![WithRounding::from(0.0); count];
            problem
                .model
                .residual(id, point, ResidualCall::Rounding(&x, &mut out));
            all.push(out);
        }
    }
    all
}

/// m (a0 + a2 A²) + i k (b0 + b2 A²)
fn instantaneous_rate(expansion: &Expansion, amplitude: f64, harmonic: usize, order: usize) -> C64 {
    let (mut a, mut b, mut power) = (0.0, 0.0, 1.0);
    for c in &expansion.landau {
        a += c.re * power;
        b += c.im * power;
        power *= amplitude * amplitude;
    }
    C64::new(order as f64 * a, harmonic as f64 * b)
}

/// The base state in the jets of the residual.
pub(super) fn base_jets(problem: &Problem, point: &[f64], jets: &[Jet]) -> Vec<f64> {
    let structure = problem.structure();
    let value = |jet: &Jet| structure.base_jet(*jet, point);
    jets.iter().map(value).collect()
}
