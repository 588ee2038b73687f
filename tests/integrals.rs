//! Integral conditions with nonlinear densities.
//!
//! The numbers come from a program of its own that expands the equations in high precision by Fourier and Chebyshev
//! collocation, and from hand calculation where a comment gives the formula.

use crate::support::{close, json, landau, number, written};
use landau_solver::Model;
use landau_solver::study::Setup;
use landau_solver::study::verify::residual_order;
use landau_solver::wavevector::WaveVector;
use landau_solver::weakly::{Expansion, Selection, select};
use serde_json::Value;
use std::sync::Arc;

/// A number holds ∫ (u + s u²).
pub const CONTROLLED: &str = "
model controlled;
coordinates { x: periodic; }
parameters { r = 0; b = 1; s = 1; }
fields { u; }
let w = u + dx(dx(u));
balance { ev: dt(u) = r*u - w - dx(dx(w)) + b*u^2 - u^3 + G; }
base { u = 0; G = 0; }
mean { unknown G: integral(u + s*u^2) = 0; }
amplitude { u = 1; }
typical { k = 1; }
";

/// ∫ (u + m u²) is kept; a wave for d ≠ 0.
const KEPT: &str = "
model kept;
coordinates { x: periodic; }
parameters { r = 1; b = 1; m = 0.5; d = 0; e = 0; }
fields { u; }
balance {
    ev: dt(u + m*u^2) = -r*dx(dx(u)) - dx(dx(dx(dx(u)))) + d*dx(dx(dx(u))) + b*dx(u*dx(u)) - e*dx(u^2)
        + dx(dx(u^3));
}
base { u = 0; }
mean { conserved integral(u + m*u^2); }
amplitude { u = 1; }
typical { k = 1; }
";

pub fn point(text: &str, options: &str) -> Value {
    let path = written("integral.model", text);
    json(&format!("point {} {options}", path.display()))
}

/// Compares c2, c4, … of a point with numbers of relative precision 10⁻¹⁰ or better.
fn coefficients(what: &str, found: &Value, expected: &[[f64; 2]]) {
    for (n, c) in expected.iter().enumerate() {
        let name = format!("c{}", 2 * n + 2);
        for (part, value) in c.iter().enumerate() {
            let size = c[0].hypot(c[1]);
            let read = number(found, &format!("/{name}/{part}"));
            close(&format!("{what}, {name}"), read, *value, 1e-10 * size);
        }
    }
}

pub fn verified(text: &str, options: &str) {
    let path = written("integral.model", text);
    let line = format!("verify {} {options}", path.display());
    let answer = landau(&line.split_whitespace().collect::<Vec<_>>());
    assert_eq!(answer.status, 0, "{line}: {}{}", answer.out, answer.err);
}

/// c2 = −3 − 4 b s + 2 b²/9 at onset; higher orders and other parameters from the other program.
#[test]
fn a_number_holds_a_nonlinear_integral() {
    for (b, s) in [(1.0, 1.0), (0.7, -0.4), (2.0, 0.3)] {
        let found = point(CONTROLLED, &format!("--set b={b} --set s={s}"));
        let expected = -3.0 - 4.0 * b * s + 2.0 * b * b / 9.0;
        coefficients("at onset", &found, &[[expected, 0.0]]);
    }
    let found = point(CONTROLLED, "--order 7");
    let at_onset = [
        -6.777_777_777_777_78,
        -17.340_642_146_776_4,
        -65.311_487_214_769_5,
    ];
    coefficients("b = s = 1", &found, &at_onset.map(|c| [c, 0.0]));
    let found = point(CONTROLLED, "--order 7 --set r=0.3 --set b=0.7 --set s=-0.4");
    let beyond = [
        -1.774_623_655_913_98,
        -2.266_751_107_332_96,
        0.174_686_160_886_807,
    ];
    coefficients("beyond onset", &found, &beyond.map(|c| [c, 0.0]));
    verified(CONTROLLED, "");
    verified(CONTROLLED, "--set r=0.3 --set b=0.7 --set s=-0.4 --order 5");
}

/// Powers up to the fourth, a gradient, and the number itself in the density and beside u in the balance.
#[test]
fn densities_of_every_kind() {
    let text = CONTROLLED.replace(" s = 1;", "");
    let text = text.replace("u^3 + G;", "u^3 + G*(1 + u);").replace(
        "integral(u + s*u^2)",
        "integral(u + 0.4*u^2 + 0.3*u^3 - 0.2*u^4 + 0.5*dx(u)^2 + 0.25*G + 0.1*u*G + dx(u))",
    );
    let found = point(&text, "--k 0.9 --order 7 --set r=0.2 --set b=0.7");
    let expected = [
        -6.694_056_733_948_38,
        5.281_182_489_795_17,
        2.726_208_565_200_07,
    ];
    coefficients("a long density", &found, &expected.map(|c| [c, 0.0]));
    verified(&text, "--k 0.9 --set r=0.2 --set b=0.7 --order 5");
    // A law in the density is expanded as one in a balance.
    let law = CONTROLLED
        .replace("let w", "law f = exp(u) - 1;\nlet w")
        .replace("u + s*u^2", "f - 1/6*u^3 - 1/24*u^4 + (s - 1/2)*u^2");
    let found = point(&law, "--order 5");
    coefficients(
        "a law",
        &found,
        &[[-6.777_777_777_777_78, 0.0], [-17.340_642_146_776_4, 0.0]],
    );
}

