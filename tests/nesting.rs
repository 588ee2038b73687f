//! However deeply a text nests or however long it repeats itself, it ends in a diagnostic or a model: nothing
//! recurses without bound. The threads of tests have stacks of 2 MiB.

use landau_codegen::diagnostic::SourceFile;
use landau_codegen::errata::{Formula, Language, Notation, Subject, compare};
use landau_codegen::expression::compile;
use landau_codegen::{Sources, generate};
use std::collections::BTreeMap;
use std::time::{Duration, Instant};

/// Tokens, and openings that a repetition leaves open.
const REPEATED: [&str; 44] = [
    "|",
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    "-",
    "+",
    "*",
    "/",
    "^",
    "=",
    ":",
    ";",
    ",",
    "..",
    "<",
    "!",
    "&",
    "u",
    "u ",
    "1",
    "1 ",
    "\"d\" ",
    "\"",
    "-(",
    "u^",
    "u^-",
    "u^(",
    "u/",
    "u+",
    "u*(",
    "u+|",
    "sin(",
    "dx(",
    "dt(",
    "sin(|",
    "select s { a: ",
    "integral(",
    "/*",
    "//\n",
    "at y = 0 {",
    "r\"\\\" (",
];

/// A spec with places for a text: an expression, a statement, an item.
fn specs(text: &str) -> Vec<String> {
    let spec = |item: &str,
                parameter: &str,
                right: &str,
                statement: &str,
                base: &str,
                size: &str| {
        format!(
            "model m \"t\"; {item} coordinates {{ x: periodic; y: 0..1; }} parameters {{ s = a in {{a, b}}; r = {parameter}; }}\n\
             fields {{ u; }} balance {{ e: dt(u) = dy(dy(u)) + select s {{ a: r, b: 1 }}*u + {right}; {statement} }}\n\
             base {{ u = {base}; }} boundary {{ at y = 0 {{ u = 0; }} at y = 1 {{ u = 0; }} }}\n\
             amplitude {{ integral({size}) = 1; }}"
        )
    };
    vec![
        spec("", "1", text, "", "0", "|u|^2"),
        spec(text, "1", "0", "", "0", "|u|^2"),
        spec("", text, "0", "", "0", "|u|^2"),
        spec("", "1", "0", text, "0", "|u|^2"),
        spec("", "1", "0", "", text, "|u|^2"),
        spec("", "1", "0", "", "0", text),
        spec(&format!("law l = {text};"), "1", "0", "", "0", "|u|^2"),
    ]
}

fn sources(text: &str) -> Sources {
    Sources {
        spec: SourceFile {
            path: "nested.model".into(),
            text: text.to_owned(),
        },
        laws: BTreeMap::new(),
        unreadable: BTreeMap::new(),
    }
}

/// Whether a spec is accepted; every refusal has its place and readable length.
fn accepted(text: &str) -> bool {
    let start = Instant::now();
    let outcome = generate(&sources(text));
    let took = start.elapsed();
    let begins = &text[..text.len().min(80)];
    assert!(took < Duration::from_secs(20), "{took:?} for {begins}…");
    match outcome {
        Ok(_) => true,
        Err(mistakes) => {
            let said = mistakes.render();
            assert!(said.contains("--> "), "{said}");
            assert!(said.len() < 30_000, "{} bytes", said.len());
            false
        }
    }
}

/// Accepted or refused: what counts is that it ends.
fn either(text: &str) {
    accepted(text);
}

#[test]
fn repetitions_of_every_token() {
    for piece in REPEATED {
        for count in [60, 3000] {
            specs(&piece.repeat(count))
                .iter()
                .for_each(|text| either(text));
        }
        let many = piece.repeat(100_000 / piece.len());
        specs(&many).iter().take(2).for_each(|text| either(text));
    }
}

#[test]
fn brackets_that_close() {
    let pairs = [
        ("(", ")"),
        ("|", "|"),
        ("-(", ")"),
        ("sin(", ")"),
        ("u^(", ")"),
        ("(u+", ")"),
        ("dx(", ")"),
        ("dx(dy(", "))"),
        ("u*(1+", ")"),
        ("exp(u*", ")"),
        ("1/(1+", ")"),
        ("select s { a: ", ", b: u }"),
        ("(((u))+", ")"),
        ("u-(", ")"),
        ("sqrt(2+", ")"),
    ];
    for (open, close) in pairs {
        for count in [2, 20, 31, 60, 64, 65, 3000] {
            let text = format!("{}u{}", open.repeat(count), close.repeat(count));
            specs(&text).iter().for_each(|text| either(text));
        }
    }
    // Text that Rust takes for a raw string and comments, and what stands in them for brackets.
    let hidden = format!(
        "r\"\\\" {}{} // \"\n",
        "(".repeat(20_000),
        ")".repeat(20_000)
    );
    let nested = format!(
        "/* /* */ \" */ {}{} // \"\n",
        "(".repeat(20_000),
        ")".repeat(20_000)
    );
    for text in [hidden, nested] {
        specs(&text)
            .iter()
            .for_each(|text| assert!(!accepted(text)));
    }
}

/// Sums inside sums: a syntax tree as high as brackets times terms.
#[test]
fn long_sums_in_brackets() {
    for (terms, levels) in [(40, 60), (1999, 1), (2100, 1), (1000, 50)] {
        let text = (0..levels).fold("u".to_owned(), |inner, _| {
            format!("({inner}{})", "+u".repeat(terms))
        });
        specs(&text).iter().for_each(|text| either(text));
        let text = (0..levels).fold("u".to_owned(), |inner, _| {
            format!("({inner}{})", "*r".repeat(terms))
        });
        specs(&text).iter().for_each(|text| either(text));
    }
    assert!(
        accepted(&specs(&format!("u{}", "+u^2/3".repeat(500)))[0]),
        "a sum of 500 terms"
    );
}

