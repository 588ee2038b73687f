//! A sweep in shares: merged they are the file that one machine writes, and nothing else passes for that.

use crate::support::{Answer, landau, root};
use std::fs;
use std::path::Path;
use std::process::Command;

const SWEEP: [&str; 8] = [
    "sweep",
    "swift_hohenberg",
    "--over",
    "k=0.8:1.2:101",
    "--over",
    "r=0.1:0.3:3",
    "--set",
    "b=0.5",
];

fn with(more: &[&str]) -> Answer {
    landau(&[&SWEEP, more].concat())
}

fn path(folder: &Path, name: &str) -> String {
    folder.join(name).display().to_string()
}

/// All shares of `count`, and their files.
fn shares(folder: &Path, count: usize) -> Vec<String> {
    let share = |index: usize| {
        let file = path(folder, &format!("part-{index}-of-{count}"));
        let answer = with(&["--shard", &format!("{index}/{count}"), "--out", &file]);
        assert_eq!(answer.status, 0, "{}", answer.err);
        file
    };
    (1..=count).map(share).collect()
}

fn merge(files: &[String], out: &str) -> Answer {
    let files = files.iter().map(String::as_str);
    let arguments: Vec<&str> = ["merge"]
        .into_iter()
        .chain(files)
        .chain(["--out", out])
        .collect();
    landau(&arguments)
}

#[test]
fn shares_merged_are_the_whole() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let whole = path(folder, "whole.csv");
    assert_eq!(with(&["--out", &whole]).status, 0);
    let described = |table: &str| {
        let text = fs::read_to_string(format!("{table}-metadata.json")).expect("a description");
        let mut described: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        let url = described["url"].take();
        // It counts the name of the table too.
        described["landau:seal"].take();
        assert_eq!(
            url.as_str(),
            Path::new(table).file_name().and_then(|n| n.to_str())
        );
        described
    };
    let about = described(&whole);
    assert_eq!(about["tableSchema"]["columns"][2]["titles"], "c0_re");
    assert!(about["landau:model_hash"].is_string() && about["landau:resolution"].is_number());
    let whole = fs::read(whole).expect("a table");
    // Nine chunks in fewer shares, as many, and more.
    for count in [1, 4, 9, 12] {
        let mut files = shares(folder, count);
        files.reverse();
        let out = path(folder, &format!("merged-{count}.csv"));
        let answer = merge(&files, &out);
        assert_eq!(answer.status, 0, "{}", answer.err);
        assert!(fs::read(&out).expect("a table") == whole, "{count} shares");
        assert_eq!(described(&out), about);
        // Once more, to the same file.
        assert_eq!(merge(&files, &out).status, 0);
    }
    // A share that is done is left as it is.
    let file = folder.join("part-2-of-4");
    let before = fs::metadata(&file)
        .and_then(|m| m.modified())
        .expect("a share");
    let again = with(&["--shard", "2/4", "--out", file.to_str().expect("a path")]);
    assert_eq!(again.status, 0, "{}", again.err);
    assert_eq!(
        fs::metadata(&file)
            .and_then(|m| m.modified())
            .expect("a share"),
        before
    );
    assert!(!folder.join("part-2-of-4.journal").exists());
}

#[test]
fn what_is_no_whole_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let files = shares(folder, 3);
    let out = path(folder, "out.csv");
    let refused = |files: &[String], text: &str| {
        let answer = merge(files, &out);
        assert_eq!(answer.status, 2, "{text}: {}", answer.err);
        assert!(answer.err.contains(text), "{text}: {}", answer.err);
        assert!(!Path::new(&out).exists());
    };
    refused(&files[..2], "missing is 3/3");
    let twice = [&files[..], &files[1..2]].concat();
    refused(&twice, "overlap");
    let other = path(folder, "other");
    let changed = SWEEP.map(|word| if word == "b=0.5" { "b=0.6" } else { word });
    let answer = landau(&[&changed[..], &["--shard", "2/3", "--out", &other]].concat());
    assert_eq!(answer.status, 0, "{}", answer.err);
    let mixed = [files[0].clone(), other.clone(), files[2].clone()];
    refused(&mixed, "b is 0.5 here and 0.6 there");
    let line = merge(&mixed, &out).err;
    assert!(
        line.len() < 1000 && line.trim().lines().count() == 1,
        "{line}"
    );
    let text = fs::read_to_string(&files[1]).expect("a share");
    fs::write(&files[1], text.replacen("0.8", "0.9", 1)).expect("written");
    refused(&files, "is damaged");
    fs::write(&files[1], "k,r\n").expect("written");
    refused(&files, "no share of a sweep");
    // Nor is a file overwritten that is something else.
    let answer = with(&["--shard", "2/3", "--out", &files[1]]);
    assert_eq!(answer.status, 2, "{}", answer.err);
    let answer = with(&["--shard", "4/3", "--out", &out]);
    assert!(
        answer.status == 2 && answer.err.contains("I/N"),
        "{}",
        answer.err
    );
    let answer = with(&["--shard", "slurm", "--out", &out]);
    assert!(answer.err.contains("SLURM_ARRAY_TASK_ID"), "{}", answer.err);
    let answer = with(&["--shard", "1/1000000000000", "--out", &out]);
    assert!(
        answer.status == 2 && answer.err.contains("100000"),
        "{}",
        answer.err
    );
}

/// A job array's task finds its share in the environment; the scripts are well formed and say how to start them.
#[test]
fn scripts_for_clusters() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let out = path(folder, "it's an atlas.csv");
    let answer = with(&[
        "--out", &out, "--emit", "slurm", "--tasks", "3", "--cpus", "2",
    ]);
    assert_eq!(answer.status, 0, "{}", answer.err);
    assert!(answer.out.starts_with("bash "), "{}", answer.out);
    let script = format!("{out}.slurm.sh");
    let checked = Command::new("bash")
        .args(["-n", &script])
        .output()
        .expect("bash");
    assert!(
        checked.status.success(),
        "{}",
        String::from_utf8_lossy(&checked.stderr)
    );
    // Its tasks, as Slurm would start them.
    for id in 1..=3 {
        let task = Command::new("bash")
            .arg(&script)
            .env("SLURM_ARRAY_TASK_ID", id.to_string())
            .env("SLURM_ARRAY_TASK_COUNT", "3")
            .env("SLURM_ARRAY_TASK_MIN", "1")
            .current_dir(root())
            .output()
            .expect("bash");
        assert!(
            task.status.success(),
            "{}",
            String::from_utf8_lossy(&task.stderr)
        );
    }
    let files: Vec<String> = (1..=3).map(|id| format!("{out}.shard-{id}")).collect();
    assert_eq!(merge(&files, &out).status, 0);
    let whole = path(folder, "whole.csv");
    assert_eq!(with(&["--out", &whole]).status, 0);
    assert!(fs::read(&whole).expect("a table") == fs::read(&out).expect("a table"));

    let answer = with(&["--out", &whole, "--emit", "hq", "--tasks", "2"]);
    assert!(
        answer.out.starts_with("hq job submit-file "),
        "{}",
        answer.out
    );
    let job: toml::Table = fs::read_to_string(format!("{whole}.hq.toml"))
        .expect("a job file")
        .parse()
        .expect("TOML");
    let tasks = job["task"].as_array().expect("tasks");
    assert_eq!(tasks.len(), 3);
    assert_eq!(tasks[2]["deps"].as_array().expect("dependencies").len(), 2);
}
