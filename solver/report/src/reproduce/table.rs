//! Tables of a report: shown by pictures, written as CSV, described beside it.

use super::study::Study;
use crate::data::csvw::{self, Datatype, cell};
use serde::{Deserialize, Deserializer, Serialize};
use serde_json::Value;

/// A table that is shown, and written as CSV.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Table {
    /// Names of the columns of numbers.
    pub header: Vec<String>,
    /// Numbers; a gap is not finite.
    #[serde(deserialize_with = "with_gaps")]
    pub rows: Vec<Vec<f64>>,
    /// Columns of words after those, by name.
    #[serde(default)]
    pub words: Vec<(String, Vec<String>)>,
    /// What each case was computed from: model, parameters, k, M, normalisation.
    #[serde(default)]
    pub cases: Vec<Value>,
}

impl Table {
    /// Without rows.
    pub fn new(header: &[&str]) -> Self {
        Table {
            header: header.iter().map(|h| (*h).to_owned()).collect(),
            rows: Vec::new(),
            words: Vec::new(),
            cases: Vec::new(),
        }
    }

    /// The same with columns of words.
    pub fn with_words(mut self, names: &[&str]) -> Self {
        let column = |name: &&str| ((*name).to_owned(), Vec::new());
        self.words = names.iter().map(column).collect();
        self
    }

    /// Adds a row with its words.
    pub fn push(&mut self, numbers: Vec<f64>, words: &[&str]) {
        self.rows.push(numbers);
        for ((_, column), word) in self.words.iter_mut().zip(words) {
            column.push((*word).to_owned());
        }
    }

    /// What its columns are, for the file beside its CSV.
    pub fn metadata(&self, csv: &str, title: &str, study: &Study) -> String {
        let numbers = self
            .header
            .iter()
            .map(|name| (name.as_str(), Datatype::Number));
        let words = self
            .words
            .iter()
            .map(|(name, _)| (name.as_str(), Datatype::Text));
        let columns: Vec<(&str, Datatype)> = numbers.chain(words).collect();
        let text = |value: &str| Value::String(value.to_owned());
        let facts = [
            ("study", text(&study.title)),
            ("source", text(&study.source)),
            ("version", text(env!("CARGO_PKG_VERSION"))),
            ("cases", Value::Array(self.cases.clone())),
        ];
        let facts = facts.map(|(name, value)| (name.to_owned(), value));
        csvw::describe(csv, title, &columns, &facts)
    }

    /// Comma-separated, empty where there is no value; words in quotation marks where they need them.
    pub fn csv(&self) -> String {
        let words = self.words.iter().map(|(name, _)| name);
        let header: Vec<String> = self
            .header
            .iter()
            .chain(words)
            .map(|name| cell(name))
            .collect();
        let mut text = header.join(",") + "\n";
        for (index, row) in self.rows.iter().enumerate() {
            let number = |v: &f64| {
                if v.is_finite() {
                    format!("{v:e}")
                } else {
                    String::new()
                }
            };
            let mut cells: Vec<String> = row.iter().map(number).collect();
            let words = self
                .words
                .iter()
                .filter_map(|(_, column)| column.get(index));
            cells.extend(words.map(|word| cell(word)));
            text += &(cells.join(",") + "\n");
        }
        text
    }
}

/// Rows as JSON keeps them: what is not a finite number comes back from `null`.
fn with_gaps<'d, D: Deserializer<'d>>(input: D) -> Result<Vec<Vec<f64>>, D::Error> {
    let rows = Vec::<Vec<Option<f64>>>::deserialize(input)?;
    let filled = |row: Vec<Option<f64>>| row.into_iter().map(|v| v.unwrap_or(f64::NAN)).collect();
    Ok(rows.into_iter().map(filled).collect())
}

#[cfg(test)]
mod tests {
    use super::Table;

    #[test]
    fn words_in_a_table() {
        let mut table = Table::new(&["k", "-T at lower"]).with_words(&["status"]);
        table.push(vec![0.5, 1.0], &["ok"]);
        table.push(vec![f64::NAN, 2.0], &["lost, again"]);
        table.push(vec![1.0, 3.0], &["=1+1\u{7}"]);
        assert_eq!(
            table.csv(),
            "k,'-T at lower,status\n5e-1,1e0,ok\n,2e0,\"lost, again\"\n1e0,3e0,'=1+1\u{fffd}\n"
        );
    }
}
