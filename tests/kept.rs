//! What a run has computed is kept: runs killed at many moments, their files cut, signals, streams that cannot be written.

use crate::support::{Answer, landau, root, written};
use std::fs;
use std::io::Write;
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

fn program(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_landau-under-test"));
    command
        .args(arguments)
        .current_dir(root())
        .env("RAYON_NUM_THREADS", "2")
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    command
}

const SWEEP: [&str; 8] = [
    "sweep",
    "swift_hohenberg_strip",
    "-M",
    "24",
    "--over",
    "k=0.9:1.1:120",
    "--over",
    "r=1:1.2:6",
];

fn sweep(out: &Path) -> Command {
    let mut command = program(&SWEEP);
    command.arg("--out").arg(out);
    command
}

fn journal(out: &Path) -> PathBuf {
    PathBuf::from(format!("{}.journal", out.display()))
}

/// The lines of a journal that are whole; none where there is no journal.
fn whole_lines(out: &Path) -> Vec<u8> {
    let mut bytes = fs::read(journal(out)).unwrap_or_default();
    let end = bytes.iter().rposition(|b| *b == b'\n').map_or(0, |i| i + 1);
    bytes.truncate(end);
    bytes
}

/// Waits until a journal has more than one line; false where the run ended before.
fn has_begun(child: &mut Child, out: &Path) -> bool {
    let end = Instant::now() + Duration::from_secs(60);
    while Instant::now() < end {
        let lines = whole_lines(out).iter().filter(|b| **b == b'\n').count();
        if lines > 1 {
            return true;
        }
        if child.try_wait().expect("asked").is_some() {
            return false;
        }
        sleep(Duration::from_millis(2));
    }
    false
}

/// A sweep killed again and again, sooner and later after its start: every line of its journal stays as it was, byte for
/// byte, and the table at the end is the one of an undisturbed run.
#[test]
fn a_sweep_killed_at_every_stage() {
    let folder = tempfile::tempdir().expect("a folder");
    let (plain, out) = (
        folder.path().join("plain.csv"),
        folder.path().join("out.csv"),
    );
    let started = Instant::now();
    assert!(sweep(&plain).status().expect("it runs").success());
    let undisturbed = started.elapsed();
    let mut kept = Vec::new();
    for attempt in 0..24 {
        let mut child = sweep(&out).spawn().expect("it runs");
        // From the first moments, in which files are opened, to a third of a whole run.
        sleep(undisturbed.mul_f64(f64::from(attempt % 12) / 36.0));
        child.kill().expect("killed");
        child.wait().expect("it ends");
        let lines = whole_lines(&out);
        if out.exists() {
            break;
        }
        assert!(
            lines.starts_with(&kept),
            "attempt {attempt}: {} bytes, then {}",
            kept.len(),
            lines.len()
        );
        kept = lines;
    }
    assert!(sweep(&out).status().expect("it runs").success());
    assert!(fs::read(&plain).expect("a table") == fs::read(&out).expect("a table"));
    assert!(!journal(&out).exists());
    // Once more, over the table that is there.
    assert!(sweep(&out).status().expect("it runs").success());
}

/// Files of other commands are whole or not there, whenever the command is killed.
#[test]
fn other_files_are_whole_or_not_there() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    let share = path("share");
    let whole = [&SWEEP[..], &["--shard", "1/1", "--out", &share]].concat();
    assert!(program(&whole).status().expect("it runs").success());
    let table = path("merged.csv");
    let files = ["a.svg", "a.png", "a.npz", "a.nc", "a.vtk"].map(path);
    let mut draw = vec![
        "pattern",
        "swift_hohenberg_strip",
        "--set",
        "r=1.2",
        "--amplitude",
        "0.1",
        "-M",
        "16",
    ];
    for file in &files {
        draw.extend(["--out", file]);
    }
    let merge = vec!["merge", &share, "--out", &table];
    for line in [&draw, &merge] {
        let started = Instant::now();
        assert!(program(line).status().expect("it runs").success());
        let undisturbed = started.elapsed();
        for attempt in 0..10 {
            let mut child = program(line).spawn().expect("it runs");
            sleep(undisturbed.mul_f64(f64::from(attempt) / 9.0));
            child.kill().expect("killed");
            child.wait().expect("it ends");
            for file in &files {
                assert!(landau_solver::file::is_sealed(file.as_ref()), "{file}");
            }
        }
        assert!(program(line).status().expect("it runs").success());
    }
}

