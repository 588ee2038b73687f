//! Patterns as data, and a study worked through into a report.

use crate::browser::{attributes, browse};
use crate::support::{close, landau};
use serde_json::Value;
use std::fs;

/// One study file with every sort of answer that is quick.
const STUDY: &str = r#"
title = "A small study"
source = "an exact solution"
model = "vibrated_bed"
resolution = 40

[[figure]]
id = "1"
title = "Numbers"
[[figure.task]]
kind = "critical"
[[figure.task.asked]]
name = "k_u"
vary = "k"
between = [0.12, 0.2]
[[figure.task.asked]]
name = "none"
vary = "k"
between = [0.08, 0.1]
[[figure.task.case]]
printed = { k_u = 0.1748, none = "0.1790", k_x = 1.0 }
[[figure.task]]
kind = "sweep"
over = { name = "k", from = 0.15, to = 0.18, count = 5 }
columns = ["a0", "a2", "amplitude"]
[[figure.task.case]]
label = "H = 40"

[[figure.task]]
kind = "claims"
[[figure.task.claim]]
says = "The bed is unstable"
name = "a0"
quantity = "a0"
above = 0.0
[[figure.task.claim]]
says = "The upper onset lies beyond 0.18"
name = "k_u"
quantity = "place"
at = { name = "k_u", vary = "k", between = [0.12, 0.2] }
above = 0.18
[[figure.task.claim]]
says = "A second onset lies below 0.1"
name = "k_v"
quantity = "place"
at = { name = "k_v", vary = "k", between = [0.08, 0.1] }
below = 0.1
[[figure.task.case]]
label = "H = 40"
k = 0.16

[[figure]]
id = "2"
title = "A pattern"
[[figure.task]]
kind = "pattern"
shade = "n"
arrows = ["u", "v"]
[[figure.task.case]]
label = "k = 0.16"
k = 0.16
"#;

pub fn run(arguments: &[&str]) -> String {
    let answer = landau(arguments);
    assert_eq!(answer.status, 0, "{arguments:?}: {}", answer.err);
    answer.out
}

/// A page without the time at which it was made.
fn timeless(page: &str) -> String {
    let (before, rest) = page.split_once("<time").expect("a time");
    let (_, after) = rest.split_once("</time>").expect("its end");
    before.to_owned() + after
}

#[test]
fn a_study_becomes_a_report() {
    let folder = tempfile::tempdir().expect("a folder");
    let (file, out) = (
        folder.path().join("small.toml"),
        folder.path().join("report"),
    );
    fs::write(&file, STUDY).expect("written");
    let arguments = [
        "reproduce",
        file.to_str().expect("a path"),
        "--out",
        out.to_str().expect("a path"),
    ];
    // What does not come out does not hide: not from the shell either.
    let run_failing = || {
        let answer = landau(&arguments);
        assert_eq!(answer.status, 3, "{}", answer.err);
        assert!(
            answer.err.contains("the report is written, but none: "),
            "{}",
            answer.err
        );
        answer.out
    };
    let printed = run_failing();
    assert!(
        printed.contains("0.1790"),
        "printed digits are kept: {printed}"
    );
    assert!(
        printed.contains("not met at 0.18: 0.17454: The upper onset lies beyond 0.18"),
        "{printed}"
    );
    let read = |name: &str| fs::read_to_string(out.join(name)).expect(name);
    let page = read("index.html");
    let links = attributes(&page, "src")
        .into_iter()
        .chain(attributes(&page, "href"));
    for link in links.filter(|link| !link.starts_with('#')) {
        assert!(out.join(link).is_file(), "{link} is missing");
    }
    for wanted in [
        "<math",
        "<table",
        "figure1-1.svg",
        "figure2-1-1.npz",
        "Did not come out",
    ] {
        assert!(page.contains(wanted), "{wanted} is not in the page");
    }
    let numbers: Value = serde_json::from_str(&read("numbers.json")).expect("JSON");
    let upper = &numbers[0];
    assert_eq!(upper["quantity"], "k_u");
    assert_eq!(upper["printed"], 0.1748);
    assert_eq!(upper["status"], "ok");
    // A number that did not come out stays beside its printed value, with the reason; so does a printed value that
    // goes with no question.
    let lost = &numbers[1];
    assert_eq!(
        (&lost["ours"], &lost["printed"]),
        (&Value::Null, &Value::from(0.179))
    );
    assert!(
        lost["status"]
            .as_str()
            .expect("a reason")
            .contains("does not change sign")
    );
    let all = numbers.as_array().expect("numbers");
    let stray = all.iter().find(|n| n["quantity"] == "k_x").expect("kept");
    assert_eq!(stray["status"], "nothing in this task is called so");
    let claims: Value = serde_json::from_str(&read("claims.json")).expect("JSON");
    let verdicts: Vec<&str> = claims
        .as_array()
        .expect("claims")
        .iter()
        .map(|c| c["verdict"].as_str().expect("a verdict"))
        .collect();
    assert_eq!(verdicts, ["holds", "not met", "undecided"]);
    let table = read("figure1-1.csv");
    let header = table.lines().next().expect("a header");
    assert_eq!(
        header,
        "case,k,c0_re,c0_im,c0_error,c2_re,c2_im,c2_error,amplitude,mean_flow,second_harmonic,leading_re,label,bifurcation,status"
    );
    assert!(
        table
            .lines()
            .nth(1)
            .expect("a row")
            .ends_with("H = 40,supercritical pitchfork,ok")
    );
    close(
        "k_u",
        upper["ours"].as_f64().expect("a number"),
        0.17454,
        2e-5,
    );

    // An interrupted run goes on, and ends in the same bytes.
    let before = [
        timeless(&read("index.html")),
        read("numbers.json"),
        read("figure1-1.csv"),
    ];
    for name in [
        "report/index.html",
        "report/numbers.json",
        "report.kept/1-2.json",
        "report.kept/2-1.json",
    ] {
        fs::remove_file(folder.path().join(name)).expect(name);
    }
    run_failing();
    let after = [
        timeless(&read("index.html")),
        read("numbers.json"),
        read("figure1-1.csv"),
    ];
    assert!(before == after, "a resumed run differs");
    // What is kept is not computed again, gaps in a table (no amplitude beyond k_u) or not.
    let written = || {
        let kept = ["1-1", "1-2", "2-1"];
        let kept = kept.map(|name| folder.path().join(format!("report.kept/{name}.json")));
        kept.map(|path| fs::metadata(path).and_then(|m| m.modified()).expect("kept"))
    };
    let first = written();
    run_failing();
    assert_eq!(written(), first, "a finished task was computed again");
    browse(&out, attributes(&page, "src").len());
}

