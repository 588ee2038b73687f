//! Parameters that take whole numbers alone.

use crate::support::{close, json, landau, number, written};

/// Diffusion in a strip of m half waves with slip walls, where the base state cos(y) fits for whole m alone; growth
/// of the gravest disturbance of u that vanishes at the walls of v: r − k² − 1/m² for v.
fn strip(declared: &str) -> String {
    let text = format!(
        "model strip \"Strip of m half waves\";\n\
         coordinates {{ x: periodic; y: 0..m*pi; }}\n\
         parameters {{ r = 0.5; m = {declared}; }}\n\
         fields {{ u; v; }}\n\
         balance {{\n\
         first: dt(u) = dx(dx(u)) + dy(dy(u)) - 3*u + 4*cos(y);\n\
         second: dt(v) = r*v + dx(dx(v)) + dy(dy(v)) - v^3;\n\
         }}\n\
         base {{ u = cos(y); v = 0; }}\n\
         boundary {{ at y = 0 {{ dy(u) = 0; v = 0; }} at y = m*pi {{ dy(u) = 0; v = 0; }} }}\n\
         amplitude {{ integral(|v|^2) = 1; }}\n"
    );
    written("strip.model", &text).to_string_lossy().into_owned()
}

#[test]
fn a_fraction_is_refused_and_never_drawn() {
    let free = strip("2 in 1..10");
    assert_eq!(
        landau(&["check", &free]).status,
        2,
        "m = 2.14 has no base state"
    );
    for declared in [
        "2 in 1..10 whole \"half waves\"",
        "2 whole",
        "2 in 1.. whole",
        "1 in 1..1 whole",
    ] {
        let answer = landau(&["check", &strip(declared)]);
        assert_eq!((answer.status, answer.err.as_str()), (0, ""), "{declared}");
    }
    let file = strip("2 in 1..10 whole \"half waves\"");
    for m in [1.0, 2.0, 5.0] {
        let point = json(&format!("point {file} --k 0.3 -M 24 --set m={m}"));
        close(
            "c0",
            number(&point, "/c0/0"),
            0.5 - 0.09 - 1.0 / (m * m),
            1e-10,
        );
        let slopes = point["dc0"].as_object().expect("an object");
        assert_eq!(
            slopes.keys().collect::<Vec<_>>(),
            ["r"],
            "no derivative by a whole number"
        );
    }
    for (value, told) in [
        ("2.5", "not a whole number"),
        ("11", "out of range"),
        ("nan", "out of range"),
    ] {
        let answer = landau(&["point", &file, "--k", "0.3", "--set", &format!("m={value}")]);
        assert_eq!((answer.status, answer.out.as_str()), (2, ""), "{value}");
        let accepts = "`m` accepts a whole number in 1..10";
        assert!(
            answer.err.contains(told) && answer.err.contains(accepts),
            "{}",
            answer.err
        );
    }
}

#[test]
fn a_sweep_goes_through_whole_numbers() {
    let file = strip("2 in 1..10 whole");
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("m.csv");
    let out = out.to_string_lossy();
    let sweep = |over: &str, out: &str| {
        landau(&[
            "sweep", &file, "--over", over, "--k", "0.3", "-M", "24", "--out", out,
        ])
    };
    let answer = sweep("m=1:7:3", &out);
    assert_eq!(answer.status, 0, "{}", answer.err);
    let mut reader = csv::Reader::from_path(&*out).expect("a table");
    let column = reader
        .headers()
        .expect("a header")
        .iter()
        .position(|name| name == "c0_re")
        .expect("a column");
    let rows: Vec<(f64, f64)> = reader
        .records()
        .map(|row| row.expect("a row"))
        .map(|row| {
            (
                row[0].parse().expect("a number"),
                row[column].parse().expect("a number"),
            )
        })
        .collect();
    assert_eq!(rows.len(), 3);
    for (m, c0) in rows {
        close(&format!("m = {m}"), c0, 0.5 - 0.09 - 1.0 / (m * m), 1e-8);
    }
    let answer = sweep("m=1:7:5", &format!("{out}.fractions"));
    assert_eq!(answer.status, 2);
    assert!(
        answer.err.contains("m = 2.5 is not a whole number"),
        "{}",
        answer.err
    );
    let answer = landau(&[
        "critical", &file, "--vary", "m", "--from", "1", "--to", "4", "--k", "0.3",
    ]);
    assert_eq!(answer.status, 2);
    assert!(
        answer
            .err
            .contains("`m` takes whole numbers: it cannot vary continuously"),
        "{}",
        answer.err
    );
    let over = [
        "critical",
        &file,
        "--vary",
        "m",
        "--from",
        "1",
        "--to",
        "4",
        "--minimize",
        "k=0.1:1",
    ];
    assert_eq!(landau(&over).status, 2);
}

/// With `whole` or without, a model whose value is whole gives the same numbers.
#[test]
fn nothing_else_changes() {
    // A base state that fits at any m, so that dc0/dm exists.
    let ask = |declared: &str| {
        let text = std::fs::read_to_string(strip(declared)).expect("the spec");
        let text = text
            .replace("+ 4*cos(y)", "")
            .replace("u = cos(y)", "u = 0");
        let file = written("strip.model", &text);
        json(&format!("point {} --k 0.3 -M 24", file.display()))
    };
    let (free, whole) = (ask("2 in 1..10"), ask("2 in 1..10 whole"));
    for key in ["/c0/0", "/c2/0", "/error/c2", "/dc0/r/0"] {
        assert_eq!(number(&free, key), number(&whole, key), "{key}");
    }
}
