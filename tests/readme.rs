//! The commands of the README run as they stand there, those that take long left out.

use crate::support::{landau, root};
use std::fs;

/// The lines of the block that begins with a line.
fn block<'p>(page: &'p str, first: &str) -> Vec<&'p str> {
    let lines = page.lines().skip_while(|line| !line.starts_with(first));
    lines.take_while(|line| !line.starts_with("```")).collect()
}

#[test]
fn commands_of_the_readme() {
    let page = fs::read_to_string(root().join("README.md")).expect("the page");
    let lines = block(&page, "landau models");
    assert!(lines.len() > 12);
    let folder = tempfile::tempdir().expect("a folder");
    // A study and the sweep of a plane take minutes; a spec of the reader's own is not there.
    let is_cheap = |line: &&str| {
        !["reproduce", "--over S=", "my.model", "--order 7"]
            .iter()
            .any(|part| line.contains(part))
    };
    let mut count = 0;
    for line in lines.into_iter().filter(is_cheap) {
        let command = line.split(" #").next().unwrap_or_default();
        let mut words: Vec<String> = command
            .split_whitespace()
            .skip(1)
            .map(str::to_owned)
            .collect();
        for index in 1..words.len() {
            if ["--out", "--plot"].contains(&words[index - 1].as_str()) {
                words[index] = folder.path().join(&words[index]).display().to_string();
            }
        }
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        let answer = landau(&words);
        assert_eq!(answer.status, 0, "{line}: {}", answer.err);
        assert!(!answer.out.is_empty(), "{line}");
        count += 1;
    }
    assert!(count >= 12, "{count}");
}
