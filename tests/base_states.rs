//! Base states against their conditions: what is refused, what is noted, what counts.

use crate::support::{close, json, landau, number, written};

fn spec(name: &str, text: &str) -> String {
    written(name, text).to_string_lossy().into_owned()
}

/// The profile e^{−y} in a box that cuts it off at y = L.
fn decaying(length: f64) -> String {
    spec(
        "decaying.model",
        &format!(
            "model decaying \"Decaying profile\";\n\
             coordinates {{ x: periodic; y: 0..L; }}\n\
             parameters {{ L = {length}; }}\n\
             fields {{ u; }}\n\
             balance {{ e: dt(u) = dx(dx(u)) + dy(dy(u)) - u; }}\n\
             base {{ u = exp(-y); }}\n\
             boundary {{\n\
             at y = 0 {{ u = 1; }}\n\
             at y = L {{\n\
             u =\n    0;\n\
             }} }}\n"
        ),
    )
}

#[test]
fn a_profile_that_is_cut_off_is_noted_or_refused() {
    for (length, notes) in [(30.0, 0), (20.0, 1), (10.0, 1)] {
        let file = decaying(length);
        let point = json(&format!("point {file} --k 1 -M 40"));
        assert_eq!(
            point["notes"].as_array().map(Vec::len),
            Some(notes),
            "{point}"
        );
        let leading = -2.0 - (std::f64::consts::PI / length).powi(2);
        close("c0", number(&point, "/c0/0"), leading, 1e-9);
        assert_eq!(json(&format!("base {file}"))["notes"], point["notes"]);
        for command in [
            vec!["check", &file],
            vec!["point", &file, "--k", "1", "-M", "40"],
            vec!["base", &file],
        ] {
            let answer = landau(&command);
            assert_eq!(answer.status, 0, "{}", answer.err);
            let place = format!(
                "{file}:10: the base state satisfies its own condition `u = 0` at y = {length} but for"
            );
            assert_eq!(
                answer.out.contains(&place),
                notes > 0,
                "{command:?}: {}",
                answer.out
            );
        }
    }
    // e^{−5} is no tail.
    let file = decaying(5.0);
    for command in [
        vec!["check", &file],
        vec!["point", &file, "--k", "1"],
        vec!["base", &file],
    ] {
        let answer = landau(&command);
        assert!(
            answer.status >= 2 && answer.out.is_empty(),
            "{}",
            answer.out
        );
        for told in [
            &format!("{file}:10: the base state does not satisfy its own condition `u = 0`"),
            "residual 6.738e-3 at y = 5",
            "say so in `base`, as in `at y = … { … }`",
            "move that end outwards",
        ] {
            assert!(answer.err.contains(told), "{told}: {}", answer.err);
        }
    }
}

/// A moving wall: u = 2 − y, where the perturbation vanishes at both walls.
#[test]
fn a_base_state_may_have_values_of_its_own_at_walls() {
    let moving = |own: &str| {
        spec(
            "moving.model",
            &format!(
                "model moving; coordinates {{ x: periodic; y: 0..1; }} fields {{ u; }}\n\
                 balance {{ e: dt(u) = dx(dx(u)) + dy(dy(u)) - dx(u)^3; }}\n\
                 base {{ u = 2 - y; {own} }}\n\
                 boundary {{ at y = 0 {{ u = 0; }} at y = 1 {{ u = 0; }} }}\n"
            ),
        )
    };
    let refused = landau(&["check", &moving("")]);
    assert_eq!(refused.status, 2);
    assert!(
        refused.err.contains("moving.model:4: ") && refused.err.contains("`u = 0`"),
        "{}",
        refused.err
    );
    let good = moving("at y = 0 { u = 2; } at y = 1 { u = 1; }");
    let answer = landau(&["check", &good]);
    assert_eq!((answer.status, answer.err.as_str()), (0, ""));
    assert!(!answer.out.contains("note"), "{}", answer.out);
    let point = json(&format!("point {good} --k 1 -M 30"));
    close(
        "c0",
        number(&point, "/c0/0"),
        -1.0 - std::f64::consts::PI.powi(2),
        1e-9,
    );
    // What `base` says of a wall is checked too.
    let wrong = landau(&[
        "check",
        &moving("at y = 0 { u = 2; } at y = 1 { u = 1.5; }"),
    ]);
    assert_eq!(wrong.status, 2);
    assert!(
        wrong.err.contains("moving.model:3: ") && wrong.err.contains("`u = 1.5`"),
        "{}",
        wrong.err
    );
}

