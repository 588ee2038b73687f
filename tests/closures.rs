//! What closes the problem at k = 0: used where the spec names it, refused where the balances do not keep it, named where
//! the spec does not.

use crate::integrals::{CONTROLLED, point, verified};
use crate::support::{close, json, landau, number, root, written};

/// c2 of a strip whose balance holds dt under dy, with and without its condition: −1.0555 and −0.3790.
#[test]
fn closures_beside_a_time_derivative_under_dy() {
    let text = "
        model lagrange;
        coordinates { x: periodic; y: 0..1; }
        parameters { r = 11; b = 1; lam = 0.1; }
        fields { u; }
        balance {
            ev: dt(u - lam*dy(dy(u))) = r*u - (u + 2*dx(dx(u)) + dx(dx(dx(dx(u))))) + dy(dy(u)) + b*u^2 - u^3 + G;
        }
        base { u = 0; G = 0; }
        boundary { at y = 0 { u = 0; } at y = 1 { u = 0; } }
        mean { unknown G: integral(u) = 0; }
        amplitude { at y = 1/2 { u = 1; } }
        typical { k = 1; }";
    let found = point(text, "");
    close("c2", number(&found, "/c2/0"), -1.055_536_486_8, 1e-9);
    verified(text, "");
    // The mode does not depend on y: c2 = −3 − b²/2 + … of the balance without walls.
    let insulated = |under: &str, walls: &str| {
        format!(
            "model insulated;
            coordinates {{ x: periodic; {} }}
            parameters {{ r = 1.1; b = 1; }}
            fields {{ u; }}
            balance {{ ev: dt(u{under}) = -r*dx(dx(u)) - dx(dx(dx(dx(u)))) + b*dx(u*dx(u)) + dx(dx(u^3)){}; }}
            base {{ u = 0; }}
            {walls}
            mean {{ conserved integral(u); }}
            amplitude {{ {}u = 1; {} }}
            typical {{ k = 1; }}",
            if walls.is_empty() { "" } else { "y: 0..1;" },
            if walls.is_empty() { "" } else { " + dy((1 + 0.7*u)*dy(u))" },
            if walls.is_empty() { "" } else { "at y = 1/2 { " },
            if walls.is_empty() { "" } else { "}" },
        )
    };
    let walls = "boundary { at y = 0 { dy(u) = 0; } at y = 1 { dy(u) = 0; } }";
    let strip = point(&insulated(" - 0.2*dy(dy(u))", walls), "-M 20");
    let line = point(&insulated("", ""), "");
    close("c2", number(&strip, "/c2/0"), number(&line, "/c2/0"), 1e-9);
}

/// A pressure whose momentum balances hold dt under dz: its gauge is taken, at onset too.
#[test]
fn a_gauge_beside_a_time_derivative_under_dz() {
    let text = "
        model voigt;
        coordinates { x: periodic; z: 0..1; }
        parameters { Ra = 1800; lam = 0.1; }
        fields { u; w; p; theta; }
        let along(q) = u*dx(q) + w*dz(q);
        let laplace(q) = dx(dx(q)) + dz(dz(q));
        balance {
            momentum_x: dt(u - lam*laplace(u)) + along(u) = -dx(p) + laplace(u);
            momentum_z: dt(w - lam*laplace(w)) + along(w) = -dz(p) + laplace(w) + Ra*theta;
            continuity: dx(u) + dz(w) = 0 for p;
            heat: dt(theta) + along(theta) = w + laplace(theta);
        }
        base { u = 0; w = 0; p = 0; theta = 0; }
        boundary { at z = 0 { w = 0; theta = 0; u = 0; } at z = 1 { w = 0; theta = 0; u = 0; } }
        mean { gauge p; }
        amplitude { at z = 1/2 { theta = 1; } }
        typical { k = 3.1; }";
    let found = point(text, "-M 24");
    let error = number(&found, "/error/c2");
    assert!(error < 1e-8, "{error}");
    verified(text, "-M 24");
}

