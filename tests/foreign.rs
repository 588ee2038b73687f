//! What is somebody else's stays: files that a command would replace, links, scripts for clusters and what they quote.

use crate::support::{Answer, landau, root};
use std::fs;
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::{Path, PathBuf};
use std::process::Command;

const SWEEP: [&str; 4] = ["sweep", "swift_hohenberg", "--over", "k=0.9:1.1:5"];

/// A folder, with names in it.
struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        Folder(tempfile::tempdir().expect("a folder"))
    }

    fn path(&self, name: &str) -> String {
        self.0.path().join(name).display().to_string()
    }

    /// A file that is somebody else's.
    fn foreign(&self, name: &str) -> String {
        let path = self.path(name);
        fs::write(&path, "mine\n").expect("written");
        path
    }

    fn is_mine(&self, name: &str) -> bool {
        fs::read(self.path(name)).is_ok_and(|bytes| bytes == b"mine\n")
    }
}

fn refused(line: &[&str], file: &str) -> Answer {
    let answer = landau(line);
    assert_eq!(answer.status, 2, "{line:?}: {}", answer.err);
    assert!(answer.err.contains(file), "{line:?}: {}", answer.err);
    assert!(answer.out.is_empty(), "{line:?}: {}", answer.out);
    answer
}

fn done(line: &[&str]) -> Answer {
    let answer = landau(line);
    assert_eq!(answer.status, 0, "{line:?}: {}", answer.err);
    answer
}

/// Every command that writes, and the file of somebody else that it would replace: refused before anything is computed,
/// replaced with `--force`, and once it is Landau's replaced without, until somebody changes it.
#[test]
fn foreign_files_are_refused_and_forced() {
    let folder = Folder::new();
    let out = folder.path("table.csv");
    let sweep = [&SWEEP[..], &["--out", &out]].concat();
    let (slurm, hq) = (
        [&sweep[..], &["--emit", "slurm"]].concat(),
        [&sweep[..], &["--emit", "hq"]].concat(),
    );
    let [plot, svg, png] = ["plot.svg", "a.svg", "a.png"].map(|name| folder.path(name));
    let [npz, nc, vtk] = ["a.npz", "a.nc", "a.vtk"].map(|name| folder.path(name));
    let drawn = [&sweep[..], &["--plot", &plot]].concat();
    let strip = "rayleigh_benard";
    let mut cases: Vec<(Vec<&str>, &str)> = vec![
        (sweep.clone(), "table.csv"),
        (sweep.clone(), "table.csv-metadata.json"),
        (sweep.clone(), "table.csv.journal"),
        (slurm, "table.csv.slurm.sh"),
        (hq, "table.csv.hq.toml"),
        (drawn, "plot.svg"),
        (vec!["base", strip, "-M", "12", "--plot", &svg], "a.svg"),
        (vec!["base", strip, "-M", "12", "--out", &npz], "a.npz"),
        (vec!["spectrum", strip, "-M", "12", "--plot", &png], "a.png"),
        (vec!["spectrum", strip, "-M", "12", "--out", &nc], "a.nc"),
        (
            vec![
                "point", strip, "--k", "3.1", "--set", "Ra=1800", "--plot", &svg,
            ],
            "a.svg",
        ),
        (
            vec![
                "point", strip, "--k", "3.1", "--set", "Ra=1800", "--out", &nc,
            ],
            "a.nc",
        ),
    ];
    let window = [
        "pattern", strip, "--k", "3.1", "--set", "Ra=1800", "--points", "9x9",
    ];
    for (file, name) in [
        (&svg, "a.svg"),
        (&png, "a.png"),
        (&npz, "a.npz"),
        (&nc, "a.nc"),
        (&vtk, "a.vtk"),
    ] {
        cases.push(([&window[..], &["--out", file]].concat(), name));
    }
    let onset = [
        "critical",
        "swift_hohenberg",
        "--vary",
        "r",
        "--from",
        "-0.1",
        "--to",
        "0.1",
        "--k",
        "1",
    ];
    cases.push(([&onset[..], &["--plot", &svg]].concat(), "a.svg"));
    for (line, name) in cases {
        let file = folder.foreign(name);
        let answer = refused(&line, &file);
        assert!(answer.err.contains("--force"), "{}", answer.err);
        assert!(folder.is_mine(name), "{line:?}");
        done(&[&line[..], &["--force"]].concat());
        assert!(!folder.is_mine(name), "{line:?}");
        // A journal is gone once its table is complete.
        if !name.ends_with(".journal") {
            done(&line);
            // A byte more, and it is somebody else's again.
            let mut changed = fs::read(&file).expect("the file");
            changed.push(b'\n');
            fs::write(&file, &changed).expect("written");
            let answer = refused(&line, &file);
            assert!(answer.err.contains("changed"), "{}", answer.err);
            assert_eq!(fs::read(&file).expect("the file"), changed);
        }
        for entry in fs::read_dir(folder.0.path()).expect("listed") {
            fs::remove_file(entry.expect("an entry").path()).expect("removed");
        }
    }
}

