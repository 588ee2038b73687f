//! The vibrated bed against Shukla, Ansari, van der Meer, Lohse & Alam (2014) and against an
//! independent program (spectral collocation, truncated series, fully nonlinear Newton solution).

use crate::support::{built, close, json, landau, number, root};
use landau_solver::model::End;
use landau_solver::study::Setup;
use landau_solver::wavevector::WaveVector;
use rayon::prelude::*;

fn critical(options: &str) -> f64 {
    number(&json(&format!("critical vibrated_bed {options}")), "/value")
}

fn row(settings: &str, expected: [f64; 4]) {
    let [lower, upper, resonance, divergence] = expected;
    close(
        "k_l",
        critical(&format!("--vary k --from 0.031 --to 0.05 {settings}")),
        lower,
        2e-5,
    );
    close(
        "k_u",
        critical(&format!("--vary k --from 0.12 --to 0.2 {settings}")),
        upper,
        2e-5,
    );
    close(
        "k_r",
        critical(&format!(
            "--vary k --from 0.047 --to 0.059 --of resonance {settings}"
        )),
        resonance,
        2e-5,
    );
    close(
        "k_d",
        critical(&format!(
            "--vary k --from 0.0585 --to 0.1 --of c2 {settings}"
        )),
        divergence,
        2e-4,
    );
}

#[test]
fn critical_wavenumbers() {
    row("", [0.03685, 0.17454, 0.05346, 0.0705]);
    row("--set H=38", [0.03793, 0.17403, 0.05426, 0.06161]);
    row("--set H=42", [0.03618, 0.17476, 0.05297, 0.07603]);
}

/// Four digits are known of each, and none for what does not change.
#[test]
fn variants() {
    let half_digit = 6e-5;
    let value = |options: &str| critical(options);
    let divergence = "--vary k --from 0.0585 --to 0.1 --of c2";
    let resonance = "--vary k --from 0.047 --to 0.059 --of resonance";
    let lower = "--vary k --from 0.031 --to 0.05";
    let upper = "--vary k --from 0.12 --to 0.2";
    close(
        "no shear work",
        value(&format!("{divergence} --set shear_work=0")),
        0.0716,
        half_digit,
    );
    for (set, expected) in [
        ("--set top=flux_free", [0.0367, 0.1744, 0.0534, 0.0645]),
        (
            "--set viscosity=variable_prandtl",
            [0.0355, 0.1783, 0.0527, 0.0671],
        ),
    ] {
        for (options, wanted) in [lower, upper, resonance, divergence].iter().zip(expected) {
            close(
                &format!("{set} {options}"),
                value(&format!("{options} {set}")),
                wanted,
                half_digit,
            );
        }
    }
    // Bulk viscosity: no change in the third digit.
    for bulk in ["spheres", "disks"] {
        close(
            bulk,
            value(&format!("{upper} --set bulk={bulk}")),
            0.1745,
            5e-4,
        );
        close(
            bulk,
            value(&format!("{lower} --set bulk={bulk}")),
            0.0369,
            5e-4,
        );
    }
}

#[test]
fn onset_in_shaking_strength() {
    for (height, expected) in [(40, 64.45), (38, 64.62), (36, 64.99)] {
        let found = critical(&format!(
            "--vary S --from 55 --to 80 --k 0.16 --set H={height}"
        ));
        close(&format!("S_c at H = {height}"), found, expected, 6e-3);
    }
}

#[test]
fn landau_coefficients() {
    for resolution in [50, 60, 100] {
        // The last digit counts from M = 60 on.
        let last = if resolution == 50 { 1.5 } else { 0.6 };
        let found = json(&format!("point vibrated_bed --k 0.16 -M {resolution}"));
        close("c0", number(&found, "/c0/0"), 0.0019036118, last * 1e-10);
        close("c2", number(&found, "/c2/0"), -0.01461255, last * 1e-8);
        close("A_e", number(&found, "/amplitude"), 0.360933, 0.6e-6);
        assert_eq!(found["bifurcation"], "supercritical pitchfork");
        let found = json(&format!("point vibrated_bed --k 0.12 -M {resolution}"));
        close("c0", number(&found, "/c0/0"), 0.0056751068, last * 1e-10);
        close("c2", number(&found, "/c2/0"), -0.00413821, last * 1e-8);
    }
}

