//! Modes that solve the nonlinear equations by themselves: c2 is zero, an answer as good as any other; and fields so
//! small, or so weakly tied to the mode, that they could be taken for nothing.

use crate::support::{close, json, landau, number, written};
use std::f64::consts::PI;

/// A row of eddies, ψ = sin kx sin πz, convects its own vorticity along its streamlines: c0 = f − ν(k² + π²), c2 = 0.
const EDDIES: [(&str, &str); 2] = [
    (
        "eddies",
        "model eddies \"Eddies between free walls\";
coordinates { x: periodic; z: 0..1; }
parameters { nu = 1 in 0..; f = 20; }
fields { u; w; p; }
let along(q) = u*dx(q) + w*dz(q);
let laplace(q) = dx(dx(q)) + dz(dz(q));
balance {
    mx: dt(u) + along(u) = -dx(p) + nu*laplace(u) + f*u;
    mz: dt(w) + along(w) = -dz(p) + nu*laplace(w) + f*w;
    continuity: dx(u) + dz(w) = 0;
}
base { u = 0; w = 0; p = 0; }
boundary { at z = 0 { dz(u) = 0; w = 0; } at z = 1 { dz(u) = 0; w = 0; } }
mean { gauge p; }
typical { k = 2; }
",
    ),
    (
        "vortices",
        "model vortices \"The same by stream function and vorticity\";
coordinates { x: periodic; z: 0..1; }
parameters { nu = 1 in 0..; f = 20; }
fields { psi; omega; }
balance {
    vorticity:  dt(omega) + dz(psi)*dx(omega) - dx(psi)*dz(omega)
                    = nu*(dx(dx(omega)) + dz(dz(omega))) + f*omega;
    definition: omega = dx(dx(psi)) + dz(dz(psi));
}
base { psi = 0; omega = 0; }
boundary { at z = 0 { psi = 0; omega = 0; } at z = 1 { psi = 0; omega = 0; } }
typical { k = 2; }
",
    ),
];

fn vanishes(found: &serde_json::Value) {
    let c2 = number(found, "/c2/0").hypot(number(found, "/c2/1"));
    assert!(c2 <= number(found, "/error/c2"), "{found}");
    assert!(c2 < 1e-12, "{found}");
    let kind = found["bifurcation"].as_str().expect("a kind");
    assert!(kind.starts_with("degenerate"), "{kind}");
    assert!(found["amplitude"].is_null());
}

#[test]
fn what_solves_the_equations_has_no_c2() {
    for (name, text) in EDDIES {
        let path = written(&format!("{name}.model"), text);
        let path = path.display();
        for (nu, f, k, m) in [
            (1.0, 20.0, 2.0, 50),
            (0.3, 3.0, 0.7, 24),
            (1.0, 0.0, 3.1, 37),
        ] {
            let found = json(&format!(
                "point {path} --k {k} --set nu={nu} --set f={f} -M {m}"
            ));
            let exact = f - nu * (k * k + PI * PI);
            close("c0", number(&found, "/c0/0"), exact, 1e-10);
            vanishes(&found);
        }
        // Higher orders at a wavenumber where no multiple of it grows as fast as a product of amplitudes.
        let found = json(&format!("point {path} --k 2.3 --order 7"));
        for order in ["c4", "c6"] {
            let c = number(&found, &format!("/{order}/0"));
            assert!(
                c.abs() <= number(&found, &format!("/error/{order}")),
                "{found}"
            );
        }
        assert_eq!(landau(&["verify", &path.to_string()]).status, 0);
        let table = written(&format!("{name}.csv"), "");
        let line = [
            "sweep",
            &path.to_string(),
            "--over",
            "k=1:4:7",
            "--force",
            "--out",
        ];
        let answer = landau(&[&line[..], &[&table.to_string_lossy()]].concat());
        assert_eq!(answer.status, 0, "{}", answer.err);
        let table = std::fs::read_to_string(table).expect("the table");
        let rows: Vec<&str> = table.lines().skip(1).collect();
        assert_eq!(rows.len(), 7);
        for row in rows {
            assert!(row.contains("degenerate") && row.ends_with("ok"), "{row}");
        }
    }
}

