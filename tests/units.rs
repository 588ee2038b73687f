//! Units do not matter: time, length and fields rescaled by 1e±9, and the same answers in the new units.

use crate::support::{close, json, number, written};

/// −3 + 4b²/(r+1) + 2b²/(r+9) at k = 1, in units of time T, of length Λ and of the field U.
#[test]
fn swift_hohenberg() {
    for time in [1e-12, 1e-9, 1.0, 1e9] {
        for length in [1e-9, 1.0, 1e9] {
            for size in [1e-9, 1.0, 1e9] {
                let spec = format!(
                    "model units \"Swift-Hohenberg in other units\";
coordinates {{ x: periodic; }}
parameters {{ r = 0.1; b = 0.7; tau = {time:e}; l = {length:e}; a = {size:e}; }}
fields {{ u; }}
balance {{
    e: tau*dt(u) = r*u - (u + 2*l^2*dx(dx(u)) + l^4*dx(dx(dx(dx(u))))) + b/a*u^2 - u^3/a^2;
}}
base {{ u = 0; }}
amplitude {{ u = a; }}
"
                );
                let path = written("units.model", &spec);
                let found = json(&format!("point {} --k {:e}", path.display(), 1.0 / length));
                let (r, b) = (0.1, 0.7);
                let c2 = -3.0 + 4.0 * b * b / (r + 1.0) + 2.0 * b * b / (r + 9.0);
                close("c0", number(&found, "/c0/0") * time, r, 1e-12);
                close("c2", number(&found, "/c2/0") * time, c2, 1e-10);
                assert_eq!(found["bifurcation"], "supercritical pitchfork");
            }
        }
    }
}

/// The bed's units, P (2.15), and others: one amplitude equation.
#[test]
fn strip_and_channel() {
    let strip = |time: f64, length: f64| {
        format!(
            "model strip \"Swift-Hohenberg strip in other units\";
coordinates {{ x: periodic; y: 0..pi*l; }}
parameters {{ r = 1.1; b = 1; tau = {time:e}; l = {length:e}; }}
fields {{ u; }}
balance {{
    e: tau*dt(u) = r*u - (u + 2*l^2*dx(dx(u)) + l^4*dx(dx(dx(dx(u))))) + l^2*dy(dy(u)) + b*u^2 - u^3;
}}
base {{ u = 0; }}
boundary {{ at y = 0 {{ u = 0; }} at y = pi*l {{ u = 0; }} }}
amplitude {{ at y = pi*l/2 {{ u = 1; }} }}
"
        )
    };
    let channel = |time: f64, length: f64| {
        format!(
            "model channel \"Poiseuille flow in other units\";
coordinates {{ x: periodic; y: -l..l; }}
parameters {{ R = 8000 in 1..; tau = {time:e}; l = {length:e}; }}
fields {{ u; v; p; }}
let speed = l/tau;
let nu = l^2/tau/R;
let along(q) = u*dx(q) + v*dy(q);
let laplace(q) = dx(dx(q)) + dy(dy(q));
balance {{
    momentum_x: dt(u) + along(u) = 2*nu*speed/l^2 - dx(p) + nu*laplace(u);
    momentum_y: dt(v) + along(v) = -dy(p) + nu*laplace(v);
    continuity: dx(u) + dy(v) = 0;
}}
base {{ u = speed*(1 - (y/l)^2); v = 0; p = 0; }}
boundary {{ at y = -l {{ u = 0; v = 0; }} at y = l {{ u = 0; v = 0; }} }}
mean {{ gauge p; }}
amplitude {{ at y = 0 {{ |v| = k*l*speed; }} }}
"
        )
    };
    /// A spec by its units of time and length.
    type Spec<'a> = &'a dyn Fn(f64, f64) -> String;
    let all: [(Spec, &str); 2] = [(&strip, "-M 24"), (&channel, "-M 60")];
    for (spec, options) in all {
        let answer = |time: f64, length: f64| {
            let path = written("units.model", &spec(time, length));
            let k = 1.0 / length;
            let found = json(&format!("point {} --k {k:e} {options}", path.display()));
            let value = |place: &str| number(&found, place) * time;
            let kind = found["bifurcation"].as_str().expect("a kind").to_owned();
            (
                [
                    value("/c0/0"),
                    value("/c0/1"),
                    value("/c2/0"),
                    value("/c2/1"),
                ],
                kind,
            )
        };
        let (one, kind) = answer(1.0, 1.0);
        for (time, length) in [
            (1e-9, 1.0),
            (1e9, 1.0),
            (1.0, 1e-9),
            (1.0, 1e9),
            (1e-12, 1e3),
        ] {
            let (other, its_kind) = answer(time, length);
            assert_eq!(its_kind, kind);
            for (index, (a, b)) in one.iter().zip(other).enumerate() {
                let size = one[index / 2 * 2].hypot(one[index / 2 * 2 + 1]);
                close("in other units", b, *a, 1e-7 * size);
            }
        }
    }
}
