//! What is said of wrong input: where it stands, what it is, what is accepted, in few words.

use crate::mistakes::small;
use crate::reports::{Desk, study};
use crate::support::landau;

const POWER_LAW: &str = r#"
[[figure.task]]
kind = "values"
[[figure.task.case]]
k = 1.0

[[figure.task]]
kind = "power_law"
critical = { name = "r_c", vary = "r", between = [-0.5, 0.9] }
distances = [1e-4, 1e-2]
count = 5
[[figure.task.case]]
k = 0.9
"#;

const KINDS: &str = "it accepts `profiles`, `law`, `convergence`, `spectrum`, `sweep`, `resonance`, `orders`, \
                     `second_harmonic`, `critical`, `claims`, `values`, `power_law`, `pattern`, `circulation`";

/// A mistake in the second task stands at the key of the second task, whatever the reader makes of it.
#[test]
fn a_mistake_of_a_study_has_its_place_and_its_key() {
    let desk = Desk::new();
    for (good, bad, place, words) in [
        (
            "distances = [1e-4, 1e-2]\n",
            "",
            "13:1",
            "`distances` is missing: it accepts two relative distances of one sign, the nearer first",
        ),
        (
            "[-0.5, 0.9]",
            "[-0.5, \"x\"]",
            "15:57",
            "`between`: invalid type: string \"x\", expected a number; it accepts two numbers, the lower first",
        ),
        (
            "count = 5",
            "count = 2024-01-01",
            "17:9",
            "count = 2024-01-01: this is a date; `count` accepts a whole number",
        ),
        ("\"power_law\"", "3", "14:8", &format!("kind = 3: {KINDS}")),
        (
            "\"power_law\"",
            "\"power\"",
            "14:8",
            &format!("kind = `power`: {KINDS}"),
        ),
        (
            "kind = \"power_law\"\n",
            "",
            "13:1",
            &format!("`kind` is missing: {KINDS}"),
        ),
        (
            "count = 5",
            "count = 5\ncount = 6",
            "18:1",
            "the key `count` stands twice in one table",
        ),
        (
            "vary = \"r\", ",
            "",
            "15:12",
            "`vary` is missing: it accepts `k` or the name of a parameter",
        ),
        (
            "count = 5",
            "count = 1.5",
            "17:9",
            "`count`: invalid type: floating point `1.5`, expected a whole number",
        ),
        (
            "k = 0.9",
            "k = 0.9\nprinted = { c0 = true }",
            "20:18",
            "`c0`: no printed number: it accepts a number, or a text with its digits such as \"0.1790\"",
        ),
        (
            "count = 5",
            "colour = 1",
            "17:1",
            "unknown field `colour`, expected one of `case`, `critical`, `distances`, `count`",
        ),
    ] {
        let answer = desk.reproduce(&study(POWER_LAW).replacen(good, bad, 1));
        assert_eq!(answer.status, 2, "{bad}: {}", answer.err);
        let file = desk.path("study.toml");
        let start = format!("error: {}:{place}\n", file.display());
        assert!(answer.err.starts_with(&start), "{start}: {}", answer.err);
        assert!(
            answer.err.contains(&format!("\n{words}\n")),
            "{words}: {}",
            answer.err
        );
    }
    let without_tasks = study("");
    let said = desk.reproduce(&without_tasks).err;
    assert!(
        said.contains("`task` is missing: it accepts one or more, as [[figure.task]]"),
        "{said}"
    );
}

/// As the page on studies says: letters, digits and hyphens.
#[test]
fn ids_begin_names_of_files() {
    let desk = Desk::new();
    for id in ["2.svg", "2_a", "-2", "2-", "", "é"] {
        let text = small().replace("id = \"1\"", &format!("id = \"{id}\""));
        let answer = desk.reproduce(&text);
        assert_eq!(answer.status, 2, "{id}: {}", answer.err);
        let words = "letters (a to z), digits and hyphens, a letter or a digit at both ends";
        assert!(answer.err.contains(words), "{id}: {}", answer.err);
    }
}

