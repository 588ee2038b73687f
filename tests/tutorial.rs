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
    let trimmed: Vec<&str> = answer.lines().map(str::trim_end).collect();
    let answer = trimmed.join("\n");
    let mut rest = answer.trim();
    let pieces: Vec<&str> = expected.split('…').map(|p| p.trim_matches('\n')).collect();
    for (index, piece) in pieces.iter().enumerate() {
        let Some(at) = rest.find(piece) else {
            return false;
        };
        if index == 0 && at != 0 {
            return false;
        }
        rest = &rest[at + piece.len()..];
    }
    rest.is_empty() || expected.ends_with('…')
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
