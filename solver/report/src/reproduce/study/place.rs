//! Where in the file a mistake is: at the key itself, not at the table that holds it.

use super::read::accepted;
use landau_solver::words::{counted, shown_path};
use std::ops::Range;
use std::path::Path;
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

impl Mistake {
    /// The mistake at the deepest of its steps that the file has.
    pub fn fault(&self, text: &str) -> Fault {
        Fault {
            range: located(text, &self.steps),
            message: self.message.clone(),
        }
    }
}

/// A mistake at a part of a text.
#[derive(Debug)]
pub(in crate::reproduce) struct Fault {
    pub range: Option<Range<usize>>,
    pub message: String,
}

impl Fault {
    /// In words: the file with line and column, the line, the message.
    pub fn pointed(self, file: &Path, text: &str) -> String {
        let file = shown_path(file);
        match self.range {
            Some(range) => format!("{file}:{}", pointed(text, range, &self.message)),
            None => format!("{file}: {}", bounded(&self.message)),
        }
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

/// Line, column and a message with the line that it is about, both of bounded length.
fn pointed(text: &str, range: Range<usize>, message: &str) -> String {
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
        "{line}:{}\n{bar} |\n{number} | {lead}{window}{tail}\n{bar} | {gap}{marks}\n{}\n",
        column + 1,
        bounded(message)
    )
}

/// A message of any length, with lines of bounded length and a bounded number of them.
fn bounded(message: &str) -> String {
    let lines: Vec<&str> = message.lines().collect();
    let mut short: Vec<String> = lines.iter().take(LINES).map(|line| cut(line)).collect();
    if lines.len() > LINES {
        short.push(format!("… ({} more)", counted(lines.len() - LINES, "line")));
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

/// A mistake that the reader of TOML finds, at its own key where it only knows the table, with the name of the key.
pub(in crate::reproduce) fn fault_of(text: &str, error: &toml::de::Error) -> Fault {
    let header = error
        .span()
        .filter(|span| text[span.clone()].starts_with("[["));
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
    let range = key.or_else(|| error.span());
    let message = in_words(error.message());
    let message = match &range {
        Some(range) => with_key(text, range, &message),
        None => message,
    };
    Fault { range, message }
}

/// What the reader of TOML says, in the words of a study: it names types as the program does.
fn in_words(message: &str) -> String {
    let untagged = [
        (
            "untagged enum Together",
            "no column: `columns` accepts columns in brackets; those of one panel in brackets of their own",
        ),
        ("untagged enum Drawn", "no column: it accepts a text"),
        (
            "untagged enum Written",
            "no printed number: it accepts a number, or a text with its digits such as \"0.1790\"",
        ),
    ];
    if let Some((_, words)) = untagged.iter().find(|(name, _)| message.contains(name)) {
        return (*words).to_owned();
    }
    message
        .replace("expected usize", "expected a whole number")
        .replace("expected f64", "expected a number")
}

/// A message with the name of the key that it is about, and what this key accepts.
fn with_key(text: &str, range: &Range<usize>, message: &str) -> String {
    if message == "duplicate key" {
        let key = text[range.clone()].trim();
        return format!("the key `{key}` stands twice in one table");
    }
    if let Some(key) = message.strip_prefix("missing field `") {
        let key = key.trim_end_matches('`');
        let accepted = accepted(key).map_or(String::new(), |words| format!(": it accepts {words}"));
        return format!("`{key}` is missing{accepted}");
    }
    let Ok(top) = DeTable::parse(text) else {
        return message.to_owned();
    };
    match key_of(top.get_ref(), range) {
        Some(key) if !message.contains(&format!("`{key}`")) => {
            let accepted = accepted(&key).filter(|_| message.starts_with("invalid"));
            let accepted = accepted.filter(|words| !message.contains(*words));
            let accepted = accepted.map_or(String::new(), |words| format!("; it accepts {words}"));
            format!("`{key}`: {message}{accepted}")
        }
        _ => message.to_owned(),
    }
}

/// The key whose value stands there, or holds what stands there.
fn key_of(table: &DeTable, range: &Range<usize>) -> Option<String> {
    fn within(value: &toml::Spanned<DeValue>, range: &Range<usize>) -> Option<Option<String>> {
        let here = value.span() == *range;
        match value.get_ref() {
            _ if here => Some(None),
            DeValue::Array(list) => list.iter().find_map(|value| within(value, range)),
            DeValue::Table(table) => key_of(table, range).map(Some),
            _ => None,
        }
    }
    table.iter().find_map(|(key, value)| {
        let deeper = within(value, range)?;
        Some(deeper.unwrap_or_else(|| key.get_ref().to_string()))
    })
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
    use super::{Mistake, Step, place_of_key, pointed};
    use std::path::Path;

    #[test]
    fn mistakes_are_pointed_at() {
        let text = "a = 1\n[[b]]\ncount = 3\nover = { count = 0 }\n";
        let table = text.find("over").expect("there")..text.len();
        let place = place_of_key(text, table, "count").expect("a key");
        let expected = "4:10\n  |\n4 | over = { count = 0 }\n  |          ^^^^^\nno\n";
        assert_eq!(pointed(text, place, "no"), expected);
        let key = |key: &str| Step::Key(key.to_owned());
        let mistake = |steps: &[Step]| Mistake {
            steps: steps.to_vec(),
            message: "no".to_owned(),
        };
        let steps = [key("b"), Step::At(0), key("over"), key("count")];
        let pointed_at = |steps: &[Step]| mistake(steps).fault(text).pointed(Path::new("f"), text);
        assert_eq!(pointed_at(&steps), format!("f:{expected}"));
        // A key that is missing is pointed at where it would stand.
        let steps = [key("b"), Step::At(0), key("k")];
        assert!(pointed_at(&steps).starts_with("f:2:"));
        assert_eq!(pointed_at(&[key("z")]), "f: no");
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
