//! Layouts from the balances' orders: conditions that name the same field first, stream function and
//! vorticity, auxiliary fields; nothing depends on the order of declaration.

use crate::support::{close, json, number, root, written};
use std::path::Path;

fn point(path: &Path, options: &str) -> serde_json::Value {
    json(&format!("point {} {options}", path.display()))
}

/// Stream function and vorticity of plane Poiseuille flow at fixed flux, ψ = ψ_y = 0 at both walls.
const STREAM: &str = "model stream \"Poiseuille flow by stream function and vorticity\";
coordinates { x: periodic; y: -1..1; }
parameters { R = 10000 in 1..; }
fields { psi; omega; }
balance {
    vorticity: dt(omega) + dy(psi)*dx(omega) - dx(psi)*dy(omega) = (dx(dx(omega)) + dy(dy(omega)))/R;
    definition: omega = dx(dx(psi)) + dy(dy(psi));
}
base { psi = y - y^3/3; omega = -2*y; }
boundary {
    at y = -1 { psi = -2/3; dy(psi) = 0; }
    at y = 1 { psi = 2/3; dy(psi) = 0; }
}
amplitude { at y = 0 { psi = 1; } }
";

/// Orszag's eigenvalue (R = 10000), and the neutral point with c2 at fixed flux.
#[test]
fn clamped_stream_function() {
    let path = written("stream.model", STREAM);
    for m in [60, 80, 100] {
        let found = point(&path, &format!("--k 1 -M {m}"));
        close("a0", number(&found, "/c0/0"), 0.003739670623, 1e-7);
        close("b0", number(&found, "/c0/1"), -0.237526488820, 1e-7);
    }
    let critical = "--k 1.02054744928533 --set R=5772.22181620970 -M 80";
    let found = point(&path, critical);
    close("omega", number(&found, "/c0/1"), -0.269424792442301, 1e-9);
    close("a2", number(&found, "/c2/0"), 30.95618697, 1e-4);
    close("b2", number(&found, "/c2/1"), -172.83352332, 1e-4);
}

/// Rigid and free convection with ψ, ω, θ: the critical points of the textbooks, no mode above them.
#[test]
fn convection_by_stream_function() {
    let spec = |walls: &str| {
        format!(
            "model rolls \"Convection by stream function\";
coordinates {{ x: periodic; z: 0..1; }}
parameters {{ Ra = 1700; Pr = 1; }}
fields {{ psi; omega; theta; }}
let along(q) = dz(psi)*dx(q) - dx(psi)*dz(q);
let laplace(q) = dx(dx(q)) + dz(dz(q));
balance {{
    vorticity: dt(omega) + along(omega) = Pr*laplace(omega) - Pr*Ra*dx(theta);
    definition: omega = laplace(psi);
    heat: dt(theta) + along(theta) = -dx(psi) + laplace(theta);
}}
base {{ psi = 0; omega = 0; theta = 0; }}
boundary {{
    at z = 0 {{ psi = 0; {walls}; theta = 0; }}
    at z = 1 {{ psi = 0; {walls}; theta = 0; }}
}}
amplitude {{ at z = 1/2 {{ theta = 1; }} }}
"
        )
    };
    let rigid = written("rigid.model", &spec("dz(psi) = 0"));
    let found = point(
        &rigid,
        "--k 3.116323554821122 --set Ra=1707.761777104718 -M 40",
    );
    close("rigid, c0", number(&found, "/c0/0"), 0.0, 1e-8);
    close(
        "rigid, c2",
        number(&found, "/c2/0"),
        -170.4557650828144,
        1e-6,
    );
    let free = written("free.model", &spec("omega = 0"));
    let (k, pi) = (
        std::f64::consts::FRAC_1_SQRT_2 * std::f64::consts::PI,
        std::f64::consts::PI,
    );
    let found = point(
        &free,
        &format!("--k {k} --set Ra={} -M 40", 6.75 * pi.powi(4)),
    );
    close("free, c0", number(&found, "/c0/0"), 0.0, 1e-8);
    close(
        "free, c2",
        number(&found, "/c2/0"),
        -9.0 * pi.powi(4) / 16.0,
        1e-7,
    );
}

/// Wall-normal velocity and vorticity of an oblique wave on Poiseuille flow, by turned axes: Squire's theorem
/// gives the eigenvalue of the wave along the flow at (k², k R) scaled.
#[test]
fn normal_velocity_and_vorticity() {
    let spec = "model oblique \"v and eta\";
coordinates { x: periodic; y: -1..1; }
parameters { R = 10000; }
fields { v; phi; }
let laplace(q) = dx(dx(q)) + dy(dy(q));
balance {
    fourth: dt(phi) + (1 - y^2)*dx(phi) + 2*dx(v) = laplace(phi)/R;
    second: phi = laplace(v);
}
base { v = 0; phi = 0; }
boundary { at y = -1 { v = 0; dy(v) = 0; } at y = 1 { v = 0; dy(v) = 0; } }
";
    let path = written("oblique.model", spec);
    let found = json(&format!("spectrum {} --k 1 -M 80", path.display()));
    close(
        "leading",
        number(&found, "/direct/0/0"),
        0.003739670623,
        1e-8,
    );
    close("second", number(&found, "/direct/1/0"), -0.03516728, 1e-7);
}