/// Definitions and laws that call one another: each is short, what they come to is not.
#[test]
fn chains_of_definitions() {
    let head = "model m; coordinates { x: periodic; } fields { u; } base { u = 1; }";
    let spec = |items: &str, value: &str| {
        format!("{head} {items} balance {{ e: dt(u) = {value} - ({value}); }}")
    };
    let chain =
        |count: usize, link: &dyn Fn(usize) -> String| (1..count).map(link).collect::<String>();
    for (length, fits) in [(30, true), (60, true), (3000, false)] {
        let lets = chain(length, &|i| format!("let a{i} = atan(a{});", i - 1));
        let laws = chain(length, &|i| format!("law b{i} = atan(b{});", i - 1));
        let of_both = format!("let a0 = u; law b0 = u; {lets} {laws}");
        for name in ["a", "b"] {
            let value = format!("{name}{}", length - 1);
            assert_eq!(
                accepted(&spec(&of_both, &value)),
                fits,
                "{length} of {name}"
            );
        }
    }
    // Outputs that read a chain from its start, so that every piece is known when the next is read.
    let lets = chain(3000, &|i| format!("let a{i} = atan(a{});", i - 1));
    let outputs: String = (1..3000)
        .step_by(50)
        .map(|i| format!("o{i} = a{i};"))
        .collect();
    let text = format!(
        "{} outputs {{ {outputs} }}",
        spec(&format!("let a0 = u; {lets}"), "u")
    );
    assert!(!accepted(&text));
    // Functions of functions: 60 levels each, 60 of them in one another.
    let nest = |name: &str, count: usize| {
        format!("{}q{}", format!("{name}(").repeat(count), ")".repeat(count))
    };
    let items = format!(
        "let f(q) = {}; let g(q) = {}; let h(q) = {};",
        nest("atan", 60),
        nest("f", 60),
        nest("g", 60)
    );
    assert!(!accepted(&spec(&items, "h(u)")));
    // A number whose definition doubles at each step, where a number is wanted.
    let doubling = chain(80, &|i| format!("let a{i} = a{0}*(1 + a{0});", i - 1));
    accepted(&format!(
        "{head} let a0 = pi; {doubling} balance {{ e: dt(u) = 1 - u; }} typical {{ k = a79; }}"
    ));
}

/// Expressions that are read beside a model: derived columns, shaded quantities.
#[test]
fn expressions_beside_a_model() {
    let good = sources(&specs("0")[0]);
    let (derivation, kernels) = generate(&good).expect("a model");
    let state = kernels.structure.state();
    assert_eq!(derivation.model.name, "m");
    for piece in REPEATED {
        for count in [60, 3000, 100_000 / piece.len()] {
            if let Err(mistakes) = compile(&good, state, &piece.repeat(count)) {
                assert!(mistakes.render().len() < 30_000);
            }
        }
    }
}

/// Printed formulas in LaTeX.
#[test]
fn formulas_in_latex() {
    let nested = |open: &str, close: &str, count: usize| {
        format!("{}u{}", open.repeat(count), close.repeat(count))
    };
    let mut texts = Vec::new();
    for count in [30, 60, 3000] {
        for (open, close) in [
            ("\\frac{", "}{2}"),
            ("\\frac{1}{", "}"),
            ("{", "}"),
            ("(", ")"),
            ("[", "]"),
            ("\\left(", "\\right)"),
            ("\\sqrt{", "}"),
            ("u^{", "}"),
            ("|", "|"),
            ("-(", ")"),
            ("\\frac{\\partial}{\\partial x}", ""),
            ("\\frac{\\partial}{\\partial x}(", ")"),
            (
                "(\\frac{\\partial}{\\partial x} + \\frac{\\partial}{\\partial y})",
                "",
            ),
            (
                "(\\frac{\\partial}{\\partial x} + \\frac{\\partial}{\\partial y})(u +",
                ")",
            ),
            ("\\hat{", "}"),
            ("\\frac{\\partial ", "}{\\partial x}"),
            ("u_{", "}"),
            ("u'", ""),
            ("u/", ""),
            ("\\mathbf{", "}"),
        ] {
            texts.push(nested(open, close, count));
        }
    }
    texts.push("\\frac{\\partial^{4000000000} u}{\\partial x^{4000000000}}".into());
    texts.push("\\frac{\\partial^4000000000 u}{\\partial x^4000000000}".into());
    texts.push("u + ".repeat(100_000));
    let (mut derivation, _) = generate(&sources(&specs("0")[0])).expect("a model");
    for text in texts {
        let begins = text[..text.len().min(60)].to_owned();
        let start = Instant::now();
        for subject in [
            Subject::Balance("e".into()),
            Subject::Linear("e".into(), "u".into()),
        ] {
            let path = "printed".to_owned();
            let formula = Formula {
                subject,
                source: SourceFile {
                    path,
                    text: text.clone(),
                },
                language: Language::Latex,
                setting: Vec::new(),
            };
            if let Err(mistakes) = compare(&mut derivation, &Notation::default(), &formula) {
                assert!(mistakes.render().len() < 30_000, "{begins}");
            }
        }
        let took = start.elapsed();
        assert!(took < Duration::from_secs(20), "{took:?} for {begins}…");
    }
}
