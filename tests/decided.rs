//! What is printed is known: an error for every number, no digit beyond it, and no verdict on a divisor or a sign that
//! lies within its error.

use crate::support::{close, json, landau, number, written};
use serde_json::Value;

/// Plane waves solve a complex Ginzburg–Landau equation exactly: c2 = −4 g (1 + i b), c4 = c6 = … = 0.
const PLANE_WAVES: &str = "model plane_waves \"Plane waves exact\";
coordinates { x: periodic; }
parameters { r = 1.3; om = 0.71; b = 1.5; d = 0.13; g = 0.37; }
fields { a; c; }
balance {
    ea: dt(a) = r*a + dx(dx(a)) - d*dx(dx(c)) - om*c - g*(a^2 + c^2)*(a - b*c);
    ec: dt(c) = r*c + dx(dx(c)) + d*dx(dx(a)) + om*a - g*(a^2 + c^2)*(c + b*a);
}
base { a = 0; c = 0; }
amplitude { a = 1; }
";

/// The same with an amplitude that nothing saturates: Re c2 = 0.
const CONSERVATIVE: &str = "model conservative \"c2 purely imaginary\";
coordinates { x: periodic; }
parameters { r = 0.1; om = 1; b = 1.5; d = 0.7; }
fields { a; c; }
balance {
    ea: dt(a) = r*a + dx(dx(a)) - d*dx(dx(c)) - om*c + b*(a^2 + c^2)*c + a;
    ec: dt(c) = r*c + dx(dx(c)) + d*dx(dx(a)) + om*a - b*(a^2 + c^2)*a + c;
}
base { a = 0; c = 0; }
amplitude { a = 1; }
";

/// A wave that is unstable to the one in the other direction.
const OPPOSED: &str = "model opposed \"Mirror-symmetric waves that drive a mean\";
coordinates { x: periodic; y: 0..1; }
parameters { r = 11.2; om = 2.0; g = 2.5; D = 0.3; }
fields { a; b; q; m; }
let laplace(f) = dx(dx(f)) + dy(dy(f));
balance {
    ea: dt(a) = r*a + laplace(a) - om*b - (a^2 + b^2)*a + g*q*dx(b) - g*m*a;
    eb: dt(b) = r*b + laplace(b) + om*a - (a^2 + b^2)*(b + a/2) - g*q*dx(a) - g*m*b;
    eq: dt(q) = laplace(q) + a*dx(b) - b*dx(a);
    em: dt(m) = D*laplace(m) + dx(dx(a^2 + b^2));
}
base { a = 0; b = 0; q = 0; m = 0; }
boundary { at y = 0 { a = 0; b = 0; q = 0; dy(m) = 0; } at y = 1 { a = 0; b = 0; dy(q) = 0; dy(m) = 0; } }
mean { conserved integral(m); }
amplitude { at y = 1/2 { a = 1; } }
";

/// Two fields of which one is measured in units of `eps`: the same problem for every value.
const UNITS: &str = "model units \"A field in other units\";
coordinates { x: periodic; }
parameters { r = 0.1; eps = 1; }
fields { u; v; }
let w = u + dx(dx(u));
balance {
    eu: dt(u) = r*u - w - dx(dx(w)) + u*v/eps - u^3;
    ev: dt(v) = dx(dx(v)) - v + eps*(u + u^2);
}
base { u = 0; v = 0; }
amplitude { u = 1; }
";

/// One eigenvalue, zero, beside a field without a time derivative.
const ALGEBRAIC: &str = "model algebraic \"One eigenvalue, zero\";
coordinates { x: periodic; }
parameters { r = 0; }
fields { u; q; }
balance { ev: dt(u) = r*u - u - 2*q - dx(dx(q)) - u^3; def: q = dx(dx(u)); }
base { u = 0; q = 0; }
amplitude { u = 1; }
";

/// The time derivative of one field in the balance of another.
const SWAPPED: &str = "model swapped \"A conserved variable as a field of its own\";
coordinates { x: periodic; }
parameters { r = 1; b = 1; m = 0.5; }
fields { u; n; }
balance { ev: dt(n) = -r*dx(dx(u)) - dx(dx(dx(dx(u)))) + b*dx(u*dx(u)) + dx(dx(u^3)); def: n = u + m*u^2; }
base { u = 0; n = 0; }
mean { conserved integral(n); }
amplitude { u = 1; }
";

fn path(name: &str, text: &str) -> String {
    written(name, text).display().to_string()
}

fn text(line: &str) -> String {
    let answer = landau(&line.split_whitespace().collect::<Vec<_>>());
    assert_eq!(answer.status, 0, "{line}: {}", answer.err);
    answer.out
}

fn reason(found: &Value, path: &str) -> String {
    let reason = found["not_decided"][path].as_str();
    reason
        .unwrap_or_else(|| panic!("{path}: {found}"))
        .to_owned()
}