/// Two phases whose conditions name the same field first: c0 by hand.
///
/// a'' = λa and D c'' = λc below, with a' + (D/d) c' = 0 and a' = a − c above.
#[test]
fn two_conditions_that_name_one_field_first() {
    let spec = |fields: &str, balances: [&str; 2], walls: [&str; 2]| {
        format!(
            "model phases \"Two phases\";
coordinates {{ x: periodic; y: 0..1; }}
parameters {{ D = 2; q = 1; s = 6; }}
fields {{ {fields} }}
balance {{ {} {} }}
base {{ a = 0; c = 0; }}
boundary {{ at y = 0 {{ a = 0; c = 0; }} at y = 1 {{ {} {} }} }}
amplitude {{ at y = 1 {{ a = 1; }} }}
",
            balances[0], balances[1], walls[0], walls[1]
        )
    };
    let first = "first: dt(a) = s*a - dx(dx(dx(dx(a)))) + dy(dy(a));";
    let second = "second: dt(c) = s*c - dx(dx(dx(dx(c)))) + D*dy(dy(c));";
    let flux = "dy(a) + D*dy(c) = 0;";
    let jump = "dy(a) = -(a - c) + q*(a - c)^2;";
    let ways = [
        ("a; c;", [first, second], [flux, jump]),
        ("c; a;", [second, first], [jump, flux]),
        ("a; c;", [second, first], [jump, flux]),
    ];
    // α cos α + sin α − … : a = sin αy, c = γ sin βy with α² = Dβ² = s − 1 − c0.
    let growth = {
        let (d, s) = (2.0_f64, 6.0);
        let mismatch = |mu: f64| {
            let (alpha, beta) = (mu.sqrt(), (mu / d).sqrt());
            let gamma = -alpha * alpha.cos() / (d * beta * beta.cos());
            alpha * alpha.cos() + alpha.sin() - gamma * beta.sin()
        };
        let (mut low, mut high) = (2.5_f64, 4.5);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if mismatch(low) * mismatch(middle) <= 0.0 {
                high = middle;
            } else {
                low = middle;
            }
        }
        s - 1.0 - low
    };
    let mut answers = Vec::new();
    for (index, (fields, balances, walls)) in ways.into_iter().enumerate() {
        let path = written(
            &format!("phases{index}.model"),
            &spec(fields, balances, walls),
        );
        let found = point(&path, "--k 1 -M 40");
        close("c0", number(&found, "/c0/0"), growth, 1e-9);
        answers.push(number(&found, "/c2/0"));
    }
    for other in &answers[1..] {
        close("c2", *other, answers[0], 1e-9 * answers[0].abs());
    }
}

/// Every shipped model with its fields, balances and conditions declared in reverse: the same answers.
#[test]
fn order_of_declaration_does_not_matter() {
    for entry in std::fs::read_dir(root().join("spec/models")).expect("models") {
        let path = entry.expect("a model").path();
        let name = path
            .file_stem()
            .expect("a name")
            .to_string_lossy()
            .into_owned();
        let text = std::fs::read_to_string(&path).expect("a spec");
        let reversed = reversed(&text);
        let turned = path.with_file_name(format!("{name}.model"));
        let turned = written_beside_laws(&turned, &reversed);
        let m = if name.starts_with("plane") { 60 } else { 40 };
        let straight = json(&format!("point {name} -M {m}"));
        let other = point(&turned, &format!("-M {m}"));
        let unit = number(&straight, "/c2/0").hypot(number(&straight, "/c2/1"));
        close(
            &name,
            number(&other, "/c0/0"),
            number(&straight, "/c0/0"),
            1e-8,
        );
        // The phase rule looks at the first field: only what does not depend on it is compared.
        let size = number(&other, "/c2/0");
        close(&name, size, number(&straight, "/c2/0"), 2e-6 * unit);
    }
}

/// The statements of the blocks `fields`, `balance` and of each wall in reverse.
fn reversed(text: &str) -> String {
    let plain: String = text
        .lines()
        .map(|line| line.split("//").next().unwrap_or(""))
        .collect::<Vec<_>>()
        .join("\n");
    let mut result = plain.clone();
    for head in ["fields {", "balance {"] {
        if let Some(start) = plain.find(head) {
            let body = &plain[start + head.len()..];
            let end = body.find('}').expect("a block");
            let mut items: Vec<&str> = body[..end].split_inclusive(';').map(str::trim).collect();
            items.retain(|item| !item.is_empty());
            items.reverse();
            let turned = format!("{head} {} ", items.join("\n"));
            result = result.replace(&plain[start..start + head.len() + end], &turned);
        }
    }
    result
}

fn written_beside_laws(path: &Path, text: &str) -> std::path::PathBuf {
    let name = path.file_name().expect("a name").to_string_lossy();
    let target = written(&name, text);
    let laws = target.with_file_name("laws");
    let _ = std::fs::create_dir(&laws);
    for entry in std::fs::read_dir(root().join("spec/laws")).expect("laws") {
        let law = entry.expect("a law").path();
        let copy = laws.join(law.file_name().expect("a name"));
        std::fs::copy(&law, copy).expect("copied");
    }
    target
}