/// The mean of the density is kept, not that of its linear part: c2 = −1.8333 and c4 = −11.17 at onset for b = 1,
/// m = 1/2.
#[test]
fn a_nonlinear_density_is_kept() {
    let found = point(KEPT, "--order 5");
    let expected = [-1.833_333_333_333_33, -11.174_768_518_518_5];
    coefficients("at onset", &found, &expected.map(|c| [c, 0.0]));
    let set = "--set r=1.2 --set b=0.8 --set d=0.7 --set e=0.5";
    let found = point(KEPT, &format!("{set} --order 7"));
    let wave = [
        [-1.388_304_862_023_65, 0.306_110_381_077_53],
        [-9.830_570_878_054_05, 1.217_519_718_096_42],
        [-21.639_566_060_625_5, -5.575_248_210_403_68],
    ];
    coefficients("a wave", &found, &wave);
    verified(KEPT, "");
    verified(KEPT, &format!("{set} --order 5"));
}

/// The terms of two modes that meet in the mean, z1² z̄2 with q1 = 2 q2 among them.
#[test]
fn pairs_share_the_condition() {
    let text = CONTROLLED.replace(" s = 1;", "");
    let text = text.replace("u + s*u^2", "u + 0.6*u^2 + 0.2*u^3");
    let path = written("pair.model", &text);
    let line = format!(
        "amplitudes {} --mode k=0.62 --mode k=1.24 --order 4 --set r=0.3 --set b=0.5",
        path.display()
    );
    let found = json(&line);
    let expected = [
        (0, [2, 0], [1, 0], -4.2),
        (0, [1, 1], [0, 1], -7.023_994_946_373_94),
        (0, [0, 2], [1, 1], 6.006_477_702_679_9),
        (0, [1, 1], [2, 0], 6.071_984_839_121_81),
        (0, [3, 0], [0, 1], -0.797_361_405_816_583),
        (1, [0, 2], [0, 1], -4.180_951_359_684_02),
        (1, [0, 2], [2, 0], -1.211_713_872_454_29),
        (1, [2, 1], [0, 1], 1.834_955_931_848_94),
        (1, [3, 0], [1, 0], 3.402_638_594_183_42),
    ];
    for (equation, z, conj, value) in expected {
        let terms = found["equations"][equation].as_array().expect("terms");
        let term = terms
            .iter()
            .find(|t| t["z"] == serde_json::json!(z) && t["conj"] == serde_json::json!(conj))
            .unwrap_or_else(|| panic!("{z:?} {conj:?} in {terms:?}"));
        close(
            &format!("{z:?} {conj:?}"),
            number(term, "/g/0"),
            value,
            1e-10 * value.abs(),
        );
    }
    let order = number(&found, "/residual_order");
    assert!(order > 4.9, "residual order {order}");
}

const STRIP: &str = "
model strip_control;
coordinates { x: periodic; y: 0..1; }
parameters { r = 11.5; b = 0.6; s = 0.8; h = 0.7; }
fields { u; }
let v = u - h*y*(1 - y);
let w = v + dx(dx(v));
balance { ev: dt(u) = r*v - w - dx(dx(w)) + dy(dy(v)) + b*v^2 - v^3 + G*(1 + v); }
base { u = h*y*(1 - y); G = 0; }
boundary { at y = 0 { u = 0; } at y = 1 { u = 0; } }
mean { unknown G: integral((1 + y)*(u + s*u^2) + 0.3*dy(v)^2 + 0.2*v^3) = 0.1946; }
amplitude { at y = 1/2 { u = 1; } }
typical { k = 1; }
";

/// Walls, a base state that varies, weights that depend on y, ∂y in the density.
#[test]
fn strips() {
    let found = point(STRIP, "--order 5 -M 30");
    let expected = [-13.900_691_603_388_6, -105.300_972_753_426];
    coefficients("a strip", &found, &expected.map(|c| [c, 0.0]));
    verified(STRIP, "-M 30");
    let solved = STRIP.replace(
        "base { u = h*y*(1 - y); G = 0; }",
        "base { guess { u = h*y*(1 - y); G = 0; } }",
    );
    let found = point(&solved, "-M 30");
    coefficients(
        "a base that is solved for",
        &found,
        &[[-13.900_691_603_388_6, 0.0]],
    );
}