#[test]
fn noise_is_no_series() {
    let model = path("plane_waves.model", PLANE_WAVES);
    let found = json(&format!("point {model} --k 0.77 --order 9"));
    close("a2", number(&found, "/c2/0"), -1.48, 1e-13);
    for name in ["c4", "c6", "c8"] {
        let size =
            number(&found, &format!("/{name}/0")).hypot(number(&found, &format!("/{name}/1")));
        let error = number(&found, &format!("/error/{name}"));
        assert!(
            size <= error && error < 1e-12,
            "{name} = {size:e} ± {error:e}"
        );
    }
    // A² = (r − k²)/(4 g), at every order
    let exact = ((1.3 - 0.77_f64 * 0.77) / 1.48).sqrt();
    for order in ["3", "5", "7", "9"] {
        let amplitude = number(&found, &format!("/amplitudes/{order}"));
        let error = number(&found, &format!("/error/amplitudes/{order}"));
        assert!((amplitude - exact).abs() <= error, "order {order}: {found}");
    }
    assert!(found["radius"].is_null() && found["amplitudes"]["pade"].is_null());
    assert!(reason(&found, "radius").contains("zero within its error"));
    reason(&found, "amplitudes.pade");
}

#[test]
fn an_amplitude_needs_a_known_divisor() {
    let model = path("conservative.model", CONSERVATIVE);
    let found = json(&format!("point {model} --k 1 --order 5"));
    close("b2", number(&found, "/c2/1"), -6.0, 1e-12);
    assert_eq!(found["bifurcation"], "degenerate Hopf");
    for key in ["amplitude", "stable", "radius"] {
        assert!(found[key].is_null(), "{key}: {found}");
        reason(&found, key);
    }
    for path in [
        "amplitudes.3",
        "amplitudes.5",
        "amplitudes.pade",
        "envelope.benjamin_feir",
        "waves.stable",
    ] {
        reason(&found, path);
    }
    let pair = json(&format!("amplitudes {model} --mode k=1 --mode k=-1"));
    assert_eq!(pair["equilibria"], serde_json::json!([]), "{pair}");
}

/// At onset, Re c0 = 0, nothing balances: neither the single wave nor the pair has an equilibrium that is known.
#[test]
fn no_equilibria_at_onset() {
    let model = path("plane_waves.model", PLANE_WAVES);
    let at = "--set r=1 --set d=0.7";
    let point = json(&format!("point {model} --k 1 {at}"));
    assert!(point["amplitude"].is_null(), "{point}");
    assert!(reason(&point, "amplitude").contains("growth rate"));
    let pair = json(&format!("amplitudes {model} --mode k=1 --mode k=-1 {at}"));
    assert_eq!(pair["equilibria"], serde_json::json!([]), "{pair}");
}

#[test]
fn the_other_wave_decides_stability_too() {
    let model = path("opposed.model", OPPOSED);
    let found = json(&format!("point {model} --k 0.8 -M 24"));
    assert_eq!(found["waves"]["stable"], "standing", "{found}");
    assert_eq!(found["stable"], false, "{found}");
    // A steady pattern has no other wave.
    let steady = json("point swift_hohenberg --k 1 --set r=0.1 --set b=0");
    assert_eq!(steady["stable"], true, "{steady}");
}

/// c2 of a field in units from 1e-60 to 1e60 of the others.
#[test]
fn units_of_a_field_change_nothing() {
    let model = path("units.model", UNITS);
    let one = json(&format!("point {model} --k 1 --order 5"));
    for eps in ["1e-60", "1e-18", "1e-12", "1e-6", "1e6", "1e18", "1e60"] {
        let found = json(&format!("point {model} --k 1 --order 5 --set eps={eps}"));
        for name in ["c0", "c2", "c4"] {
            let [a, b] = [&one, &found].map(|v| number(v, &format!("/{name}/0")));
            let bar = number(&found, &format!("/error/{name}"));
            assert!(
                (a - b).abs() <= 2.0 * bar && bar < 1e-11 * (1.0 + a.abs()),
                "{name} at {eps}: {a} {b} {bar}"
            );
        }
    }
    close("c2", number(&one, "/c2/0"), 0.027_742_796_2, 1e-10);
}

/// A growth rate that is the difference of large terms is known to their rounding, and zero is a value.
#[test]
fn errors_see_cancellation() {
    for r in ["1e-9", "3e-12", "-2e-14", "0"] {
        let found = json(&format!(
            "point swift_hohenberg --k 1 --set b=0 --set r={r}"
        ));
        let exact: f64 = r.parse().expect("a number");
        let (a0, error) = (number(&found, "/c0/0"), number(&found, "/error/c0"));
        assert!((a0 - exact).abs() <= error, "{a0} ± {error} for {exact}");
        assert!((1e-16..1e-12).contains(&error), "{error}");
    }
    for (name, spec) in [("algebraic.model", ALGEBRAIC), ("swapped.model", SWAPPED)] {
        let model = path(name, spec);
        let found = json(&format!("point {model} --k 1"));
        assert!(
            number(&found, "/c0/0").abs() <= number(&found, "/error/c0"),
            "{found}"
        );
        assert!(number(&found, "/error/c0") > 0.0, "{found}");
    }
    // n = u + m u²: a conserved cubic coefficient of −11/6 at m = 1/2
    let found = json(&format!("point {} --k 1", path("swapped.model", SWAPPED)));
    close("a2", number(&found, "/c2/0"), -11.0 / 6.0, 1e-12);
}

