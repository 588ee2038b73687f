//! Part 2: ⟨X†, L X⟩ = ⟨L†X†, X⟩ for smooth fields that obey the boundary conditions, by quadrature;
//! the spectrum of L† against the conjugate spectrum of L.

use super::{Check, Setup};
use crate::base::BaseState;
use crate::collocation::{Grid, Series};
use crate::error::Result;
use crate::model::{C64, End, Jet, KernelId, evaluate};
use crate::problem::{LinearProblem, Problem, quarter_turn};
use crate::spectrum;
use crate::study::quadrature::adjoint_mode;
use crate::weakly::{LandauPoint, Selection, quadrature_grid, quadrature_weights};

/// Degree of the random fields.
const DEGREE: usize = 11;

pub(super) fn check(setup: &Setup, base: &BaseState, point: &LandauPoint) -> Result<Vec<Check>> {
    let problem = point.problem;
    if let Err(reason) = problem.adjoint() {
        return Ok(vec![Check::left_out(2, "duality", reason.to_string())]);
    }
    let k = point.k();
    let mut checks = Vec::new();
    let worst = (0..4)
        .map(|seed| duality(problem, k, seed))
        .fold(0.0, f64::max);
    let detail = match problem.resolution {
        0 => "random numbers".to_owned(),
        m => format!("random smooth fields, {} points", 4 * m + 1),
    };
    checks.push(Check::below(2, "duality, relative", worst, 1e-10, detail));
    let mut resolutions = vec![setup.effective_resolution()];
    if resolutions[0] > 0 {
        resolutions.push(resolutions[0] + resolutions[0].div_ceil(2));
    }
    for resolution in resolutions {
        let other = Problem::new(setup.model, base, &setup.discretisation, resolution)?;
        let pair = crate::weakly::select(&other, k, Selection::Near(point.c0))?;
        let difference = (adjoint_mode(&other, &pair)?.c.conj() - pair.c).norm();
        let name = match resolution {
            0 => "|c0(L) − conj c0(L†)|".to_owned(),
            m => format!("|c0(L) − conj c0(L†)| at M = {m}"),
        };
        checks.push(Check::report(2, name, difference, "two discretisations"));
    }
    let direct = spectrum::eigenvalues(problem, k)?;
    let adjoint = spectrum::adjoint_eigenvalues(problem, k)?;
    let leading = direct
        .values
        .first()
        .zip(adjoint.values.first())
        .map_or(f64::NAN, |(a, b)| (a - b.conj()).norm().min((a - b).norm()));
    checks.push(Check::report(
        2,
        "leading eigenvalues of L and L†, difference",
        leading,
        "each discretised on its own",
    ));
    Ok(checks)
}

/// |⟨Y, L X⟩ − ⟨L†Y, X⟩| over the sum of the moduli.
pub fn duality(problem: &Problem, k: f64, seed: u64) -> f64 {
    let Ok(adjoint) = problem.adjoint() else {
        return f64::NAN;
    };
    let mut random = Random(seed.wrapping_mul(0x9e37_79b9).wrapping_add(12345));
    let structure = problem.structure();
    let x = admissible(&problem.direct, problem, k, &mut random);
    let y = admissible(adjoint, problem, k, &mut random);
    let grid = quadrature_grid(problem);
    let weights = quadrature_weights(problem, grid);
    let (mut total, mut size) = (C64::new(0.0, 0.0), 0.0);
    for (i, &xi) in Grid::new(grid).nodes.iter().enumerate() {
        let point = problem.base.point(problem.model, xi, k);
        let direct = evaluate(problem.model, KernelId::Linear, &point);
        let mirrored = evaluate(problem.model, KernelId::Adjoint, &point);
        let profiles = structure.profiles();
        for (term, c) in structure.linear.iter().zip(&direct) {
            if term.jet.t == 0 && usize::from(term.jet.field) < profiles {
                let value = *c * jet_value(problem, &x, k, term.jet, xi);
                let left = jet_value(problem, &y, k, Jet::value(term.row), xi).conj();
                total += weights[i] * left * value;
                size += (weights[i] * left * value).norm();
            }
        }
        for (term, c) in structure.adjoint.iter().zip(&mirrored) {
            if term.jet.t == 0 && term.row < profiles {
                let value = (*c * jet_value(problem, &y, k, term.jet, xi)).conj();
                total -= weights[i] * value * jet_value(problem, &x, k, Jet::value(term.row), xi);
            }
        }
    }
    total.norm() / size.max(1e-300)
}

/// Chebyshev coefficients of random smooth fields that obey the conditions of a problem.
fn admissible(
    linear: &LinearProblem,
    problem: &Problem,
    k: f64,
    random: &mut Random,
) -> Vec<Vec<C64>> {
    let columns = linear.layout.columns.len();
    let degree = if problem.resolution == 0 { 0 } else { DEGREE };
    let mut series: Vec<Vec<C64>> = (0..columns)
        .map(|_| {
            (0..=degree)
                .map(|n| random.complex() / (1.0 + (n * n) as f64))
                .collect()
        })
        .collect();
    let size = columns * (degree + 1);
    let q = linear.walls.len();
    if q == 0 {
        return series;
    }
    // The smallest change that meets the conditions: x − Wᴴ (W Wᴴ)⁻¹ W x.
    let w = nalgebra::DMatrix::from_fn(q, size, |row, column| {
        let wall = &linear.walls[row];
        let xi = if wall.end == End::Lower { -1.0 } else { 1.0 };
        let (field, n) = (column / (degree + 1), column % (degree + 1));
        let mut unit = vec![0.0; degree + 1];
        unit[n] = 1.0;
        let terms = wall
            .linear
            .iter()
            .filter(|(jet, _)| usize::from(jet.field) == field);
        terms
            .map(|(jet, c)| {
                symbol(problem, *jet, k)
                    * *c
                    * Series::new(unit.clone(), jet.y.into()).values(xi, jet.y.into())
                        [usize::from(jet.y)]
            })
            .sum::<C64>()
    });
    let x = nalgebra::DVector::from_fn(size, |i, _| series[i / (degree + 1)][i % (degree + 1)]);
    let gram = &w * w.adjoint();
    if let Some(multiplier) = gram.lu().solve(&(&w * &x)) {
        let corrected = x - w.adjoint() * multiplier;
        for (i, value) in corrected.iter().enumerate() {
            series[i / (degree + 1)][i % (degree + 1)] = *value;
        }
    }
    series
}

fn symbol(problem: &Problem, jet: Jet, k: f64) -> C64 {
    quarter_turn(usize::from(jet.x))
        * k.powi(i32::from(jet.x))
        * k.abs().powi(i32::from(jet.absx))
        * problem.scale().powi(i32::from(jet.y))
}

fn jet_value(problem: &Problem, series: &[Vec<C64>], k: f64, jet: Jet, xi: f64) -> C64 {
    let Some(own) = series.get(usize::from(jet.field)) else {
        return C64::new(0.0, 0.0);
    };
    let order = usize::from(jet.y);
    let part = |of: fn(&C64) -> f64| {
        Series::new(own.iter().map(of).collect(), order).values(xi, order)[order]
    };
    symbol(problem, jet, k) * C64::new(part(|c| c.re), part(|c| c.im))
}

/// A small generator with a fixed seed: the certificate is the same on every run.
pub(super) struct Random(pub u64);

impl Random {
    /// Uniform in (−1, 1).
    pub fn number(&mut self) -> f64 {
        // Knuth's MMIX constants
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub fn complex(&mut self) -> C64 {
        C64::new(self.number(), self.number())
    }
}
