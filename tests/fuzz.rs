//! Any text gives a diagnostic or a model, any study a message or a report: no panic, no hang.

use crate::mistakes::small;
use crate::support::root;
use landau_codegen::diagnostic::SourceFile;
use landau_codegen::{Sources, generate};
use landau_report::library::Library;
use landau_report::reproduce::{Formulas, Provenance, Study, Workshop};
use landau_solver::file::Overwrite;
use landau_solver::study::Silent;
use proptest::prelude::*;
use std::collections::BTreeMap;
use std::fs;
use std::time::{Duration, Instant};

fn read(text: String) {
    let spec = SourceFile {
        path: "fuzz.model".into(),
        text,
    };
    if let Err(mistakes) = generate(&Sources {
        spec,
        laws: BTreeMap::new(),
        unreadable: BTreeMap::new(),
    }) {
        assert!(!mistakes.list.is_empty());
        assert!(mistakes.render().contains("error"));
    }
}

const SPEC: &str = include_str!("../spec/models/swift_hohenberg_strip.model");

const PIECES: [&str; 40] = [
    "model",
    "m",
    ";",
    "{",
    "}",
    "(",
    ")",
    "fields",
    "u",
    "v",
    "parameters",
    "r",
    "=",
    "1",
    "in",
    "0..1",
    "balance",
    "e",
    ":",
    "dt",
    "dx",
    "dy",
    "+",
    "-",
    "*",
    "/",
    "^",
    "base",
    "boundary",
    "at",
    "y",
    "let",
    "coordinates",
    "x",
    "periodic",
    ",",
    "integral",
    "select",
    "|",
    "\"doc\"",
];

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_text(text in "\\PC{0,200}") {
        read(text);
    }

    #[test]
    fn any_bytes(bytes in proptest::collection::vec(any::<u8>(), 0..200)) {
        read(String::from_utf8_lossy(&bytes).into_owned());
    }

    #[test]
    fn any_tokens(picks in proptest::collection::vec(0..PIECES.len(), 0..80)) {
        read(picks.into_iter().map(|i| PIECES[i]).collect::<Vec<_>>().join(" "));
    }

    /// A good spec with a piece cut out, doubled or replaced.
    #[test]
    fn damaged_specs(at in 0..SPEC.len(), len in 0..40usize, piece in 0..PIECES.len()) {
        let floor = |mut i: usize| { while !SPEC.is_char_boundary(i.min(SPEC.len())) { i -= 1 } i.min(SPEC.len()) };
        let (start, end) = (floor(at), floor((at + len).min(SPEC.len())));
        read(format!("{}{}{}", &SPEC[..start], PIECES[piece], &SPEC[end..]));
    }
}

/// Deep nesting, laws that include each other, definitions that double at each step.
#[test]
fn hostile_specs_end_quickly() {
    let head = "model m; coordinates { x: periodic; } fields { u; } base { u = 0; }";
    let brackets = format!(
        "{head} balance {{ e: dt(u) = {}u{}; }}",
        "(".repeat(5000),
        ")".repeat(5000)
    );
    let signs = format!("{head} balance {{ e: dt(u) = {}u; }}", "-".repeat(20_000));
    let mut doubling = head.to_owned();
    for i in 0..60 {
        doubling += &format!("let a{i}(q) = a{0}(a{0}(q)) + q;", i + 1);
    }
    doubling += "let a60(q) = q*u; balance { e: dt(u) = a0(u); }";
    let tower = format!("{head} balance {{ e: dt(u) = {}u; }}", "u^".repeat(3000));
    let powers = format!("{head} balance {{ e: dt(u) = 9^9^9^9*u + (1+u)^(1/1000001); }}");
    for text in [brackets, signs, doubling, tower, powers] {
        read(text);
    }
    let law = |other: &str| SourceFile {
        path: format!("{other}.law"),
        text: format!("use laws::{other}::{{f as g}}; law f(u) = g(u);"),
    };
    let laws = BTreeMap::from([("a".to_owned(), law("b")), ("b".to_owned(), law("a"))]);
    let text = format!("{head} use laws::a::{{f}}; balance {{ e: dt(u) = f; }}")
        .replace(
            head,
            "model m; use laws::a::{f}; coordinates { x: periodic; } fields { u; } base { u = 0; }",
        )
        .replace("use laws::a::{f}; balance", "balance");
    let spec = SourceFile {
        path: "circle.model".into(),
        text,
    };
    let said = match generate(&Sources {
        spec,
        laws,
        unreadable: BTreeMap::new(),
    }) {
        Err(mistakes) => mistakes.render(),
        Ok(_) => panic!("a circle of laws was accepted"),
    };
    assert!(said.contains("defined by itself"), "{said}");
}

