//! What a report must not do: believe what others have changed, write where others have written, show what is not so.

use crate::support::{Answer, landau, root};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// A study in a folder of its own, and the folder of its report.
pub struct Desk {
    folder: TempDir,
}

impl Desk {
    pub fn new() -> Self {
        Desk {
            folder: tempfile::tempdir().expect("a folder"),
        }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Works through a study.
    pub fn reproduce(&self, study: &str) -> Answer {
        fs::write(self.path("study.toml"), study).expect("written");
        self.again(&self.path("report"))
    }

    /// Works through the same study once more.
    pub fn again(&self, out: &Path) -> Answer {
        let paths = [&self.path("study.toml"), out].map(|p| p.to_string_lossy().into_owned());
        landau(&["reproduce", &paths[0], "--out", &paths[1]])
    }

    pub fn json(&self, name: &str) -> Vec<Value> {
        let text = fs::read_to_string(self.path("report").join(name)).expect(name);
        serde_json::from_str(&text).expect("JSON")
    }

    pub fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).expect(name)
    }
}

/// A study of one figure with the given tasks, of a model without a bounded coordinate.
pub fn study(tasks: &str) -> String {
    format!(
        "title = \"t\"\nsource = \"s\"\nmodel = \"swift_hohenberg\"\n[[figure]]\nid = \"1\"\ntitle = \"f\"\n{tasks}"
    )
}

pub const SWEEP: &str = r#"
[[figure.task]]
kind = "sweep"
over = { name = "k", from = 0.8, to = 1.2, count = 5 }
columns = ["a0"]
[[figure.task.case]]
label = "r = 0.3"
set = ["r=0.3"]
"#;

/// Every file of a folder, with its content.
pub fn files(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut list = Vec::new();
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            list.extend(files(&path));
        } else {
            list.push((path.clone(), fs::read(&path).unwrap_or_default()));
        }
    }
    list.sort();
    list
}

/// A digit that is changed in a kept task, a path in it, another file in its place: each is computed again.
#[test]
fn a_kept_task_that_was_changed_is_computed_again() {
    let desk = Desk::new();
    let text = study(SWEEP);
    assert_eq!(desk.reproduce(&text).status, 0);
    let kept = desk.path("report.kept/1-1.json");
    let (good, table) = (
        fs::read_to_string(&kept).expect("kept"),
        desk.read("report/figure1-1.csv"),
    );
    serde_json::from_str::<Value>(&good).expect("a kept task is JSON");
    let value = table.lines().nth(1).expect("a row").split(',').nth(2);
    let value = value.expect("c0").parse::<f64>().expect("a number");
    let digits = format!("{value}");
    assert!(good.contains(&digits), "{digits} in {good}");
    for changed in [
        good.replace(&digits, "7.25"),
        good.replace("\"files\":[]", "\"files\":[\"../../../../etc/passwd\"]"),
        good.replace("\"seal\":\"", "\"seal\":\"0"),
        String::new(),
    ] {
        assert_ne!(changed, good);
        fs::write(&kept, &changed).expect("written");
        let answer = desk.again(&desk.path("report"));
        assert_eq!(answer.status, 0);
        let note = format!(
            "note: {} is damaged; its task is computed again, and the file is replaced",
            kept.display()
        );
        assert!(answer.err.contains(&note), "{}", answer.err);
        assert_eq!(desk.read("report/figure1-1.csv"), table);
        assert!(!desk.read("report/index.html").contains("passwd"));
        assert_eq!(fs::read_to_string(&kept).expect("kept"), good);
    }
}

/// A task that shows points of somebody else's is made anew where their file changes.
#[test]
fn a_kept_task_knows_its_reference() {
    let desk = Desk::new();
    fs::write(desk.path("points.csv"), "k,a0\n0.9,0.1\n").expect("written");
    let reference = "reference = [{ file = \"points.csv\", label = \"others\" }]\n";
    let text = study(&SWEEP.replace(
        "[[figure.task.case]]",
        &format!("{reference}[[figure.task.case]]"),
    ));
    assert_eq!(desk.reproduce(&text).status, 0);
    let before = desk.read("report/figure1-1.svg");
    fs::write(desk.path("points.csv"), "k,a0\n0.9,0.2\n").expect("written");
    assert_eq!(desk.again(&desk.path("report")).status, 0);
    assert_ne!(before, desk.read("report/figure1-1.svg"));
    assert!(desk.read("report/sources/points.csv").contains("0.2"));
}