/// What `nohup` and a shell's `&` ignore stays ignored; `setsid` and friends do the same.
#[test]
fn ignored_signals_stay_ignored() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out.csv");
    let mut child = Command::new("sh")
        .args(["-c", "trap '' HUP INT; exec \"$@\"", "sh"])
        .arg(env!("CARGO_BIN_EXE_landau-under-test"))
        .args(SWEEP)
        .arg("--out")
        .arg(&out)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("a shell");
    assert!(has_begun(&mut child, &out));
    for name in ["-HUP", "-INT"] {
        let sent = Command::new("kill")
            .args([name, &child.id().to_string()])
            .status();
        assert!(sent.expect("it runs").success());
    }
    assert!(child.wait().expect("it ends").success());
    assert!(out.exists());
}

/// A single computation, however long, ends at once by a signal, as any program does that keeps nothing.
#[test]
fn a_long_computation_is_interrupted() {
    let line = ["point", "vibrated_bed", "--k", "0.16", "-M", "900"];
    let mut child = program(&line).spawn().expect("it runs");
    sleep(Duration::from_millis(500));
    // Not INT, which is ignored where the tests run in the background.
    let sent = Command::new("kill")
        .args(["-TERM", &child.id().to_string()])
        .status();
    assert!(sent.expect("it runs").success());
    let asked = Instant::now();
    let status = child.wait().expect("it ends");
    assert_eq!(status.signal(), Some(15), "{status}");
    assert!(asked.elapsed() < Duration::from_secs(5));
}

/// With a full disk behind standard output there is no answer, and the status says so.
#[test]
fn an_answer_that_cannot_be_written_is_no_answer() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out.csv").display().to_string();
    let lines: [&[&str]; 6] = [
        &["models"],
        &["models", "--json"],
        &["point", "swift_hohenberg", "--json"],
        &["explain", "swift_hohenberg"],
        &[
            "sweep",
            "swift_hohenberg",
            "--over",
            "k=0.9:1:3",
            "--out",
            &out,
        ],
        &["--help"],
    ];
    for line in lines {
        let full = fs::OpenOptions::new()
            .write(true)
            .open("/dev/full")
            .expect("a device");
        let output = program(line)
            .stdout(full)
            .stderr(Stdio::piped())
            .output()
            .expect("it runs");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{line:?}: {said}");
        assert!(said.contains("standard output"), "{line:?}: {said}");
        // A reader that has gone away wanted no more.
        let mut child = program(line)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("it runs");
        drop(child.stdout.take());
        let output = child.wait_with_output().expect("it ends");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{line:?}: {said}");
        assert!(!said.contains("panic"), "{line:?}: {said}");
        // Without any standard output, which the standard library replaces by /dev/null.
        let output = Command::new("sh")
            .args(["-c", "exec \"$@\" >&-", "sh"])
            .arg(env!("CARGO_BIN_EXE_landau-under-test"))
            .args(line)
            .current_dir(root())
            .output()
            .expect("a shell");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{line:?}: {said}");
        assert!(
            said.ends_with(
                "error: the answer could not be written to standard output: it is closed\n"
            ),
            "{line:?}: {said}"
        );
    }
}

/// Where standard error cannot be written, words are lost and nothing else: a sweep goes on, an error keeps its status.
#[test]
fn a_full_standard_error_stops_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out.csv");
    let mut child = sweep(&out).spawn().expect("it runs");
    assert!(has_begun(&mut child, &out));
    child.kill().expect("killed");
    child.wait().expect("it ends");
    let full = || {
        fs::OpenOptions::new()
            .write(true)
            .open("/dev/full")
            .expect("a device")
    };
    assert!(
        sweep(&out)
            .stderr(full())
            .status()
            .expect("it runs")
            .success()
    );
    assert!(out.exists());
    let status = program(&["point", "no_such_model"]).stderr(full()).status();
    assert_eq!(status.expect("it runs").code(), Some(2));
}

