//! Study files: the page about them, the one of another paper, shares.

use crate::reproduce::run;
use crate::support::{close, landau};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// The page about study files holds one that runs as it says, and names every kind of task.
#[test]
fn the_page_about_studies_holds_one() {
    let page =
        fs::read_to_string(crate::support::root().join("spec/STUDIES.md")).expect("the page");
    let (_, rest) = page.split_once("```toml\n").expect("an example");
    let (study, _) = rest.split_once("```").expect("its end");
    let folder = tempfile::tempdir().expect("a folder");
    let (file, out) = (
        folder.path().join("study.toml"),
        folder.path().join("report"),
    );
    fs::write(&file, study).expect("written");
    let paths = [&file, &out].map(|p| p.to_str().expect("a path"));
    let answer = landau(&["reproduce", paths[0], "--out", paths[1]]);
    assert_eq!(answer.status, 3, "{}", answer.err);
    assert!(answer.err.contains("free: Ra_c"), "{}", answer.err);
    let read = |name: &str| -> Value {
        let text = fs::read_to_string(out.join(name)).expect(name);
        serde_json::from_str(&text).expect("JSON")
    };
    let numbers = read("numbers.json");
    close(
        "Ra_c",
        numbers[0]["ours"].as_f64().expect("Ra_c"),
        1707.762,
        5e-4,
    );
    assert_eq!(numbers[1]["printed"], 657.511);
    assert_eq!(read("claims.json")[0]["verdict"], "holds");
    // A kind that the page forgets would be named by the error of one that is not known.
    fs::write(&file, study.replace("\"sweep\"", "\"swoop\"")).expect("written");
    let error = landau(&["reproduce", paths[0], "--out", paths[1]]).err;
    let kinds: Vec<&str> = error.split('`').skip(3).step_by(2).collect();
    assert!(kinds.len() >= 12, "{error}");
    for kind in kinds {
        assert!(
            page.contains(&format!("| `{kind}` |")),
            "{kind} is not in the page"
        );
    }
}

/// The second study: onsets to all printed digits; the coefficient of Schlüter, Lortz & Busse (1965) to the fourth decimal,
/// and the Nusselt number of Clever & Busse (1974) to what third order leaves of it.
#[test]
fn another_paper_is_reproduced_without_rust() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("report");
    let study = crate::support::root().join("spec/studies/schlueter1965.toml");
    let paths = [&study, &out].map(|p| p.to_str().expect("a path"));
    run(&["reproduce", paths[0], "--out", paths[1]]);
    let text = fs::read_to_string(out.join("numbers.json")).expect("numbers");
    let numbers: Vec<Value> = serde_json::from_str(&text).expect("JSON");
    let mut compared = 0;
    for number in numbers.iter().filter(|n| n["printed"].is_number()) {
        let [ours, printed] =
            ["ours", "printed"].map(|key| number[key].as_f64().expect("a number"));
        let allowed = match number["name"].as_str().expect("a name") {
            "Ra_c" => 5e-4,
            "k of Ra_c" => 1e-3,
            "flux" => 3e-4,
            "nusselt" => 4e-3,
            name => panic!("{name}"),
        };
        close(&number["quantity"].to_string(), ours, printed, allowed);
        compared += 1;
    }
    assert_eq!(compared, 10);
    for file in [
        "sources/rolls.model",
        "sources/schlueter1965.toml",
        "figureheat-1.csv-metadata.json",
    ] {
        assert!(out.join(file).is_file(), "{file}");
    }
}

