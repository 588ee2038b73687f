//! What a task of a study gives: pictures, tables, arrays, numbers.

use serde::{Deserialize, Deserializer, Serialize};

/// One number beside the printed one.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Number {
    pub figure: String,
    pub quantity: String,
    pub ours: Option<f64>,
    pub printed: Option<f64>,
    pub note: String,
}

/// A table that is shown, and written as CSV.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Table {
    pub header: Vec<String>,
    #[serde(deserialize_with = "with_gaps")]
    pub rows: Vec<Vec<f64>>,
}

/// A picture with the data it was drawn from.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Picture {
    pub caption: String,
    pub svg: String,
    pub table: Option<Table>,
    /// Files that stand beside it already, by name.
    pub files: Vec<String>,
}

/// Everything that a figure consists of.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Outcome {
    pub pictures: Vec<Picture>,
    pub numbers: Vec<Number>,
    /// What did not come out, in a sentence.
    pub failures: Vec<String>,
}

impl Outcome {
    /// Files that the pictures came with.
    pub fn files(&self) -> impl Iterator<Item = &String> {
        self.pictures.iter().flat_map(|picture| &picture.files)
    }

    pub fn add(&mut self, other: Outcome) {
        self.pictures.extend(other.pictures);
        self.numbers.extend(other.numbers);
        self.failures.extend(other.failures);
    }
}

impl Table {
    pub fn new(header: &[&str]) -> Self {
        let header = header.iter().map(|h| (*h).to_owned()).collect();
        let rows = Vec::new();
        Table { header, rows }
    }

    /// Comma-separated, empty where there is no value.
    pub fn csv(&self) -> String {
        let mut text = self.header.join(",") + "\n";
        for row in &self.rows {
            let cells: Vec<String> = row
                .iter()
                .map(|v| {
                    if v.is_finite() {
                        format!("{v:e}")
                    } else {
                        String::new()
                    }
                })
                .collect();
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