/// A table of another sweep has the same columns and is another table: each part of a sweep that may differ is named.
#[test]
fn tables_of_other_sweeps() {
    let folder = Folder::new();
    let out = folder.path("table.csv");
    fn with<'a>(out: &'a str, more: &[&'a str]) -> Vec<&'a str> {
        [&SWEEP[..], &["--out", out], more].concat()
    }
    done(&with(&out, &[]));
    let before = fs::read(&out).expect("a table");
    for (more, part) in [
        (&["--set", "r=0.2"][..], "r is 0.2 here and"),
        (
            &["--near", "0.1"],
            "the mode of the rows is nearest to 0.1,0 here and leading there",
        ),
        (&["-M", "60"], "M is 60 here and 50 there"),
    ] {
        let answer = refused(&with(&out, more), &out);
        assert!(answer.err.contains(part), "{}", answer.err);
        assert!(answer.err.len() < 600, "{}", answer.err);
    }
    let other = [
        "sweep",
        "swift_hohenberg",
        "--over",
        "k=0.9:1.2:5",
        "--out",
        &out,
    ];
    assert!(
        refused(&other, &out)
            .err
            .contains("the axis k is 5 values from 0.9 to 1.2")
    );
    assert_eq!(fs::read(&out).expect("a table"), before);
    done(&with(&out, &[]));
    // A journal of another sweep holds finished rows: it is named, and kept.
    let journal = folder.path("table.csv.journal");
    fs::remove_file(&out).expect("removed");
    let text = fs::read_to_string(format!("{out}-metadata.json")).expect("a description");
    let described: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let mut sweep = described["landau:sweep"].clone();
    // Hashes of the sources of the solver and of the generator.
    let build = sweep["build"].as_str().expect("a build");
    let hashes: Vec<&str> = build.split('-').collect();
    let is_hash = |hash: &&str| hash.len() == 16 && u64::from_str_radix(hash, 16).is_ok();
    assert!(hashes.len() == 2 && hashes.iter().all(is_hash), "{build}");
    sweep["build"] = "another".into();
    let line = serde_json::json!({"landau_journal": 2, "sweep": sweep}).to_string() + "\n";
    fs::write(&journal, &line).expect("written");
    let answer = refused(&with(&out, &[]), &journal);
    assert!(
        answer.err.contains("the build of Landau is"),
        "{}",
        answer.err
    );
    assert_eq!(fs::read_to_string(&journal).expect("there"), line);
}

/// Nothing is written through a link that the user did not name, whatever is allowed.
#[test]
fn links_lead_nowhere() {
    let folder = Folder::new();
    let out = folder.path("table.csv");
    for name in [
        "table.csv.journal",
        "table.csv-metadata.json",
        "table.csv.slurm.sh",
    ] {
        folder.foreign("diary");
        symlink(folder.path("diary"), folder.path(name)).expect("a link");
        for force in [&[][..], &["--force"]] {
            let mut line = [&SWEEP[..], &["--out", &out], force].concat();
            if name.ends_with(".sh") {
                line.extend(["--emit", "slurm"]);
            }
            refused(&line, name);
        }
        assert!(folder.is_mine("diary"));
        fs::remove_file(folder.path(name)).expect("removed");
    }
    // One name for two files, and a folder for a file.
    let svg = folder.path("a.svg");
    refused(
        &["base", "rayleigh_benard", "--plot", &svg, "--out", &svg],
        "a.svg",
    );
    let drawn = [&SWEEP[..], &["--out", &svg, "--plot", &svg]].concat();
    assert!(refused(&drawn, "a.svg").err.contains("twice"));
    let share = folder.path("share");
    done(&[&SWEEP[..], &["--out", &share, "--shard", "1/1"]].concat());
    let before = fs::read(&share).expect("a share");
    refused(&["merge", &share, "--out", &share, "--force"], "share");
    let way_round = folder.path("./share");
    refused(&["merge", &share, "--out", &way_round, "--force"], "share");
    assert_eq!(fs::read(&share).expect("a share"), before);
    fs::create_dir(folder.path("a.npz")).expect("a folder");
    let answer = refused(
        &["base", "rayleigh_benard", "--out", &folder.path("a.npz")],
        "a.npz",
    );
    assert!(answer.err.contains("folder"), "{}", answer.err);
}

/// What is replaced keeps its permissions; what is said of `auto` is `auto`.
#[test]
fn modes_and_descriptions() {
    let folder = Folder::new();
    let out = folder.path("table.csv");
    let line = [
        "sweep",
        "vibrated_bed",
        "-M",
        "16",
        "--over",
        "k=0.1:0.12:2",
        "--set",
        "H=auto",
        "--out",
        &out,
    ];
    done(&line);
    for name in ["table.csv", "table.csv-metadata.json"] {
        let private = fs::Permissions::from_mode(0o600);
        fs::set_permissions(folder.path(name), private).expect("set");
    }
    done(&line);
    for name in ["table.csv", "table.csv-metadata.json"] {
        let info = fs::metadata(folder.path(name)).expect("there");
        assert_eq!(info.permissions().mode() & 0o777, 0o600, "{name}");
    }
    let text = fs::read_to_string(format!("{out}-metadata.json")).expect("a description");
    let described: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let parameters = described["landau:parameters"].as_str().expect("parameters");
    assert!(parameters.split(' ').any(|p| p == "H=auto"), "{parameters}");
    assert_eq!(described["landau:sweep"]["parameters"]["H"], "auto");
}

/// Options that a script's tasks could not obey are refused at once.
#[test]
fn options_of_scripts() {
    let folder = Folder::new();
    let (out, plot) = (folder.path("a.csv"), folder.path("a.svg"));
    for more in [
        &["--emit", "slurm", "--plot", &plot][..],
        &["--emit", "hq", "--plot", &plot],
        &["--emit", "slurm", "--shard", "1/2"],
        &["--shard", "1/2", "--plot", &plot],
        &["--tasks", "3"],
        &["--cpus", "3"],
        &["--emit", "slurm", "--tasks", "0"],
        &["--emit", "slurm", "--tasks", "1000000"],
        &["--emit", "hq", "--cpus", "0"],
    ] {
        let answer = landau(&[&SWEEP[..], &["--out", &out], more].concat());
        assert_eq!(answer.status, 2, "{more:?}: {}", answer.err);
    }
    assert_eq!(fs::read_dir(folder.0.path()).expect("listed").count(), 0);
    let answer = done(&[&SWEEP[..], &["--out", &out, "--emit", "slurm", "--json"]].concat());
    let said: serde_json::Value = serde_json::from_str(&answer.out).expect("JSON");
    assert_eq!(said["start"], format!("bash {out}.slurm.sh"));
}

/// A program and a table whose names hold what a shell would expand: the script runs, by a stand-in for `sbatch`, and
/// expands nothing.
#[test]
fn names_in_scripts_are_names() {
    let folder = Folder::new();
    let hostile = "a $(touch pwned) `touch pwned` \"x\" 'y' \\ é\u{1} *";
    let home = PathBuf::from(folder.path(hostile));
    fs::create_dir(&home).expect("a folder");
    let program = home.join("landau");
    fs::copy(env!("CARGO_BIN_EXE_landau-under-test"), &program).expect("copied");
    let out = home.join("a table.csv");
    let run = |engine: &str| {
        Command::new(&program)
            .args(SWEEP)
            .args(["--emit", engine, "--tasks", "2", "--out"])
            .arg(&out)
            .current_dir(folder.0.path())
            .output()
            .expect("it runs")
    };
    assert!(run("slurm").status.success() && run("hq").status.success());
    // `sbatch` runs what it is given: the tasks of an array one after another.
    let stand_in = "#!/bin/bash
array=0
while [[ \"$1\" == --* ]]; do
    if [[ \"$1\" == --array=1-* ]]; then array=${1#--array=1-}; fi
    if [[ \"$1\" == --wrap ]]; then exec sh -c \"$2\"; fi
    shift
done
for ((id = 1; id <= array; id++)); do
    SLURM_ARRAY_TASK_ID=$id SLURM_ARRAY_TASK_COUNT=$array SLURM_ARRAY_TASK_MIN=1 bash \"$@\" >&2
done
if [ $array = 0 ]; then bash \"$@\" >&2; fi
echo 7
";
    let tools = folder.0.path().join("tools");
    fs::create_dir(&tools).expect("a folder");
    fs::write(tools.join("sbatch"), stand_in).expect("written");
    fs::set_permissions(tools.join("sbatch"), fs::Permissions::from_mode(0o755)).expect("set");
    let started = Command::new("bash")
        .arg(home.join("a table.csv.slurm.sh"))
        .env(
            "PATH",
            format!(
                "{}:{}",
                tools.display(),
                std::env::var("PATH").unwrap_or_default()
            ),
        )
        .current_dir(folder.0.path())
        .output()
        .expect("it runs");
    assert!(
        started.status.success(),
        "{}",
        String::from_utf8_lossy(&started.stderr)
    );
    assert!(!folder.0.path().join("pwned").exists() && !root().join("pwned").exists());
    let plain = folder.path("plain.csv");
    done(&[&SWEEP[..], &["--out", &plain]].concat());
    assert_eq!(
        fs::read(&out).expect("merged"),
        fs::read(&plain).expect("a table")
    );
    // The job file is TOML, and holds the names as they are.
    let text = fs::read_to_string(home.join("a table.csv.hq.toml")).expect("a job file");
    let job: toml::Table = text.parse().expect("TOML");
    let command = job["task"][0]["command"].as_array().expect("a command");
    assert_eq!(command[0].as_str().map(Path::new), Some(program.as_path()));
    assert_eq!(
        job["task"][0]["request"][0]["resources"]["cpus"].as_str(),
        Some("4")
    );
    assert_eq!(job["task"][2]["deps"].as_array().map(Vec::len), Some(2));
}

/// Names that are no text work, or are refused in a sentence.
#[test]
fn names_that_are_not_utf8() {
    let folder = Folder::new();
    let name = |bytes: &[u8]| folder.0.path().join(std::ffi::OsStr::from_bytes(bytes));
    let out = name(b"t\xffable.csv");
    let run = |line: &[&str], out: &Path| {
        let output = Command::new(env!("CARGO_BIN_EXE_landau-under-test"))
            .args(line)
            .arg("--out")
            .arg(out)
            .current_dir(root())
            .output()
            .expect("it runs");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!said.contains("panic"), "{line:?}: {said}");
        (output.status.code(), said)
    };
    assert_eq!(run(&SWEEP, &out).0, Some(0));
    assert!(name(b"t\xffable.csv-metadata.json").is_file());
    assert_eq!(run(&SWEEP, &out).0, Some(0));
    let slurm = [&SWEEP[..], &["--emit", "slurm"]].concat();
    assert_eq!(run(&slurm, &out).0, Some(0));
    assert!(name(b"t\xffable.csv.slurm.sh").is_file());
    let (status, said) = run(&[&SWEEP[..], &["--emit", "hq"]].concat(), &out);
    assert!(status == Some(2) && said.contains("UTF-8"), "{said}");
    let study = folder.path("study.toml");
    fs::write(
        &study,
        "title = \"t\"\nmodel = \"swift_hohenberg\"\nresolution = 8\n",
    )
    .expect("written");
    let (status, said) = run(&["reproduce", &study], &name(b"r\xffeport"));
    assert!(matches!(status, Some(0 | 2)), "{said}");
}

/// What a command reads is not replaced, under any name, whatever is allowed.
#[test]
fn inputs_are_not_replaced() {
    let folder = Folder::new();
    let text = fs::read(root().join("spec/models/swift_hohenberg.model")).expect("a spec");
    fs::create_dir(folder.path("laws")).expect("made");
    let law = "fn square(x) = x^2;\n";
    let [table, picture] = ["my.csv-metadata.json", "my.svg"].map(|name| folder.path(name));
    let link = folder.path("link.svg");
    symlink(&picture, &link).expect("a link");
    let rule = folder.path("laws/square.law");
    fs::write(&rule, law).expect("written");
    for model in [&table, &picture] {
        fs::write(model, &text).expect("written");
    }
    let out = folder.path("my.csv");
    let range = ["--over", "k=0.9:1.1:3"];
    let onset = ["--vary", "r", "--from", "-0.1", "--to", "0.1", "--k", "1"];
    for (line, file) in [
        (
            [&["sweep", &picture, "--out", &picture][..], &range].concat(),
            &picture,
        ),
        (
            [&["sweep", &picture, "--out", &link][..], &range].concat(),
            &link,
        ),
        (
            [&["sweep", &picture, "--out", &rule][..], &range].concat(),
            &rule,
        ),
        (
            [&["sweep", &table, "--out", &out][..], &range].concat(),
            &table,
        ),
        (
            [
                &["sweep", &picture, "--out", &out, "--plot", &link][..],
                &range,
            ]
            .concat(),
            &link,
        ),
        (vec!["base", &picture, "--plot", &link], &link),
        (
            vec!["point", &picture, "--k", "1", "--plot", &picture],
            &picture,
        ),
        (vec!["pattern", &picture, "--k", "1", "--out", &link], &link),
        (
            [&["critical", &picture, "--plot", &link][..], &onset].concat(),
            &link,
        ),
    ] {
        let line = [&line[..], &["--force"]].concat();
        let answer = landau(&line);
        assert_eq!(answer.status, 2, "{line:?}: {}", answer.err);
        let words =
            "is what the command reads, and is not replaced: choose another name for the result";
        assert_eq!(answer.err, format!("error: {file} {words}\n"), "{line:?}");
        for model in [&table, &picture] {
            assert_eq!(fs::read(model).expect("there"), text, "{line:?}");
        }
        assert_eq!(fs::read_to_string(&rule).expect("there"), law);
    }
}
