//! dc0/dp and dc0/dk of every model against central differences of c0 itself, parameters and wavenumbers in
//! boundary conditions among them.

use crate::support::{built, close, json, number};
use landau_solver::Model;
use landau_solver::model::C64;
use landau_solver::spectrum::{EigenPair, follow, leading};
use landau_solver::study::Setup;
use landau_solver::study::sensitivity::parameters;
use landau_solver::wavevector::WaveVector;
use landau_solver::weakly::Envelope;
use std::sync::Arc;

/// Model, wavenumber, M, settings.
type Case = (&'static str, f64, usize, &'static [&'static str]);

const CASES: [Case; 17] = [
    ("vibrated_bed", 0.16, 50, &[]),
    ("vibrated_bed", 0.16, 50, &["H=auto"]),
    ("vibrated_bed", 0.12, 50, &["top=decaying"]),
    ("vibrated_bed", 0.12, 50, &["top=flux_free", "bulk=disks"]),
    ("plane_poiseuille", 1.0, 60, &["R=8000"]),
    ("plane_poiseuille_flux", 0.9, 60, &["R=5000"]),
    ("rayleigh_benard", 3.0, 30, &["Ra=2000"]),
    (
        "rayleigh_benard",
        2.2,
        30,
        &["walls=free", "Ra=800", "Pr=0.7"],
    ),
    ("swift_hohenberg", 0.9, 10, &[]),
    ("swift_hohenberg_strip", 1.1, 24, &[]),
    ("kuramoto_sivashinsky", 0.8, 10, &[]),
    ("brusselator", 1.7, 10, &[]),
    ("brusselator_strip", 1.7, 20, &[]),
    ("granular_couette", 3.0, 10, &[]),
    ("robin_strip", 1.0, 30, &[]),
    ("robin_strip", 0.7, 30, &["beta=0", "gamma=2"]),
    ("swift_hohenberg", 1.1, 10, &["b=0"]),
];

/// c0 of the mode next to `pair` at other parameters and another wavenumber.
fn growth(setup: &Setup, pair: &EigenPair, k: f64) -> C64 {
    let base = setup.base(None).expect("a base state");
    let problem = setup.problem(&base).expect("a problem");
    follow(&problem, WaveVector::along_x(k), pair)
        .expect("the mode")
        .c
}

#[test]
fn derivatives_of_the_growth_rate() {
    for (name, k, m, settings) in CASES {
        let model = built(name);
        check(&model, name, k, m, settings);
    }
}

fn check(model: &Arc<dyn Model>, name: &str, k: f64, m: usize, settings: &[&str]) {
    let mut setup = Setup::new(model.clone(), m).expect("M");
    let settings: Vec<String> = settings.iter().map(|s| (*s).to_owned()).collect();
    setup.set(&settings).expect("settings");
    let base = setup.base(None).expect("a base state");
    let problem = setup.problem(&base).expect("a problem");
    let pair = leading(&problem, WaveVector::along_x(k)).expect("a mode");
    let slope = Envelope::of(&problem, &pair).expect("its envelope").slope;
    let unit = pair.scale.max(pair.c.norm());
    let compare = |what: &str, found: C64, by_difference: C64, size: f64| {
        // The difference itself is off by h² and by rounding over h.
        let allowed = 2e-5 * found.norm() + 2e-7 * unit / size;
        assert!(
            (found - by_difference).norm() <= allowed,
            "{name} {settings:?}: dc0/d{what} = {found:.8e}, by differences {by_difference:.8e}"
        );
    };
    let h = 1e-4 * k;
    let difference = (growth(&setup, &pair, k + h) - growth(&setup, &pair, k - h)) / (2.0 * h);
    compare("k", slope, difference, k);
    for (id, found) in parameters(&setup, &base, &pair) {
        let info = &model.structure().parameters[id];
        let found = found.expect("a derivative");
        let value = setup.parameters.values[id];
        let size = if value == 0.0 { 1.0 } else { value.abs() };
        let h = 1e-4 * size;
        let at = |value: f64| {
            let mut moved = setup.clone();
            moved.parameters.values[id] = value;
            growth(&moved, &pair, k)
        };
        let difference = if value + h > info.upper {
            // one-sided, of second order
            (at(value) * 3.0 - at(value - h) * 4.0 + at(value - 2.0 * h)) / (2.0 * h)
        } else if value - h < info.lower {
            (at(value + h) * 4.0 - at(value) * 3.0 - at(value + 2.0 * h)) / (2.0 * h)
        } else {
            (at(value + h) - at(value - h)) / (2.0 * h)
        };
        compare(&info.name, found, difference, size);
    }
}

/// What L does not hold has a derivative of zero exactly.
#[test]
fn parameters_of_nonlinear_terms_alone() {
    for (name, parameter) in [("swift_hohenberg", "b"), ("robin_strip", "gamma")] {
        let found = crate::support::json(&format!("point {name}"));
        let slope = crate::support::number(&found, &format!("/dc0/{parameter}/0"));
        assert_eq!(slope, 0.0, "{name}");
    }
}

/// The extremum over k of the bed's neutral curve with P (6.4), whose conditions hold |k|: there the growth
/// rate, computed beside it, is largest.
#[test]
fn extremum_with_a_wavenumber_in_a_condition() {
    let line =
        "critical vibrated_bed --set top=decaying --vary S --from 40 --to 60 --minimize k=0.06:0.2";
    let found = crate::support::json(line);
    let (s, k) = (
        crate::support::number(&found, "/value"),
        crate::support::number(&found, "/k"),
    );
    let model = built("vibrated_bed");
    let mut setup = Setup::new(model.clone(), 50).expect("M");
    let settings = ["top=decaying".to_owned(), format!("S={s}")];
    setup.set(&settings).expect("settings");
    let base = setup.base(None).expect("a base state");
    let problem = setup.problem(&base).expect("a problem");
    let growth = |k: f64| {
        leading(&problem, WaveVector::along_x(k))
            .expect("a mode")
            .c
            .re
    };
    // The crest of a parabola through three points.
    let h = 1e-3;
    let (low, middle, high) = (growth(k - h), growth(k), growth(k + h));
    let crest = k + 0.5 * h * (low - high) / (low - 2.0 * middle + high);
    assert!((crest - k).abs() < 2e-6, "{crest} beside {k}");
}

/// A parameter that is as good as zero: its derivative is that at zero, not what rounding leaves of it.
#[test]
fn parameters_next_to_zero() {
    for r in ["0", "1e-17", "-3e-12", "1e-300"] {
        let found = json(&format!("point swift_hohenberg --k 0.9 --set r={r}"));
        close("dc0/dr", number(&found, "/dc0/r/0"), 1.0, 1e-9);
        assert_eq!(number(&found, "/dc0/b/0"), 0.0);
    }
}