/// Every refusal names the place in the spec.
#[test]
fn refusals_have_a_place() {
    let head = "model m; coordinates { x: periodic; y: 0..H; }\nparameters { H = 1; r = 1; }\nfields { u\n in -1..1; w; }\n";
    let walls = "boundary { at y = 0 { u = 0; w = 0; } at y = H { u = 0; w = 0; } }";
    let of = |right: &str, base: &str| {
        spec(
            "m.model",
            &format!(
                "{head}balance {{\n first: dt(u) = dy(dy(u)) + dx(dx(u)) + {right};\n second: dt(w) = dy(dy(w)) + dx(dx(w)); }}\n\
                 base {{ w = 0; {base} }}\n{walls}"
            ),
        )
    };
    for (right, base, set, told) in [
        (
            "r",
            "u = y*(1 - y);",
            "r=1",
            "m.model:6: the base state does not satisfy the balance `first`",
        ),
        ("r", "", "H=-1", "m.model:1: the interval 0..-1 is empty"),
        (
            "r*exp(u)",
            "",
            "r=9",
            "m.model:8: Newton's method for the base state",
        ),
    ] {
        let answer = landau(&["base", &of(right, base), "--set", set]);
        assert!(
            answer.status >= 2 && answer.out.is_empty(),
            "{told}: {}",
            answer.out
        );
        assert!(answer.err.contains(told), "{told}: {}", answer.err);
    }
}

/// A condition that ties two fields counts for the base state: T = 1 + y and c = p + q y with q = p² and p + q = 3.
#[test]
fn a_condition_that_ties_two_fields_counts() {
    let file = spec(
        "tied.model",
        "model tied; coordinates { x: periodic; y: 0..1; } fields { T; c; }\n\
         balance { heat: dt(T) = dx(dx(T)) + dy(dy(T)); salt: dt(c) = dx(dx(c)) + dy(dy(c)); }\n\
         base { guess { T = 1; c = 1 + y; } }\n\
         boundary { at y = 0 { T = 1; dy(c) = c^2*T; } at y = 1 { dy(T) + T = 3; c = T + 1; } }\n",
    );
    let base = json(&format!("base {file} --points 3"));
    let p = (13.0_f64.sqrt() - 1.0) / 2.0;
    for (place, y) in [0.0, 0.5, 1.0].into_iter().enumerate() {
        close(
            "T",
            number(&base, &format!("/profiles/T/{place}")),
            1.0 + y,
            1e-12,
        );
        close(
            "c",
            number(&base, &format!("/profiles/c/{place}")),
            p + p * p * y,
            1e-12,
        );
    }
    // The perturbation: c' = κ c with κ = 2 p at the wall, c = T there where T' + T = 0.
    assert_eq!(landau(&["check", &file]).status, 0);
}

/// Laws, a nonlinear condition that ties two fields, and one through a law: values by collocation with residual control
/// (`scipy.integrate.solve_bvp` at a tolerance of 1e-11).
#[test]
fn tied_conditions_with_laws_agree_with_another_solver() {
    let file = spec(
        "laws.model",
        "model laws; coordinates { x: periodic; y: -h..2*h; } parameters { r = 9; h = 0.5; a = 0.4; q = 1.5; } fields { T; c; }\n\
         law kap = (1 + a*y^2 + y*T/3)*exp(-T/4)*q; law rea = r*T*(1 - T)/(1 + c^2 + y^2);\n\
         balance { heat: dt(T) = dx(kap*dx(T)) + dy(kap*dy(T)) + rea;\n\
         salt: dt(c) = dy(dy(c)) + dx(dx(c)) - c + T^2*(1 + y)/2; }\n\
         base { guess { T = 0.3*(1 + y/h)*(2 - y/h); c = 0.1; } }\n\
         boundary { at y = -h { T = 0.2; dy(c) = c/3 + c^2*T; } at y = 2*h { kap*dy(T) + T = 0.1; c = 0.3; } }\n",
    );
    let base = json(&format!("base {file} --points 5"));
    let temperature = [
        0.2,
        0.566207889894,
        0.745148226201,
        0.756507572572,
        0.677785646664,
    ];
    let salt = [
        0.178055129722,
        0.213121076317,
        0.257577567735,
        0.290458179920,
        0.3,
    ];
    for place in 0..5 {
        let at = |name: &str| number(&base, &format!("/profiles/{name}/{place}"));
        close("T", at("T"), temperature[place], 1e-10);
        close("c", at("c"), salt[place], 1e-10);
    }
}