/// The mean of u y-independent modes between insulating walls: −dy((1 + g u) dy(u)) takes no part.
#[test]
fn strips_keep_a_nonlinear_density() {
    let text = "
        model strip_kept;
        coordinates { x: periodic; y: 0..1; }
        parameters { r = 1.02; b = 0.7; m = 0.6; g = 0.5; }
        fields { u; }
        balance {
            ev: dt(u + m*u^2) = -r*dx(dx(u)) - dx(dx(dx(dx(u)))) + dy((1 + g*u)*dy(u)) + b*dx(u*dx(u))
                - dx(dx(u^3));
        }
        base { u = 0; }
        boundary { at y = 0 { dy(u) = 0; } at y = 1 { dy(u) = 0; } }
        mean { conserved integral(u + m*u^2); }
        amplitude { at y = 1/2 { u = 1; } }
        typical { k = 1; }";
    let found = point(text, "-M 20 --order 5");
    coefficients(
        "beyond onset",
        &found,
        &[[4.018_317_056_856_19, 0.0], [26.985_305_624_43, 0.0]],
    );
    let onset = point(text, "-M 20 --set r=1");
    close("at onset", number(&onset, "/c2/0"), 3.921_666_666_667, 1e-9);
    verified(text, "-M 20");
}

fn expansion(text: &str, order: usize) -> Expansion {
    let path = written("planted.model", text);
    let sources = landau_codegen::build::read_sources(&path).expect("the spec can be read");
    let model: Arc<dyn Model> = Arc::new(landau_codegen::tape(&sources).expect("well formed"));
    let setup = Setup::new(model, 20).expect("M");
    let base = setup.base(None).expect("a base state");
    let problem = setup.problem(&base).expect("a problem");
    let pair = select(&problem, WaveVector::along_x(1.0), Selection::Leading).expect("a mode");
    Expansion::to(&problem, vec![pair], order).expect("the expansion")
}

/// A density of the other sign, twice as large or left out beside balances that stay as they are: the certificate
/// measures the condition itself and finds the square of the amplitude.
#[test]
fn planted_densities_are_noticed() {
    let cases = [
        (CONTROLLED, "s*u^2) = 0", ["-s*u^2) = 0", "2*s*u^2) = 0"]),
        (
            KEPT,
            "integral(u + m*u^2)",
            ["integral(u - m*u^2)", "integral(u + 2*m*u^2)"],
        ),
    ];
    for (text, written, wrong) in cases {
        let right = expansion(text, 3);
        let slope = residual_order(&right).slope.expect("a slope");
        assert!((slope - 4.0).abs() < 0.1, "{slope}");
        for planted in wrong {
            let mut mixed = expansion(&text.replace(written, planted), 3);
            // The densities of the right model, the modes and multipliers of the other.
            mixed.problem = right.problem.clone();
            let found = residual_order(&mixed);
            assert!(
                found.slope.is_some_and(|slope| slope < 2.1),
                "{planted}: {:?} in {}",
                found.slope,
                found.row
            );
        }
    }
}

/// `explain` prints the parts of the conditions where it prints N2 and N3.
#[test]
fn explained() {
    let text = CONTROLLED.replace("u + s*u^2", "u + s*u^2 + 0.2*u^3");
    let path = written("explained.model", &text).display().to_string();
    let answer = landau(&["explain", &path]);
    assert_eq!(answer.status, 0, "{}", answer.err);
    for line in ["unknown G: ∫ s u' u' dx", "unknown G: ∫ 1/5 u' u' u' dx"] {
        assert!(answer.out.contains(line), "{line} in {}", answer.out);
    }
}

/// Heat leaves through walls of fixed temperature: ∫ θ is conserved for no choice of the switches, and the claim is refused.
#[test]
fn a_claim_that_holds_for_no_choice_of_the_switches() {
    let shipped = std::fs::read_to_string("../spec/models/rayleigh_benard.model").expect("a model");
    let claim = "conserved integral(theta);";
    let text = shipped.replace("conserved integral(u);", claim);
    assert!(text.contains(claim));
    let path = written("claimed_heat.model", &text);
    let answer = landau(&["check", &path.display().to_string()]);
    assert_eq!(answer.status, 2, "{}", answer.out);
    let message = "the integral of theta is not conserved at the default parameters, for any choice of the switches";
    assert!(answer.err.contains(message), "{}", answer.err);
    let path = written("claimed_momentum.model", &shipped);
    let answer = landau(&["check", &path.display().to_string()]);
    assert_eq!(answer.status, 0, "{}", answer.err);
}
