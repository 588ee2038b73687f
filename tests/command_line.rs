//! The contract of the command line: keys, exit codes, messages, files whole or not at all.

use crate::support::{close, json, landau, number, root};

#[test]
fn point_has_its_keys() {
    let found = json("point vibrated_bed --k 0.16");
    for path in [
        "/model",
        "/parameters/F",
        "/k",
        "/M",
        "/c0/1",
        "/c2/1",
        "/amplitude",
        "/bifurcation",
        "/normalization",
        "/error/c0",
        "/error/c2",
        "/resonance/mean_flow",
        "/resonance/second_harmonic",
        "/outputs",
        "/dc0/S/1",
    ] {
        assert!(
            found.pointer(path).is_some(),
            "{path} is missing in {found}"
        );
    }
    assert_eq!(found["parameters"]["top"], "dirichlet");
}

#[test]
fn spectra_are_sorted_and_conjugate() {
    let found = json("spectrum plane_poiseuille --k 1 --set R=10000 -M 60");
    let part = |name: &str, i: usize, p: usize| number(&found, &format!("/{name}/{i}/{p}"));
    for i in 0..20 {
        assert!(part("direct", i, 0) >= part("direct", i + 1, 0));
        assert!(part("adjoint", i, 0) >= part("adjoint", i + 1, 0));
    }
    assert!((part("direct", 0, 0) - part("adjoint", 0, 0)).abs() < 1e-7);
    assert!((part("direct", 0, 1) + part("adjoint", 0, 1)).abs() < 1e-7);
    // P (6.4) has no adjoint conditions, and the command says so.
    let open = json("spectrum vibrated_bed --k 0.1 --set top=decaying");
    assert!(open["adjoint"].is_null());
    assert!(
        open["adjoint_missing"]
            .as_str()
            .is_some_and(|s| s.contains("no adjoint boundary conditions"))
    );
}

#[test]
fn bad_input_is_refused_in_a_sentence() {
    for (line, status, words) in [
        (
            "point vibrated_bed --k 0.16 --set G=1",
            2,
            "no parameter `G`",
        ),
        (
            "point vibrated_bed --k 0.16 --set e=2",
            2,
            "a number in 0..1",
        ),
        ("point vibrated_bed --k 0.16 --set e=nan", 2, "accepts"),
        (
            "point vibrated_bed --k 0.16 --set top=open",
            2,
            "dirichlet, flux_free, decaying, neumann",
        ),
        ("point vibrated_bed --k 0.16 --set S", 2, "NAME=VALUE"),
        ("point vibrated_bed --k -1", 2, "positive number"),
        ("point vibrated_bed --k 0", 2, "positive number"),
        ("point vibrated_bed --k 0.1 -M 2", 2, "M accepts 4 to 1000"),
        ("point vibrated_bed --k 0.1 --order 4", 2, "--order"),
        ("point vibrated_bed --k 0.1 --near x", 2, "--near"),
        (
            "point vibrated_bad --k 0.1",
            2,
            "did you mean `vibrated_bed`?",
        ),
        ("point", 2, "Usage"),
        (
            "critical vibrated_bed --vary top --from 0 --to 1",
            2,
            "switch",
        ),
        (
            "critical vibrated_bed --vary S --from 50 --to 100",
            2,
            "--k",
        ),
        (
            "critical vibrated_bed --vary S --from 50 --to 100 --minimize q=1:2",
            2,
            "k=A:B",
        ),
        (
            "critical vibrated_bed --vary k --from 0.1 --to 0.11",
            3,
            "does not change sign",
        ),
        (
            "sweep vibrated_bed --over k=0.1:0.2 --out /tmp/never.csv",
            2,
            "NAME=FROM:TO:COUNT",
        ),
        (
            "sweep vibrated_bed --over S=50:100:2 --out /tmp/never.csv",
            2,
            "--k",
        ),
        (
            "sweep vibrated_bed --over k=0.1:0.2:3 --out /nowhere/never.csv",
            2,
            "/nowhere",
        ),
        (
            "sweep swift_hohenberg --over k=0.9:1:3 --k 3 --out /tmp/never.csv",
            2,
            "k varies, and k = 3 is given too",
        ),
        (
            "sweep swift_hohenberg --over r=0.1:0.2:3 --set r=0.3 --k 1 --out /tmp/never.csv",
            2,
            "`r` varies, and r = 0.3 is set too",
        ),
        (
            "sweep swift_hohenberg --over r=-1e308:1e308:3 --k 1 --out /tmp/never.csv",
            2,
            "TO − FROM has to be a number",
        ),
        (
            "point swift_hohenberg --set r=0.1 --set r=0.2",
            2,
            "`r` is set twice, by `r=0.1` and by `r=0.2`",
        ),
        (
            "amplitudes swift_hohenberg --mode k=1,k=2",
            2,
            "names k twice",
        ),
        ("check /nowhere/a.model", 2, "cannot be read"),
        ("explain vibrated_bed --operator N4", 2, "possible values"),
    ] {
        let arguments: Vec<&str> = line.split_whitespace().collect();
        let answer = landau(&arguments);
        assert_eq!(
            answer.status, status,
            "{line}: {} {}",
            answer.out, answer.err
        );
        assert!(answer.err.contains(words), "{line}: {}", answer.err);
        assert_eq!(answer.out, "", "{line} prints no number");
    }
}

