//! Nothing lost, nothing taken over by silence: sweeps killed, resumed, tampered with, started twice.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("sweep-{name}"));
    let _ = fs::remove_dir_all(&path);
    fs::create_dir_all(&path).expect("a folder");
    path
}

fn command(out: &Path, extra: &[&str]) -> Command {
    // Signals that are ignored where the tests run, in the background for example, are not ignored here.
    let mut command = Command::new("env");
    command
        .args(["--default-signal", env!("CARGO_BIN_EXE_landau-under-test")])
        .args(["sweep", "swift_hohenberg_strip", "-M", "30"])
        .args(["--over", "k=0.9:1.1:80", "--over", "r=1:1.2:5", "--out"])
        .arg(out)
        .args(extra)
        .env("RAYON_NUM_THREADS", "2")
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    command
}

fn run(out: &Path, extra: &[&str]) -> Output {
    command(out, extra)
        .output()
        .expect("the binary under test runs")
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn journal(out: &Path) -> PathBuf {
    PathBuf::from(format!("{}.journal", out.display()))
}

/// Starts a sweep and waits until its journal has a line or two.
fn started(out: &Path) -> Child {
    let child = command(out, &[])
        .spawn()
        .expect("the binary under test runs");
    for _ in 0..2000 {
        let lines = fs::read_to_string(journal(out)).map_or(0, |text| text.lines().count());
        if lines > 2 {
            break;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    child
}

fn signal(child: &Child, name: &str) {
    let status = Command::new("kill")
        .args([&format!("-{name}"), &child.id().to_string()])
        .status();
    assert!(status.is_ok_and(|s| s.success()), "kill -{name}");
}

/// A journal that a kill left behind.
fn killed(out: &Path) {
    let mut child = started(out);
    signal(&child, "KILL");
    child.wait().expect("it ends");
    assert!(!out.exists());
    assert!(
        fs::read_to_string(journal(out))
            .expect("a journal")
            .lines()
            .count()
            > 2
    );
}

#[test]
fn killed_and_resumed_to_the_byte() {
    let folder = folder("killed");
    let whole = folder.join("whole.csv");
    assert!(run(&whole, &[]).status.success());
    let out = folder.join("resumed.csv");
    for _ in 0..2 {
        killed(&out);
        let again = run(&out, &[]);
        assert!(again.status.success(), "{}", said(&again));
        assert!(said(&again).contains("resumed: "), "{}", said(&again));
        assert_eq!(
            fs::read(&whole).expect("a table"),
            fs::read(&out).expect("a table")
        );
        assert!(!journal(&out).exists());
        fs::remove_file(&out).expect("removed");
    }
    let left: Vec<_> = fs::read_dir(&folder).expect("listed").collect();
    // The table, and what its columns are, which the removed one leaves too.
    assert_eq!(left.len(), 3, "{left:?}");
}

/// A digit changed, a row missing, a chunk under another number, a line cut off: computed again, with a word.
#[test]
fn a_journal_is_not_believed() {
    let folder = folder("tampered");
    let whole = folder.join("whole.csv");
    assert!(run(&whole, &[]).status.success());
    let out = folder.join("table.csv");
    killed(&out);
    let text = fs::read_to_string(journal(&out)).expect("a journal");
    let lines: Vec<&str> = text.lines().collect();
    let line = lines[1];
    let digit = line.find("\"c0\":[").expect("a number") + 9;
    let other = if &line[digit..=digit] == "7" {
        "3"
    } else {
        "7"
    };
    let changed = format!("{}{other}{}", &line[..digit], &line[digit + 1..]);
    let renumbered = line.replacen("\"chunk\":", "\"chunk\":1", 1);
    let shorter = {
        let start = line.find("{\"coordinates\"").expect("a row");
        let end = start + line[start..].find("},").expect("its end") + 2;
        format!("{}{}", &line[..start], &line[end..])
    };
    let cut = line[..line.len() / 2].to_owned();
    for damaged in [changed, renumbered, shorter, cut] {
        fs::write(journal(&out), format!("{}\n{damaged}\n", lines[0])).expect("written");
        let again = run(&out, &[]);
        assert!(again.status.success(), "{}", said(&again));
        assert!(
            said(&again).contains("1 line of its journal does not fit"),
            "{}",
            said(&again)
        );
        assert_eq!(
            fs::read(&whole).expect("a table"),
            fs::read(&out).expect("a table")
        );
    }
}

#[test]
fn two_runs_with_one_output() {
    let folder = folder("twice");
    let out = folder.join("table.csv");
    let mut first = started(&out);
    let second = run(&out, &[]);
    if first.try_wait().expect("asked").is_none() {
        assert_eq!(second.status.code(), Some(2), "{}", said(&second));
        assert!(said(&second).contains("another run"), "{}", said(&second));
    }
    assert!(first.wait().expect("it ends").success());
    assert!(out.exists() && !journal(&out).exists());
}

#[test]
fn signals_say_what_is_kept() {
    let folder = folder("signals");
    for (name, status) in [("INT", 130), ("TERM", 143), ("HUP", 129)] {
        let out = folder.join(format!("{name}.csv"));
        let child = started(&out);
        signal(&child, name);
        let output = child.wait_with_output().expect("it ends");
        assert_eq!(
            output.status.code(),
            Some(status),
            "{name}: {}",
            said(&output)
        );
        assert!(
            said(&output).contains("the same command goes on"),
            "{}",
            said(&output)
        );
        let again = run(&out, &[]);
        assert!(
            again.status.success() && said(&again).contains("resumed: "),
            "{}",
            said(&again)
        );
    }
}

#[test]
fn somebody_elses_files_are_safe() {
    let folder = folder("others");
    let out = folder.join("table.csv");
    fs::write(&out, "my,own,numbers\n1,2,3\n").expect("written");
    let refused = run(&out, &[]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(said(&refused).contains("--force"), "{}", said(&refused));
    assert_eq!(
        fs::read_to_string(&out).expect("read"),
        "my,own,numbers\n1,2,3\n"
    );
    assert!(run(&out, &["--force"]).status.success());
    // Its own table is its own to make again.
    assert!(run(&out, &[]).status.success());
    for wrong in ["/dev/null", "/", "missing/table.csv"] {
        let answer = run(Path::new(wrong), &[]);
        assert_eq!(answer.status.code(), Some(2), "{wrong}: {}", said(&answer));
    }
    let link = folder.join("link.csv");
    let target = folder.join("target.csv");
    std::os::unix::fs::symlink(&target, &link).expect("a link");
    let dangling = run(&link, &[]);
    assert_eq!(dangling.status.code(), Some(2), "{}", said(&dangling));
    fs::copy(&out, &target).expect("copied");
    // Without the description beside it, it is no table of this sweep.
    assert_eq!(run(&link, &[]).status.code(), Some(2));
    let description = |table: &Path| PathBuf::from(format!("{}-metadata.json", table.display()));
    fs::copy(description(&out), description(&target)).expect("copied");
    assert!(run(&link, &[]).status.success());
    assert!(fs::symlink_metadata(&link).expect("there").is_symlink());
    let names: Vec<_> = fs::read_dir(&folder)
        .expect("listed")
        .map(|e| e.expect("a file").file_name())
        .collect();
    // A table, a link and its target; what their columns are.
    assert_eq!(names.len(), 5, "{names:?}");
}

/// Rows of a pole and rows without an answer say so, and hold no number that is none.
#[test]
fn rows_carry_errors_distances_and_status() {
    let folder = folder("status");
    let out = folder.join("pole.csv");
    // 2 c0(k) meets the eigenvalue at 2k where r = 2q − q2: at r = 0.36, k² = 0.4.
    let k = 0.4_f64.sqrt();
    let output = Command::new(env!("CARGO_BIN_EXE_landau-under-test"))
        .args(["sweep", "swift_hohenberg", "--set", "r=0.36", "--over"])
        .arg(format!("k={}:{}:21", k - 1e-3, k + 1e-3))
        .arg("--out")
        .arg(&out)
        .output()
        .expect("the binary under test runs");
    assert!(output.status.success(), "{}", said(&output));
    let text = fs::read_to_string(&out).expect("a table");
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().expect("a header").split(',').collect();
    let column = |name: &str| header.iter().position(|h| *h == name).expect("a column");
    let mut resonant = 0;
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        let distance: f64 = cells[column("second_harmonic")].parse().unwrap_or(0.0);
        let near = distance < 1e-4;
        assert_eq!(
            cells[column("status")] != "ok",
            distance < 1e-3 * 0.5 || near,
            "{line}"
        );
        resonant += usize::from(cells[column("status")] != "ok");
        assert!(!line.contains("NaN") && !line.contains("inf"), "{line}");
    }
    assert!(resonant > 0);
}

/// A mode that grows inside the range alone, beside one that decays slowly everywhere: the fastest growing one is
/// found, with few points and with many. a: r − (1 − k²)²; b: −s.
#[test]
fn growth_between_stable_ends() {
    let spec = "model window \"Growth inside a window, beside a mode that decays slowly\";
coordinates { x: periodic; }
parameters { r = 0.1; s = 0.01; }
fields { a; b; }
balance {
    window: dt(a) = r*a - (a + 2*dx(dx(a)) + dx(dx(dx(dx(a))))) - a^3;
    slow:   dt(b) = -s*b - b^3;
}
base { a = 0; b = 0; }
typical { k = 1; }
";
    let path = crate::support::written("window.model", spec);
    let folder = tempfile::tempdir().expect("a folder");
    for (axis, growth) in [
        ("k=0.5:1.5:9", 0.1),
        ("k=0.5:1.5:101", 0.1),
        ("r=-0.2:0.1:4", 0.1),
    ] {
        let out = folder.path().join("window.csv").display().to_string();
        let line = [
            "sweep",
            &path.display().to_string(),
            "--over",
            axis,
            "--out",
            &out,
        ];
        let k = if axis.starts_with('k') {
            &[][..]
        } else {
            &["--k", "1"][..]
        };
        let answer = crate::support::landau(&[&line[..], k, &["--force"]].concat());
        assert_eq!(answer.status, 0, "{axis}: {}", answer.err);
        let table = std::fs::read_to_string(&out).expect("the table");
        let rates = table
            .lines()
            .skip(1)
            .filter_map(|row| row.split(',').nth(1));
        let rates = rates.map(|rate| rate.parse::<f64>().expect("a rate"));
        crate::support::close(axis, rates.fold(f64::MIN, f64::max), growth, 1e-12);
    }
}
