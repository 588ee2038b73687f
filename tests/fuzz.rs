//! Any text gives a diagnostic or a model: no panic, no hang.

use landau_codegen::diagnostic::SourceFile;
use landau_codegen::{Sources, generate};
use proptest::prelude::*;
use std::collections::BTreeMap;

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