#[test]
fn no_command_answers_with_what_is_not_converged() {
    let picture = path("unused.model", UNITS).replace("unused.model", "pattern.svg");
    for m in ["4", "8"] {
        for line in [
            "point plane_poiseuille_flux --k 1",
            "amplitudes plane_poiseuille_flux --mode k=1",
            "amplitudes plane_poiseuille_flux --mode k=1 --order 5",
            "pattern plane_poiseuille_flux --k 1 --amplitude 0.1",
        ] {
            let mut words: Vec<&str> = line.split_whitespace().collect();
            words.extend(["-M", m]);
            if line.starts_with("pattern") {
                words.extend(["--out", picture.as_str()]);
            }
            let answer = landau(&words);
            assert_eq!(answer.status, 3, "{line} -M {m}: {}", answer.out);
            assert!(
                answer.err.contains("not converged"),
                "{line}: {}",
                answer.err
            );
        }
    }
}

/// The digits before every ± end where the error begins.
#[test]
fn no_digit_stands_beyond_its_error() {
    let opposed = path("opposed.model", OPPOSED);
    let mut bars = 0;
    for line in [
        "point plane_poiseuille --k 1 --set R=8000 --order 7 -M 50".to_owned(),
        "point rayleigh_benard --k 3 --order 5 -M 14".to_owned(),
        "point brusselator --k 1 --set A=2 --set B=7 --set D1=1 --set D2=1".to_owned(),
        format!("point {opposed} --k 0.8 -M 10"),
        "amplitudes rayleigh_benard --mode k=3 --mode k=6 --set Ra=3000 -M 16".to_owned(),
        "spectrum plane_poiseuille --k 1 -M 30".to_owned(),
    ] {
        let shown = text(&line);
        for (before, after) in shown.match_indices(" ± ").map(|(at, _)| shown.split_at(at)) {
            let error = after.trim_start_matches(" ± ");
            let end = error.find(|c: char| !(c.is_ascii_digit() || "e-.".contains(c)));
            let error: f64 = error[..end.unwrap_or(error.len())]
                .parse()
                .expect("an error");
            let number = before.strip_suffix(" i").unwrap_or(before);
            let start = number.rfind(|c: char| !(c.is_ascii_digit() || "e-.".contains(c)));
            let number = &number[start.map_or(0, |s| s + 1)..];
            let (mantissa, exponent) = number.split_once('e').unwrap_or((number, "0"));
            let decimals = mantissa.split_once('.').map_or(0, |(_, d)| d.len() as i32);
            let place = exponent.parse::<i32>().expect("an exponent") - decimals;
            if number.trim_start_matches('-') != "0" {
                assert!(
                    place >= error.log10().floor() as i32,
                    "{number} ± {error} in\n{shown}"
                );
            }
            bars += 1;
        }
    }
    assert!(bars > 60, "{bars}");
}

/// Every number of a point has an error under its name.
#[test]
fn every_number_has_an_error() {
    let found = json("point rayleigh_benard --k 3 --order 5 -M 20");
    for key in [
        "c0",
        "c2",
        "c4",
        "amplitude",
        "radius",
        "resonance",
        "outputs",
        "dc0",
        "amplitudes",
        "envelope",
    ] {
        let (value, error) = (&found[key], &found["error"][key]);
        match value {
            Value::Object(parts) => {
                for (part, value) in parts {
                    assert_eq!(
                        value.is_null(),
                        error[part].is_null(),
                        "{key}.{part}: {found}"
                    );
                }
            }
            value => assert_eq!(value.is_null(), error.is_null(), "{key}: {found}"),
        }
    }
    // Onset of the textbooks between free walls: the bars hold at a small M, where they are wide.
    let line = "point rayleigh_benard --k 2.221441469079183 --set walls=free --set Pr=0.71 --set Ra=657.5113644795163";
    for m in [10, 12, 14] {
        let found = json(&format!("{line} -M {m}"));
        let exact = -8.0 * 0.71 / 1.71;
        let curvature = number(&found, "/envelope/d2c0_dk2/0");
        let error = number(&found, "/error/envelope/d2c0_dk2");
        assert!(
            (curvature - exact).abs() <= error,
            "{curvature} ± {error} for {exact}"
        );
    }
}