/// The options of a command, and what is said of them on one line.
#[test]
fn messages_are_short() {
    let onset = ["critical", "swift_hohenberg", "--vary", "r", "--k", "1"];
    for (line, words) in [
        (
            vec![
                "pattern",
                "swift_hohenberg",
                "--k",
                "1",
                "--wavelengths",
                "1e300",
                "--out",
                "x.svg",
            ],
            "error: --wavelengths 1e300: it accepts a number above 0, up to 100",
        ),
        (
            vec!["point", "vibrated_bed", "--k", "0.16", "--set", "F=1e300"],
            "error: F = 1e300 is out of range: `F` accepts a number in 0.1..40",
        ),
        (
            vec!["point", "swift_hohenberg", "--k", "-1e300"],
            "error: k = -1e300 is not a wavenumber: it has to be a positive number",
        ),
        (
            [&onset[..], &["--from", "1e-300", "--to", "2e-300"]].concat(),
            "error: `r` cannot vary from 1e-300 to 2e-300: the difference has to be at least 1e-150",
        ),
        (
            [&onset[..], &["--from", "-1e308", "--to", "1e308"]].concat(),
            "error: `r` cannot vary from -1e308 to 1e308: the difference has to be a number, below 1.8e308",
        ),
        (
            [&onset[..], &["--from", "0.1", "--to", "0.1"]].concat(),
            "error: `r` cannot vary from 0.1 to 0.1: give two different numbers, --from and --to",
        ),
        (
            vec![
                "base",
                "swift_hohenberg",
                "--out",
                "a\nb.npz",
                "--plot",
                "a\nb.txt",
            ],
            "error: --plot a\\u000ab.txt: it accepts .svg, .png",
        ),
        (
            vec![
                "amplitudes",
                "swift_hohenberg",
                "--mode",
                "k=1",
                "--mode",
                "k=0.9",
                "--mode",
                "k=0.8",
                "--mode",
                "k=0.7",
                "--order",
                "9",
            ],
            // 18!/(8! 10!) − 1
            "error: 4 modes to order 9 have 43757 monomials z^p z̄^s up to degree 10, one more than the order: at most \
             5000 are computed; ask for fewer modes, or for a lower --order",
        ),
    ] {
        let answer = landau(&line);
        assert_eq!(answer.status, 2, "{line:?}: {}", answer.err);
        assert_eq!(answer.err, format!("{words}\n"), "{line:?}");
    }
    // A base state and a spectrum are about no mode.
    for command in ["base", "spectrum"] {
        let answer = landau(&[command, "swift_hohenberg", "--near", "1"]);
        assert_eq!(answer.status, 2, "{}", answer.err);
        assert!(
            answer.err.contains("unexpected argument '--near'"),
            "{}",
            answer.err
        );
    }
}

/// Negative numbers with an exponent are numbers.
#[test]
fn negative_numbers_have_exponents() {
    let line = "critical swift_hohenberg --vary r --k 1 --from -1e-1 --to 1e-1 --near -1e-2";
    let answer = landau(&line.split(' ').collect::<Vec<_>>());
    assert_eq!(answer.status, 0, "{}", answer.err);
    assert!(answer.out.starts_with("r = 0 ± "), "{}", answer.out);
}

/// One row is a row.
#[test]
fn one_is_singular() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (out, share) = (path("table.csv"), path("share"));
    let sweep = ["sweep", "swift_hohenberg", "--over", "k=1:1:1", "--out"];
    let answer = landau(&[&sweep[..], &[&out]].concat());
    let end = format!("\n1 row, 1 with a number, 1 ok, 1 unstable: {out}\n");
    assert!(answer.out.ends_with(&end), "{}", answer.out);
    assert_eq!(
        landau(&[&sweep[..], &[&share, "--shard", "1/1"]].concat()).status,
        0
    );
    let answer = landau(&["merge", &share, "--out", &out]);
    assert_eq!(answer.out, format!("1 share: {out}\n"), "{}", answer.err);
}
