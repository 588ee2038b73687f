//! Right-hand sides of the closures at q = 0: the densities of integral conditions run on truncated polynomials.
//!
//! A condition keeps ∫ D(X) dy, averaged over x, at its value in the base state. In its expansion the coefficient of
//! z^p z̄^s is ∫ D1 X_α dy + ∫ F_α dy, with D1 the linear part of D and F_α made of lower orders, so that
//!
//! ∫ D1 X_α dy = −∫ F_α dy.
//!
//! A coefficient with q ≠ 0 averages to zero over x, and has no such row.

use super::forcing::{Group, Preparation};
use super::mode::Mode;
use super::scramble::Weight;
use crate::model::{C64, ResidualId};
use crate::problem::Problem;
use crate::series::{Arithmetic, Monomials};

/// The densities of a problem's closures, with their coefficients through the degree completed.
pub(super) struct Integrals {
    group: Group,
    /// Weights of the quadrature.
    measures: Vec<f64>,
}

impl Integrals {
    /// The densities around the base state of a problem; `None` where all are linear.
    pub fn new(prepare: &Preparation) -> Option<Self> {
        let problem = prepare.problem;
        let residual = ResidualId::Integrals(problem.base.case);
        let kernel = problem.model().residual(residual)?;
        let outputs: Vec<usize> = problem.borders.iter().map(|b| b.closure).collect();
        let quadrature = problem.quadrature();
        let measures = quadrature.nodes.iter().map(|(_, measure)| *measure);
        Some(Integrals {
            measures: measures.collect(),
            group: prepare.group(kernel, &outputs, quadrature.points),
        })
    }

    /// Whether the densities run in real arithmetic.
    pub fn is_real(&self) -> bool {
        self.group.is_real()
    }

    /// Begins the next degree, for the stored monomials `wanted`.
    pub fn begin(&mut self, monomials: &Monomials, degree: usize, wanted: &[usize]) {
        self.group.begin(monomials, degree, wanted);
    }

    /// ∫ F_α dy of every stored monomial of the degree begun, `[monomial][border of the problem]`.
    pub fn outputs(&mut self, monomials: &Monomials, degree: usize) -> Vec<Vec<C64>> {
        let count = monomials.of(degree).len();
        let jets = |_: usize, _: usize| None;
        let outputs = self.group.outputs(monomials, degree, &jets);
        let integral = |values: &Vec<C64>| -> C64 {
            let pairs = values.iter().zip(&self.measures);
            pairs.map(|(value, measure)| value * *measure).sum()
        };
        let of = |index: usize| outputs.iter().map(|row| integral(&row[index])).collect();
        (0..count).map(of).collect()
    }

    /// Completes the degree begun with its modes, `[monomial]`.
    pub fn complete(
        &mut self,
        problem: &Problem,
        monomials: &Monomials,
        degree: usize,
        modes: &[Option<Mode>],
    ) {
        self.group.complete(problem, monomials, degree, modes);
    }
}

/// Right-hand sides of the closures for X[0;2], −2 ∫ D2(X, X̄) dy, in the solver's basis, one for each border of the
/// problem; empty where all densities are linear. With weights every jet is multiplied by its weight.
pub(super) fn second_order(
    problem: &Problem,
    fundamental: &Mode,
    arithmetic: Arithmetic,
    weight: Option<Weight>,
) -> Vec<C64> {
    let prepare = Preparation::new(problem, fundamental.q, arithmetic, weight);
    let Some(mut integrals) = Integrals::new(&prepare) else {
        return Vec::new();
    };
    let mut monomials = Monomials::new(1);
    monomials.extend();
    integrals.begin(&monomials, 1, &[0]);
    integrals.complete(problem, &monomials, 1, &[Some(fundamental.clone())]);
    monomials.extend();
    let mean = monomials.of(2).iter().position(|m| m.is_real());
    let mean: Vec<usize> = mean.into_iter().collect();
    integrals.begin(&monomials, 2, &mean);
    let by_monomial = integrals.outputs(&monomials, 2);
    let values = mean.first().map_or(&[][..], |&index| &by_monomial[index]);
    let right = values.iter().zip(&problem.borders);
    right
        .map(|(value, border)| -value * border.factor())
        .collect()
}
