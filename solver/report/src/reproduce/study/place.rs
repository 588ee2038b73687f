//! Where in the file a mistake is: at the key itself, not at the table that holds it.

use std::ops::Range;
use toml::de::{DeTable, DeValue};

/// Characters of a line that are shown, around the mistake.
const SHOWN: usize = 120;
/// Lines of a message, and characters of each.
const LINES: usize = 60;
const LINE: usize = 600;

/// A step into a file: a key, or a position in a list.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::reproduce) enum Step {
    Key(String),
    At(usize),
}

/// A mistake, and where it stands: steps from the top of the file.
#[derive(Clone, Debug)]
pub(in crate::reproduce) struct Mistake {
    pub steps: Vec<Step>,
    pub message: String,
}

/// A mistake with its line: at the deepest of its steps that the file has.
pub(in crate::reproduce) fn pointed_at(text: &str, mistake: &Mistake) -> String {
    match located(text, &mistake.steps) {
        Some(range) => pointed(text, range, &mistake.message),
        None => bounded(&mistake.message),
    }
}

/// The part of the file at which steps end, or at which they leave what is written.
fn located(text: &str, steps: &[Step]) -> Option<Range<usize>> {
    let top = DeTable::parse(text).ok()?;
    let (first, deeper) = steps.split_first()?;
    let Step::Key(key) = first else { return None };
    let (key, mut value) = top.get_ref().get_key_value(key.as_str())?;
    let mut range = key.span();
    for step in deeper {
        let next = match (step, value.get_ref()) {
            (Step::Key(key), DeValue::Table(table)) => {
                let entry = table.get_key_value(key.as_str());
                entry.map(|(key, value)| (key.span(), value))
            }
            (Step::At(index), DeValue::Array(list)) => {
                list.get(*index).map(|value| (value.span(), value))
            }
            _ => None,
        };
        let Some((span, deeper)) = next else { break };
        (range, value) = (span, deeper);
    }
    Some(range)
}

/// A message with the line that it is about, both of bounded length.
pub(super) fn pointed(text: &str, range: Range<usize>, message: &str) -> String {
    let before = &text[..range.start];
    let line = before.matches('\n').count() + 1;
    let start = before.rfind('\n').map_or(0, |at| at + 1);
    let column = text[start..range.start].chars().count();
    let whole = text[start..].lines().next().unwrap_or_default();
    let length = whole.chars().count();
    // A window of the line, the mistake inside.
    let first = if length <= SHOWN {
        0
    } else {
        column.saturating_sub(SHOWN / 3)
    };
    let printable = |c: char| if c.is_control() { '\u{fffd}' } else { c };
    let window: String = whole
        .chars()
        .skip(first)
        .take(SHOWN)
        .map(printable)
        .collect();
    let lead = if first > 0 { "…" } else { "" };
    let tail = if first + SHOWN < length { "…" } else { "" };
    let room = (SHOWN + first - column).max(1);
    let within = text[range].lines().next().unwrap_or_default();
    let marks = "^".repeat(within.chars().count().clamp(1, room));
    let gap = " ".repeat(lead.chars().count() + column - first);
    let number = line.to_string();
    let bar = " ".repeat(number.len());
    format!(
        "line {line}, column {}\n{bar} |\n{number} | {lead}{window}{tail}\n{bar} | {gap}{marks}\n{}\n",
        column + 1,
        bounded(message)
    )
}

/// A message of any length, with lines of bounded length and a bounded number of them.
pub(super) fn bounded(message: &str) -> String {
    let lines: Vec<&str> = message.lines().collect();
    let mut short: Vec<String> = lines.iter().take(LINES).map(|line| cut(line)).collect();
    if lines.len() > LINES {
        short.push(format!("… ({} more lines)", lines.len() - LINES));
    }
    short.join("\n")
}

/// A line, its middle left out where it is long.
fn cut(line: &str) -> String {
    let length = line.chars().count();
    if length <= LINE {
        return line.to_owned();
    }
    let start: String = line.chars().take(LINE / 2).collect();
    let end: String = line.chars().skip(length - LINE / 3).collect();
    format!("{start} … {end}")
}

