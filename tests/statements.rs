//! What a spec says comes out as it was said: names of coordinates, names of ends, unused definitions, cylindrical
//! continuity, integrals that the walls or continuity keep, base states that are none.

use crate::support::{close, json, landau, number, written};

fn explain(spec: &str) -> String {
    let path = written("said.model", spec);
    let answer = landau(&["explain", &path.to_string_lossy()]);
    assert_eq!(answer.status, 0, "{}", answer.err);
    answer.out
}

const RENAMED: &str = "model renamed \"Other letters\";
coordinates { z: periodic; x: 0..1; }
parameters { r = 20; }
fields { w; u; }
balance {
    first: dt(w) + u*dz(w) + w*dz(u) = r*w + dz(dz(w)) + dx(dx(w));
    second: dt(u) = -u + dx(dx(u)) + dz(dz(u)) + absdz(absdz(u)) + w^2;
}
base { w = 0; u = 0; }
boundary { at x = 0 { w = 0; u = 0; } at x = 1 { w = 0; dx(u) = -absdz(u); } }
";

#[test]
fn coordinates_keep_their_names() {
    let text = explain(RENAMED);
    assert!(text.contains("first: -w' u'_z - w'_z u'"), "{text}");
    assert!(text.contains("u'_x + |∂z|u' = 0"), "{text}");
    // ∂z² + |∂z|² is nothing.
    assert!(text.contains("[second, u] -1 + ∂x²\n"), "{text}");
    let latex = landau(&["explain", "rayleigh_benard", "--format", "latex"]);
    assert!(latex.out.contains("\\partial_{z}") && !latex.out.contains("\\partial_{y}"));
}

#[test]
fn unused_definitions_leave_no_trace() {
    let unused: String = (0..12)
        .map(|i| format!("let spare{i}(q) = q^{} + dx(q)*u*r^{i};\n", i % 4 + 1))
        .collect();
    let spec = RENAMED.replace("balance {", &format!("{unused}balance {{"));
    let first = explain(&spec);
    assert_eq!(first, explain(RENAMED));
    let path = written("spare.model", &spec);
    let spectrum = || landau(&["spectrum", &path.to_string_lossy(), "--k", "1.3", "--json"]).out;
    let answer = spectrum();
    for _ in 0..6 {
        assert_eq!(first, explain(&spec));
        assert_eq!(answer, spectrum());
    }
}

/// Taylor & Couette between cylinders of ratio 1/2, continuity as textbooks write it: the left null function
/// of the gauge is r. Critical Reynolds number to 12 digits.
const CYLINDERS: &str = "model cylinders \"Taylor-Couette flow\";
coordinates { z: periodic; r: ri..ro; }
parameters { eta = 0.5 in 0..1; Re = 68 in 0..; }
let ri = eta/(1 - eta);
let ro = 1/(1 - eta);
let a = -eta^2/(1 - eta^2)/ri;
let b = ri/(1 - eta^2);
fields { u; v; w; p; }
let along(q) = u*dr(q) + w*dz(q);
let laplace(q) = dr(dr(q)) + dr(q)/r + dz(dz(q));
balance {
    radial:    dt(u) + Re*(along(u) - v^2/r) = -dr(p) + laplace(u) - u/r^2;
    azimuthal: dt(v) + Re*(along(v) + u*v/r) = laplace(v) - v/r^2;
    axial:     dt(w) + Re*along(w) = -dz(p) + laplace(w);
    continuity: dr(u) + u/r + dz(w) = 0;
}
base { u = 0; w = 0; v = a*r + b/r; p = Re*(a^2*r^2/2 + 2*a*b*log(r) - b^2/(2*r^2)); }
boundary { at r = ri { u = 0; w = 0; v = 1; } at r = ro { u = 0; w = 0; v = 0; } }
mean { gauge p; }
";

#[test]
fn cylinders() {
    let path = written("cylinders.model", CYLINDERS);
    let found = json(&format!(
        "critical {} --vary Re --from 60 --to 80 --minimize k=2.5:4 -M 30",
        path.display()
    ));
    close("Re", number(&found, "/value"), 68.1862683464, 1e-8);
    close("k", number(&found, "/k"), 3.1624759, 1e-6);
    let text = landau(&["explain", &path.to_string_lossy()]).out;
    assert!(
        text.contains("at r = ri: ") && text.contains("at r = ro: "),
        "{text}"
    );
    let certificate = json(&format!("verify {} --k 3.16 -M 30", path.display()));
    let checks = certificate["checks"].as_array().expect("checks");
    assert!(
        checks.iter().all(|c| c["verdict"] != "failed"),
        "{certificate}"
    );
}

