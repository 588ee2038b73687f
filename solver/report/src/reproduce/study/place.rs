//! Where in the file a mistake is: at the key itself, not at the table that holds it.

use std::ops::Range;

/// A message with the line that it is about, as the reader of TOML writes it.
pub(super) fn pointed(text: &str, range: Range<usize>, message: &str) -> String {
    let before = &text[..range.start];
    let line = before.matches('\n').count() + 1;
    let start = before.rfind('\n').map_or(0, |at| at + 1);
    let column = text[start..range.start].chars().count() + 1;
    let shown = text[start..].lines().next().unwrap_or_default();
    let marks = "^".repeat(text[range].chars().count().max(1));
    let (number, gap) = (line.to_string(), " ".repeat(column - 1));
    let bar = " ".repeat(number.len());
    format!(
        "TOML parse error at line {line}, column {column}\n{bar} |\n{number} | {shown}\n{bar} | {gap}{marks}\n{message}\n"
    )
}

/// A mistake that the reader of TOML finds, at its own key where it only knows the table.
pub(super) fn refined(text: &str, error: &toml::de::Error) -> String {
    let header = error
        .span()
        .filter(|span| text[span.clone()].starts_with('['));
    // The reader knows the first table of a list, or the one itself.
    let found = header.and_then(|span| {
        let within = |end: usize| {
            let table = span.start..end;
            let key = named(text, table.clone(), error.message());
            key.or_else(|| written(text, table, error.message()))
        };
        let (own, list) = table_ends(text, span.start);
        within(own).or_else(|| within(list))
    });
    match found {
        Some(range) => pointed(text, range, error.message()),
        None => error.to_string(),
    }
}

/// The end of a table with its own tables, where the next of its kind begins, and of the list, where one above does.
fn table_ends(text: &str, start: usize) -> (usize, usize) {
    let depth = |line: &str| line.matches('.').count();
    let mut at = start;
    let mut lines = text[start..].split_inclusive('\n');
    let header = lines.next().unwrap_or_default();
    at += header.len();
    let mut own = None;
    for line in lines {
        if line.starts_with('[') && depth(line) <= depth(header) {
            own = own.or(Some(at));
            if depth(line) < depth(header) {
                return (own.unwrap_or(at), at);
            }
        }
        at += line.len();
    }
    (own.unwrap_or(text.len()), text.len())
}

/// The key that a message names: unknown field `colums`.
fn named(text: &str, table: Range<usize>, message: &str) -> Option<Range<usize>> {
    let key = message.strip_prefix("unknown field `")?.split('`').next()?;
    place_of_key(text, table, key)
}

/// The value that a message quotes: invalid type: integer `3`, or string "abc".
fn written(text: &str, table: Range<usize>, message: &str) -> Option<Range<usize>> {
    let rest = message.strip_prefix("invalid type: ")?;
    let value = match rest.split_once('`') {
        Some((_, quoted)) => quoted.split('`').next()?.to_owned(),
        None => format!("\"{}\"", rest.split('"').nth(1)?),
    };
    let at = text[table.clone()].find(&format!("= {value}"))? + table.start + 2;
    Some(at..at + value.len())
}

/// A key of a table, or of one in braces: where it is given a value.
pub(super) fn place_of_key(text: &str, table: Range<usize>, key: &str) -> Option<Range<usize>> {
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

/// The n-th place, from 1, at which a text stands.
pub(super) fn occurrence(text: &str, what: &str, number: usize) -> Option<Range<usize>> {
    let (at, _) = text.match_indices(what).nth(number.checked_sub(1)?)?;
    Some(at..at + what.len())
}

#[cfg(test)]
mod tests {
    use super::{place_of_key, pointed};

    #[test]
    fn mistakes_are_pointed_at() {
        let text = "a = 1\n[[b]]\ncount = 3\nover = { count = 0 }\n";
        let table = text.find("over").expect("there")..text.len();
        let place = place_of_key(text, table, "count").expect("found");
        assert_eq!(
            pointed(text, place, "no"),
            "TOML parse error at line 4, column 10\n  |\n4 | over = { count = 0 }\n  |          ^^^^^\nno\n"
        );
    }
}