/// Pipes and devices are refused, and no command waits for them.
#[test]
fn files_that_are_no_files() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (pipe, out) = (path("pipe.toml"), path("out"));
    let made = Command::new("mkfifo").arg(&pipe).status();
    assert!(made.expect("it runs").success());
    for source in [pipe.as_str(), "/dev/zero", "/dev/null"] {
        let lines: [&[&str]; 3] = [
            &["merge", source, "--out", &out],
            &["reproduce", source, "--out", &out],
            &["explain", "swift_hohenberg", "--against", source],
        ];
        for line in lines {
            let mut child = program(line)
                .stderr(Stdio::piped())
                .spawn()
                .expect("it runs");
            let end = Instant::now() + Duration::from_secs(60);
            while child.try_wait().expect("asked").is_none() && Instant::now() < end {
                sleep(Duration::from_millis(10));
            }
            child.kill().expect("ended or killed");
            let output = child.wait_with_output().expect("it ends");
            let said = String::from_utf8_lossy(&output.stderr).into_owned();
            assert_eq!(output.status.code(), Some(2), "{line:?}: {said}");
            assert!(said.contains("no plain file"), "{line:?}: {said}");
        }
    }
}

/// Titles and names of a spec cannot command the terminal that they are printed on.
#[test]
fn control_characters_of_a_spec_are_shown() {
    let spec = "model plain \"\u{1b}[2Jred \u{9b}31m \u{202e}title\";
coordinates { x: periodic; }
parameters { r = 0.1; }
fields { u \"\u{7}field\"; }
balance { swift: dt(u) = r*u - (u + 2*dx(dx(u)) + dx(dx(dx(dx(u))))) - u^3; }
base { u = 0; }
typical { k = 1; }
";
    let good = written("loud.model", spec).display().to_string();
    let bad = written("bad.model", &spec.replace("- u^3", "- w\u{1b}[31m^3"))
        .display()
        .to_string();
    let said = |line: &[&str]| -> Answer { landau(line) };
    let answers = [
        said(&["point", &good]),
        said(&["explain", &good]),
        said(&["verify", &good]),
        said(&["check", &bad]),
    ];
    for answer in answers {
        let text = answer.out + &answer.err;
        let commands = |c: char| c.is_control() && c != '\n' && c != '\t';
        assert!(
            !text.contains(commands) && !text.contains('\u{202e}'),
            "{text:?}"
        );
    }
}

/// A journal that ends in garbage, or holds some, costs what is damaged alone.
#[test]
fn garbage_in_a_journal() {
    let folder = tempfile::tempdir().expect("a folder");
    let (plain, out) = (
        folder.path().join("plain.csv"),
        folder.path().join("out.csv"),
    );
    assert!(sweep(&plain).status().expect("it runs").success());
    let mut child = sweep(&out).spawn().expect("it runs");
    assert!(has_begun(&mut child, &out));
    child.kill().expect("killed");
    child.wait().expect("it ends");
    let mut lines = whole_lines(&out);
    let first = lines.iter().position(|b| *b == b'\n').expect("a line") + 1;
    lines.splice(first..first, b"\xff\xfe\x80 no text\n".iter().copied());
    let count = lines.iter().filter(|b| **b == b'\n').count() - 2;
    lines.extend(b"{\"chunk\": 3, \"ro");
    fs::File::create(journal(&out))
        .and_then(|mut file| file.write_all(&lines))
        .expect("written");
    let output = sweep(&out)
        .stderr(Stdio::piped())
        .output()
        .expect("it runs");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    assert!(said.contains("2 lines of its journal do not fit"), "{said}");
    assert!(said.contains("resumed: ") && count > 0, "{said}");
    assert!(fs::read(&plain).expect("a table") == fs::read(&out).expect("a table"));
}