/// A normal mode of the axis: eigenvalues are −(zeros of Bessel functions)², by both L and L†.
#[test]
fn an_axis() {
    let spec = |balance: &str, wall: &str| {
        format!(
            "model axis \"Diffusion around an axis\";
coordinates {{ x: periodic; r: 0..1; }}
parameters {{ g = 0; }}
fields {{ T; }}
balance {{ {balance} }}
base {{ T = 0; }}
boundary {{ at r = 0 {{ {wall} }} at r = 1 {{ T = 0; }} }}
"
        )
    };
    let plain = "heat: r*dt(T) = dr(r*dr(T)) + r*dx(dx(T)) + g*r*T - r*T^3;";
    let angular =
        "heat: r^2*dt(T) = r^2*dr(dr(T)) + r*dr(T) - T + r^2*dx(dx(T)) + g*r^2*T - r^2*T^3;";
    for (balance, wall, zero) in [
        (plain, "dr(T) = 0;", 2.404_825_557_695_773),
        (angular, "T = 0;", 3.831_705_970_207_512),
    ] {
        let path = written("axis.model", &spec(balance, wall));
        let found = json(&format!("spectrum {} --k 1 -M 24", path.display()));
        let expected = -1.0 - f64::powi(zero, 2);
        close("L", number(&found, "/direct/0/0"), expected, 1e-10);
        close("L†", number(&found, "/adjoint/0/0"), expected, 1e-10);
    }
    // Divided by r, L has the same eigenvalues, and L† no conditions: the message says what helps.
    let divided = "heat: dt(T) = dr(dr(T)) + dr(T)/r + dx(dx(T)) + g*T - T^3;";
    let path = written("divided.model", &spec(divided, "dr(T) = 0;"));
    let answer = landau(&["spectrum", &path.to_string_lossy(), "--k", "1"]);
    assert_eq!(answer.status, 0);
    assert!(
        answer.out.contains("multiply each balance by r"),
        "{}",
        answer.out
    );
}

/// ∫u is kept by continuity where the base has a profile; with sticky walls the same claim is refused.
#[test]
fn integrals_that_continuity_keeps() {
    let spec = |wall: &str| {
        format!(
            "model channel \"A force that feeds the base alone\";
coordinates {{ x: periodic; y: 0..1; }}
parameters {{ f = 300; }}
fields {{ u; v; p; }}
let along(q) = u*dx(q) + v*dy(q);
let laplace(q) = dx(dx(q)) + dy(dy(q));
balance {{
    momentum_x: dt(u) + along(u) = f*cos(2*pi*y) - dx(p) + laplace(u);
    momentum_y: dt(v) + along(v) = -dy(p) + laplace(v);
    continuity: dx(u) + dy(v) = 0;
}}
base {{ v = 0; p = 0; u = f*cos(2*pi*y)/(4*pi^2); }}
boundary {{ at y = 0 {{ {wall} v = 0; }} at y = 1 {{ {wall} v = 0; }} }}
mean {{ conserved integral(u); gauge p; }}
"
        )
    };
    let free = written("free.model", &spec("dy(u) = 0;"));
    assert_eq!(landau(&["check", &free.to_string_lossy()]).status, 0);
    let mean = json(&format!("spectrum {} --k 0 -M 30", free.display()));
    let leading = -f64::powi(std::f64::consts::PI, 2);
    close("L at k = 0", number(&mean, "/direct/0/0"), leading, 1e-9);
    close("L† at k = 0", number(&mean, "/adjoint/0/0"), leading, 1e-9);
    let sticky = written("sticky.model", &spec("u = f/(4*pi^2);"));
    let answer = landau(&["check", &sticky.to_string_lossy()]);
    assert_eq!(answer.status, 2);
    assert!(
        answer.err.contains("this integral is not conserved"),
        "{}",
        answer.err
    );
}