/// A multiplier that has to vanish and does not is an error everywhere.
#[test]
fn integrals_that_are_not_kept_are_refused() {
    let spec = std::fs::read_to_string(root().join("spec/models/granular_couette.model"));
    let spec = spec.expect("the spec");
    let wrong = spec
        .replace("integral(phi*v)", "integral(v)")
        .replace("integral(phi*u)", "integral(u)");
    let path = written("granular_couette.model", &wrong);
    let laws = path.with_file_name("laws");
    std::fs::create_dir(&laws).expect("a folder");
    std::fs::copy(root().join("spec/laws/lun.law"), laws.join("lun.law")).expect("copied");
    let file = path.display().to_string();
    let mode = ["--k", "3.141592653589793", "--near", "-0.05,0.36"];
    for command in ["point", "verify"] {
        let answer = landau(&[&[command, &file], &mode[..]].concat());
        assert_eq!(answer.status, 3, "{command}: {}", answer.out);
        assert!(
            answer.err.contains("multiplier"),
            "{command}: {}",
            answer.err
        );
    }
    let choice = format!(
        "k=3.141592653589793,near={}",
        "-0.05,0.36".replace(',', ":")
    );
    let answer = landau(&["amplitudes", &file, "--mode", &choice]);
    assert_eq!(answer.status, 3, "{}", answer.out);
    let out = path.with_file_name("rows.csv").display().to_string();
    let sweep = ["sweep", &file, "--over", "k=3.1:3.2:2", "--out", &out];
    landau(&[&sweep[..], &mode[2..]].concat());
    let rows = std::fs::read_to_string(&out).expect("a table");
    let rows: Vec<&str> = rows.lines().skip(1).collect();
    let refused = rows.iter().filter(|row| row.contains("does not vanish"));
    assert_eq!(refused.count(), 2, "{rows:?}");
    // With the integrals that its balances keep.
    let found = json(&format!("point granular_couette {}", mode.join(" ")));
    close("c2", number(&found, "/c2/0"), -216.637_4, 1e-4);
    close("c2", number(&found, "/c2/1"), -189.329_4, 1e-4);
}

/// One conserved field: products cancel in the mean to rounding, and what they leave is no multiplier.
#[test]
fn cancelled_means_are_no_alarm() {
    let film = "
        model film;
        coordinates { x: periodic; }
        parameters { B = 1; }
        fields { h in 0..; }
        balance { mass: dt(h) + dx(h^3*(dx(dx(dx(h))) + B*dx(h))) = 0; }
        base { h = 1; }
        mean { conserved integral(h); }
        amplitude { h = 1; }";
    let benney = "
        model benney;
        coordinates { x: periodic; }
        parameters { R = 1.875; s = 1; }
        fields { h in 0..; }
        balance { mass: dt(h) + dx(2/3*h^3 + 8/15*R*h^6*dx(h) + s*h^3*dx(dx(dx(h)))) = 0; }
        base { h = 1; }
        mean { conserved integral(h); }
        amplitude { h = 1; }";
    let coupled = "
        model coupled;
        coordinates { x: periodic; }
        parameters { r = 0.1; s = 0.8; gam = 0.6; sig = 0.9; }
        fields { u; v; }
        let w = u + dx(dx(u));
        balance {
            eu: dt(u) = r*u - w - dx(dx(w)) - u^3 - s*u*v;
            ev: dt(v) = sig*dx(dx(v)) + gam*dx(dx(u^2));
        }
        base { u = 0; v = 0; }
        mean { conserved integral(v); }
        amplitude { u = 1; }";
    let wide = &[0.55, 0.6, 0.7, 0.77, 0.8, 0.83, 0.9, 0.95, 1.07][..];
    for (text, wavenumbers) in [
        (film, wide),
        (benney, wide),
        (coupled, &[0.85, 0.9, 1.0, 1.07][..]),
    ] {
        for k in wavenumbers {
            let path = written("film.model", text);
            let line = format!("verify {} --k {k}", path.display());
            let answer = landau(&line.split_whitespace().collect::<Vec<_>>());
            assert_eq!(answer.status, 0, "{line}: {}{}", answer.out, answer.err);
        }
    }
}

