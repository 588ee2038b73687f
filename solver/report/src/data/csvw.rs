//! What a table's columns are, in a file beside it: CSV on the Web (W3C 2015), `NAME.csv-metadata.json`.

use landau_solver::error::Result;
use landau_solver::file::write_whole;
use landau_solver::study::row;
use serde_json::{Map, Value, json};
use std::path::Path;

/// The name of the description of a table.
pub fn beside(csv: &str) -> String {
    format!("{csv}-metadata.json")
}

/// What a column of a report's table or of a sweep is.
pub fn meaning(name: &str) -> String {
    if let Some(text) = row::meaning(name) {
        return text.to_owned();
    }
    let text = match name {
        "case" => "position of the case in the study, from 1",
        "label" => "label of the case",
        "question" => "position of the question in the task, from 1",
        "value" => "where the critical point lies",
        "error" => "absolute error of the value",
        "M" => "highest degree of the Chebyshev polynomials",
        "k" => "wavenumber",
        "L" => "growth rate of the leading mode, by L",
        "L†" => "the same by the continuous adjoint",
        "difference" => "modulus of the difference of the two eigenvalues",
        "a0" => "growth rate, Re c0",
        "a2" => "Re c2",
        "A_e" => "equilibrium amplitude",
        "circulation" => "circulation around the square",
        name => name,
    };
    text.to_owned()
}

/// The description of a table: its title, its columns in order (those of words named), and facts about the whole.
pub fn describe(
    csv: &str,
    title: &str,
    columns: &[(&str, Datatype)],
    facts: &[(String, Value)],
) -> String {
    let column = |(name, datatype): &(&str, Datatype)| {
        json!({
            "titles": name,
            "dc:description": meaning(name),
            "datatype": datatype.name(),
            "null": "",
        })
    };
    let mut table = json!({
        "@context": "http://www.w3.org/ns/csvw",
        "url": csv,
        "dc:title": title,
        "dialect": { "header": true },
        "tableSchema": { "columns": columns.iter().map(column).collect::<Vec<Value>>() },
    });
    for (name, value) in facts {
        table[format!("landau:{name}")] = value.clone();
    }
    format!("{table:#}\n")
}

/// The description of a sweep's table: its columns, and what the numbers were computed from, `title` among them.
fn describe_sweep<'h>(
    csv: &str,
    header: impl Iterator<Item = &'h str>,
    facts: &Map<String, Value>,
) -> String {
    let columns: Vec<(&str, Datatype)> = header
        .map(|name| match name {
            "bifurcation" | "status" => (name, Datatype::Text),
            name => (name, Datatype::Number),
        })
        .collect();
    let title = facts
        .get("title")
        .and_then(Value::as_str)
        .unwrap_or_default();
    let facts: Vec<(String, Value)> = facts
        .iter()
        .filter(|(name, _)| *name != "title")
        .map(|(name, value)| (name.clone(), value.clone()))
        .collect();
    describe(csv, title, &columns, &facts)
}

/// Writes the description of a sweep's table beside it.
///
/// # Errors
/// A folder that cannot be written to.
pub fn write_beside<'h>(
    table: &Path,
    header: impl Iterator<Item = &'h str>,
    facts: &Map<String, Value>,
) -> Result<()> {
    let name = table.file_name().unwrap_or_default().to_string_lossy();
    let path = table.with_file_name(beside(&name));
    write_whole(&path, describe_sweep(&name, header, facts).as_bytes())
}

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Datatype {
    /// Floating-point numbers.
    Number,
    /// Words.
    Text,
}

impl Datatype {
    fn name(self) -> &'static str {
        match self {
            Datatype::Number => "double",
            Datatype::Text => "string",
        }
    }
}
