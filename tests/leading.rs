//! Which mode a row of a sweep holds: the leading one of its place, whatever the range, the number of rows and the direction.

use crate::support::{built, landau, written};
use landau_solver::model::C64;
use landau_solver::spectrum;
use landau_solver::study::row::Row;
use landau_solver::study::sweep::{Range, RowMode, Sweep};
use landau_solver::study::{Axis, Setup, Silent};
use landau_solver::wavevector::WaveVector;
use std::sync::Arc;

/// A real mode at k = 1 and a wave at k = 1.6, uncoupled. Exactly: σ_u = r1 − (1 − k²)², σ_w = r2 − (1.6² − k²)²/4 ± 1.5 i.
const CROSSING: &str = r#"
model crossing "A real mode and a wave whose growth rates cross";
coordinates { x: periodic; }
parameters { r1 = 0.5; r2 = 0.4; k2 = 1.6; om = 1.5; }
fields { u; a; b; }
let w1 = u + dx(dx(u));
let w2 = k2^2*a + dx(dx(a));
let w3 = k2^2*b + dx(dx(b));
balance {
    eu: dt(u) = r1*u - w1 - dx(dx(w1)) - u^3 - u*(a^2 + b^2)/2;
    ea: dt(a) = r2*a - k2^2*w2/4 - dx(dx(w2))/4 - om*b - a*(a^2 + b^2) - a*u^2;
    eb: dt(b) = r2*b - k2^2*w3/4 - dx(dx(w3))/4 + om*a - b*(a^2 + b^2) - b*u^2;
}
base { u = 0; a = 0; b = 0; }
amplitude { integral(|u|^2 + |a|^2 + |b|^2) = 1; }
typical { k = 1; }
"#;

/// Growth rates of the real mode and of the wave.
fn growth(k: f64) -> [f64; 2] {
    let distance = |k0: f64| (k0 * k0 - k * k).powi(2);
    [0.5 - distance(1.0), 0.4 - distance(1.6) / 4.0]
}

fn crossing() -> Setup {
    let path = written("crossing.model", CROSSING);
    let sources = landau_codegen::build::read_sources(&path).expect("the spec can be read");
    let model = landau_codegen::tape(&sources).expect("the spec is well formed");
    Setup::new(Arc::new(model), 8).expect("M")
}

fn along_k(setup: &Setup, from: f64, to: f64, count: usize, mode: RowMode) -> Vec<Row> {
    let step = (to - from) / (count.max(2) - 1) as f64;
    let range = Range {
        name: "k".to_owned(),
        axis: Axis::Wavenumber,
        values: (0..count).map(|i| from + step * i as f64).collect(),
    };
    let sweep = Sweep::new(setup, vec![range], None, mode, Vec::new());
    sweep.expect("a sweep").run(&Silent)
}

#[test]
fn rows_hold_the_mode_that_grows_fastest() {
    let setup = crossing();
    for (from, to, count) in [
        (0.8, 2.2, 57),
        (2.2, 0.8, 57),
        (0.8, 2.2, 9),
        (1.2, 1.7, 200),
        (1.6, 1.0, 3),
        (1.6, 1.6, 1),
    ] {
        for row in along_k(&setup, from, to, count, RowMode::Leading) {
            let k = row.coordinates[0];
            let [real, wave] = growth(k);
            let exact = if real > wave {
                [real, 0.0]
            } else {
                [wave, 1.5]
            };
            let c0 = row.c0.expect("a mode");
            assert!(
                (c0[0] - exact[0]).abs() < 1e-12 && (c0[1] - exact[1]).abs() < 1e-12,
                "k = {k} of {from}..{to}: {c0:?} for {exact:?}"
            );
            assert_eq!(row.leading, Some(c0[0]));
        }
    }
}

