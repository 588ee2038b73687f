//! The tutorial's files and commands, run as they are printed.

use crate::support::root;
use std::path::Path;
use std::process::Command;

/// A fenced block: its information string and its lines.
struct Block<'t> {
    info: &'t str,
    text: String,
}

fn blocks(page: &str) -> Vec<Block<'_>> {
    let mut found = Vec::new();
    let mut lines = page.lines();
    while let Some(line) = lines.next() {
        if let Some(info) = line.strip_prefix("```") {
            let body: Vec<&str> = lines.by_ref().take_while(|l| *l != "```").collect();
            found.push(Block {
                info,
                text: body.join("\n"),
            });
        }
    }
    found
}

/// Everything that a command prints.
fn run(command: &str, folder: &Path) -> String {
    let arguments = command
        .strip_prefix("landau ")
        .expect("a command of landau");
    let output = Command::new(env!("CARGO_BIN_EXE_landau-under-test"))
        .args(arguments.split_whitespace())
        .current_dir(folder)
        .output()
        .expect("the binary under test runs");
    let text = |bytes| String::from_utf8_lossy(bytes).into_owned();
    text(&output.stdout) + &text(&output.stderr)
}

/// Whether a printed answer is the expected one, `…` standing for anything.
fn agrees(expected: &str, answer: &str) -> bool {
    let lines = |text: &str| -> Vec<String> {
        let lines = text.trim().lines().map(str::trim_end);
        lines.map(str::to_owned).collect()
    };
    if !expected.contains('…') {
        let (expected, answer) = (lines(expected), lines(answer));
        let mut pairs = expected.iter().zip(&answer);
        return expected.len() == answer.len() && pairs.all(|(a, b)| same_words(a, b));
    }
    let answer = lines(answer).join("\n");
    let mut after = answer.as_str();
    let pieces: Vec<&str> = expected.split('…').map(|p| p.trim_matches('\n')).collect();
    for (index, piece) in pieces.iter().enumerate() {
        let Some(at) = after.find(piece) else {
            return false;
        };
        if index == 0 && at != 0 {
            return false;
        }
        after = &after[at + piece.len()..];
    }
    after.is_empty() || expected.ends_with('…')
}

/// Rounding errors differ from machine to machine: what is smaller says nothing.
const ROUNDING: f64 = 1e-9;

/// Whether two lines have the same words, numbers to two units of their last printed digit.
fn same_words(expected: &str, answer: &str) -> bool {
    let same = |(a, b): (&str, &str)| {
        let [left, right] = [a, b].map(number);
        let close = left
            .zip(right)
            .is_some_and(|((x, unit), (y, _))| (x - y).abs() <= 2.0 * unit + ROUNDING);
        a == b || close
    };
    let [expected, answer] = [expected, answer].map(|line| line.split_whitespace());
    expected.clone().count() == answer.clone().count() && expected.zip(answer).all(same)
}

/// A word that is a number, with the unit of its last digit.
fn number(word: &str) -> Option<(f64, f64)> {
    let text = word.trim_matches(|c: char| matches!(c, ',' | ';' | ':' | '(' | ')'));
    let value: f64 = text.parse().ok()?;
    let (digits, exponent) = text.split_once('e').unwrap_or((text, "0"));
    let decimals = digits.split_once('.').map_or(0, |(_, after)| after.len());
    let power = exponent.parse::<i32>().ok()? - i32::try_from(decimals).ok()?;
    Some((value, 10_f64.powi(power)))
}

#[test]
fn numbers_agree_to_their_last_digit() {
    assert!(same_words(
        "c2 = -170.4557650828 ± 8e-11",
        "c2 = -170.455765084 ± 3e-10"
    ));
    assert!(!same_words(
        "c2 = -170.4557650828 ± 8e-11",
        "c2 = -170.45576 ± 3e-6"
    ));
    assert!(!same_words("order 4.0000e0", "order 4.0010e0"));
    assert!(!same_words("passed 1e-16", "failed 1e-16"));
    assert!(!same_words("a 1", "a 1 b"));
}

/// Runs every command of a page and compares; how many there were.
fn commands(page: &str, folder: &Path) -> usize {
    let consoles = blocks(page).into_iter().filter(|b| b.info == "console");
    consoles.map(|block| compare(&block.text, folder)).count()
}

/// One command with its answer.
fn compare(text: &str, folder: &Path) {
    let (command, expected) = text.split_once('\n').expect("an answer");
    let command = command.strip_prefix("$ ").expect("a prompt");
    let answer = run(command, folder);
    assert!(
        agrees(expected, &answer),
        "{command} answers\n{answer}\nnot\n{expected}"
    );
}

#[test]
fn the_page_beyond_c2_says_what_the_tool_says() {
    let page = std::fs::read_to_string(root().join("spec/AMPLITUDES.md")).expect("the page");
    assert!(commands(&page, &root()) >= 6);
}

#[test]
fn the_tutorial_says_what_the_tool_says() {
    let page = std::fs::read_to_string(root().join("spec/TUTORIAL.md")).expect("the tutorial");
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("rolls.model");
    let mut commands = 0;
    for block in blocks(&page) {
        match block.info {
            "landau rolls.model" => std::fs::write(&file, block.text + "\n").expect("written"),
            "landau rolls.model, continued" => {
                let before = std::fs::read_to_string(&file).expect("the file so far");
                std::fs::write(&file, before + "\n" + &block.text + "\n").expect("written");
            }
            "console" => {
                compare(&block.text, folder.path());
                commands += 1;
            }
            other => panic!("a block of another kind: {other}"),
        }
    }
    assert!(commands >= 8);

    let model = std::fs::read_to_string(&file).expect("the file");
    let slips = page.lines().filter_map(|line| line.strip_prefix("| `"));
    let mut count = 0;
    for slip in slips {
        let cells: Vec<&str> = slip.split(" | ").collect();
        let code = |cell: &str| cell.trim_matches('`').to_owned();
        let (right, wrong) = (code(cells[0]), code(cells[1]));
        let message = cells[2].trim_end_matches(" |");
        assert!(model.contains(&right), "{right} is in the file");
        std::fs::write(
            folder.path().join("slip.model"),
            model.replacen(&right, &wrong, 1),
        )
        .expect("written");
        let answer = run("landau check slip.model", folder.path());
        assert!(
            answer.contains(message),
            "{wrong} meets\n{answer}\nnot {message}"
        );
        count += 1;
    }
    assert!(count >= 9);
}