/// A mistake that the reader of TOML finds, at its own key where it only knows the table.
pub(in crate::reproduce) fn refined(text: &str, error: &toml::de::Error) -> String {
    let header = error
        .span()
        .filter(|span| text[span.clone()].starts_with('['));
    // The reader knows the first table of a list, or the one itself.
    let key = header.and_then(|span| {
        let within = |end: usize| {
            let table = span.start..end;
            let key = named(text, table.clone(), error.message());
            key.or_else(|| written(text, table, error.message()))
        };
        let (table, list) = table_ends(text, span.start);
        within(table).or_else(|| within(list))
    });
    // The reader names types of numbers as the program does.
    let message = error
        .message()
        .replace("expected usize", "expected a whole number")
        .replace("expected f64", "expected a number");
    match key.or_else(|| error.span()) {
        Some(range) => pointed(text, range, &message),
        None => bounded(&message),
    }
}

/// The end of a table with its own tables, where the next of its kind begins, and of the list, where one above does.
fn table_ends(text: &str, start: usize) -> (usize, usize) {
    let depth = |line: &str| line.matches('.').count();
    let mut at = start;
    let mut lines = text[start..].split_inclusive('\n');
    let header = lines.next().unwrap_or_default();
    at += header.len();
    let mut table = None;
    for line in lines {
        if line.starts_with('[') && depth(line) <= depth(header) {
            table = table.or(Some(at));
            if depth(line) < depth(header) {
                return (table.unwrap_or(at), at);
            }
        }
        at += line.len();
    }
    (table.unwrap_or(text.len()), text.len())
}

/// The key that a message names: unknown field `colums`.
fn named(text: &str, table: Range<usize>, message: &str) -> Option<Range<usize>> {
    let key = message.strip_prefix("unknown field `")?.split('`').next()?;
    place_of_key(text, table, key)
}

/// The value that a message quotes: invalid type: integer `3`, or string "abc".
fn written(text: &str, table: Range<usize>, message: &str) -> Option<Range<usize>> {
    let quoted = message.strip_prefix("invalid type: ");
    let quoted = quoted.or_else(|| message.strip_prefix("invalid value: "))?;
    let value = match quoted.split_once('`') {
        Some((_, value)) => value.split('`').next()?.to_owned(),
        None => format!("\"{}\"", quoted.split('"').nth(1)?),
    };
    let at = text[table.clone()].find(&format!("= {value}"))? + table.start + 2;
    Some(at..at + value.len())
}

/// A key of a table, or of one in braces: where it is given a value.
fn place_of_key(text: &str, table: Range<usize>, key: &str) -> Option<Range<usize>> {
    let inside = &text[table.clone()];
    let mut places = inside.match_indices(key).filter(|(at, _)| {
        let before = inside[..*at].chars().next_back();
        let after = inside[at + key.len()..].trim_start();
        let starts = before.is_none_or(|c| c.is_whitespace() || c == '{' || c == '.');
        starts && (after.starts_with('=') || after.starts_with(']'))
    });
    let (at, _) = places.next()?;
    Some(table.start + at..table.start + at + key.len())
}

#[cfg(test)]
mod tests {
    use super::{Mistake, Step, place_of_key, pointed, pointed_at};

    #[test]
    fn mistakes_are_pointed_at() {
        let text = "a = 1\n[[b]]\ncount = 3\nover = { count = 0 }\n";
        let table = text.find("over").expect("there")..text.len();
        let place = place_of_key(text, table, "count").expect("a key");
        let expected = "line 4, column 10\n  |\n4 | over = { count = 0 }\n  |          ^^^^^\nno\n";
        assert_eq!(pointed(text, place, "no"), expected);
        let key = |key: &str| Step::Key(key.to_owned());
        let mistake = |steps: &[Step]| Mistake {
            steps: steps.to_vec(),
            message: "no".to_owned(),
        };
        let steps = [key("b"), Step::At(0), key("over"), key("count")];
        assert_eq!(pointed_at(text, &mistake(&steps)), expected);
        // A key that is missing is pointed at where it would stand.
        let steps = [key("b"), Step::At(0), key("k")];
        assert!(pointed_at(text, &mistake(&steps)).starts_with("line 2, "));
        assert_eq!(pointed_at(text, &mistake(&[key("z")])), "no");
    }

    /// A line of any length is shown in part, with the mistake in it.
    #[test]
    fn lines_are_shown_in_part() {
        let text = format!(
            "a = [{}9, {}1]\n",
            "1, ".repeat(20_000),
            "1, ".repeat(20_000)
        );
        let at = text.find('9').expect("there");
        let shown = pointed(&text, at..at + 1, &"m".repeat(60_000));
        assert!(shown.len() < 2_000, "{}", shown.len());
        let lines: Vec<&str> = shown.lines().collect();
        let mark = lines[3].chars().position(|c| c == '^').expect("a mark");
        assert_eq!(lines[2].chars().nth(mark), Some('9'), "{shown}");
    }
}
