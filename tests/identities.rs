//! Identities that hold for every model: duality, symmetry, second routes, residual order, tape
//! against emitted code; and that a planted mistake breaks them.

use crate::support::{built, tape};
use landau_solver::Model;
use landau_solver::model::{
    BalanceId, C64, CaseId, Kernel, KernelId, ResidualId, Structure, evaluate,
};
use landau_solver::problem::Problem;
use landau_solver::series::Monomial;
use landau_solver::space::Place;
use landau_solver::study::Setup;
use landau_solver::study::verify::{duality, residual_order, second_route};
use landau_solver::wavevector::WaveVector;
use landau_solver::weakly::{self, Expansion, Selection};
use std::sync::Arc;

/// Model, wavenumber, M, parameters: off criticality throughout.
type Case = (
    &'static str,
    f64,
    usize,
    &'static [(&'static str, &'static str)],
);

const CASES: [Case; 13] = [
    ("vibrated_bed", 0.16, 50, &[]),
    ("vibrated_bed", 0.12, 50, &[]),
    (
        "vibrated_bed",
        0.13,
        50,
        &[("top", "flux_free"), ("bulk", "spheres")],
    ),
    (
        "vibrated_bed",
        0.13,
        50,
        &[
            ("bulk", "disks"),
            ("viscosity", "variable_prandtl"),
            ("shear_work", "0"),
        ],
    ),
    ("swift_hohenberg_strip", 1.05, 24, &[("r", "1.2")]),
    ("swift_hohenberg", 0.97, 10, &[("r", "0.2")]),
    ("kuramoto_sivashinsky", 0.9, 10, &[("nu", "0.9")]),
    ("brusselator", 1.9, 10, &[("B", "4.2")]),
    ("rayleigh_benard", 3.0, 30, &[("Ra", "2000")]),
    (
        "rayleigh_benard",
        2.2,
        30,
        &[("Ra", "800"), ("walls", "free"), ("Pr", "0.7")],
    ),
    ("plane_poiseuille", 1.0, 60, &[("R", "8000")]),
    ("plane_poiseuille_flux", 1.0, 60, &[("R", "8000")]),
    ("robin_strip", 1.0, 24, &[]),
];

fn with_problem<R>(
    model: &Arc<dyn Model>,
    resolution: usize,
    settings: &[(&str, &str)],
    action: impl FnOnce(&Arc<Problem>) -> R,
) -> R {
    let mut setup = Setup::new(model.clone(), resolution).expect("M");
    for (name, value) in settings {
        setup
            .parameters
            .set_text(model.structure(), name, value)
            .expect("a parameter");
    }
    let base = setup.base(None).expect("a base state");
    action(&setup.problem(&base).expect("a problem"))
}

/// The order of the residual in A.
fn order(problem: &Arc<Problem>, k: f64) -> f64 {
    order_of(problem, k, 3)
}

fn order_of(problem: &Arc<Problem>, k: f64, order: usize) -> f64 {
    let pair = weakly::select(problem, WaveVector::along_x(k), Selection::Leading).expect("a mode");
    let expansion = Expansion::to(problem, vec![pair], order).expect("the expansion");
    residual_order(&expansion).slope.unwrap_or(f64::NAN)
}

/// c2 by the forms against c2 by the series of the residual, relative to what it is the sum of.
fn forms_against_series(problem: &Arc<Problem>, k: f64) -> f64 {
    let point =
        weakly::point(problem, WaveVector::along_x(k), Selection::Leading).expect("a point");
    let expansion = Expansion::to(problem, vec![point.pair.clone()], 2).expect("second order");
    let cubic = Monomial {
        z: vec![2],
        conj: vec![1],
    };
    let c2 = expansion.last_coefficients().coefficient(0, &cubic);
    (c2.expect("c2") - point.c2).norm() / point.size()
}

#[test]
fn residual_falls_as_fourth_power() {
    for (name, k, m, settings) in CASES {
        let found = with_problem(&built(name), m, settings, |p| order(p, k));
        assert!(
            (found - 4.0).abs() < 0.08,
            "{name} {settings:?} at k = {k}: order {found}"
        );
    }
}

#[test]
fn duality_by_quadrature() {
    for (name, k, m, settings) in CASES {
        let worst = with_problem(&built(name), m, settings, |p| {
            (0..6)
                .map(|seed| duality(p, WaveVector::along_x(k), seed))
                .fold(0.0, f64::max)
        });
        assert!(worst < 1e-10, "{name} {settings:?}: {worst:.2e}");
    }
}

#[test]
fn forms_are_symmetric_and_equal_the_series_route() {
    for (name, _, m, settings) in CASES {
        for degree in [2, 3] {
            let (difference, asymmetry) =
                with_problem(&built(name), m, settings, |p| second_route(p, degree));
            assert!(
                difference < 1e-10,
                "{name} N{degree}: {difference:.2e} from the series route"
            );
            assert!(
                asymmetry < 1e-12,
                "{name} N{degree}: asymmetry {asymmetry:.2e}"
            );
        }
    }
}

