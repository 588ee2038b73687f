//! What a task of a study gives: pictures, tables, numbers, verdicts on statements.

use super::study::{Case, Printed, Study, named};
use crate::data::csvw::{self, Datatype};
use serde::{Deserialize, Deserializer, Serialize};

/// One number beside the printed one.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Number {
    /// The figure that it belongs to.
    pub figure: String,
    /// The case, and what it is.
    pub quantity: String,
    /// The case alone.
    #[serde(default)]
    pub case: String,
    /// What it is, alone.
    #[serde(default)]
    pub name: String,
    /// The statement that it decides.
    #[serde(default)]
    pub decides: Option<String>,
    /// Nothing where it did not come out.
    pub ours: Option<f64>,
    /// Absolute error of ours.
    pub error: Option<f64>,
    /// What the source has.
    pub printed: Option<f64>,
    /// The same with its own digits.
    pub printed_as: Option<String>,
    /// `ok`, or why there is no number.
    pub status: String,
    /// A sentence beside it.
    pub note: String,
}

impl Number {
    /// Whether both are one number: a point marked in one picture and asked for beside another.
    fn is(&self, other: &Number) -> bool {
        let free = self.decides.is_none() && other.decides.is_none();
        let same = self.figure == other.figure && self.quantity == other.quantity;
        free && same
            && self.ours == other.ours
            && (self.printed.is_none() || other.printed.is_none())
    }

    /// A number of a case, by the name under which the source may print it.
    pub fn new(figure: &str, case: &Case, quantity: &str, label: String) -> Self {
        let printed = case.printed.get(quantity);
        Number {
            figure: figure.to_owned(),
            quantity: label,
            case: case.label.clone(),
            name: quantity.to_owned(),
            decides: None,
            ours: None,
            error: None,
            printed: printed.map(|p| p.value),
            printed_as: printed.map(|p| p.text.clone()),
            status: "did not come out".to_owned(),
            note: case.note.clone(),
        }
    }

    /// The same with its value.
    pub fn answered(self, ours: f64, error: Option<f64>) -> Self {
        let status = match ours.is_finite() {
            true => "ok".to_owned(),
            false => "no value".to_owned(),
        };
        Number {
            ours: Some(ours).filter(|x| x.is_finite()),
            error,
            status,
            ..self
        }
    }

    /// The same without one, and why.
    pub fn failed(self, reason: &str) -> Self {
        Number {
            status: reason.to_owned(),
            ..self
        }
    }

    /// The difference in units of the last printed digit.
    pub fn units(&self) -> Option<f64> {
        let printed = Printed {
            value: self.printed?,
            text: self.printed_as.clone()?,
        };
        Some((self.ours? - printed.value) / printed.last_digit())
    }
}

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
}

/// A picture with the data it was drawn from.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Picture {
    /// What stands under it.
    pub caption: String,
    /// What is seen, in a sentence.
    pub says: String,
    /// The drawing.
    pub svg: String,
    /// Its data.
    pub table: Option<Table>,
    /// Files that stand beside it already, by name.
    pub files: Vec<String>,
}

/// What became of a statement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// In every case, beyond the error.
    Holds,
    /// Not in some case.
    Fails,
    /// An error or a missing number leaves it open.
    Undecided,
}

/// A statement of the source, decided by numbers.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Claim {
    /// The figure that it is about.
    pub figure: String,
    /// The statement.
    pub says: String,
    /// What became of it.
    pub verdict: Verdict,
    /// The number of every case that decides it.
    pub evidence: Vec<String>,
}

/// Everything that a figure consists of.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Outcome {
    /// Drawings with their data.
    pub pictures: Vec<Picture>,
    /// Numbers beside printed ones.
    pub numbers: Vec<Number>,
    /// Statements and what became of them.
    #[serde(default)]
    pub claims: Vec<Claim>,
    /// What did not come out, in a sentence.
    pub failures: Vec<String>,
}

impl Outcome {
    /// Files that the pictures came with.
    pub fn files(&self) -> impl Iterator<Item = &String> {
        self.pictures.iter().flat_map(|picture| &picture.files)
    }

    /// Adds everything of another.
    pub fn add(&mut self, other: Outcome) {
        self.pictures.extend(other.pictures);
        for number in other.numbers {
            match self.numbers.iter_mut().find(|known| known.is(&number)) {
                // With what is printed, if either has it.
                Some(known) if known.printed.is_none() => *known = number,
                Some(_) => {}
                None => self.numbers.push(number),
            }
        }
        self.claims.extend(other.claims);
        self.failures.extend(other.failures);
    }