/// The studies that ship, with one line left out or one number replaced: accepted or refused in bounded time, and what is
/// accepted of a small study is worked through, without a panic.
#[test]
fn damaged_studies_end_quickly() {
    let library = Library {
        models: landau_spec::models(),
    };
    let folder = tempfile::tempdir().expect("a folder");
    let studies = root().join("spec/studies");
    for name in [
        "rolls.model",
        "vibrated_disks.model",
        "clever_busse_1974.csv",
    ] {
        fs::copy(studies.join(name), folder.path().join(name)).expect("copied");
    }
    let read = |name: &str| fs::read_to_string(studies.join(name)).expect(name);
    let path = folder.path().join("study.toml");
    let attempt = |text: &str, name: &str, worked_through: bool| -> bool {
        fs::write(&path, text).expect("written");
        let provenance = Provenance {
            command: String::new(),
            date: String::new(),
            commit: None,
        };
        let began = Instant::now();
        let accepted = Study::read(&path).is_ok_and(|study| {
            let out = folder.path().join(name);
            let shop = Workshop::new(&library, &study, &out, Overwrite::Recognised, provenance);
            shop.is_ok_and(|shop| {
                if worked_through {
                    let _ = shop.run(&Formulas::default(), &Silent);
                }
                true
            })
        });
        assert!(began.elapsed() < Duration::from_secs(30), "{text}");
        accepted
    };
    let mut accepted = 0;
    for shipped in ["shukla2014.toml", "schlueter1965.toml"] {
        for text in damaged(&read(shipped)) {
            accepted += usize::from(attempt(&text, "report", false));
        }
    }
    for (index, text) in damaged(&small()).iter().enumerate() {
        accepted += usize::from(attempt(text, &format!("report{index}"), true));
    }
    assert!(accepted > 20, "{accepted}");
}

/// A study with every n-th line left out, and with every n-th number replaced.
fn damaged(text: &str) -> Vec<String> {
    const LEFT_OUT: usize = 60;
    const REPLACED: usize = 60;
    let lines: Vec<&str> = text.lines().collect();
    let step = (lines.len() / LEFT_OUT).max(1);
    let left_out = (0..lines.len()).step_by(step).map(|at| {
        let kept = lines.iter().enumerate().filter(|(i, _)| *i != at);
        kept.map(|(_, line)| *line).collect::<Vec<_>>().join("\n")
    });
    let mut list: Vec<String> = left_out.collect();
    let numbers: Vec<(usize, usize)> = numbers(text);
    let values = [
        "0",
        "-1",
        "nan",
        "inf",
        "1e300",
        "-1e-300",
        "1000000000",
        "0.5",
    ];
    let step = (numbers.len() / REPLACED).max(1);
    for (count, (start, end)) in numbers.iter().step_by(step).enumerate() {
        let value = values[count % values.len()];
        list.push(format!("{}{value}{}", &text[..*start], &text[*end..]));
    }
    list
}

/// Where the numbers of a text stand.
fn numbers(text: &str) -> Vec<(usize, usize)> {
    let bytes = text.as_bytes();
    let part = |b: u8| b.is_ascii_digit() || matches!(b, b'.' | b'-' | b'e');
    let mut list = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        let starts =
            bytes[at].is_ascii_digit() && (at == 0 || matches!(bytes[at - 1], b' ' | b'['));
        if !starts {
            at += 1;
            continue;
        }
        let end = (at..bytes.len())
            .find(|&i| !part(bytes[i]))
            .unwrap_or(bytes.len());
        list.push((at, end));
        at = end;
    }
    list
}