/// The constant of a flux function with a time derivative drifts; a height with u = h_x has the coefficients of
/// Kuramoto & Sivashinsky's equation.
#[test]
fn a_constant_that_drifts() {
    let spec = "model height \"A growing surface\";
coordinates { x: periodic; }
parameters { nu = 0.9; }
fields { h; }
balance { growth: dt(h) = -dx(dx(h)) - nu*dx(dx(dx(dx(h)))) - dx(h)^2/2; }
base { h = 0; }
mean { gauge h; }
amplitude { h = 1; }
";
    let path = written("height.model", spec);
    for k in [0.8, 0.9, 1.0] {
        let height = json(&format!("point {} --k {k}", path.display()));
        let slope = json(&format!(
            "point kuramoto_sivashinsky --set nu=0.9 --set delta=0 --k {k}"
        ));
        close(
            "c0",
            number(&height, "/c0/0"),
            number(&slope, "/c0/0"),
            1e-12,
        );
        // û = i k ĥ
        let c2 = number(&slope, "/c2/0") * k * k;
        close("c2", number(&height, "/c2/0"), c2, 1e-11);
    }
    let found = json(&format!("verify {} --k 1", path.display()));
    assert_eq!(found["checks"][0]["verdict"], "passed", "{found}");
}

/// Surface waves: ∂t of a wall variable by an auxiliary field. Long waves decay by lubrication theory,
/// −g k² d³/(3ν), and at k = 0 the height stays and the shear decays.
#[test]
fn a_kinematic_condition() {
    let spec = "model surface \"Waves on a viscous layer\";
coordinates { x: periodic; y: -1..0; }
parameters { nu = 0.01 in 0..; g = 1; }
fields { u; v; p; h; s; }
let laplace(q) = dx(dx(q)) + dy(dy(q));
balance {
    momentum_x: dt(u) = -dx(p) + nu*laplace(u);
    momentum_y: dt(v) = -dy(p) + nu*laplace(v);
    continuity: dx(u) + dy(v) = 0;
    flat: dy(h) = 0;
    kinematic: dt(h) = s;
}
base { u = 0; v = 0; p = 0; h = 0; s = 0; }
boundary {
    at y = -1 { u = 0; v = 0; }
    at y = 0 { v = s; dy(u) + dx(v) = 0; p = g*h + 2*nu*dy(v); }
}
";
    let path = written("surface.model", spec);
    let leading = |k: &str, place: &str| {
        let found = json(&format!("spectrum {} --k {k} -M 30", path.display()));
        number(&found, place)
    };
    let lubrication = -1e-8 / 0.03;
    close(
        "long waves",
        leading("1e-4", "/direct/0/0"),
        lubrication,
        1e-4 * lubrication.abs(),
    );
    close("height", leading("0", "/direct/0/0"), 0.0, 1e-11);
    let shear = -0.01 * f64::powi(std::f64::consts::PI / 2.0, 2);
    close("shear", leading("0", "/direct/1/0"), shear, 1e-9);
}

#[test]
fn base_states_that_are_none() {
    let spec = |base: &str| {
        format!(
            "model base \"A base state in closed form\";
coordinates {{ x: periodic; y: 0..1; }}
parameters {{ r = 20; }}
fields {{ u; w; }}
balance {{
    first: dt(u) = r*u + dy(dy(u)) + dx(dx(u));
    second: dt(w) = 1 + dy(dy(w)) + dx(dx(w)) - u^2;
}}
base {{ {base} }}
boundary {{ at y = 0 {{ u = 0; w = 0; }} at y = 1 {{ u = 0; w = 0; }} }}
"
        )
    };
    for (base, told) in [
        ("u = 0; w = y*(1 - y)/2;", ""),
        ("u = 0; w = y^2/2;", "does not satisfy the balance `second`"),
        (
            "u = 0; w = (1 - y^2)/2;",
            "does not satisfy its own condition",
        ),
        // The residual of `first` is small, that of `second` large.
        (
            "u = 1e-6*sin(pi*y); w = 1000*y*(1 - y);",
            "does not satisfy the balance `second`",
        ),
    ] {
        let path = written("base.model", &spec(base));
        let path = path.to_string_lossy();
        let answer = landau(&["check", &path]);
        assert_eq!(
            answer.status,
            if told.is_empty() { 0 } else { 2 },
            "{base}: {}",
            answer.err
        );
        assert!(answer.err.contains(told), "{base}: {}", answer.err);
        let point = landau(&["point", &path, "--k", "1"]);
        assert_eq!(
            point.status,
            if told.is_empty() { 0 } else { 3 },
            "{base}: {}",
            point.err
        );
    }
}