/// P (5.8): A_e ~ √(k_u − k).
#[test]
fn square_root_law() {
    let upper = critical("--vary k --from 0.15 --to 0.2");
    let logarithms: Vec<(f64, f64)> = (0..7)
        .map(|i| {
            let distance = 10.0_f64.powf(-5.0 + i as f64 / 3.0);
            let found = json(&format!(
                "point vibrated_bed --k {}",
                upper * (1.0 - distance)
            ));
            (distance.ln(), number(&found, "/amplitude").ln())
        })
        .collect();
    let n = logarithms.len() as f64;
    let (x, y) = logarithms
        .iter()
        .fold((0.0, 0.0), |(a, b), (x, y)| (a + x / n, b + y / n));
    let above: f64 = logarithms.iter().map(|(a, b)| (a - x) * (b - y)).sum();
    let below: f64 = logarithms.iter().map(|(a, _)| (a - x).powi(2)).sum();
    close("exponent", above / below, 0.5, 0.005);
}

/// P (4.7) prints u' = 0 at the bottom, where P (3.4) has ∂u'/∂y = 0: the band shrinks.
#[test]
fn printed_bottom_condition_is_a_misprint() {
    let spec =
        std::fs::read_to_string(root().join("spec/models/vibrated_bed.model")).expect("the spec");
    let changed = spec.replace(
        "at y = 0 { dy(u) = 0; v = 0; T = 0; }",
        "at y = 0 { u = 0; v = 0; T = 0; }",
    );
    assert_ne!(spec, changed);
    let folder = tempfile::tempdir().expect("a folder");
    let laws = folder.path().join("laws");
    std::fs::create_dir(&laws).expect("a folder");
    for law in ["grossman.law", "hard_particles.law"] {
        std::fs::copy(root().join("spec/laws").join(law), laws.join(law)).expect("a law");
    }
    let path = folder.path().join("printed.model");
    std::fs::write(&path, changed).expect("a file");
    let value = |from: f64, to: f64| {
        number(
            &json(&format!(
                "critical {} --vary k --from {from} --to {to}",
                path.display()
            )),
            "/value",
        )
    };
    close("lower end", value(0.035, 0.06), 0.0437, 1e-4);
    close("upper end", value(0.12, 0.19), 0.1660, 1e-4);
}

/// Another closure: Enskog disks, imported in place of the first, with viscosities of its own.
#[test]
fn second_closure() {
    let path = root().join("spec/studies/vibrated_disks.model");
    let base = json(&format!("base {} --set H=70 --points 2001", path.display()));
    close("n(0)", number(&base, "/profiles/n/0"), 0.0546406, 6e-8);
    // The reference's largest density, 0.15006, is the largest value at the 71 Gauss–Lobatto points
    // of its M = 70; between them the profile reaches 0.15007.
    let densities: Vec<f64> = base["profiles"]["n"]
        .as_array()
        .expect("a profile")
        .iter()
        .filter_map(serde_json::Value::as_f64)
        .collect();
    let at = |fraction: f64| {
        let place = fraction * 2000.0;
        let (i, rest) = ((place as usize).min(1999), place.fract());
        densities[i] + rest * (densities[i + 1] - densities[i])
    };
    let nodes = (0..70).map(|j| 0.5 * (1.0 - (std::f64::consts::PI * f64::from(j) / 70.0).cos()));
    close(
        "largest n at the nodes",
        nodes.map(at).fold(0.0, f64::max),
        0.15006,
        6e-6,
    );
    let point = json(&format!(
        "point {} --k 0.06 --set H=70 -M 60",
        path.display()
    ));
    close("c0", number(&point, "/c0/0"), 0.0045444655, 1e-9);
    close("c2", number(&point, "/c2/0"), -0.0045849456, 1e-9);
}

