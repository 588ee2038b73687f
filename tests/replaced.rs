//! What a report replaces: files that it wrote and nobody changed.

use crate::reports::{Desk, SWEEP, files, study};
use crate::support::{landau, root};
use std::fs::{self, Permissions};
use std::os::unix::fs::{MetadataExt, PermissionsExt};
use std::os::unix::process::CommandExt;
use std::process::Command;

/// A file of a report that was edited by hand, or one of somebody else under the name of one, is replaced with --force
/// alone, and is told of before anything is computed.
#[test]
fn edited_files_of_a_report_are_not_replaced() {
    let desk = Desk::new();
    let report = desk.path("report");
    assert_eq!(desk.reproduce(&study(SWEEP)).status, 0);
    assert_eq!(desk.again(&report).status, 0);
    fs::write(report.join("notes.txt"), "mine").expect("written");
    for name in [
        "index.html",
        "numbers.json",
        "figure1-1.svg",
        "figure1-1.csv",
        "figure9-1.svg",
        "sources/study.toml",
    ] {
        let path = report.join(name);
        let mut edited = fs::read(&path).unwrap_or_default();
        edited.extend(b"<!-- my remark -->");
        fs::write(&path, &edited).expect("written");
        let before = files(&report);
        let answer = desk.again(&report);
        assert_eq!(answer.status, 2, "{name}: {} {}", answer.out, answer.err);
        let words = format!(
            "{} exists and is not replaced: this report did not write it, or it was changed since. Remove it, choose \
             another name, or give --force",
            path.display()
        );
        assert!(answer.err.contains(&words), "{words}: {}", answer.err);
        assert!(files(&report) == before, "{name}");
        let study = desk.path("study.toml").to_string_lossy().into_owned();
        let out = report.to_string_lossy().into_owned();
        let forced = landau(&["reproduce", &study, "--out", &out, "--force"]);
        assert_eq!(forced.status, 0, "{name}: {}", forced.err);
        if name == "figure9-1.svg" {
            // Nothing replaces it: this study has no such figure.
            assert_eq!(fs::read(&path).expect("read"), edited);
            fs::remove_file(&path).expect("removed");
        } else {
            assert_ne!(fs::read(&path).expect("read"), edited, "{name}");
        }
        assert_eq!(desk.again(&report).status, 0, "{name}");
    }
    assert_eq!(desk.read("report/notes.txt"), "mine");
}

/// A kept task that cannot be read is named, computed again and left as it is; another file in its folder is named.
#[test]
fn an_unreadable_kept_task_is_computed_again() {
    let desk = Desk::new();
    assert_eq!(desk.reproduce(&study(SWEEP)).status, 0);
    let (table, kept) = (
        desk.read("report/figure1-1.csv"),
        desk.path("report.kept/1-1.json"),
    );
    let run = || {
        let paths = ["study.toml", "report"].map(|name| desk.path(name));
        let mut command = Command::new(env!("CARGO_BIN_EXE_landau-under-test"));
        command.args(["reproduce".as_ref(), paths[0].as_os_str(), "--out".as_ref()]);
        command.arg(&paths[1]).current_dir(root());
        // Root reads everything: as nobody, then.
        let owner = fs::metadata("/proc/self").map(|info| info.uid());
        if owner.is_ok_and(|owner| owner == 0) {
            command.uid(65534);
        }
        command.output().expect("it runs")
    };
    for folder in ["", "report", "report.kept"] {
        fs::set_permissions(desk.path(folder), Permissions::from_mode(0o777)).expect("set");
    }
    fs::set_permissions(&kept, Permissions::from_mode(0o000)).expect("set");
    for is_marked in [true, false] {
        if !is_marked {
            fs::remove_dir_all(desk.path("report")).expect("removed");
        } else {
            for (path, _) in files(&desk.path("report")) {
                fs::set_permissions(path, Permissions::from_mode(0o666)).expect("set");
            }
            let sources = desk.path("report/sources");
            fs::set_permissions(sources, Permissions::from_mode(0o777)).expect("set");
        }
        let output = run();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{said}");
        let words = format!("note: {} cannot be read: Permission denied", kept.display());
        assert!(said.contains(&words), "{words}: {said}");
        assert_eq!(desk.read("report/figure1-1.csv"), table);
        let mode = fs::metadata(&kept).expect("there").permissions().mode();
        assert_eq!(mode & 0o777, 0);
    }
    fs::remove_dir_all(desk.path("report")).expect("removed");
    fs::write(desk.path("report.kept/notes.txt"), "mine").expect("written");
    let answer = desk.again(&desk.path("report"));
    assert_eq!(answer.status, 2, "{}", answer.err);
    assert!(answer.err.contains("notes.txt is none"), "{}", answer.err);
}

