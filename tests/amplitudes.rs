//! Amplitude equations of several modes, against coefficients that are exact or from an independent program of 80
//! bits; their equilibria.

use crate::support::{built, close, json, landau, number, written};
use landau_solver::model::C64;
use landau_solver::series::Monomial;
use landau_solver::study::amplitudes::{AmplitudesReport, ModeChoice};
use landau_solver::study::{Progress, Setup};
use serde_json::Value;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The coefficient of a monomial, named as it is printed, in the equation of one mode.
fn coefficient(found: &Value, mode: usize, name: &str) -> C64 {
    let terms = found["equations"][mode].as_array().expect("terms");
    let exponents = |list: &Value| -> Vec<u8> {
        let list = list.as_array().expect("exponents").iter();
        list.map(|e| e.as_u64().expect("an exponent") as u8)
            .collect()
    };
    let term = terms.iter().find(|term| {
        let (z, conj) = (exponents(&term["z"]), exponents(&term["conj"]));
        Monomial { z, conj }.name() == name
    });
    let term = term.unwrap_or_else(|| panic!("no {name} in {found}"));
    C64::new(number(term, "/g/0"), number(term, "/g/1"))
}

/// Every listed coefficient to a relative tolerance.
fn coefficients(line: &str, mode: usize, tolerance: f64, expected: &[(&str, f64, f64)]) {
    let found = json(line);
    for (name, re, im) in expected {
        let (g, expected) = (coefficient(&found, mode, name), C64::new(*re, *im));
        assert!(
            (g - expected).norm() <= tolerance * expected.norm().max(1e-2),
            "{line}: {name} in the equation of z{}: {g} instead of {expected}",
            mode + 1
        );
    }
}