/// Rotating convection, free walls. Below onset a geostrophic wave, v and p alone, decays slowest, as −Pr k²: no
/// product of it with itself is left. Above, convection has the c2 that it has.
#[test]
fn fields_that_a_mode_has_no_part_of() {
    let text = "model rotating \"Convection in a rotating layer\";
coordinates { x: periodic; z: 0..1; }
parameters { Ra = 1000 in 0..; Pr = 0.1 in 0..; Ta = 2000 in 0..; }
fields { u; v; w; p; theta; }
let along(f) = u*dx(f) + w*dz(f);
let laplace(f) = dx(dx(f)) + dz(dz(f));
balance {
    mx: (dt(u) + along(u))/Pr - sqrt(Ta)*v = -dx(p) + laplace(u);
    my: (dt(v) + along(v))/Pr + sqrt(Ta)*u = laplace(v);
    mz: (dt(w) + along(w))/Pr = -dz(p) + Ra*theta + laplace(w);
    continuity: dx(u) + dz(w) = 0;
    heat: dt(theta) + along(theta) - w = laplace(theta);
}
base { u = 0; v = 0; w = 0; p = 0; theta = 0; }
boundary {
    at z = 0 { dz(u) = 0; dz(v) = 0; w = 0; theta = 0; }
    at z = 1 { dz(u) = 0; dz(v) = 0; w = 0; theta = 0; }
}
mean { gauge p; }
";
    let path = written("rotating.model", text);
    for (k, m) in [(1.0, 24), (1.0, 50), (0.5, 80)] {
        let found = json(&format!("point {} --k {k} -M {m}", path.display()));
        close("c0", number(&found, "/c0/0"), -0.1 * k * k, 1e-10);
        vanishes(&found);
    }
    // Between free walls steady rolls begin at Ra = ((k² + π²)³ + π² Ta)/k² (Chandrasekhar 1961), whatever Pr.
    let line = format!(
        "critical {} --vary Ra --from 1800 --to 9000 --k 3 --set Pr=7 -M 30",
        path.display()
    );
    let sum = 9.0 + PI * PI;
    let exact = (sum.powi(3) + PI * PI * 2000.0) / 9.0;
    close("Ra", number(&json(&line), "/value"), exact, 1e-5);
}

/// A field of any size counts where something of the mode determines it: c2 = −3 for both routes of the feedback.
#[test]
fn small_fields_count() {
    for delta in [1e-3, 1e-9, 1e-14, 1e6] {
        let spec = format!(
            "model slaved \"A small field that saturates the growth\";
coordinates {{ x: periodic; }}
parameters {{ r = 1.2; g = 1; h = 0; delta = {delta:e}; }}
fields {{ a; w; q; }}
balance {{
    growth: dt(a) = r*a + dx(dx(a)) - g*a*(w/delta)^2 - h*a*q/delta;
    linear: w = delta*a;
    square: q = delta*a^2;
}}
base {{ a = 0; w = 0; q = 0; }}
amplitude {{ a = 1; }}
"
        );
        let path = written("slaved.model", &spec);
        for (g, h) in [(1.0, 0.0), (0.0, 1.0), (0.25, 0.75)] {
            let found = json(&format!(
                "point {} --k 1 --set g={g} --set h={h}",
                path.display()
            ));
            close("c0", number(&found, "/c0/0"), 0.2, 1e-13);
            close("c2", number(&found, "/c2/0"), -3.0, 1e-11);
        }
    }
}

/// A critical value of zero is found like any other: inside the interval, at its ends, on a point of the scan; its
/// error covers it.
#[test]
fn roots_at_zero() {
    let spec = "model level \"Neutral where r is zero\";
coordinates { x: periodic; y: 0..1; }
parameters { r = 0.1; D = 1 in 0..; }
fields { u; }
balance { e: dt(u) = (r + D*pi^2 + 4)*u + 4*dx(dx(u)) + D*dy(dy(u)) - u^3; }
base { u = 0; }
boundary { at y = 0 { u = 0; } at y = 1 { u = 0; } }
";
    let level = written("level.model", spec).display().to_string();
    let cases = [
        (level.as_str(), "--from -1 --to 1.7 --k 1"),
        (&level, "--from -1 --to 1 --k 1 --set D=100 -M 30"),
        (&level, "--from -1 --to 1 --k 1 --set D=1e4 -M 90"),
        (&level, "--from -1 --to 0 --k 1"),
        (&level, "--from 0 --to 1 --k 1"),
        ("swift_hohenberg", "--from -0.5 --to 0 --k 1"),
        ("swift_hohenberg", "--from 0 --to 0.5 --k 1"),
        (
            "swift_hohenberg",
            "--from -0.3 --to 0.4 --minimize k=0.8:1.3",
        ),
    ];
    for (model, options) in cases {
        let found = json(&format!("critical {model} --vary r {options}"));
        let (value, error) = (number(&found, "/value"), number(&found, "/error"));
        assert!(value.abs() <= error && error < 1e-7, "{options}: {found}");
    }
}
