//! What must never be: numerics that know of plots, the command line or the generator; a generator or a solver that
//! knows a model; files that nobody reads to the end.

use crate::support::root;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The crates that a package needs to be built, itself left out.
fn needs(package: &str) -> Vec<String> {
    let output = Command::new(env!("CARGO"))
        .args([
            "tree",
            "-p",
            package,
            "-e",
            "normal",
            "--prefix",
            "none",
            "--offline",
        ])
        .current_dir(root())
        .output()
        .expect("cargo runs");
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let names = text.lines().filter_map(|line| line.split(' ').next());
    let mut names: Vec<String> = names.skip(1).map(str::to_owned).collect();
    names.sort();
    names.dedup();
    names
}

#[test]
fn crates_know_what_is_below_them() {
    let above = |names: &[&str], package: &str| {
        let needed = needs(package);
        for name in names {
            assert!(
                !needed.iter().any(|n| n == name),
                "{package} needs {name}: {needed:?}"
            );
        }
    };
    let surface = [
        "clap",
        "indicatif",
        "kuva",
        "maud",
        "landau-cli",
        "landau-report",
        "landau-codegen",
    ];
    above(&surface, "landau-solver");
    above(&surface, "landau-contract");
    above(
        &["syn", "quote", "faer", "landau-solver"],
        "landau-contract",
    );
    above(&["faer", "landau-solver", "clap"], "landau-codegen");
    above(&["clap", "landau-cli"], "landau-report");
}

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
}

fn all(folders: &[&str]) -> Vec<(PathBuf, String)> {
    let mut found = Vec::new();
    for folder in folders {
        sources(&root().join(folder), &mut found);
    }
    let read = |path: PathBuf| {
        let text = std::fs::read_to_string(&path).expect("a source");
        (path, text)
    };
    found.into_iter().map(read).collect()
}

#[test]
fn no_model_is_known_outside_specs_and_tests() {
    // Names, and the words in them that belong to no other science.
    let models = landau_spec::models();
    let words = [
        "granular",
        "bed",
        "poiseuille",
        "couette",
        "brusselator",
        "hohenberg",
        "sivashinsky",
        "benard",
    ];
    let names: Vec<&str> = models.iter().map(|m| m.structure().name.as_str()).collect();
    for (path, text) in all(&["codegen", "solver"]) {
        for name in &names {
            assert!(!text.contains(name), "{} names {name}", path.display());
        }
        let text = text.to_lowercase();
        let known = text
            .split(|c: char| !c.is_alphabetic())
            .find(|word| words.contains(word));
        assert_eq!(known, None, "{}", path.display());
    }
}

#[test]
fn files_are_read_to_the_end() {
    for (path, text) in all(&["codegen", "solver", "spec/src", "tests"]) {
        let lines = text.lines().count();
        assert!(lines <= 500, "{} has {lines} lines", path.display());
    }
}

/// The table of the generator's stages stands once: the crate's documentation includes it, ARCHITECTURE.md repeats it.
#[test]
fn the_stages_are_said_once() {
    let read = |path: &str| std::fs::read_to_string(crate::support::root().join(path)).expect(path);
    let (stages, whole) = (read("codegen/STAGES.md"), read("ARCHITECTURE.md"));
    assert!(
        whole.contains(stages.trim()),
        "ARCHITECTURE.md does not hold codegen/STAGES.md"
    );
}