    /// Why what is labelled so did not come out.
    pub fn reason(&self, label: &str) -> String {
        let start = format!("{label}: ");
        let found = self.failures.iter().find_map(|f| f.strip_prefix(&start));
        found.unwrap_or("did not come out").to_owned()
    }

    /// A printed number that no answer of the task goes with is named, not dropped.
    pub fn demand_partners(&mut self, figure: &str, cases: &[Case]) {
        for case in cases {
            for quantity in case.printed.keys() {
                let answers = |n: &Number| n.quantity.ends_with(quantity.as_str());
                if self.numbers.iter().any(answers) {
                    continue;
                }
                let label = named(case, quantity);
                let reason = "nothing in this task is called so";
                self.failures.push(format!("{label}: {reason}"));
                let number = Number::new(figure, case, quantity, label);
                self.numbers.push(number.failed(reason));
            }
        }
    }
}

impl Table {
    /// Without rows.
    pub fn new(header: &[&str]) -> Self {
        Table {
            header: header.iter().map(|h| (*h).to_owned()).collect(),
            rows: Vec::new(),
            words: Vec::new(),
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
        let facts = [
            ("study", study.title.as_str()),
            ("source", &study.source),
            ("model", &study.model),
            ("version", env!("CARGO_PKG_VERSION")),
        ];
        let facts = facts.map(|(name, value)| (name.to_owned(), value.into()));
        let resolution = ("resolution".to_owned(), study.resolution.into());
        let facts: Vec<_> = facts.into_iter().chain([resolution]).collect();
        csvw::describe(csv, title, &columns, &facts)
    }

    /// Comma-separated, empty where there is no value; words in quotation marks where they need them.
    pub fn csv(&self) -> String {
        let mut header = self.header.clone();
        header.extend(self.words.iter().map(|(name, _)| name.clone()));
        let header: Vec<String> = header.iter().map(|name| quoted(name)).collect();
        let mut text = header.join(",") + "\n";
        for (index, row) in self.rows.iter().enumerate() {
            let number = |v: &f64| match v.is_finite() {
                true => format!("{v:e}"),
                false => String::new(),
            };
            let mut cells: Vec<String> = row.iter().map(number).collect();
            let words = self
                .words
                .iter()
                .filter_map(|(_, column)| column.get(index));
            cells.extend(words.map(|word| text_cell(word)));
            text += &(cells.join(",") + "\n");
        }
        text
    }
}

/// A word as CSV has it.
fn quoted(word: &str) -> String {
    match word.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", word.replace('"', "\"\"")),
        false => word.to_owned(),
    }
}

/// A word as CSV has it; an apostrophe before one that a spreadsheet would compute as a formula.
fn text_cell(word: &str) -> String {
    if word.starts_with(['=', '+', '-', '@', '\t', '\r']) {
        quoted(&format!("'{word}"))
    } else {
        quoted(word)
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
    use super::super::study::Printed;
    use super::{Number, Table, text_cell};

    #[test]
    fn a_label_is_no_formula() {
        for (word, cell) in [
            ("=1+1", "'=1+1"),
            ("-x", "'-x"),
            ("@sum(a,b)", "\"'@sum(a,b)\""),
            ("S = 100", "S = 100"),
            ("a,b", "\"a,b\""),
        ] {
            assert_eq!(text_cell(word), cell);
        }
    }

    #[test]
    fn differences_in_units_of_the_last_printed_digit() {
        let number = |ours: f64, printed: &str| Number {
            figure: String::new(),
            quantity: String::new(),
            case: String::new(),
            name: String::new(),
            decides: None,
            ours: Some(ours),
            error: None,
            printed: printed.parse().ok(),
            printed_as: Some(printed.to_owned()),
            status: String::new(),
            note: String::new(),
        };
        let units = |ours, printed| number(ours, printed).units().expect("units");
        assert!((units(0.0368, "0.0366") - 2.0).abs() < 1e-9);
        assert!((units(0.18, "0.1790") - 10.0).abs() < 1e-9);
        assert!((units(64.28, "64.23") - 5.0).abs() < 1e-9);
        assert!((units(6.4e-3, "6.38e-3") - 2.0).abs() < 1e-9);
        assert_eq!(Printed::of("1700").last_digit(), 1.0);
    }

    #[test]
    fn words_in_a_table() {
        let mut table = Table::new(&["k"]).with_words(&["status"]);
        table.push(vec![0.5], &["ok"]);
        table.push(vec![f64::NAN], &["lost, again"]);
        assert_eq!(table.csv(), "k,status\n5e-1,ok\n,\"lost, again\"\n");
    }
}
