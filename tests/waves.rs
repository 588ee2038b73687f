//! Waves in mirror-symmetric models: a travelling wave drives a mean flow, which a steady pattern does not.

use crate::support::{close, json, number, written};

/// By hand: c2 = −4 + 4 g/(1 + 2 a0) for û = 1 in a (and i in b), X[0;2] being the driven mean alone.
const WAVES: &str = "model waves \"Waves that drive a mean\";
coordinates { x: periodic; }
parameters { r = 1.1; w = 2; g = 1; }
fields { a; b; q; }
balance {
    first:  dt(a) = r*a + dx(dx(a)) - w*b - (a^2 + b^2)*a + g*q*dx(b);
    second: dt(b) = r*b + dx(dx(b)) + w*a - (a^2 + b^2)*b - g*q*dx(a);
    mean:   dt(q) = -q + dx(dx(q)) + a*dx(b) - b*dx(a);
}
base { a = 0; b = 0; q = 0; }
amplitude { a = 1; }
typical { k = 1; }
";

#[test]
fn a_wave_drives_a_mean() {
    let path = written("waves.model", WAVES);
    for (r, g) in [(1.1, 1.0), (1.1, 2.0), (1.3, 0.4), (0.95, -1.0)] {
        let found = json(&format!(
            "point {} --k 1 --set r={r} --set g={g}",
            path.display()
        ));
        let a0 = r - 1.0;
        let c2 = -4.0 + 4.0 * g / (1.0 + 2.0 * a0);
        close("a0", number(&found, "/c0/0"), a0, 1e-13);
        close("b0", number(&found, "/c0/1").abs(), 2.0, 1e-13);
        close("a2", number(&found, "/c2/0"), c2, 1e-12);
        close("b2", number(&found, "/c2/1"), 0.0, 1e-12);
    }
}

/// The same equations with a term of coefficient zero that breaks the mirror: another arithmetic, one answer.
#[test]
fn with_and_without_the_mirror() {
    let path = written("mirror.model", WAVES);
    let broken = WAVES
        .replace("g = 1; }", "g = 1; d = 0; }")
        .replace("dt(q) = -q", "dt(q) = d*dx(q) - q");
    let broken = written("broken.model", &broken);
    for k in [0.7, 1.0, 1.2] {
        let point = |path: &std::path::Path| json(&format!("point {} --k {k}", path.display()));
        let (with, without) = (point(&path), point(&broken));
        for place in ["/c0/0", "/c2/0", "/c2/1"] {
            close(place, number(&with, place), number(&without, place), 1e-12);
        }
    }
}

/// The certificate of a wave with a wall: every part holds, the residual order among them.
#[test]
fn certificate_of_a_wave_between_walls() {
    let walled = WAVES
        .replace("{ x: periodic; }", "{ x: periodic; y: 0..1; }")
        .replace("r*a + dx(dx(a))", "r*a + dx(dx(a)) + dy(dy(a))")
        .replace("r*b + dx(dx(b))", "r*b + dx(dx(b)) + dy(dy(b))")
        .replace("-q + dx(dx(q))", "-q + dx(dx(q)) + dy(dy(q))")
        .replace(
            "amplitude { a = 1; }",
            "boundary {
                at y = 0 { a = 0; b = 0; q = 0; }
                at y = 1 { a = 0; b = 0; dy(q) = 0; }
            }
            amplitude { at y = 1/2 { a = 1; } }",
        )
        .replace("r = 1.1", "r = 11");
    let path = written("walled.model", &walled);
    let found = json(&format!("verify {} -M 30", path.display()));
    let checks = found["checks"].as_array().expect("checks");
    assert!(checks.iter().all(|c| c["verdict"] != "failed"), "{found}");
    assert_eq!(checks[0]["verdict"], "passed", "{found}");
}