/// What a killed run left half written, in any folder of a report, is gone after the next run.
#[test]
fn files_that_killed_runs_left_are_removed() {
    let desk = Desk::new();
    assert_eq!(desk.reproduce(&study(SWEEP)).status, 0);
    let left = ["report", "report/sources", "report.kept"];
    let left = left.map(|folder| desk.path(folder).join(".landau-Eq9NGl"));
    for forced in [false, true] {
        for path in &left {
            fs::write(path, "half").expect("written");
        }
        let paths = ["study.toml", "report"].map(|name| desk.path(name).display().to_string());
        let mut line = vec!["reproduce", &paths[0], "--out", &paths[1]];
        if forced {
            line.push("--force");
        }
        let answer = landau(&line);
        assert_eq!(answer.status, 0, "{}", answer.err);
        for path in &left {
            assert!(!path.exists(), "{}", path.display());
        }
        assert!(desk.path("report/.landau-report").is_file());
    }
    // The folder of a table, of a share, of what they make, of a picture.
    let left = desk.path(".landau-Eq9NGl");
    let path = |name: &str| desk.path(name).display().to_string();
    let (table, share, merged, picture) =
        (path("t.csv"), path("share"), path("m.csv"), path("a.svg"));
    let sweep = ["sweep", "swift_hohenberg", "--over", "k=1:1.1:2", "--out"];
    for line in [
        [&sweep[..], &[&table]].concat(),
        [&sweep[..], &[&share, "--shard", "1/1"]].concat(),
        vec!["merge", &share, "--out", &merged],
        vec!["spectrum", "rayleigh_benard", "--plot", &picture],
    ] {
        fs::write(&left, "half").expect("written");
        let answer = landau(&line);
        assert_eq!(answer.status, 0, "{line:?}: {}", answer.err);
        assert!(!left.exists(), "{line:?}");
    }
}

/// A file of somebody else in the place of a kept task is named and stays, whether there is a report or not.
#[test]
fn notes_in_the_place_of_a_kept_task_stay() {
    let desk = Desk::new();
    assert_eq!(desk.reproduce(&study(SWEEP)).status, 0);
    let kept = desk.path("report.kept/1-1.json");
    for text in ["my notes", "{}"] {
        fs::write(&kept, text).expect("written");
        let answer = desk.again(&desk.path("report"));
        assert_eq!(answer.status, 2, "{}", answer.err);
        let words = format!(
            "error: {} exists and is not replaced: it is no finished task of a report. Remove it, choose another name, or \
             give --force\n",
            kept.display()
        );
        assert_eq!(answer.err, words);
        assert_eq!(desk.read("report.kept/1-1.json"), text);
    }
}

/// A study in the place where its report would write is refused, even with `--force`.
#[test]
fn a_report_does_not_replace_what_it_is_made_from() {
    let desk = Desk::new();
    let reference = "reference = [{ file = \"report/figure1-1.csv\", label = \"others\" }]\n";
    let text = study(&SWEEP.replace(
        "[[figure.task.case]]",
        &format!("{reference}[[figure.task.case]]"),
    ));
    assert_eq!(desk.reproduce(&study(SWEEP)).status, 0);
    fs::write(desk.path("report/figure1-1.csv"), "k,a0\n0.9,0.1\n").expect("written");
    fs::write(desk.path("study.toml"), text).expect("written");
    let paths = ["study.toml", "report"].map(|name| desk.path(name).display().to_string());
    let answer = landau(&["reproduce", &paths[0], "--out", &paths[1], "--force"]);
    assert_eq!(answer.status, 2, "{}", answer.err);
    let words = "report/figure1-1.csv is what the report is made from, and the report would replace it: choose another --out";
    assert!(answer.err.contains(words), "{}", answer.err);
    assert_eq!(desk.read("report/figure1-1.csv"), "k,a0\n0.9,0.1\n");
}