#[test]
fn a_study_that_asks_for_nothing_known_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("report");
    for (broken, expected) in [
        (
            STUDY.replace("kind = \"sweep\"", "kind = \"swoop\""),
            "swoop",
        ),
        (
            STUDY.replace("vibrated_bed", "vibrated_bad"),
            "did you mean",
        ),
        (STUDY.replace("vary = \"k\"", "vary = \"Q\""), "Q"),
        (STUDY.replace("shade = \"n\"", "shade = \"m\""), "`m`"),
        (
            STUDY.replace("id = \"2\"", "id = \"1\""),
            "two figures have the id `1`",
        ),
        (STUDY.replace("count = 5", "count = 0"), "count = 0"),
        (
            STUDY.replace("columns = [", "colums = ["),
            "unknown field `colums`",
        ),
        (
            STUDY.replace("none = \"0.1790\"", "none = \"0.1x\""),
            "is no number",
        ),
    ] {
        let file = folder.path().join("broken.toml");
        fs::write(&file, broken).expect("written");
        let answer = landau(&[
            "reproduce",
            file.to_str().expect("a path"),
            "--out",
            out.to_str().expect("a path"),
        ]);
        assert_eq!(answer.status, 2, "{expected}: {}", answer.err);
        assert!(answer.err.contains(expected), "{expected}: {}", answer.err);
        // What is wrong in the file is pointed at by its own line.
        let (_, line) = answer.err.split_once(" | ").unwrap_or_default();
        let shown = line.lines().next().unwrap_or_default();
        if ["swoop", "count = 0", "two figures", "colums"]
            .iter()
            .any(|e| expected.contains(e))
        {
            let key = expected.rsplit('`').nth(1).unwrap_or(expected);
            assert!(shown.contains(key), "{expected}: {}", answer.err);
        }
        assert!(!out.join("index.html").exists());
    }
}

#[test]
fn formulas_in_latex() {
    let printed = run(&[
        "explain",
        "vibrated_bed",
        "--operator",
        "L",
        "--format",
        "latex",
    ]);
    for wanted in [
        r"[\text{mass},\,v]\quad -n^{0}_{y} - n^{0} \partial_{y}",
        r"\frac{1}{n^{0}} \left[\left(2 \mu^{0} + \lambda^{0}\right) \partial_{x}^{2} + \mu^{0}_{y} \partial_{y} + \mu^{0} \partial_{y}^{2}\right]",
    ] {
        assert!(printed.contains(wanted), "{wanted} is not in\n{printed}");
    }
    let balanced = |line: &str| line.matches('{').count() == line.matches('}').count();
    assert!(printed.lines().all(balanced));
}
