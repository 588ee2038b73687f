//! What a table's columns are, in a file beside it: CSV on the Web (W3C 2015), `NAME.csv-metadata.json`.

use landau_solver::file::seal::{BLANK, sealed};
use landau_solver::study::row::{self, Table};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

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
            "titles": plain_text(name),
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

/// Key of what a table was computed from, for machines.
pub const SWEEP: &str = "landau:sweep";
/// Key of the hash of a table.
pub const TABLE: &str = "landau:table";

/// Where the description of a table stands.
pub fn path_beside(table: &Path) -> PathBuf {
    let mut name = table.file_name().unwrap_or_default().to_os_string();
    name.push("-metadata.json");
    table.with_file_name(name)
}

/// The description of a sweep's table, sealed: its columns, and what the numbers were computed from. `hash` is that of the
/// table.
pub fn describe_sweep(path: &Path, table: &Table, hash: &str) -> Vec<u8> {
    let csv = path.file_name().unwrap_or_default().to_string_lossy();
    let columns: Vec<(&str, Datatype)> = table
        .header
        .iter()
        .map(|name| match name.as_str() {
            "bifurcation" | "status" => (name.as_str(), Datatype::Text),
            name => (name, Datatype::Number),
        })
        .collect();
    let title = table.facts.get("title").and_then(Value::as_str);
    let facts = table.facts.iter().filter(|(name, _)| *name != "title");
    let mut facts: Vec<(String, Value)> = facts
        .map(|(name, value)| (name.clone(), value.clone()))
        .collect();
    facts.extend([
        ("sweep".to_owned(), json!(table.sweep)),
        ("table".to_owned(), json!(hash)),
        ("seal".to_owned(), json!(BLANK)),
    ]);
    sealed(describe(&csv, title.unwrap_or_default(), &columns, &facts).into_bytes())
}

/// A text as a cell of a CSV: in quotation marks where it needs them.
pub fn cell(text: &str) -> String {
    let text = plain_text(text);
    if text.contains([',', '"', '\n']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text
    }
}

/// A text that a spreadsheet takes for one, without control characters: what begins as a formula does gets an apostrophe.
fn plain_text(text: &str) -> String {
    let text = crate::shown(text);
    if text.starts_with(['=', '+', '-', '@']) {
        format!("'{text}")
    } else {
        text
    }
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