/// A mode that is followed starts where the largest growth is, here the real one, and hides nothing.
#[test]
fn a_followed_mode_keeps_the_leading_growth_beside_it() {
    let setup = crossing();
    for (from, to) in [(0.8, 2.2), (2.2, 0.8)] {
        for row in along_k(&setup, from, to, 95, RowMode::Followed(None)) {
            let [real, wave] = growth(row.coordinates[0]);
            let c0 = row.c0.expect("a mode");
            assert!(
                (c0[0] - real).abs() < 1e-11 && c0[1] == 0.0,
                "{c0:?} for {real}"
            );
            let leading = row.leading.expect("a leading mode");
            assert!((leading - real.max(wave)).abs() < 1e-12);
        }
        let wave = C64::new(0.4, 1.5);
        for row in along_k(&setup, from, to, 95, RowMode::Followed(Some(wave))) {
            let exact = growth(row.coordinates[0])[1];
            let c0 = row.c0.expect("a mode");
            assert!((c0[0] - exact).abs() < 1e-11 && (c0[1] - 1.5).abs() < 1e-11);
        }
    }
}

/// The bed has a crowd of slow diffusive modes beside the convective one. Every row agrees with its own full spectrum.
#[test]
fn tall_beds_agree_with_their_full_spectra() {
    for (set, from, to) in [
        ("S=100", 0.01, 0.6),
        ("S=400", 0.02, 0.4),
        ("S=60", 0.15, 0.2),
        ("S=800", 0.05, 0.3),
    ] {
        let mut setup = Setup::new(built("vibrated_bed"), 50).expect("M");
        setup
            .set(&[set.to_owned(), "H=auto".to_owned()])
            .expect("parameters");
        let base = setup.base(None).expect("a base state");
        let problem = setup.problem(&base).expect("a problem");
        for row in along_k(&setup, from, to, 61, RowMode::Leading) {
            let k = row.coordinates[0];
            let full = spectrum::eigenvalues(&problem, WaveVector::along_x(k)).expect("a spectrum");
            let leading = row.leading.expect("a leading mode");
            let difference = (leading - full.values[0].re).abs();
            assert!(
                difference < 1e-8 * full.scale(),
                "{set}, k = {k}: {leading:e} for {:e}",
                full.values[0]
            );
        }
    }
}

/// Inside the unstable band no row says otherwise, on a range that is mostly stable.
#[test]
fn a_coarse_sweep_over_a_wide_range_finds_the_band() {
    let rows = along_k(
        &Setup::new(built("vibrated_bed"), 50).expect("M"),
        0.01,
        0.6,
        30,
        RowMode::Leading,
    );
    let unstable = |row: &&Row| row.c0.is_some_and(|c0| c0[0] > 0.0);
    assert_eq!(rows.iter().filter(unstable).count(), 7);
    let row = &rows[3];
    assert!((row.coordinates[0] - 0.071_034_5).abs() < 1e-6);
    // The program's own spectrum and point say so, which other tests compare with published numbers.
    assert!((row.c0.expect("a mode")[0] - 0.005_291_0).abs() < 1e-7);
    assert!((row.c2.expect("a coefficient")[0] + 5.396e-5).abs() < 1e-8);
    assert_eq!(row.bifurcation, "supercritical pitchfork");
}

/// The command counts unstable rows by the leading mode, also where another one is followed.
#[test]
fn unstable_rows_are_counted_by_the_leading_mode() {
    let path = written("crossing.model", CROSSING);
    let out = path.with_file_name("table.csv");
    let (model, out) = (path.display().to_string(), out.display().to_string());
    let asked = [
        "sweep",
        &model,
        "--over",
        "k=0.8:2.2:57",
        "--out",
        &out,
        "--json",
    ];
    for extra in [&[][..], &["--follow"], &["--follow", "--near", "0.5"]] {
        let answer = landau(&[&asked[..], extra, &["--force"]].concat());
        assert_eq!(answer.status, 0, "{}", answer.err);
        let count = (0..57).filter(|i| {
            let [real, wave] = growth(0.8 + 1.4 / 56.0 * f64::from(*i));
            real.max(wave) > 0.0
        });
        let expected = format!("\"unstable\":{}", count.count());
        assert!(
            answer.out.contains(&expected),
            "{expected} in {}",
            answer.out
        );
    }
}