/// Two conditions about one field at one end: a clamped plate under the load 24, s = y²(1 − y)².
#[test]
fn two_conditions_about_one_field_count() {
    let file = spec(
        "plate.model",
        "model plate; coordinates { x: periodic; y: 0..1; } fields { s; w; }\n\
         balance { load: dt(w) = dx(dx(w)) + dy(dy(w)) - 24; bending: w = dx(dx(s)) + dy(dy(s)); }\n\
         boundary { at y = 0 { s = 0; dy(s) = 0; } at y = 1 { s = 0; dy(s) = 0; } }\n\
         amplitude { integral(|w|^2) = 1; }\n",
    );
    let base = json(&format!("base {file} --points 5"));
    for place in 0..5 {
        let y = f64::from(place) / 4.0;
        close(
            "s",
            number(&base, &format!("/profiles/s/{place}")),
            (y * (1.0 - y)).powi(2),
            1e-12,
        );
        close(
            "w",
            number(&base, &format!("/profiles/w/{place}")),
            2.0 - 12.0 * y + 12.0 * y * y,
            1e-11,
        );
    }
}

/// Without a word on the amplitude a pressure does not count, and a gauge that moves does.
#[test]
fn a_pressure_is_no_part_of_the_default_norm() {
    let channel = |amplitude: &str| {
        spec(
            "channel.model",
            &format!(
                "model channel; coordinates {{ x: periodic; y: -1..1; }} parameters {{ R = 6000; }} fields {{ u; v; p; }}\n\
                 let along(q) = u*dx(q) + v*dy(q); let laplace(q) = dx(dx(q)) + dy(dy(q));\n\
                 balance {{ momentum_x: dt(u) + along(u) = -dx(p) + (laplace(u) + 2)/R;\n\
                 momentum_y: dt(v) + along(v) = -dy(p) + laplace(v)/R; continuity: dx(u) + dy(v) = 0; }}\n\
                 base {{ u = 1 - y^2; v = 0; p = 0; }}\n\
                 boundary {{ at y = -1 {{ u = 0; v = 0; }} at y = 1 {{ u = 0; v = 0; }} }} mean {{ gauge p; }} {amplitude}"
            ),
        )
    };
    let ask = |file: &str| json(&format!("point {file} --k 1.02 -M 60"));
    let (plain, named) = (
        ask(&channel("")),
        ask(&channel("amplitude { integral(|u|^2 + |v|^2) = 1; }")),
    );
    assert_eq!(plain["normalization"], "∫ (|u|² + |v|²) dy = 1");
    assert_eq!(plain["c2"], named["c2"]);
    let drifting = spec(
        "front.model",
        "model front; coordinates { x: periodic; } parameters { nu = 0.9; } fields { h; }\n\
         balance { motion: dt(h) = -dx(dx(h)) - nu*dx(dx(dx(dx(h)))) - dx(h)^2/2; }\n\
         base { h = 0; } mean { gauge h; }",
    );
    assert_eq!(
        json(&format!("point {drifting} --k 1"))["normalization"],
        "|h|² = 1"
    );
}

/// A base state that is zero everywhere is solved for like any other, from any start: ∂t q = r q + ∇²q − q³ between walls
/// has c0 = r − π² − k² and, with q = A sin πz cos kx, c2 = −9/4.
#[test]
fn a_base_state_that_is_zero() {
    for base in ["", "base { guess { q = 0.1 + z; } }"] {
        let file = spec(
            "zero.model",
            &format!(
                "model zero \"A base state that is zero\";\n\
                 coordinates {{ x: periodic; z: 0..1; }}\n\
                 parameters {{ r = 1; }}\n\
                 fields {{ q; }}\n\
                 balance {{ e: dt(q) = r*q + dx(dx(q)) + dz(dz(q)) - q^3; }}\n\
                 {base}\n\
                 boundary {{ at z = 0 {{ q = 0; }} at z = 1 {{ q = 0; }} }}\n\
                 amplitude {{ at z = 1/2 {{ q = 1; }} }}\n"
            ),
        );
        let point = json(&format!("point {file} --k 1"));
        let leading = -std::f64::consts::PI.powi(2);
        close("c0", number(&point, "/c0/0"), leading, 1e-10);
        close("c2", number(&point, "/c2/0"), -2.25, 1e-10);
    }
}