/// The same kernels interpreted: the same numbers to rounding.
#[test]
fn tape_equals_emitted_code() {
    for name in [
        "vibrated_bed",
        "rayleigh_benard",
        "plane_poiseuille_flux",
        "granular_couette",
        "robin_strip",
    ] {
        let (emitted, tape) = (built(name), tape(name));
        assert_eq!(emitted.structure(), tape.structure(), "{name}");
        with_problem(&emitted, 20, &[], |problem| {
            for part in [0.1, 0.55, 0.965] {
                let point = problem.base.at(Place::at(part), WaveVector::along_x(1.3));
                for kernel in [
                    KernelId::Base,
                    KernelId::Linear,
                    KernelId::Adjoint,
                    KernelId::Nonlinear,
                    KernelId::Conditions(CaseId(0)),
                    KernelId::Outputs,
                ] {
                    let (a, b) = (
                        evaluate(emitted.as_ref(), kernel, &point),
                        evaluate(tape.as_ref(), kernel, &point),
                    );
                    assert_eq!(a, b, "{name} {kernel:?}");
                }
                let structure = emitted.structure();
                let c = evaluate(emitted.as_ref(), KernelId::Nonlinear, &point);
                let jets = |seed: f64| -> Vec<C64> {
                    (0..structure.form_jets.len())
                        .map(|i| C64::new((seed + i as f64).sin(), (seed * i as f64).cos()))
                        .collect()
                };
                let (x, y) = (jets(0.3), jets(1.7));
                for row in structure.balances.ids() {
                    let (a, b) = (
                        emitted.form(2, row, &c, &[&x, &y]),
                        tape.form(2, row, &c, &[&x, &y]),
                    );
                    assert!(
                        (a - b).norm() <= 1e-13 * a.norm().max(1.0),
                        "{name} {row:?}: {a} {b}"
                    );
                }
            }
        });
    }
}

/// The continuous adjoint, discretised on its own, against the direct problem (P figure 3).
#[test]
fn adjoint_eigenvalue_along_the_sweep() {
    with_problem(&built("vibrated_bed"), 100, &[], |problem| {
        for k in [0.04, 0.07, 0.1, 0.13, 0.16, 0.174] {
            let pair =
                landau_solver::spectrum::leading(problem, WaveVector::along_x(k)).expect("a mode");
            let adjoint = landau_solver::study::quadrature::adjoint_mode(problem, &pair)
                .expect("its adjoint");
            let difference = (adjoint.c.conj() - pair.c).norm();
            assert!(difference < 1e-8, "k = {k}: {difference:.2e}");
        }
    });
}

/// At (16, 400) the difference is truncation, and falls with M.
#[test]
fn adjoint_difference_falls_with_resolution() {
    let settings: &[(&str, &str)] = &[("F", "16"), ("S", "400")];
    let difference = |m: usize| {
        with_problem(&built("vibrated_bed"), m, settings, |problem| {
            let pair = landau_solver::spectrum::leading(problem, WaveVector::along_x(0.1))
                .expect("a mode");
            let adjoint = landau_solver::study::quadrature::adjoint_mode(problem, &pair)
                .expect("its adjoint");
            (adjoint.c.conj() - pair.c).norm()
        })
    };
    let (coarse, fine) = (difference(50), difference(120));
    assert!(
        fine < 0.1 * coarse,
        "{coarse:.2e} at M = 50, {fine:.2e} at M = 120"
    );
}

/// The slow modes crowd at a continuous spectrum: what `spectrum` reports falls with M.
#[test]
fn slow_modes_of_the_adjoint_converge() {
    let reported = |resolution: usize| {
        let line = format!("spectrum vibrated_bed --k 0.05 -M {resolution}");
        let found = crate::support::json(&line);
        [1, 2, 4].map(|i| crate::support::number(&found, &format!("/difference/{i}")))
    };
    let (coarse, fine) = (reported(50), reported(100));
    for (coarse, fine) in coarse.iter().zip(fine) {
        assert!(
            fine < 0.1 * coarse,
            "{coarse:.2e} at M = 50, {fine:.2e} at M = 100"
        );
    }
}

/// A model one of whose emitted coefficients has the wrong sign.
struct Planted {
    model: Arc<dyn Model>,
    kernel: KernelId,
    coefficient: usize,
}

impl Model for Planted {
    fn structure(&self) -> &Structure {
        self.model.structure()
    }

    fn sources(&self) -> Vec<(String, String)> {
        self.model.sources()
    }

    fn laws(&self) -> Vec<(String, String)> {
        self.model.laws()
    }

    fn evaluate(&self, kernel: KernelId, point: &[f64], out: &mut [f64]) {
        self.model.evaluate(kernel, point, out);
        if kernel == self.kernel {
            out[self.coefficient] = -out[self.coefficient];
        }
    }