/// A report goes into a folder of its own; what others have there stays as it is.
#[test]
fn folders_of_others_stay_as_they_are() {
    let desk = Desk::new();
    fs::write(desk.path("study.toml"), study(SWEEP)).expect("written");
    let foreign = desk.path("foreign");
    fs::create_dir(&foreign).expect("made");
    fs::write(foreign.join("index.html"), "mine").expect("written");
    fs::create_dir(desk.path("other.kept")).expect("made");
    fs::write(desk.path("other.kept/1-1.json"), "mine").expect("written");
    let before = files(&foreign);
    for out in [
        foreign.clone(),
        desk.path("other"),
        foreign.join("index.html"),
        PathBuf::from("."),
        PathBuf::from("/"),
        PathBuf::from(".."),
    ] {
        let answer = desk.again(&out);
        assert_eq!(answer.status, 2, "{}: {}", out.display(), answer.err);
        assert!(answer.err.contains("a report accepts"), "{}", answer.err);
    }
    assert!(files(&foreign) == before);
    assert_eq!(desk.read("other.kept/1-1.json"), "mine");
    // An empty folder is as good as none, and a report of an earlier run is replaced.
    fs::create_dir(desk.path("empty")).expect("made");
    for _ in 0..2 {
        assert_eq!(desk.again(&desk.path("empty")).status, 0);
    }
    // A link in the place of one of its files leads to a file of somebody else.
    fs::remove_file(desk.path("empty/index.html")).expect("removed");
    std::os::unix::fs::symlink(foreign.join("index.html"), desk.path("empty/index.html"))
        .expect("a link");
    let answer = desk.again(&desk.path("empty"));
    assert_eq!(answer.status, 2, "{}", answer.err);
    assert!(files(&foreign) == before);
}

/// Names that lead out of the folder of the report, or that no link can hold, are refused before anything is written.
#[test]
fn ids_are_names_of_files() {
    let desk = Desk::new();
    let outside = desk.path("evil");
    for id in [
        "../../evil",
        &outside.to_string_lossy(),
        "a/b",
        "..",
        ".",
        "",
        ".hidden",
        "a b",
        "a\\nb",
        "a\\u0000",
        "\\u202Eevil",
        "<b>",
        &"x".repeat(300),
    ] {
        let text = study(SWEEP).replace("id = \"1\"", &format!("id = \"{id}\""));
        let answer = desk.reproduce(&text);
        assert_eq!(answer.status, 2, "{id}: {}", answer.err);
        assert!(answer.err.contains("id"), "{id}: {}", answer.err);
        assert!(!desk.path("report").exists() && !outside.exists(), "{id}");
    }
}

/// A report that is killed at any moment loses no finished task, leaves no half of a file, and goes on to the same bytes.
#[test]
fn a_killed_report_goes_on() {
    let desk = Desk::new();
    let sweeps: String = (0..6)
        .map(|i| {
            SWEEP
                .replace("r=0.3", &format!("r=0.3{i}"))
                .replace("count = 5", "count = 400")
        })
        .collect();
    let text = study(&sweeps);
    let start = Instant::now();
    assert_eq!(desk.reproduce(&text).status, 0);
    let whole = start.elapsed();
    let expected: Vec<(PathBuf, Vec<u8>)> = files(&desk.path("report"))
        .into_iter()
        .filter(|(path, _)| {
            // The page has its date, and the list of files the page's hash.
            !path.ends_with("index.html") && !path.ends_with(".landau-report")
        })
        .collect();
    let page = desk.read("report/index.html");
    let paths = ["study.toml", "report"].map(|name| desk.path(name).to_string_lossy().into_owned());
    for part in 1..8_u32 {
        for folder in ["report", "report.kept"] {
            fs::remove_dir_all(desk.path(folder)).expect("removed");
        }
        let mut child = Command::new(env!("CARGO_BIN_EXE_landau-under-test"))
            .args(["reproduce", &paths[0], "--out", &paths[1]])
            .current_dir(root())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("started");
        std::thread::sleep(Duration::from_millis(1) + whole * part / 9);
        child.kill().expect("killed");
        child.wait().expect("ended");
        // Every file that is there is whole: a kept task has its seal, a page its end.
        let finished: Vec<(PathBuf, Vec<u8>)> = files(&desk.path("report.kept"))
            .into_iter()
            .filter(|(path, _)| path.extension().is_some_and(|e| e == "json"))
            .collect();
        for (path, content) in &finished {
            serde_json::from_slice::<Value>(content).unwrap_or_else(|e| panic!("{path:?}: {e}"));
        }
        assert_eq!(desk.again(&desk.path("report")).status, 0);
        for (path, content) in finished {
            assert!(fs::read(&path).is_ok_and(|now| now == content), "{path:?}");
        }
        let named = |(path, _): &(PathBuf, Vec<u8>)| {
            let name = path.file_name().unwrap_or_default();
            !name.to_string_lossy().starts_with(".landau-")
        };
        let after: Vec<(PathBuf, Vec<u8>)> = files(&desk.path("report"))
            .into_iter()
            .filter(|(path, _)| !path.ends_with("index.html"))
            .filter(named)
            .collect();
        assert!(after == expected, "killed after {part}/9");
        let end = |page: &str| page.split("</time>").nth(1).map(str::to_owned);
        assert_eq!(end(&desk.read("report/index.html")), end(&page));
    }
}

