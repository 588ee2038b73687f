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