/// Base states over the range of the experiments keep their conditions to 1e-10.
#[test]
fn base_states() {
    // The corners of F in 4..16, S in 50..1000, e in 0.8..0.99, and places between.
    let mut places = vec![(6.0, 100.0, 0.9), (10.0, 200.0, 0.9), (16.0, 200.0, 0.8)];
    for corner in 0..8 {
        let pick =
            |bit: usize, low: f64, high: f64| if corner >> bit & 1 == 0 { low } else { high };
        places.push((
            pick(0, 4.0, 16.0),
            pick(1, 50.0, 1000.0),
            pick(2, 0.8, 0.99),
        ));
    }
    let model = built("vibrated_bed");
    let cases = places
        .iter()
        .flat_map(|place| [(place, "40"), (place, "auto")]);
    cases
        .collect::<Vec<_>>()
        .into_par_iter()
        .for_each(|(&(layers, shaking, e), height)| {
            let settings = [
                format!("F={layers}"),
                format!("S={shaking}"),
                format!("e={e}"),
                format!("H={height}"),
            ];
            let mut setup = Setup::new(model.clone(), 50).expect("M");
            for (name, text) in settings.iter().filter_map(|s| s.split_once('=')) {
                let set = setup.parameters.set_text(model.structure(), name, text);
                set.expect("a parameter of the bed");
            }
            let state = setup
                .base(None)
                .unwrap_or_else(|error| panic!("{settings:?}: {error}"));
            let structure = model.structure();
            let value = |point: &[f64], field: &str, order| {
                let field = structure.field(field).expect("a field");
                structure.base_value(point, field, order)
            };
            let bottom = state.at_end(End::Lower);
            let temperature = value(&bottom, "T", 0);
            close(&format!("T(0) {settings:?}"), temperature, 1.0, 1e-10);
            // κ grows with √T: the flux against that of the whole bed.
            let top = state.at_end(End::Upper);
            let flux = |point: &[f64]| value(point, "T", 0).sqrt() * value(point, "T", 1);
            close(
                &format!("flux(H) {settings:?}"),
                flux(&top) / flux(&bottom),
                0.0,
                1e-10,
            );
            // ∫n by a rule of its own: 4000 panels of five points (Boole).
            let ends = state.space.ends().expect("an interval");
            let (panels, length) = (4000, ends[1] - ends[0]);
            let at = |i: usize| {
                let y = ends[0] + length * i as f64 / (4 * panels) as f64;
                value(&state.at(state.space.place(y), WaveVector::MEAN), "n", 0)
            };
            let weight = |i: usize| match i % 4 {
                0 if i == 0 || i == 4 * panels => 7.0,
                0 => 14.0,
                2 => 12.0,
                _ => 32.0,
            };
            let sum: f64 = (0..=4 * panels).map(|i| weight(i) * at(i)).sum();
            let mass = sum * length / (90 * panels) as f64;
            close(&format!("mass {settings:?}"), mass, layers, 1e-10 * layers);
        });
    // What cannot be resolved is refused.
    let refused = landau(&[
        "base",
        "vibrated_bed",
        "--set",
        "F=40",
        "--set",
        "S=50",
        "--set",
        "H=20",
    ]);
    assert_eq!(
        (refused.status, refused.out.as_str()),
        (3, ""),
        "{}",
        refused.err
    );
}

/// c2 at strong shaking converges with M, or the error says how far it has.
#[test]
fn strong_shaking_converges_or_says_so() {
    for settings in ["--set F=10 --set S=200", "--set F=16 --set S=400"] {
        let coarse = json(&format!("point vibrated_bed --k 0.1 -M 60 {settings}"));
        let fine = json(&format!("point vibrated_bed --k 0.1 -M 140 {settings}"));
        let difference = (number(&coarse, "/c2/0") - number(&fine, "/c2/0")).abs();
        let promised = number(&coarse, "/error/c2") + number(&fine, "/error/c2");
        assert!(
            difference <= 3.0 * promised,
            "{settings}: {difference:.2e} where {promised:.2e} was promised"
        );
    }
}