/// A formula brings no elements of its own into the page, whatever text of the study it stands in.
#[test]
fn texts_bring_no_elements() {
    let desk = Desk::new();
    let evil = [
        r"$\\operatorname{<img src=x onerror=alert(1)>}$",
        r"$\\mathop{<img src=x onerror=alert(1)>}$",
        "<script>alert(1)</script>",
        r"$\\text{</math><script>alert(1)</script>}$",
        r"$\\operatorname{</mi></math><iframe src=x>}$",
    ]
    .join(" ");
    let symbol = r#"
[symbol.k]
text = "<script>alert(1)</script>"
latex = '\operatorname{<img src=x onerror=alert(1)>}'
"#;
    let text = study(SWEEP)
        .replace(
            "title = \"t\"",
            &format!("title = \"{evil}\"\nintroduction = \"{evil}\""),
        )
        .replace("source = \"s\"", &format!("source = \"{evil}\""))
        .replace(
            "title = \"f\"",
            &format!("title = \"{evil}\"\ntext = \"{evil}\""),
        )
        .replace(
            "label = \"r = 0.3\"",
            &format!("label = \"{evil}\"\nnote = \"{evil}\""),
        )
        .replace("[[figure]]", &format!("{symbol}[[figure]]"));
    let answer = desk.reproduce(&text);
    assert_eq!(answer.status, 0, "{}", answer.err);
    let page = desk.read("report/index.html");
    for element in ["<img src=x", "<script", "<iframe", " onerror=alert(1)>"] {
        assert!(!page.contains(element), "{element}");
    }
    assert!(page.contains("Content-Security-Policy") && page.contains("default-src 'none'"));
    let picture = desk.read("report/figure1-1.svg");
    assert!(!picture.contains("<script") && !picture.contains("<img"));
}

/// Signs that no picture, page or table can show, and labels that a spreadsheet would compute.
#[test]
fn texts_can_be_shown() {
    let desk = Desk::new();
    for (text, told) in [
        (study(SWEEP).replace("\"f\"", "\"f\\u0007\""), "U+0007"),
        (study(SWEEP).replace("\"t\"", "\"t\\u202Et\""), "U+202E"),
        (
            study(SWEEP).replace("\"r = 0.3\"", "\"=1+1\""),
            "spreadsheet",
        ),
        (
            study(SWEEP).replace("\"r = 0.3\"", "\"@SUM(A1)\""),
            "spreadsheet",
        ),
        (study(SWEEP).replace("\"f\"", "\"\"\"f\nf\"\"\""), "U+000A"),
    ] {
        let answer = desk.reproduce(&text);
        assert_eq!(answer.status, 2, "{told}: {}", answer.err);
        assert!(answer.err.contains(told), "{told}: {}", answer.err);
        assert!(!desk.path("report").exists());
    }
}

/// Printed numbers of two cases: each is answered by its own, or missed by name.
#[test]
fn printed_numbers_do_not_hide_behind_one_another() {
    let desk = Desk::new();
    let tasks = r#"
[[figure.task]]
kind = "sweep"
over = { name = "k", from = 0.6, to = 1.0, count = 5 }
columns = ["a0"]
mark = [{ name = "k_l", vary = "k", between = [0.6, 1.0] }]
[[figure.task.case]]
set = ["r=0.1"]
printed = { k_l = 0.8269 }
[[figure.task.case]]
set = ["r=0.2"]
printed = { k_l = 99.0, l = 3.0 }
"#;
    let answer = desk.reproduce(&study(tasks));
    assert_eq!(answer.status, 3, "{}", answer.err);
    assert!(
        answer.err.contains("nothing in this task is called so"),
        "{}",
        answer.err
    );
    let numbers = desk.json("numbers.json");
    let of = |printed: f64| {
        let number = numbers.iter().find(|n| n["printed"] == printed);
        number.unwrap_or_else(|| panic!("{printed} in {numbers:?}"))
    };
    let exact = |r: f64| (1.0 - r.sqrt()).sqrt();
    for (printed, r) in [(0.8269, 0.1), (99.0, 0.2)] {
        let ours = of(printed)["ours"].as_f64().expect("a number");
        assert!((ours - exact(r)).abs() < 1e-9, "{printed}: {ours}");
    }
    assert_eq!(of(3.0)["ours"], Value::Null);
}