    fn form(&self, degree: usize, row: BalanceId, c: &[f64], x: &[&[C64]]) -> C64 {
        self.model.form(degree, row, c, x)
    }

    fn residual(&self, residual: ResidualId) -> Option<&Kernel> {
        self.model.residual(residual)
    }
}

fn plant(model: &Arc<dyn Model>, kernel: KernelId, coefficient: usize) -> Arc<dyn Model> {
    Arc::new(Planted {
        model: model.clone(),
        kernel,
        coefficient,
    })
}

/// A wrong sign in one emitted term breaks the second route and c2 by the series.
#[test]
fn planted_sign_is_found() {
    let count = built("vibrated_bed").structure().form_coefficients;
    for coefficient in [1, count / 3, 2 * count / 3] {
        let planted = plant(&built("vibrated_bed"), KernelId::Nonlinear, coefficient);
        let (cubic, second, third) = with_problem(&planted, 50, &[], |problem| {
            (
                forms_against_series(problem, 0.16),
                second_route(problem, 2).0,
                second_route(problem, 3).0,
            )
        });
        assert!(
            second.max(third) > 1e-6,
            "coefficient {coefficient} passed the second route"
        );
        assert!(
            cubic > 1e-6,
            "coefficient {coefficient} passed the comparison of c2: {cubic:.1e}"
        );
    }
}

/// Every coefficient of N2 and N3, of L†, and of every adjoint condition of two terms, one after another: its
/// wrong sign is noticed.
#[test]
fn every_planted_sign_is_found() {
    signs_are_found(&[
        ("swift_hohenberg_strip", 1.05, 20, &[("r", "1.2")]),
        ("rayleigh_benard", 3.0, 24, &[("Ra", "2000")]),
        ("robin_strip", 1.0, 20, &[]),
        ("granular_couette", 3.0, 10, &[]),
    ]);
}

/// The same of the bed, which has hundreds of them.
#[test]
#[ignore = "slow profile"]
fn every_planted_sign_of_the_bed_is_found() {
    signs_are_found(&[("vibrated_bed", 0.16, 24, &[])]);
}

/// Model, wavenumber, M, settings.
type Planting = (
    &'static str,
    f64,
    usize,
    &'static [(&'static str, &'static str)],
);

fn signs_are_found(cases: &[Planting]) {
    for &(name, k, m, settings) in cases {
        let model = built(name);
        let plant = |kernel: KernelId, coefficient: usize| plant(&model, kernel, coefficient);
        let structure = model.structure();
        // A coefficient that vanishes at this base state has no sign.
        let vanishes = |kernel: KernelId, coefficient: usize| {
            let values = with_problem(&model, m, settings, |problem| {
                let places = problem.space().evenly(5).into_iter();
                let states = places.map(|place| problem.base.at(place, WaveVector::along_x(k)));
                let values = states.map(|at| evaluate(model.as_ref(), kernel, &at)[coefficient]);
                values.collect::<Vec<f64>>()
            });
            values.iter().all(|v| *v == 0.0)
        };
        for coefficient in 0..structure.form_coefficients {
            if vanishes(KernelId::Nonlinear, coefficient) {
                continue;
            }
            let planted = plant(KernelId::Nonlinear, coefficient);
            let worst = with_problem(&planted, m, settings, |problem| {
                let routes = [2, 3].map(|degree| second_route(problem, degree).0);
                routes[0].max(routes[1])
            });
            assert!(
                worst > 1e-6,
                "{name}: {coefficient} passed the second route"
            );
        }
        let broken = |planted: &Arc<dyn Model>| {
            with_problem(planted, m, settings, |problem| {
                (0..4)
                    .map(|seed| duality(problem, WaveVector::along_x(k), seed))
                    .fold(0.0, f64::max)
            }) > 1e-8
        };
        for (coefficient, term) in structure.adjoint.iter().enumerate() {
            // M0† stands apart from L†, and a row of one term may be turned as a whole.
            if term.jet.t == 0 && !vanishes(KernelId::Adjoint, coefficient) {
                let planted = plant(KernelId::Adjoint, coefficient);
                assert!(broken(&planted), "{name}: term {coefficient} of L† passed");
            }
        }
        let Ok(conditions) = &structure.cases[CaseId(0)].adjoint else {
            panic!("{name} has adjoint conditions");
        };
        let mut first = 0;
        for condition in conditions {
            for coefficient in first..first + condition.jets.len() {
                let kernel = KernelId::AdjointConditions(CaseId(0));
                if condition.jets.len() > 1 && !vanishes(kernel, coefficient) {
                    let planted = plant(kernel, coefficient);
                    assert!(broken(&planted), "{name}: condition {coefficient} passed");
                }
            }
            first += condition.jets.len();
        }
    }
}