/// Empty columns of a table are explained below it.
#[test]
fn a_missing_adjoint_spectrum_is_explained() {
    let line = "spectrum vibrated_bed --k 0.1 -M 20 --set top=decaying";
    let arguments: Vec<&str> = line.split_whitespace().collect();
    let answer = landau(&arguments);
    assert_eq!(answer.status, 0, "{}", answer.err);
    let last = answer.out.lines().last().unwrap_or_default();
    let words = "the columns of L† are empty: no adjoint boundary conditions";
    assert!(last.starts_with(words), "{}", answer.out);
}

/// An eigenvalue is spelled alike in `--near` and in `--mode`.
#[test]
fn an_eigenvalue_has_one_spelling_everywhere() {
    let point = |near: &str| {
        json(&format!(
            "point brusselator --k 0.8 --set A=2 --set B=6 --near {near}"
        ))
    };
    assert_eq!(point("0:1"), point("0,1"));
    let modes = |near: &str| {
        json(&format!(
            "amplitudes brusselator --set A=2 --set B=6 --mode k=0.8,near={near}"
        ))
    };
    assert_eq!(modes("0:1"), modes("0,1"));
}

#[test]
fn help_has_examples() {
    for command in [
        "point", "critical", "sweep", "verify", "spectrum", "base", "explain", "check",
    ] {
        let answer = landau(&[command, "--help"]);
        assert_eq!(answer.status, 0);
        assert!(answer.out.contains("Example"), "{command}: {}", answer.out);
    }
    let listed = landau(&["models"]);
    assert_eq!(listed.status, 0);
    assert!(listed.out.contains("vibrated_bed"));
}

#[test]
fn models_run_from_their_files() {
    let path = root().join("spec/models/swift_hohenberg.model");
    let from_file = json(&format!("point {} --k 1", path.display()));
    assert_eq!(from_file["c2"], json("point swift_hohenberg --k 1")["c2"]);
}

#[test]
fn certificates_hold() {
    const CUBIC: &str = "N3 symmetric, relative";
    // What a certificate leaves out, and nothing else: a model without N3, data that the quadrature does not take,
    // conditions without an adjoint.
    let cases: [(&str, &[&str]); 12] = [
        ("verify vibrated_bed --k 0.16", &[]),
        ("verify swift_hohenberg_strip --k 1.02", &[]),
        ("verify plane_poiseuille --k 1 --set R=8000 -M 60", &[CUBIC]),
        ("verify rayleigh_benard --k 3 --set Ra=2000", &[CUBIC]),
        ("verify brusselator --k 1.9", &[]),
        ("verify brusselator_strip --k 1.9", &[]),
        (
            "verify plane_poiseuille_flux --k 1 --set R=8000 -M 60",
            &[CUBIC],
        ),
        ("verify kuramoto_sivashinsky --k 0.9", &[CUBIC]),
        ("verify swift_hohenberg --k 0.95", &[]),
        (
            "verify robin_strip --k 1",
            &["c2 by two routes", "N2 symmetric, relative", CUBIC],
        ),
        ("verify granular_couette --k 3 --near 0", &[]),
        (
            "verify vibrated_bed --k 0.1 -M 80 --set top=neumann",
            &["duality", "c2 by two routes"],
        ),
    ];
    for (line, expected) in cases {
        let found = json(line);
        let checks = found["checks"].as_array().expect("checks");
        for part in 1..=5 {
            let mut own = checks.iter().filter(|c| c["part"] == part);
            assert!(own.next().is_some(), "{line}: part {part} is missing");
        }
        let left_out = checks.iter().filter(|c| c["verdict"] == "left out");
        let names: Vec<&str> = left_out.filter_map(|c| c["name"].as_str()).collect();
        assert_eq!(names, expected, "{line}");
    }
}

/// The same file for any number of threads, and after an interruption.
#[test]
fn sweeps_are_deterministic_and_resume() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = |name: &str, threads: &str, before: Option<&str>| {
        let out = folder.path().join(name);
        if let Some(journal) = before {
            std::fs::write(folder.path().join(format!("{name}.journal")), journal)
                .expect("a journal");
        }
        let status = std::process::Command::new(env!("CARGO_BIN_EXE_landau-under-test"))
            .args([
                "sweep",
                "swift_hohenberg",
                "--over",
                "k=0.8:1.2:90",
                "--over",
                "r=0.1:0.3:3",
                "--out",
            ])
            .arg(&out)
            .env("RAYON_NUM_THREADS", threads)
            .output()
            .expect("the binary under test runs");
        assert!(
            status.status.success(),
            "{}",
            String::from_utf8_lossy(&status.stderr)
        );
        assert!(!folder.path().join(format!("{name}.journal")).exists());
        std::fs::read_to_string(out).expect("a table")
    };
    let one = run("one.csv", "1", None);
    assert_eq!(one, run("two.csv", "2", None));
    // A journal that was cut off before its first line was whole is no harm.
    assert_eq!(one, run("three.csv", "2", Some("{\"landau_journal\":2,")));
    assert_eq!(one.lines().count(), 271);
    assert!(
        one.lines()
            .next()
            .is_some_and(|h| h == "k,r,c0_re,c0_im,c0_error,c2_re,c2_im,c2_error,amplitude,bifurcation,mean_flow,second_harmonic,leading_re,status")
    );
    assert!(one.lines().skip(1).all(|line| line.ends_with(",ok")));
}

