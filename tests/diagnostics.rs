//! Broken specs: each `diagnostics/*.model` with the expected text beside it (golden: our own
//! output, read over once; `UPDATE_GOLDEN=1` writes it anew). Adding a case is adding a file.

use crate::support::{landau, root};
use std::fs;
use std::path::Path;

fn cases() -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(root().join("tests/diagnostics"))
        .expect("the folder")
        .filter_map(|e| e.ok().map(|e| e.path()))
        .filter(|p| p.extension().is_some_and(|e| e == "model"))
        .filter_map(|p| p.file_stem().map(|s| s.to_string_lossy().into_owned()))
        .collect();
    names.sort();
    names
}

#[test]
fn check_says_what_is_wrong() {
    let names = cases();
    assert!(names.len() >= 40, "{} broken specs", names.len());
    for name in names {
        let spec = format!("tests/diagnostics/{name}.model");
        let answer = landau(&["check", &spec]);
        assert_eq!(answer.status, 2, "{name} passed: {}", answer.out);
        let file = root().join("tests/diagnostics").join(format!("{name}.txt"));
        if std::env::var_os("UPDATE_GOLDEN").is_some() {
            fs::write(&file, &answer.err).expect("a file");
        }
        let expected = fs::read_to_string(&file).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(answer.err, expected, "{name}");
        // file:line:column of the spec or of a law file, the source line, a caret below it.
        let place = answer
            .err
            .lines()
            .find_map(|line| line.trim_start().strip_prefix("--> "))
            .unwrap_or_else(|| panic!("{name}: no place in {}", answer.err));
        let parts: Vec<&str> = place.split(':').collect();
        let whole = |text: &str| text.parse::<usize>().is_ok_and(|n| n > 0);
        assert!(
            parts.len() == 3 && whole(parts[1]) && whole(parts[2]),
            "{name}: {place}"
        );
        assert!(
            parts[0] == spec || parts[0].ends_with(".law"),
            "{name}: {place}"
        );
        let caret = |line: &str| line.contains('|') && line.contains('^');
        assert!(answer.err.lines().any(caret), "{name}: {}", answer.err);
    }
}

/// The build script says the same.
#[test]
fn the_build_script_agrees() {
    for name in [
        "misspelt_field",
        "missing_condition",
        "second_time_derivative",
        "unbalanced_bracket",
        "prime",
    ] {
        let text = fs::read_to_string(root().join(format!("tests/diagnostics/{name}.model")))
            .expect("the spec");
        let crate_folder = tempfile::tempdir().expect("a folder");
        let models = crate_folder.path().join("models");
        fs::create_dir(&models).expect("a folder");
        fs::write(models.join("broken.model"), text).expect("a file");
        let said = landau_codegen::build::generate_folder(crate_folder.path(), crate_folder.path())
            .expect_err("a broken spec");
        let expected = fs::read_to_string(root().join(format!("tests/diagnostics/{name}.txt")))
            .expect("the text");
        let body = |text: &str, file: &str| -> String {
            let start = text.find("error: ").unwrap_or(0);
            text[start..]
                .replace("error: the spec has mistakes", "")
                .replace(file, "FILE")
                .trim()
                .to_owned()
        };
        let own = format!("tests/diagnostics/{name}.model");
        assert_eq!(
            body(&said, "models/broken.model"),
            body(&expected, &own),
            "{name}"
        );
        assert!(
            !Path::new(&crate_folder.path().join("models.rs")).exists(),
            "nothing is written"
        );
    }
}