/// Real coefficients of both equations.
type Table = [(usize, &'static str, f64)];

fn table(line: &str, tolerance: f64, expected: &Table) {
    let found = json(line);
    for (mode, name, re) in expected {
        let g = coefficient(&found, mode - 1, name);
        assert!(
            (g - re).norm() <= tolerance * re.abs().max(1e-2),
            "{line}: {name} in the equation of z{mode}: {g} instead of {re}"
        );
    }
}

#[test]
fn pairs_of_swift_hohenberg() {
    let modes = "--mode k=0.6324555320336759 --mode k=1.2649110640673518";
    table(
        &format!("amplitudes swift_hohenberg {modes} --set r=0.36 --set b=0.5 --order 5"),
        1e-9,
        &[
            (1, "z2 z̄1", 1.0),
            (1, "z1² z̄1", -23.0 / 16.0),
            (1, "z1 z2 z̄2", -4.28125),
            (1, "z1³ z̄2", -8.518_066_406_25),
            (1, "z1 z2 z̄1²", -18.193_359_375),
            (1, "z2² z̄1 z̄2", -10.435_655_381_94),
            (1, "z1³ z̄1²", 0.505_371_093_75),
            (1, "z2² z̄1³", 52.071_456_909_18),
            (1, "z1² z2 z̄1 z̄2", 98.745_366_791_15),
            (1, "z1 z2² z̄2²", -14.587_980_700_6),
            (2, "z1²", 0.5),
            (2, "z1 z2 z̄1", -4.28125),
            (2, "z2² z̄2", -1.420_138_888_889),
            (2, "z1³ z̄1", -4.855_957_031_25),
            (2, "z1² z2 z̄2", -14.073_953_510_8),
            (2, "z2² z̄1²", -8.892_144_097_22),
            (2, "z1⁴ z̄2", 26.055_445_834_6),
            (2, "z1² z2 z̄1²", 22.588_528_291_7),
            (2, "z1 z2² z̄1 z̄2", 50.745_868_806_2),
            (2, "z2³ z̄2²", -13.605_452_449_1),
        ],
    );
    table(
        "amplitudes swift_hohenberg --mode k=0.62 --mode k=1.24 --set r=0.3 --set b=0.5",
        1e-9,
        &[
            (1, "z1", -0.078_963_36),
            (1, "z2 z̄1", 1.0),
            (1, "z1² z̄1", -1.155_230_968_03),
            (1, "z1 z2 z̄2", -4.438_900_600_4),
            (2, "z2", 0.010_986_24),
            (2, "z1²", 0.5),
            (2, "z1 z2 z̄1", -3.979_225_914_41),
            (2, "z2² z̄2", -1.595_857_013_71),
        ],
    );
    table(
        &format!("amplitudes swift_hohenberg_strip {modes} --set r=1.36 --set b=0.5 -M 36"),
        1e-9,
        &[
            (1, "z2 z̄1", 0.848_826_363_157),
            (1, "z1² z̄1", -1.119_033_660_36),
            (1, "z1 z2 z̄2", -3.252_618_105_98),
            (2, "z1²", 0.424_413_181_578),
            (2, "z1 z2 z̄1", -3.252_618_105_98),
            (2, "z2² z̄2", -1.107_941_523_63),
        ],
    );
    coefficients(
        "amplitudes kuramoto_sivashinsky --mode k=0.45 --mode k=0.9 --set nu=1 --set delta=0",
        0,
        1e-9,
        &[
            ("z1", 0.161_493_75, 0.0),
            ("z2 z̄1", 0.0, -0.45),
            ("z1² z̄1", 0.0, 0.0),
            ("z1 z2 z̄2", -0.334_821_428_571, 0.0),
        ],
    );
    coefficients(
        "amplitudes kuramoto_sivashinsky --mode k=0.45 --mode k=0.9 --set nu=1 --set delta=0",
        1,
        1e-9,
        &[
            ("z1²", 0.0, -0.45),
            ("z1 z2 z̄1", -0.669_642_857_143, 0.0),
            ("z2² z̄2", -0.107_066_381_156, 0.0),
        ],
    );
}

/// u_t = [r − ((1 + ∂xx)(4 + ∂xx))²] u + b u² − u³: modes 1 and 2 neutral together, exact for any b.
#[test]
fn an_exact_pair() {
    let text = "model double \"Two wavenumbers at onset\";
coordinates { x: periodic; }
parameters { r = 0; b = 1; }
fields { u; }
let one(q) = q + dx(dx(q));
let two(q) = 4*q + dx(dx(q));
balance { evolution: dt(u) = r*u - one(two(one(two(u)))) + b*u^2 - u^3; }
base { u = 0; }
amplitude { u = 1; }
";
    let path = written("double.model", text);
    for b in [0.7_f64, 1.0, -2.0] {
        let b2 = b * b;
        table(
            &format!(
                "amplitudes {} --mode k=1 --mode k=2 --set b={b}",
                path.display()
            ),
            1e-9,
            &[
                (1, "z2 z̄1", 2.0 * b),
                (1, "z1² z̄1", -3.0 + b2 / 4.0),
                (1, "z1 z2 z̄2", -6.0 + 101.0 * b2 / 400.0),
                (2, "z1²", b),
                (2, "z1 z2 z̄1", -6.0 + 101.0 * b2 / 400.0),
                (2, "z2² z̄2", -3.0 + 4051.0 * b2 / 16200.0),
            ],
        );
    }
}

/// Three to one: the coupling is cubic, z̄1² z2 and z1³ with −u³'s own weights where b = 0.
#[test]
fn three_to_one_and_incommensurate() {
    let line = |modes: &str| format!("amplitudes swift_hohenberg {modes} --set r=0.2 --set b=0");
    table(
        &line("--mode k=0.5 --mode k=1.5"),
        1e-12,
        &[
            (1, "z1² z̄1", -3.0),
            (1, "z2 z̄1²", -3.0),
            (1, "z1 z2 z̄2", -6.0),
            (2, "z1³", -1.0),
            (2, "z1 z2 z̄1", -6.0),
            (2, "z2² z̄2", -3.0),
        ],
    );
    let found = json(&line("--mode k=0.9 --mode k=1.13"));
    let terms = found["equations"][0].as_array().expect("terms").len();
    assert_eq!(terms, 3, "z1, z1² z̄1 and z1 z2 z̄2 alone: {found}");
}

#[test]
fn waves_of_the_brusselator() {
    let line =
        "amplitudes brusselator --mode k=1 --mode k=-1 --set A=2 --set B=7 --set D1=1 --set D2=1";
    for (mode, own, other) in [(0, "z1² z̄1", "z1 z2 z̄2"), (1, "z2² z̄2", "z1 z2 z̄1")] {
        coefficients(
            line,
            mode,
            1e-9,
            &[
                (own, -11.0 / 24.0, -0.505_181_485_540_9),
                (other, -2.75, 0.433_012_701_892_2),
            ],
        );
    }
    let point = json("point brusselator --k 1 --set A=2 --set B=7 --set D1=1 --set D2=1");
    assert_eq!(point["waves"]["stable"], "travelling", "{point}");
    close("self", number(&point, "/waves/self/0"), -11.0 / 24.0, 1e-10);
    close("cross", number(&point, "/waves/cross/0"), -2.75, 1e-10);
    // A steady pattern is no wave.
    let steady = json("point brusselator --k 2 --set B=4.1");
    assert!(steady["waves"].is_null(), "{steady}");
}

/// Double diffusion between free walls: Re self vanishes at onset, and fifth order decides.
#[test]
fn waves_of_thermosolutal_convection() {
    let text = "model thermosolutal \"Thermosolutal convection between free walls\";
coordinates { x: periodic; z: 0..1; }
parameters { Ra = 1157.22; Rs = 657.5113644795163; Pr = 1; tau = 0.1; }
fields { u; w; p; theta; s; }
let along(q)   = u*dx(q) + w*dz(q);
let laplace(q) = dx(dx(q)) + dz(dz(q));
balance {
    momentum_x: dt(u) + along(u) = -dx(p) + Pr*laplace(u);
    momentum_z: dt(w) + along(w) = -dz(p) + Pr*laplace(w) + Pr*(Ra*theta - Rs*s);
    continuity: dx(u) + dz(w) = 0 for p;
    heat:       dt(theta) + along(theta) = w + laplace(theta);
    salt:       dt(s) + along(s) = w + tau*laplace(s);
}
base { u = 0; w = 0; p = 0; theta = 0; s = 0; }
boundary {
    at z = 0 { dz(u) = 0; w = 0; theta = 0; s = 0; }
    at z = 1 { dz(u) = 0; w = 0; theta = 0; s = 0; }
}
mean { gauge p; conserved integral(u); }
amplitude { at z = 1/2 { w = 1; } }
";
    let path = written("thermosolutal.model", text);
    let onset = 1.76 * 27.0 * std::f64::consts::PI.powi(4) / 4.0;
    let line = format!(
        "amplitudes {} --mode k=2.221441469079183 --mode k=-2.221441469079183 --set Ra={onset} --order 5 -M 24",
        path.display()
    );
    coefficients(
        &line,
        0,
        1e-8,
        &[
            ("z1", 0.0, 9.820_132_388_296),
            ("z1² z̄1", 0.0, -0.376_889_180_722_2),
            ("z1 z2 z̄2", -0.364_545_525_843_0, 0.261_799_354_351_4),
            ("z1³ z̄1²", -0.031_190_852_327_1, 0.084_633_389_919_7),
            ("z1² z2 z̄1 z̄2", 0.068_820_348_186_2, -0.272_130_329_010_2),
            ("z1 z2² z̄2²", -0.040_527_001_624_1, 0.114_777_793_019_4),
        ],
    );
}

/// A steady and an oscillating mode at one wavenumber, by hand: with (a) and (b, c) = (1, −i)/√2 the equations are
/// z1' = r z1 − 3 |z1|² z1 − 2 h |z2|² z1, z2' = (s + i w) z2 − 2 |z2|² z2 − 2 g |z1|² z2.
#[test]
fn steady_and_oscillating_together() {
    let text = "model mixed \"A steady and an oscillating mode\";
coordinates { x: periodic; }
parameters { r = 0.3; s = 0.2; w = 2; g = 0.7; h = 0.4; }
fields { a; b; c; }
balance {
    steady: dt(a) = r*a + a + dx(dx(a)) - a^3 - h*(b^2 + c^2)*a;
    first:  dt(b) = s*b + b + dx(dx(b)) - w*c - (b^2 + c^2)*b - g*a^2*b;
    second: dt(c) = s*c + c + dx(dx(c)) + w*b - (b^2 + c^2)*c - g*a^2*c;
}
base { a = 0; b = 0; c = 0; }
amplitude { integral(|a|^2 + |b|^2 + |c|^2) = 1; }
";
    let path = written("mixed.model", text);
    let line = format!(
        "amplitudes {} --mode k=1,near=0.3 --mode k=1,near=0.2:2",
        path.display()
    );
    let answer = landau(&line.split_whitespace().collect::<Vec<_>>());
    assert_eq!(answer.status, 0, "{}", answer.err);
    coefficients(
        &line,
        0,
        1e-10,
        &[
            ("z1", 0.3, 0.0),
            ("z1² z̄1", -3.0, 0.0),
            ("z1 z2 z̄2", -0.8, 0.0),
        ],
    );
    coefficients(
        &line,
        1,
        1e-10,
        &[
            ("z2", 0.2, 2.0),
            ("z2² z̄2", -2.0, 0.0),
            ("z1 z2 z̄1", -1.4, 0.0),
        ],
    );
    let found = json(&line);
    // Without quadratic terms fourth order has none either.
    assert!(number(&found, "/residual_order") > 3.92, "{found}");
}

/// The bed's two to one resonance: the single-mode c2 diverges there, the pair's coefficients do not.
#[test]
fn the_pair_of_the_bed() {
    let found = json("amplitudes vibrated_bed --mode k=0.054 --mode k=0.108");
    let expected = [
        (1, "z1", 0.003_205_804_949_575_06),
        (2, "z2", 0.006_211_194_885_710_86),
        (1, "z1² z̄1", -0.001_045_664_780_30),
        (1, "z1 z2 z̄2", -0.007_646_664_929_56),
        (2, "z1 z2 z̄1", -0.006_500_583_009_52),
        (2, "z2² z̄2", -0.002_809_345_244_26),
        // The sign of both depends on that of the second mode.
        (1, "z2 z̄1", 0.010_561_738_267_22),
        (2, "z1²", 0.000_666_749_392_707),
    ];
    for (mode, name, re) in expected {
        let g = coefficient(&found, mode - 1, name);
        let g = if name == "z2 z̄1" || name == "z1²" {
            g.re.abs()
        } else {
            g.re
        };
        close(name, g, re, 1e-5 * re.abs());
    }
    let states = found["equilibria"].as_array().expect("equilibria");
    let known = [
        ([0.0, 1.486_911_16], false),
        ([0.792_915_21, 0.209_505_96], false),
        ([2.066_469_33, 0.131_833_65], true),
    ];
    assert_eq!(states.len(), known.len(), "{found}");
    for (state, (sizes, stable)) in states.iter().zip(known) {
        for (j, size) in sizes.into_iter().enumerate() {
            close(
                "equilibrium",
                number(state, &format!("/z/{j}/0")).abs(),
                size,
                2e-5,
            );
        }
        assert_eq!(state["stable"], stable, "{state}");
        assert!(state["next_order"].as_f64().is_some(), "{state}");
    }
    // c2 = g(z1² z̄1) + g(z2 z̄1) g(z1²)/(2 c1 − c2), and c2 at 2k is the pair's own.
    for k in [0.05346, 0.0537, 0.056] {
        let pair = json(&format!(
            "amplitudes vibrated_bed --mode k={k} --mode k={}",
            2.0 * k
        ));
        let g = |mode, name| coefficient(&pair, mode, name);
        let (c1, c2) = (g(0, "z1"), g(1, "z2"));
        let single = g(0, "z1² z̄1") + g(0, "z2 z̄1") * g(1, "z1²") / (2.0 * c1 - c2);
        let expected = number(&json(&format!("point vibrated_bed --k {k}")), "/c2/0");
        close("c2 at k", single.re, expected, 1e-7 * expected.abs());
        let twice = number(
            &json(&format!("point vibrated_bed --k {}", 2.0 * k)),
            "/c2/0",
        );
        close("c2 at 2k", g(1, "z2² z̄2").re, twice, 1e-8 * twice.abs());
        assert!(g(0, "z1² z̄1").norm() < 0.0012, "smooth through resonance");
    }
    let near = landau(&["point", "vibrated_bed", "--k", "0.0535"]);
    assert!(
        near.out.contains("--mode k=0.0535 --mode k=0.107"),
        "{}",
        near.out
    );
}

/// Competition by hand, u_t = r u − (1 + ∂xx)² u − u³: z_i' = a_i z_i − 3 |z_i|² z_i − 6 |z_j|² z_i, pure states stable, the mixed
/// one not; and of waves, where the standing one has |z|² = −a0/(self + cross).
#[test]
fn equilibria_by_hand() {
    let found =
        json("amplitudes swift_hohenberg --mode k=0.95 --mode k=1.08 --set r=0.2 --set b=0");
    let rate = |k: f64| 0.2 - (1.0 - k * k).powi(2);
    let (a, b) = (rate(0.95), rate(1.08));
    // 3x + 6y = a, 6x + 3y = b
    let (x, y) = ((2.0 * b - a) / 9.0, (2.0 * a - b) / 9.0);
    let expected = [
        ([a / 3.0, 0.0], Some(true)),
        ([0.0, b / 3.0], Some(true)),
        ([x, y], Some(false)),
    ];
    let states = found["equilibria"].as_array().expect("equilibria");
    assert_eq!(states.len(), expected.len(), "{found}");
    for (state, (squares, stable)) in states.iter().zip(expected) {
        for (j, square) in squares.into_iter().enumerate() {
            close(
                "z",
                number(state, &format!("/z/{j}/0")),
                square.sqrt(),
                1e-10,
            );
        }
        assert_eq!(state["stable"].as_bool(), stable, "{state}");
        assert_eq!(state["drift"].as_f64(), Some(0.0), "{state}");
    }
    // −2a, and a_j − 2a of the other mode, both twice but for the free phase.
    let own = states[0]["eigenvalues"].as_array().expect("eigenvalues");
    let mut real: Vec<f64> = own.iter().map(|c| number(c, "/0")).collect();
    real.sort_by(f64::total_cmp);
    for (found, exact) in real.iter().zip([-2.0 * a, b - 2.0 * a, b - 2.0 * a]) {
        close("an eigenvalue", *found, exact, 1e-10);
    }
    let line = "brusselator --set A=2 --set B=7.1 --set D1=1 --set D2=1";
    let waves = json(&format!("amplitudes {line} --mode k=1 --mode k=-1"));
    let states = waves["equilibria"].as_array().expect("equilibria");
    let (own, cross) = (
        coefficient(&waves, 0, "z1² z̄1"),
        coefficient(&waves, 0, "z1 z2 z̄2"),
    );
    let standing = (-0.05 / (own.re + cross.re)).sqrt();
    close(
        "the standing wave",
        number(&states[2], "/z/0/0"),
        standing,
        1e-10,
    );
    assert_eq!(states[2]["stable"], false, "{waves}");
    let c0 = coefficient(&waves, 0, "z1");
    let travelling = -0.05 / own.re;
    let drift = -(c0.im + own.im * travelling);
    close("the drift", number(&states[0], "/drift"), drift, 1e-10);
}

/// Counts the steps that are announced and done.
#[derive(Default)]
struct Steps {
    announced: AtomicUsize,
    done: AtomicUsize,
    ended: AtomicUsize,
}

impl Progress for Steps {
    fn begin(&self, steps: usize) {
        self.announced.store(steps, Ordering::Relaxed);
    }

    fn advance(&self, steps: usize) {
        self.done.fetch_add(steps, Ordering::Relaxed);
    }

    fn end(&self) {
        self.ended.fetch_add(1, Ordering::Relaxed);
    }
}

/// Two modes, three orders beyond the first and the next two, thirty defects, the equilibria, and the companions that a model
/// without a cross-stream coordinate has: three draws of noise.
#[test]
fn every_step_is_told() {
    let steps = Steps::default();
    let setup = Setup::new(built("swift_hohenberg"), 50).expect("M");
    let modes = [1.0, 0.7].map(|k| ModeChoice { k, near: None });
    AmplitudesReport::compute(&setup, &modes, 4, &steps).expect("the equations");
    let counts = [&steps.announced, &steps.done, &steps.ended].map(|n| n.load(Ordering::Relaxed));
    let expected = 2 + 3 + 2 + 30 + 1 + 3;
    assert_eq!(counts, [expected, expected, 1]);
}

#[test]
fn refusals() {
    let refused = |line: &str, status: i32, text: &str| {
        let answer = landau(&line.split_whitespace().collect::<Vec<_>>());
        assert_eq!(answer.status, status, "{line}: {}", answer.err);
        assert!(answer.err.contains(text), "{line}: {}", answer.err);
        assert!(answer.out.is_empty(), "{line}: {}", answer.out);
    };
    let sh = "amplitudes swift_hohenberg --mode k=1";
    refused(&format!("{sh} --mode k=-1"), 2, "one and the same");
    refused(&format!("{sh} --mode k=1"), 2, "one and the same");
    refused(
        "amplitudes kuramoto_sivashinsky --mode k=1 --mode k=-1",
        2,
        "one and the same",
    );
    refused(&format!("{sh} --order 1"), 2, "--order 1");
    refused(&format!("{sh} --order 40"), 2, "--order 40");
    refused("amplitudes swift_hohenberg --mode k=0", 2, "wavenumber");
    refused("amplitudes swift_hohenberg --mode 1", 2, "k=K");
    refused("amplitudes swift_hohenberg --mode k=1,near=a", 2, "near");
    refused("amplitudes swift_hohenberg", 2, "--mode");
    refused("point swift_hohenberg --k 1 --order 4", 2, "odd numbers");
}