/// Two shares, then the whole, which computes nothing again: the report is that of one run.
#[test]
fn a_study_in_shares() {
    let folder = tempfile::tempdir().expect("a folder");
    let study = crate::support::root().join("spec/studies/schlueter1965.toml");
    let study = study.to_str().expect("a path");
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (plain, shared) = (path("plain"), path("shared"));
    run(&["reproduce", study, "--out", &plain]);
    for share in ["2/2", "1/2"] {
        let said = run(&["reproduce", study, "--out", &shared, "--shard", share]);
        assert!(said.contains("4 tasks kept"), "{said}");
    }
    let kept = fs::read_dir(path("shared.kept")).expect("kept");
    let times = kept.map(|file| file.and_then(|f| f.metadata()?.modified()).expect("a time"));
    let before: Vec<_> = times.collect();
    assert_eq!(before.len(), 8);
    run(&["reproduce", study, "--out", &shared]);
    let after = fs::read_dir(path("shared.kept")).expect("kept");
    let after: Vec<_> = after
        .map(|file| file.and_then(|f| f.metadata()?.modified()).expect("a time"))
        .collect();
    assert_eq!(before, after, "a finished task was computed again");
    for file in [
        "numbers.json",
        "claims.json",
        "figureonset-1.csv",
        "figurepattern-1-1.npz",
    ] {
        let read = |out: &str| fs::read(Path::new(out).join(file)).expect(file);
        assert!(read(&plain) == read(&shared), "{file} differs");
    }
    let refused = landau(&["reproduce", study, "--out", &shared, "--shard", "3/2"]);
    assert_eq!(refused.status, 2, "{}", refused.err);
}

/// Neutral curves r = (1 − k²)² of two cases: two curves, each along the axis, exact; a number that is marked in one
/// picture and asked for beside another stands once, with what is printed.
#[test]
fn curves_of_two_cases() {
    let study = r#"
title = "Neutral curves"
source = "exact solutions"
model = "swift_hohenberg"
[[figure]]
id = "1"
title = "Neutral curves"
[[figure.task]]
kind = "critical"
against = { name = "k", from = 0.8, to = 1.2, count = 5 }
[[figure.task.asked]]
name = "r_0"
vary = "r"
between = [-0.5, 0.5]
[[figure.task.case]]
label = "small"
set = ["b=0.1"]
[[figure.task.case]]
label = "large"
set = ["b=0.7"]
[[figure]]
id = "2"
title = "Growth"
[[figure.task]]
kind = "sweep"
over = { name = "k", from = 0.8, to = 1.2, count = 9 }
columns = ["a0"]
mark = [{ name = "k_l", vary = "k", between = [0.8, 1.0] }]
[[figure.task.case]]
label = ""
set = ["r=0.1"]
[[figure.task]]
kind = "critical"
asked = [{ name = "k_l", vary = "k", between = [0.8, 1.0] }]
[[figure.task.case]]
label = ""
set = ["r=0.1"]
printed = { k_l = 0.8269 }
"#;
    let folder = tempfile::tempdir().expect("a folder");
    let (file, out) = (folder.path().join("s.toml"), folder.path().join("report"));
    fs::write(&file, study).expect("written");
    let paths = [&file, &out].map(|p| p.to_str().expect("a path"));
    run(&["reproduce", paths[0], "--out", paths[1]]);
    let page = fs::read_to_string(out.join("index.html")).expect("the page");
    assert!(page.contains("r_0, r over k for small, large"), "{page}");
    let text = fs::read_to_string(out.join("numbers.json")).expect("numbers");
    let numbers: Vec<Value> = serde_json::from_str(&text).expect("JSON");
    assert_eq!(numbers.len(), 11);
    for (number, k) in numbers
        .iter()
        .zip([0.8_f64, 0.9, 1.0, 1.1, 1.2].iter().cycle())
        .take(10)
    {
        let exact = (1.0 - k * k).powi(2);
        close(
            "r_0",
            number["ours"].as_f64().expect("a number"),
            exact,
            1e-9,
        );
    }
    let exact = (1.0 - 0.1_f64.sqrt()).sqrt();
    close(
        "k_l",
        numbers[10]["ours"].as_f64().expect("k_l"),
        exact,
        1e-9,
    );
    assert_eq!(numbers[10]["printed"], 0.8269);
}