/// Every row carries its status; a sweep with failures still writes the others.
#[test]
fn failures_are_rows_too() {
    let spec = "model half \"No coefficient below p = 0\";
coordinates { x: periodic; }
parameters { p = 1; }
fields { u; }
balance { motion: dt(u) = sqrt(p)*u + dx(dx(u)) - u^3; }
base { u = 0; }
";
    let path = crate::support::written("half.model", spec);
    let out = path.with_extension("csv");
    let answer = landau(&[
        "sweep",
        &path.to_string_lossy(),
        "--over",
        "p=-1:4:6",
        "--k",
        "0.5",
        "--out",
        &out.to_string_lossy(),
    ]);
    assert_eq!(answer.status, 0, "{}", answer.err);
    let mut table = csv::Reader::from_path(&out).expect("a table");
    let rows: Vec<csv::StringRecord> = table.records().map(|r| r.expect("a row")).collect();
    assert_eq!(rows.len(), 6);
    let status = |row: &csv::StringRecord| row[row.len() - 1].to_owned();
    assert!(
        status(&rows[0]).contains("no value in the balance `motion`"),
        "{}",
        status(&rows[0])
    );
    assert!(rows[0].iter().skip(1).take(7).all(str::is_empty));
    for row in &rows[2..] {
        assert_eq!(status(row), "ok");
        let (p, c0): (f64, f64) = (row[0].parse().expect("p"), row[1].parse().expect("c0"));
        close("c0", c0, p.sqrt() - 0.25, 1e-13);
    }
}

/// A spec whose form is right and whose law has no derivative at the base state.
#[test]
fn a_law_singular_at_the_base_state_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("root.model");
    let spec = "model root \"A square root at zero, for one value of a parameter\";
coordinates { x: periodic; y: 0..1; }
parameters { r = 1; a = 1; }
fields { u; }
law root = sqrt(u);
balance { motion: dt(u) = dx(dx(u)) + dy(dy(u)) + r*(root - sqrt(a)); }
base { u = a; }
boundary { at y = 0 { u = a; } at y = 1 { u = a; } }
";
    std::fs::write(&path, spec).expect("written");
    let path = path.to_str().expect("a path");
    assert_eq!(landau(&["check", path]).status, 0);
    for command in ["point", "spectrum", "verify"] {
        let answer = landau(&[command, path, "--k", "1", "--set", "a=0"]);
        assert_eq!((answer.status, answer.out.as_str()), (3, ""), "{command}");
        let told = ["balance `motion`", "singular at the base state"];
        assert!(
            told.iter().all(|t| answer.err.contains(t)),
            "{}",
            answer.err
        );
    }
    // A base state that vanishes for all parameters is refused before any work.
    let vanishing = spec.replace("u = a", "u = 0").replace(" - sqrt(a)", "");
    std::fs::write(path, vanishing.replace(" a = 1;", "")).expect("written");
    let answer = landau(&["check", path]);
    assert_eq!(answer.status, 2);
    assert!(answer.err.contains("root.model:6:11"), "{}", answer.err);
    assert!(answer.err.contains("the law `root`"), "{}", answer.err);
}

/// Every key of every JSON object stands in the page that lists them.
#[test]
fn the_page_of_keys_is_whole() {
    let page = std::fs::read_to_string(root().join("spec/data.md")).expect("the page");
    let commands = [
        "base vibrated_bed --points 3",
        "spectrum swift_hohenberg",
        "point swift_hohenberg --order 5",
        "point brusselator --k 1 --set B=7 --set D1=1",
        "amplitudes swift_hohenberg --mode k=1",
        "critical swift_hohenberg --vary r --from -0.1 --to 0.1 --k 1",
        "verify swift_hohenberg",
    ];
    for command in commands {
        let name = command.split(' ').next().expect("a command");
        let row = page
            .lines()
            .find(|l| l.starts_with(&format!("| `{name}` |")));
        let row = row.unwrap_or_else(|| panic!("{name} is not in the page"));
        let found = json(command);
        for key in found.as_object().expect("an object").keys() {
            // Coefficients beyond c2 and the coordinate have names of their own.
            let known = row.contains(&format!("`{key}`")) || key == "y";
            assert!(known, "{name}: `{key}` is not in the page");
        }
    }
}
