//! Texts of any size end in an answer of readable size; numbers that are none end in status 3.

use crate::support::{landau, written};

fn spec(parameters: &str, body: &str) -> String {
    format!(
        "model m \"t\";\ncoordinates {{ x: periodic; }}\nparameters {{ {parameters} }}\nfields {{ u; }}\n{body}\n\
         base {{ u = 0; }}\n"
    )
}

#[test]
fn texts_of_a_megabyte() {
    let balance = |right: &str| format!("balance {{ e: dt(u) = r*u {right}; }}");
    let chain: String = (1..5000)
        .map(|i| format!("let a{i} = a{} + r;\n", i - 1))
        .collect();
    let slopes: String = (1..60)
        .map(|i| format!("let a{i} = dx(a{0}) + a{0}*r;\n", i - 1))
        .collect();
    let deep: String = (1..300)
        .map(|i| format!("let a{i} = dx(a{});\n", i - 1))
        .collect();
    let mistakes: String = (0..20_000)
        .map(|i| format!("let a{i} = zz{i};\n"))
        .collect();
    let parameters: String = (0..20_000).map(|i| format!("; p{i} = 1")).collect();
    let fields = spec("r = 1;", &balance("")).replace(
        "fields { u;",
        &format!(
            "fields {{ u; {}",
            (0..20_000).map(|i| format!("f{i}; ")).collect::<String>()
        ),
    );
    let cases = [
        (
            2,
            spec("r = 1;", &balance(&format!("- {}", "a".repeat(900_000)))),
        ),
        (
            2,
            spec("r = 1;", &format!("{}{}", balance(""), ";".repeat(900_000))),
        ),
        (2, spec("r = 1;", &balance(&"+ zz ".repeat(150_000)))),
        (
            2,
            spec("r = 1;", &balance(&format!("+ {}u", "-".repeat(200_000)))),
        ),
        (
            2,
            spec("r = 1;", &balance(&format!("+ u{}", "^1".repeat(100_000)))),
        ),
        (
            2,
            spec("r = 1;", &balance(&format!("- u^{}", "9".repeat(1000)))),
        ),
        (
            2,
            spec("r = 1;", &balance(&format!("- 1e{}*u", "9".repeat(1000)))),
        ),
        (
            2,
            spec(
                "r = 1;",
                &balance(&format!("- 0.{}*u", "1".repeat(100_000))),
            ),
        ),
        (2, spec("r = 1;", &balance("- u^3*2^(2^(2^(2^(2^2))))"))),
        (2, spec("r = 1;", &balance("- (((((r+u)^9)^9)^9)^9)^9"))),
        (
            2,
            spec(
                "r = 1;",
                &format!("let a0 = u;\n{chain}{}", balance("- a4999")),
            ),
        ),
        (
            0,
            spec(
                "r = 1;",
                &format!("let a0 = u;\n{slopes}{}", balance("- a59")),
            ),
        ),
        (
            2,
            spec(
                "r = 1;",
                &format!("let a0 = u;\n{deep}{}", balance("- a299")),
            ),
        ),
        (2, spec("r = 1;", &format!("{mistakes}{}", balance("")))),
        (2, spec(&format!("r = 1{parameters}"), &balance(""))),
        (2, fields),
    ];
    for (index, (status, text)) in cases.iter().enumerate() {
        let path = written("large.model", text);
        let answer = landau(&["check", &path.to_string_lossy()]);
        assert_eq!(answer.status, *status, "{index}: {}", answer.err);
        assert!(
            answer.err.len() < 20_000,
            "{index}: {} bytes",
            answer.err.len()
        );
    }
    let path = written("many.model", &cases[13].1);
    let told = landau(&["check", &path.to_string_lossy()]).err;
    assert_eq!(told.matches("error: `zz").count(), 20);
    assert!(told.contains("more mistakes"));
}

