//! Part 1: the residual order.
//!
//! X⁰ plus the series through X[3;3], with dA/dt = a0 A + a2 A³ and dθ/dt = b0 + b2 A², put into the
//! *unexpanded* residual and boundary conditions: the defect must fall as A⁴. A wrong factor, shift,
//! mass term, boundary datum or sign in N3 shows here, off criticality too.

use super::Check;
use crate::collocation::{Grid, GridKind};
use crate::error::Result;
use crate::model::{C64, End, Jet, ResidualCall, ResidualId};
use crate::problem::Problem;
use crate::weakly::{Expansion, LandauPoint, Mode};

/// Phases of the fundamental at which the defect is sampled: enough for the harmonics of A⁴.
const PHASES: usize = 12;
/// Halvings of the amplitude.
const HALVINGS: usize = 14;
/// A defect counts while it stands this far above what rounding leaves at A = 0.
const ABOVE_FLOOR: f64 = 300.0;
/// The slope, within 2%.
const SLOPE: f64 = 4.0;

pub(super) fn check(point: &LandauPoint) -> Result<Vec<Check>> {
    let expansion = point.third_order()?;
    let list = defects(&expansion);
    let (slope, amplitude) = slope(&list, &floor(&expansion));
    let detail = format!("log2 of the ratio of defects at A = {amplitude:.2e} and its half");
    let passed = slope.is_finite() && slope >= SLOPE * 0.98;
    let name = "order of the residual in A".to_owned();
    Ok(vec![Check {
        part: 1,
        name,
        value: slope,
        bound: SLOPE * 0.98,
        passed,
        detail,
    }])
}

/// Amplitudes and defects, each amplitude half the one before.
pub fn defects(expansion: &Expansion) -> Vec<(f64, f64)> {
    let start = start(expansion);
    (0..HALVINGS)
        .map(|i| start / f64::powi(2.0, i as i32))
        .map(|amplitude| (amplitude, defect(expansion, amplitude)))
        .collect()
}

/// An amplitude at which the series still makes sense, by the fields that have a time derivative: a
/// pressure has a scale of its own.
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
    let size = |key: (usize, usize)| {
        let values = &expansion.modes[&key].values;
        let own = moving
            .iter()
            .flat_map(|block| &values[block.offset..block.offset + block.len]);
        own.map(|v| v.norm()).fold(1e-300, f64::max)
    };
    let (first, second) = (size((1, 1)), size((0, 2)).max(size((2, 2))));
    // Where second order catches up with first, the series is of no use.
    0.1 * (1.0 / first).min(first / second)
}

/// What rounding leaves of the defect: at A = 0, and for each unit of A (from an amplitude so small
/// that A⁴ is nothing).
pub fn floor(expansion: &Expansion) -> (f64, f64) {
    let rest = defect(expansion, 0.0);
    let tiny = start(expansion) * 1e-5;
    // What does not stand out of the rest is the rest.
    let slope = (defect(expansion, tiny) - 2.0 * rest).max(0.0) / tiny;
    (rest, slope)
}

/// The slope between the two smallest amplitudes whose defects stand clear of the floor.
pub fn slope(defects: &[(f64, f64)], floor: &(f64, f64)) -> (f64, f64) {
    let clear = |&(a, d): &(f64, f64)| d > ABOVE_FLOOR * (floor.0 + floor.1 * a) && d > 0.0;
    let mut pairs = defects.windows(2).filter(|w| clear(&w[1]));
    pairs
        .next_back()
        .map_or((f64::NAN, f64::NAN), |w| ((w[0].1 / w[1].1).log2(), w[0].0))
}

/// Largest residual over all balances (at their own points) and boundary conditions.
fn defect(expansion: &Expansion, amplitude: f64) -> f64 {
    let problem = expansion.problem;
    let structure = problem.structure();
    let mut worst = 0.0_f64;
    for (row, block) in problem.direct.layout.rows.iter().enumerate() {
        let values = residuals(
            expansion,
            amplitude,
            block.grid,
            ResidualId::Balances,
            structure.balances.len(),
        );
        for value in values {
            worst = worst.max(value[row].abs());
        }
    }
    for (index, wall) in problem.direct.walls.iter().enumerate() {
        let kind = if wall.end == End::Lower {
            GridKind::Lower
        } else {
            GridKind::Upper
        };
        let id = ResidualId::Conditions(problem.base.case);
        // The perturbation obeys B(X⁰ + X') − B(X⁰) = 0.
        let with = residuals(expansion, amplitude, kind, id, problem.direct.walls.len());
        let without = residuals(expansion, 0.0, kind, id, problem.direct.walls.len());
        for (a, b) in with.iter().zip(&without) {
            worst = worst.max((a[index] - b[index]).abs());
        }
    }
    worst
}

/// Residuals at all points of a grid and all phases.
fn residuals(
    expansion: &Expansion,
    amplitude: f64,
    grid: GridKind,
    id: ResidualId,
    count: usize,
) -> Vec<Vec<f64>> {
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
        let moving = Mode {
            rate: mode.values.iter().map(|v| v * rate).collect(),
            ..mode.clone()
        };
        tables.push((
            harmonic,
            order,
            moving.jets(problem, expansion.k, jets, grid),
        ));
    }
    let mut all = Vec::new();
    for phase in 0..PHASES {
        let theta = 2.0 * std::f64::consts::PI * (phase as f64 + 0.25) / PHASES as f64;
        for (i, point) in base.iter().enumerate() {
            let mut x = base_jets(problem, point, jets);
            for (harmonic, order, table) in &tables {
                let size = amplitude.powi(*order as i32);
                let turn = C64::from_polar(1.0, *harmonic as f64 * theta);
                // X[0;m] stands once, the others with their conjugates.
                let weight = if *harmonic == 0 { size } else { 2.0 * size };
                for (value, jet) in x.iter_mut().zip(table.at(i)) {
                    *value += weight * (jet * turn).re;
                }
            }
            let mut out = vec![0.0; count];
            problem
                .model
                .residual(id, point, ResidualCall::Real(&x, &mut out));
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
    jets.iter()
        .map(|jet| {
            let order = usize::from(jet.y);
            let field = usize::from(jet.field);
            if jet.is_base() && order <= structure.base_order {
                point[structure.base_position(field, order)]
            } else {
                0.0
            }
        })
        .collect()
}
