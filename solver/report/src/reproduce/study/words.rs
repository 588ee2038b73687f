//! Texts of a study that no page, picture or table could show.

use super::place::Fault;
use super::read::accepted;
use crate::is_shown;
use std::ops::Range;
use toml::de::{DeTable, DeValue};

/// Keys whose texts are prose: of any length, over several lines.
const PROSE: [&str; 10] = [
    "text",
    "introduction",
    "note",
    "says",
    "quote",
    "latex",
    "right",
    "why",
    "printed",
    "derived",
];
/// Those of them that are LaTeX as a whole.
const FORMULAS: [&str; 2] = ["latex", "right"];
/// Characters of any other text.
const LONGEST: usize = 1000;
/// Keys whose texts start a cell of a table: a spreadsheet takes some for formulas.
const CELLS: [&str; 2] = ["label", "name"];

/// Refuses dates, control characters, marks that turn the direction of a text, and labels that a spreadsheet computes.
///
/// # Errors
/// Where, and what is accepted. What is no TOML at all is left to its reader.
pub(in crate::reproduce) fn check(text: &str) -> Result<(), Fault> {
    let Ok(table) = DeTable::parse(text) else {
        return Ok(());
    };
    let mut wrong: Vec<(Range<usize>, String)> = Vec::new();
    walk(table.get_ref(), &mut wrong);
    // The first of the file, whatever the order of its keys.
    wrong.sort_by_key(|(range, _)| range.start);
    match wrong.into_iter().next() {
        None => Ok(()),
        Some((range, message)) => Err(Fault {
            range: Some(range),
            message,
        }),
    }
}

fn walk(table: &DeTable, wrong: &mut Vec<(Range<usize>, String)>) {
    for (key, value) in table {
        if let Err(message) = shown(key.get_ref(), false) {
            wrong.push((key.span(), message));
        }
        below(key.get_ref(), value.get_ref(), value.span(), wrong);
    }
}

fn below(key: &str, value: &DeValue, span: Range<usize>, wrong: &mut Vec<(Range<usize>, String)>) {
    match value {
        DeValue::String(text) => {
            if let Err(message) = said(key, text) {
                wrong.push((span, format!("{key}: {message}")));
            }
        }
        DeValue::Array(list) => {
            for value in list {
                below(key, value.get_ref(), value.span(), wrong);
            }
        }
        DeValue::Table(table) => walk(table, wrong),
        DeValue::Datetime(date) => {
            let accepted = accepted(key).unwrap_or("numbers, or texts in quotation marks");
            wrong.push((
                span,
                format!("{key} = {date}: this is a date; `{key}` accepts {accepted}"),
            ));
        }
        _ => {}
    }
}

/// Whether the text of a key can be shown.
fn said(key: &str, text: &str) -> Result<(), String> {
    let prose = PROSE.contains(&key);
    shown(text, prose)?;
    if !prose && text.chars().count() > LONGEST {
        return Err(format!("it accepts at most {LONGEST} characters"));
    }
    if CELLS.contains(&key) && text.starts_with(['=', '+', '-', '@']) {
        return Err(format!(
            "`{text}` begins as a formula of a spreadsheet does: it accepts texts that do not begin with =, +, - or @ \
             (− is a minus sign)"
        ));
    }
    // In a formula a line may end so; between dollar signs stands one.
    let mut outside = text.split('$').step_by(2);
    if prose && !FORMULAS.contains(&key) && outside.any(|part| part.contains("\\\n")) {
        return Err(
            "a backslash stands at the end of a line: one alone joins two lines, \\\\ is a backslash"
                .to_owned(),
        );
    }
    Ok(())
}

/// Whether every character of a text can be shown; prose has lines.
fn shown(text: &str, prose: bool) -> Result<(), String> {
    match text
        .chars()
        .find(|&c| !(is_shown(c) || prose && matches!(c, '\n' | '\t' | '\r')))
    {
        None => Ok(()),
        Some(c) => Err(format!(
            "the character U+{:04X} cannot be shown: texts accept neither control characters nor marks that turn the \
             direction of writing",
            u32::from(c)
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::check;

    #[test]
    fn what_cannot_be_shown_is_refused() {
        for (text, refused) in [
            ("title = \"a\\u0007b\"", "U+0007"),
            ("title = \"a\\u202Eb\"", "U+202E"),
            ("a = [{ label = \"x\\u0000\" }]", "U+0000"),
            ("title = \"two\\nlines\"", "U+000A"),
            ("label = \"=1+1\"", "spreadsheet"),
            (
                "between = [0.1, 2024-01-01]",
                "between = 2024-01-01: this is a date; `between` accepts two numbers, the lower first",
            ),
            ("[printed]\n\"a\\u001b\" = 1", "U+001B"),
            ("text = \"\"\"\npasses \\\\\nthrough\"\"\"", "backslash"),
        ] {
            let message = check(text).expect_err(text).message;
            assert!(message.contains(refused), "{message}");
        }
        for text in [
            "text = \"\"\"two\nlines $\\\\alpha$\"\"\"",
            "label = \"−1: S = 100, é, κ, Ra_c\"",
            "latex = '''a \\\\\nb'''",
        ] {
            assert!(check(text).is_ok());
        }
    }
}