/// Where nothing comes out, the report says so, and so does the shell.
#[test]
fn what_does_not_come_out_is_a_failure() {
    let desk = Desk::new();
    // A coefficient that is no number: every row fails.
    let model = "model lost \"A law outside its range\";
coordinates { x: periodic; }
parameters { r = 1; }
fields { u; }
balance { e: dt(u) = sqrt(r)*u + dx(dx(u)) - u^3; }
base { u = 0; }
";
    fs::write(desk.path("lost.model"), model).expect("written");
    let tasks = SWEEP.replace(
        "set = [\"r=0.3\"]",
        "set = [\"r=-1\"]\nmodel = \"lost.model\"",
    );
    let answer = desk.reproduce(&study(&tasks));
    assert_eq!(answer.status, 3, "{} {}", answer.out, answer.err);
    assert!(
        answer.err.contains("none of 5 points came out"),
        "{}",
        answer.err
    );
    let page = desk.read("report/index.html");
    assert!(
        page.contains("Did not come out: r = 0.3: none of 5 points"),
        "{page}"
    );
    // The table stays, with the reason in every row.
    assert_eq!(desk.read("report/figure1-1.csv").lines().count(), 6);
}

/// What is not converged is no number of a report, and a claim without a bound is none.
#[test]
fn values_are_converged_and_claims_have_bounds() {
    let desk = Desk::new();
    let poor = "
[[figure.task]]
kind = \"values\"
[[figure.task.case]]
label = \"M = 8\"
model = \"plane_poiseuille\"
resolution = 8
k = 1.02
set = [\"R=5800\"]
";
    let answer = desk.reproduce(&study(poor));
    assert_eq!(answer.status, 3, "{}", answer.err);
    for number in desk.json("numbers.json") {
        assert_eq!(number["ours"], Value::Null, "{number}");
        assert_ne!(number["status"], "ok", "{number}");
    }
    let bound = "
[[figure.task]]
kind = \"claims\"
[[figure.task.claim]]
says = \"It grows\"
name = \"a0\"
quantity = \"a0\"
[[figure.task.case]]
k = 1.0
";
    let answer = desk.reproduce(&study(bound));
    assert_eq!(answer.status, 2, "{}", answer.err);
    assert!(
        answer.err.contains("nothing decides the statement"),
        "{}",
        answer.err
    );
}

/// What a study was made from is delivered whole; no file replaces another of its name.
#[test]
fn sources_are_complete() {
    let desk = Desk::new();
    for folder in ["errata", "one", "two"] {
        fs::create_dir(desk.path(folder)).expect("made");
    }
    let spec =
        fs::read_to_string(root().join("spec/models/swift_hohenberg.model")).expect("a spec");
    let other = spec.replace("model swift_hohenberg", "model swift_hohenberg_two");
    fs::write(desk.path("one/sh.model"), &spec).expect("written");
    fs::write(desk.path("two/sh.model"), &other).expect("written");
    fs::write(desk.path("points.csv"), "k,a0\n0.9,0.1\n").expect("written");
    let errata = "source = \"printed\"\nformula = []\n";
    fs::write(desk.path("errata/study.toml"), errata).expect("written");
    let reference = "reference = [{ file = \"points.csv\", label = \"others\" }]\n[[figure.task.case]]\nmodel = \"two/sh.model\"\nlabel = \"two\"\n";
    let text = study(&SWEEP.replace(
        "[[figure.task.case]]",
        &format!("{reference}[[figure.task.case]]"),
    ))
    .replace(
        "model = \"swift_hohenberg\"",
        "model = \"one/sh.model\"\nerrata = \"errata/study.toml\"",
    );
    let answer = desk.reproduce(&text);
    assert_eq!(answer.status, 0, "{}", answer.err);
    for (name, content) in [
        ("study.toml", text.as_str()),
        ("errata/study.toml", errata),
        ("sh.model", &spec),
        ("sh-2.model", &other),
        ("points.csv", "k,a0\n0.9,0.1\n"),
    ] {
        assert_eq!(
            desk.read(&format!("report/sources/{name}")),
            content,
            "{name}"
        );
    }
    // The description of a table names what each case was computed from.
    let described: Value =
        serde_json::from_str(&desk.read("report/figure1-1.csv-metadata.json")).expect("JSON");
    let cases = described["landau:cases"].as_array().expect("cases");
    assert_eq!(cases.len(), 2);
    assert_eq!(cases[1]["parameters"]["r"], 0.3);
    for key in [
        "model",
        "model_hash",
        "parameters",
        "normalization",
        "label",
    ] {
        assert!(!cases[0][key].is_null(), "{key}: {described}");
    }
}