/// What a spec names is used or refused, with its place.
#[test]
fn no_closure_is_dropped() {
    let refused = |text: &str, line: &str| {
        let path = written("refused.model", text).display().to_string();
        let answer = landau(&["check", &path]);
        assert_eq!(answer.status, 2, "{}", answer.out);
        assert!(answer.err.contains(line), "{line}: {}", answer.err);
    };
    refused(&CONTROLLED.replace("u + s*u^2", "s*u^2"), "no linear part");
    refused(
        &CONTROLLED.replace("u + s*u^2", "u + s*dt(u)"),
        "time derivative",
    );
    // Another integral that is conserved, of the base state, does not stand in for it.
    let two = "
        model two;
        coordinates { x: periodic; y: 0..1; }
        parameters { F = 1; }
        fields { n; u; }
        balance {
            mass: dt(n) = dx(dx(n)) + dy(dy(n));
            flow: dt(u) = dx(dx(u)) + dy(dy(u)) - u + n*u;
        }
        base { u = 0; n = F; integral(n) = F; }
        boundary { at y = 0 { dy(n) = 0; u = 0; } at y = 1 { dy(n) = 0; u = 0; } }
        mean { conserved integral(u); }";
    refused(two, "not conserved");
}

/// Integrals that the balances keep and nothing declares are named, and the envelope has its caveat.
#[test]
fn what_is_kept_is_named() {
    let named = |text: &str| -> Vec<String> {
        let path = written("kept.model", text);
        let answer = landau(&["check", &path.display().to_string()]);
        assert_eq!(answer.status, 0, "{}", answer.err);
        let notes = answer.out.lines().filter(|line| line.starts_with("note"));
        notes.map(str::to_owned).collect()
    };
    let film = |mean: &str| {
        format!(
            "model film;
            coordinates {{ x: periodic; }}
            fields {{ h in 0..; }}
            balance {{ mass: dt(h) + dx(h^3*(dx(dx(dx(h))) + dx(h))) = 0; }}
            base {{ h = 1; }}
            {mean}
            amplitude {{ h = 1; }}"
        )
    };
    assert!(named(&film(""))[0].contains("integral(h)"));
    assert!(named(&film("mean { conserved integral(h); }")).is_empty());
    for mean in ["", "mean { conserved integral(h); }"] {
        let found = point(&film(mean), "--k 0.8");
        assert_eq!(found["conserved_mean"], true, "{found}");
        let undeclared = found["undeclared"].as_array().expect("a list");
        assert_eq!(undeclared.is_empty(), !mean.is_empty());
    }
    // A reaction that makes of one field what it takes from the other.
    let reaction = |taken: &str| {
        format!(
            "model reaction;
            coordinates {{ x: periodic; y: 0..1; }}
            fields {{ a; b; }}
            balance {{
                ea: dt(a) = dx(dx(a)) + dy(dy(a)) - a + b + a^2*b;
                eb: dt(b) = 2*dx(dx(b)) + 2*dy((1 + b)*dy(b)) + a - b - {taken};
            }}
            base {{ a = 0; b = 0; }}
            boundary {{
                at y = 0 {{ dy(a) = 0; dy(b) = 0; }}
                at y = 1 {{ dy(a) = 0; dy(b) = 0; }}
            }}"
        )
    };
    let found = named(&reaction("a^2*b"));
    assert!(
        found.len() == 1 && found[0].contains("integral(a + b)"),
        "{found:?}"
    );
    // Kept by the linear balances alone, or up to a flux through a wall: not kept.
    assert!(named(&reaction("2*a^2*b")).is_empty());
    let leaking = reaction("a^2*b").replace("at y = 0 { dy(a) = 0;", "at y = 0 { a = 0;");
    assert!(named(&leaking).is_empty());
    // Momentum, whose proof takes the balance of mass times the velocity.
    let spec = std::fs::read_to_string(root().join("spec/models/granular_couette.model"));
    let spec = spec
        .expect("the spec")
        .replace("conserved integral(phi*v);", "");
    let spec = spec.replace("conserved integral(phi*u);", "");
    let path = written("granular_couette.model", &spec);
    let laws = path.with_file_name("laws");
    std::fs::create_dir(&laws).expect("a folder");
    std::fs::copy(root().join("spec/laws/lun.law"), laws.join("lun.law")).expect("copied");
    let answer = landau(&["check", &path.display().to_string()]);
    assert!(
        answer.out.contains("integral(phi0 v) to first order"),
        "{}",
        answer.out
    );
}