/// A resonance, an unnamed conserved quantity, a double eigenvalue, an impossible normalisation, a mode that is
/// not resolved: status 3, a sentence, and no number.
#[test]
fn no_number_where_there_is_no_answer() {
    let line = |fields: &str, balances: &str, rest: &str| {
        format!(
            "model line \"t\";\ncoordinates {{ x: periodic; }}\nparameters {{ r = 0.1; }}\nfields {{ {fields} }}\n\
             balance {{ {balances} }}\n{rest}\n"
        )
    };
    let hohenberg = "e: dt(u) = r*u - (u + 2*dx(dx(u)) + dx(dx(dx(dx(u))))) + u^2 - u^3;";
    let twice = format!(
        "{hohenberg} {}",
        hohenberg.replace('u', "w").replace("e:", "f:")
    );
    let zero = "base { u = 0; }";
    let cases = [
        // ∫u is conserved and not named, c0 = 4e-12.
        (
            line(
                "u;",
                "e: dt(u) = -dx(dx(r*u + dx(dx(u)) + u^2 - u^3));",
                zero,
            ),
            vec!["--k", "1", "--set", "r=1.000000000004"],
            "nearly singular",
        ),
        (
            line("u; w;", &twice, "base { u = 0; w = 0; }"),
            vec!["--k", "1"],
            "not simple",
        ),
        (
            line("u;", hohenberg, &format!("{zero} amplitude {{ u = 0; }}")),
            vec!["--k", "1"],
            "normalised",
        ),
        (
            line(
                "u;",
                hohenberg,
                &format!("{zero} amplitude {{ u = 1e-200; }}"),
            ),
            vec!["--k", "1"],
            "out of the range",
        ),
    ];
    for (spec, options, told) in cases {
        let path = written("none.model", &spec);
        let path = path.to_string_lossy();
        for json in [&[][..], &["--json"][..]] {
            let arguments: Vec<&str> = ["point", &path]
                .into_iter()
                .chain(options.iter().copied())
                .chain(json.iter().copied())
                .collect();
            let answer = landau(&arguments);
            assert_eq!(answer.status, 3, "{told}: {}", answer.out);
            assert_eq!(answer.out, "", "{told}");
            assert!(answer.err.contains(told), "{told}: {}", answer.err);
        }
    }
    for line in [
        "point plane_poiseuille --k 1 -M 14 --set R=10000",
        "spectrum plane_poiseuille --k 1 -M 8 --set R=10000",
    ] {
        let arguments: Vec<&str> = line.split(' ').collect();
        let answer = landau(&arguments);
        assert_eq!((answer.status, answer.out.as_str()), (3, ""), "{line}");
        assert!(
            answer.err.contains("not converged"),
            "{line}: {}",
            answer.err
        );
    }
}

/// c2 = 0 exactly is degenerate, and a c0 of rounding has neither a side nor an amplitude.
#[test]
fn kinds_that_are_not_decided() {
    let spec = "model degenerate \"t\";
coordinates { x: periodic; }
parameters { r = 0.1; b = 0; d = 0; }
fields { u; }
balance { e: dt(u) = r*u - (u + 2*dx(dx(u)) + dx(dx(dx(dx(u))))) + b*u^3 - u^5 + d*dx(u); }
base { u = 0; }
amplitude { u = 1; }
";
    let path = written("degenerate.model", spec);
    let point = |set: &str| crate::support::json(&format!("point {} --k 1 {set}", path.display()));
    let flat = point("");
    assert_eq!(flat["bifurcation"], "degenerate pitchfork");
    assert!(flat["amplitude"].is_null());
    let neutral = point("--set r=0 --set b=-1");
    assert_eq!(neutral["bifurcation"], "supercritical pitchfork");
    assert!(neutral["amplitude"].is_null());
    let wave = point("--set d=1e-3 --set b=-1");
    assert_eq!(wave["bifurcation"], "supercritical Hopf");
    // A wave of no speed, in the arithmetic of waves.
    let still = point("--set d=0 --set b=-1");
    assert_eq!(still["bifurcation"], "supercritical pitchfork");
}
