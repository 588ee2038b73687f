//! Part 2: ⟨X†, L X⟩ = ⟨L†X†, X⟩ for smooth fields that obey the boundary conditions, by quadrature;
//! the spectrum of L† against the conjugate spectrum of L.

use super::{Check, Setup};
use crate::error::Result;
use crate::model::layout::read_terms;
use crate::model::{C64, Id, Jet, KernelId, Table, evaluate};
use crate::problem::{LinearProblem, Problem, symbol};
use crate::space::{Place, Series};
use crate::spectrum;
use crate::study::quadrature::adjoint_mode;
use crate::wavevector::WaveVector;
use crate::weakly::{LandauPoint, Selection};

/// Degree of the random fields.
const DEGREE: usize = 11;

pub(super) fn check(setup: &Setup, point: &LandauPoint) -> Result<Vec<Check>> {
    let problem = &point.problem;
    if let Err(reason) = problem.adjoint() {
        return Ok(vec![Check::left_out(2, "duality", reason.to_string())]);
    }
    let k = point.pair.k;
    let mut checks = Vec::new();
    let worst = (0..4)
        .map(|seed| duality(problem, k, seed))
        .fold(0.0, f64::max);
    let detail = match problem.resolution {
        None => "random numbers".to_owned(),
        Some(m) => format!("random smooth fields, {} points", 4 * m + 1),
    };
    checks.push(Check::below(2, "duality, relative", worst, 1e-10, detail));
    let mut resolutions = vec![setup.effective_resolution()];
    resolutions.extend(setup.finer_resolution().map(Some));
    for resolution in resolutions {
        let other = Problem::new(&problem.base, resolution)?;
        let pair = crate::weakly::select(&other, k, Selection::Near(point.c0))?;
        let difference = (adjoint_mode(&other, &pair)?.c.conj() - pair.c).norm();
        let name = match resolution {
            None => "|c0(L) − conj c0(L†)|".to_owned(),
            Some(m) => format!("|c0(L) − conj c0(L†)| at M = {m}"),
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
pub fn duality(problem: &Problem, k: WaveVector, seed: u64) -> f64 {
    let Ok(adjoint) = problem.adjoint() else {
        return f64::NAN;
    };
    let mut random = Random(seed.wrapping_mul(0x9e37_79b9).wrapping_add(12345));
    let structure = problem.structure();
    let x = Smooth::admissible(&problem.direct, k, &mut random);
    let y = Smooth::admissible(adjoint, k, &mut random);
    let (mut total, mut size) = (C64::new(0.0, 0.0), 0.0);
    for (place, weight) in problem.quadrature().nodes {
        let point = problem.base.at(place, k);
        let direct = evaluate(problem.model(), KernelId::Linear, &point);
        let mirrored = evaluate(problem.model(), KernelId::Adjoint, &point);
        for (term, c) in read_terms(&structure.linear, &direct) {
            if term.jet.t == 0 && x.has(term.jet.of) {
                let value = c * x.jet(term.jet, place);
                let left = y.jet(Jet::value(term.row), place).conj();
                total += weight * left * value;
                size += (weight * left * value).norm();
            }
        }
        for (term, c) in read_terms(&structure.adjoint, &mirrored) {
            if term.jet.t == 0 && x.has(term.row) {
                let value = (c * y.jet(term.jet, place)).conj();
                total -= weight * value * x.jet(Jet::value(term.row), place);
            }
        }
    }
    total.norm() / size.max(1e-300)
}

/// Random smooth fields, by Chebyshev coefficients, that obey the conditions of a problem.
struct Smooth<'p, Row, Column> {
    problem: &'p LinearProblem<Row, Column>,
    k: WaveVector,
    series: Table<Column, Vec<C64>>,
}

impl<'p, Row: Id, Column: Id> Smooth<'p, Row, Column> {
    fn admissible(
        problem: &'p LinearProblem<Row, Column>,
        k: WaveVector,
        random: &mut Random,
    ) -> Self {
        let degree = if problem.space.is_point() { 0 } else { DEGREE };
        let coefficient = |n: usize| 1.0 / (1.0 + (n * n) as f64);
        let mut one = || {
            (0..=degree)
                .map(|n| random.complex() * coefficient(n))
                .collect()
        };
        let mut series: Table<Column, Vec<C64>> = problem.layout.columns.map(|_| one());
        let (q, width) = (problem.walls.len(), degree + 1);
        if q == 0 {
            return Smooth { problem, k, series };
        }
        let size = series.len() * width;
        // The smallest change that meets the conditions: x − Wᴴ (W Wᴴ)⁻¹ W x.
        let w = nalgebra::DMatrix::from_fn(q, size, |row, position| {
            let wall = &problem.walls[row];
            let (column, n) = (Column::at(position / width), position % width);
            let terms = wall.linear.iter().filter(|(jet, _)| jet.of == column);
            let term = |(jet, c): &(Jet<Column>, f64)| {
                let order = usize::from(jet.y);
                let polynomial = problem.space.polynomial(n, order);
                let place = problem.space.end(wall.end);
                let value = problem.space.evaluate(&polynomial, place, order)[order];
                symbol(jet, k) * *c * value
            };
            terms.map(term).sum::<C64>()
        });
        let x = nalgebra::DVector::from_fn(size, |i, _| series[Column::at(i / width)][i % width]);
        let gram = &w * w.adjoint();
        if let Some(multiplier) = gram.lu().solve(&(&w * &x)) {
            let corrected = x - w.adjoint() * multiplier;
            for (i, value) in corrected.iter().enumerate() {
                series[Column::at(i / width)][i % width] = *value;
            }
        }
        Smooth { problem, k, series }
    }

    /// Whether a column is a profile.
    fn has(&self, column: Column) -> bool {
        self.series.find(column).is_some()
    }

    fn jet(&self, jet: Jet<Column>, place: Place) -> C64 {
        let (own, order) = (&self.series[jet.of], usize::from(jet.y));
        let part = |of: fn(&C64) -> f64| {
            let series = Series::new(own.iter().map(of).collect(), order);
            self.problem.space.evaluate(&series, place, order)[order]
        };
        symbol(&jet, self.k) * C64::new(part(|c| c.re), part(|c| c.im))
    }
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
