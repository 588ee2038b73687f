//! Golden text: the derived operators of every model, so that a change of the physics shows in a
//! diff. These files are golden, our own output read over once, not a source of truth.
//! `UPDATE_GOLDEN=1 cargo test golden` writes them anew.

use crate::support::root;
use landau_codegen::build::{generate_module, read_sources};
use landau_codegen::emit::text;
use landau_codegen::generate;
use std::fs;

#[test]
fn operators() {
    let mut compared = 0;
    for entry in fs::read_dir(root().join("spec/models")).expect("models") {
        let path = entry.expect("an entry").path();
        let sources = read_sources(&path).expect("the spec can be read");
        let (derivation, _) = generate(&sources).unwrap_or_else(|e| panic!("{e}"));
        let folder = root().join("tests/golden").join(&derivation.model.name);
        for section in text::sections(&derivation) {
            let name = format!("{section:?}.txt")
                .to_lowercase()
                .replace(['(', ')'], "");
            let found = text::print(&derivation, section);
            let file = folder.join(name);
            if std::env::var_os("UPDATE_GOLDEN").is_some() {
                fs::create_dir_all(&folder).expect("a folder");
                fs::write(&file, &found).expect("a file");
            }
            let golden =
                fs::read_to_string(&file).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
            assert_eq!(
                found,
                golden,
                "{} differs; see the head of golden.rs",
                file.display()
            );
            compared += 1;
        }
    }
    assert!(compared >= 55, "only {compared} operators were compared");
}

/// Generated code is the same to the byte on every run.
#[test]
fn emission_is_deterministic() {
    for name in ["vibrated_bed", "rayleigh_benard", "plane_poiseuille_flux"] {
        let path = root().join(format!("spec/models/{name}.model"));
        let once = || {
            let sources = read_sources(&path).expect("the spec can be read");
            generate_module(sources).unwrap_or_else(|e| panic!("{e}")).2
        };
        assert_eq!(once(), once(), "{name}");
    }
}

/// P (3.11) and P (6.6), letter by letter; and no set of conditions for P (6.4) and P (6.5).
#[test]
fn adjoint_conditions_of_the_paper() {
    let printed = crate::support::landau(&["explain", "vibrated_bed", "--operator", "adjoint"]).out;
    let cases: Vec<&str> = printed.split("-- top = ").skip(1).collect();
    let lines = |case: &str| -> Vec<String> {
        case.lines()
            .skip(1)
            .map(|l| l.trim().to_owned())
            .filter(|l| !l.is_empty())
            .collect()
    };
    let bottom = [
        "at y = 0: u†_y - n⁰_y/n⁰ u† = 0",
        "at y = 0: v† = 0",
        "at y = 0: T† = 0",
    ];
    let top = ["at y = H: u† = 0", "at y = H: v† = 0", "at y = H: T† = 0"];
    assert_eq!(lines(cases[0]), [bottom, top].concat());
    let top = [
        "at y = H: u† = 0",
        "at y = H: v† = 0",
        "at y = H: T†_y - n⁰_y/n⁰ T† = 0",
    ];
    assert_eq!(lines(cases[1]), [bottom, top].concat());
    for case in &cases[2..] {
        assert!(
            case.contains("no adjoint boundary conditions independent of the eigenvalue exist"),
            "{case}"
        );
        assert!(
            case.contains("v' is free and asks for a condition on n†"),
            "{case}"
        );
    }
}

/// Emitted code names the balance of each block of lines, has no silent zero for what a model lacks, and can be read in
/// a folder of the user's choice.
#[test]
fn emitted_code_can_be_read() {
    let path = root().join("spec/models/rayleigh_benard.model");
    let sources = read_sources(&path).expect("the spec can be read");
    let (_, _, code) = generate_module(sources).unwrap_or_else(|e| panic!("{e}"));
    let linear = code
        .split("fn linear_coefficients")
        .nth(1)
        .expect("the kernel of L");
    let linear = linear.split("\n}").next().expect("its body");
    for balance in ["momentum_x", "momentum_z", "continuity", "heat"] {
        let comment = format!("    // the balance `{balance}`\n");
        assert!(linear.contains(&comment), "{comment} is not in {linear}");
    }
    assert!(!code.contains("landau_comment"), "a comment is left over");
    assert!(!code.contains("_ => C64") && !code.contains("_ => out"));
    assert!(code.contains("absent => panic!"));
    let crate_folder = tempfile::tempdir().expect("a folder");
    let models = crate_folder.path().join("models");
    fs::create_dir(&models).expect("a folder");
    fs::copy(&path, models.join("rayleigh_benard.model")).expect("a copy");
    let readable = crate_folder.path().join("to/read");
    landau_codegen::build::generate_readable(crate_folder.path(), &readable).expect("the code");
    let written = fs::read_to_string(readable.join("rayleigh_benard.rs")).expect("the module");
    assert!(written.contains("fn linear_coefficients"));
}
