//! The certificate of amplitude systems: the order of the defect, and what it notices.

use crate::support::built;
use landau_solver::model::C64;
use landau_solver::problem::Problem;
use landau_solver::study::Setup;
use landau_solver::study::verify::residual_order;
use landau_solver::wavevector::WaveVector;
use landau_solver::weakly::{Expansion, Selection, select};

fn with_expansion<R>(
    name: &str,
    m: usize,
    set: &[&str],
    modes: &[(f64, Option<C64>)],
    order: usize,
    action: impl FnOnce(&Problem, Expansion) -> R,
) -> R {
    let model = built(name);
    let mut setup = Setup::new(model.clone(), m).expect("M");
    let set: Vec<String> = set.iter().map(|s| (*s).to_owned()).collect();
    setup.set(&set).expect("parameters");
    let base = setup.base(None).expect("a base state");
    let problem = setup.problem(&base).expect("a problem");
    let pair = |&(k, near): &(f64, Option<C64>)| {
        let selection = near.map_or(Selection::Leading, Selection::Near);
        select(&problem, WaveVector::along_x(k), selection).expect("a mode")
    };
    let pairs = modes.iter().map(pair).collect();
    let expansion = Expansion::to(&problem, pairs, order).expect("the expansion");
    action(&problem, expansion)
}

/// The defect of order 3, 5, 7 falls as the fourth, sixth, eighth power, of pairs too.
#[test]
fn the_defect_falls_as_it_should() {
    type Case = (&'static str, usize, &'static [&'static str], &'static [f64]);
    let cases: [Case; 10] = [
        ("swift_hohenberg", 10, &["r=0.1"], &[1.0]),
        ("swift_hohenberg", 10, &["r=0.3", "b=0.5"], &[0.62, 1.24]),
        ("kuramoto_sivashinsky", 10, &["nu=0.9", "delta=0.5"], &[1.0]),
        (
            "swift_hohenberg_strip",
            24,
            &["r=1.36", "b=0.5"],
            &[0.63, 1.26],
        ),
        ("rayleigh_benard", 24, &["Ra=1800"], &[3.1]),
        ("brusselator", 10, &["B=4.2"], &[2.0]),
        ("granular_couette", 10, &["e=0.8", "H=27"], &[3.0]),
        // Linear balances: from fourth order on they are forced by the rates alone.
        ("robin_strip", 24, &[], &[1.0]),
        ("plane_poiseuille", 60, &["R=5800"], &[1.02]),
        ("vibrated_bed", 40, &[], &[0.054, 0.108]),
    ];
    for (name, m, set, k) in cases {
        for order in [3, 5, 7] {
            let modes: Vec<_> = k.iter().map(|&k| (k, None)).collect();
            let found = with_expansion(name, m, set, &modes, order, |_, e| residual_order(&e));
            if let Some(slope) = found.slope {
                let expected = (order + 1) as f64;
                assert!(
                    (slope - expected).abs() <= 0.02 * expected,
                    "{name} {k:?} at order {order}: {slope} at {:.1e} in {}",
                    found.amplitude,
                    found.row
                );
            } else {
                assert!(
                    order > 3,
                    "{name} {k:?}: rounding hides order 3, in {}",
                    found.row
                );
            }
        }
    }
}

/// A coefficient doubled, of the other sign, or conjugate: the defect falls by a lower power.
#[test]
fn planted_coefficients_are_noticed() {
    type Case = (
        &'static str,
        usize,
        &'static [&'static str],
        &'static [f64],
        usize,
    );
    let cases: [Case; 4] = [
        ("swift_hohenberg", 10, &["r=0.3", "b=0.5"], &[0.62, 1.24], 3),
        (
            "kuramoto_sivashinsky",
            10,
            &["nu=0.9", "delta=0.5"],
            &[1.0],
            5,
        ),
        ("swift_hohenberg_strip", 20, &["r=1.1", "b=0.7"], &[1.0], 5),
        ("rayleigh_benard", 20, &["Ra=1800"], &[3.1], 3),
    ];
    for (name, m, set, k, order) in cases {
        let modes: Vec<_> = k.iter().map(|&k| (k, None)).collect();
        with_expansion(name, m, set, &modes, order, |_, mut expansion| {
            for j in 0..k.len() {
                // The linear terms are eigenvalues, which other parts of the certificate see to.
                for term in 1..expansion.system.equations[j].len() {
                    let g = expansion.system.equations[j][term].g;
                    let degree = expansion.system.equations[j][term].monomial.degree() as f64;
                    for wrong in [-g, 2.0 * g, g.conj()] {
                        if (wrong - g).norm() <= 1e-9 * g.norm() {
                            continue;
                        }
                        expansion.system.equations[j][term].g = wrong;
                        let found = residual_order(&expansion).slope;
                        assert!(
                            found.is_some_and(|slope| slope < degree + 0.1),
                            "{name} {k:?}, equation {j}, term {term}: {found:?}"
                        );
                    }
                    expansion.system.equations[j][term].g = g;
                }
            }
        });
    }
}
