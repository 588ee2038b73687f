//! A file of printed formulas, each compared with the derivation.
//!
//! A formula is transcribed as it stands in print. Where it differs from the derivation, the file
//! names the slips that explain this: with all of them mended the formula agrees, and with any one
//! left it does not. So an erratum is proved, and a slip that is none does not stand.

use landau_codegen::derive::Derivation;
use landau_codegen::diagnostic::SourceFile;
use landau_codegen::emit::difference;
use landau_codegen::errata::{Abbreviations, Comparison, Formula, Subject, compare};
use landau_codegen::formula::{Arrangement, Formula as Tree};
use landau_codegen::model::End;
use landau_solver::error::{Error, Result};
use serde::Deserialize;
use std::path::Path;

/// The whole file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Errata {
    /// Where the formulas are printed: a citation.
    pub source: String,
    #[serde(default)]
    abbreviation: Vec<Abbreviation>,
    formula: Vec<Entry>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Abbreviation {
    name: String,
    text: String,
}

/// One printed formula.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    number: String,
    about: About,
    /// Parameters and switches that the formula is printed for.
    #[serde(default)]
    set: Vec<String>,
    printed: String,
    #[serde(default)]
    slip: Vec<Slip>,
}

/// What a formula is about, by names of the model.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
enum About {
    Balance(String),
    Law(String),
    Base(String),
    Linear { balance: String, field: String },
    Adjoint { row: String, field: String },
    Nonlinear { degree: usize, balance: String },
    Condition { at: Place, field: String },
    AdjointCondition { at: Place, field: String },
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Place {
    Lower,
    Upper,
}

/// A place where print and derivation part.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Slip {
    /// The text as printed, every occurrence of it.
    pub printed: String,
    /// What it should be.
    pub derived: String,
    pub verdict: Verdict,
    #[serde(default)]
    pub why: String,
}

/// Whose slip it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub enum Verdict {
    #[serde(rename = "misprint")]
    Misprint,
    #[serde(rename = "misreading by the copy")]
    Misreading,
    #[serde(rename = "cannot tell")]
    CannotTell,
}

impl Verdict {
    pub fn words(self) -> &'static str {
        match self {
            Verdict::Misprint => "misprint",
            Verdict::Misreading => "misreading by the copy",
            Verdict::CannotTell => "cannot tell",
        }
    }
}

/// A formula with what came of the comparison.
pub struct Judgement {
    /// Its number in the source.
    pub number: String,
    /// What the formula is about, in words.
    pub about: String,
    /// As it is printed.
    pub printed: String,
    /// What is wrong in it, named.
    pub slips: Vec<Slip>,
    /// Terms of either side.
    pub terms: usize,
    /// Terms that differ: as printed, as derived.
    pub differences: Vec<[Tree; 2]>,
    /// What the slips do not explain.
    pub unexplained: Option<String>,
}

impl Errata {
    /// Reads a file of printed formulas.
    ///
    /// # Errors
    /// A file that is missing, or says what such a file does not (with line and column).
    pub fn read(path: &Path) -> Result<Self> {
        let text = std::fs::read_to_string(path)
            .map_err(|e| Error::input(format!("{} cannot be read: {e}", path.display())))?;
        toml::from_str(&text).map_err(|e| Error::input(format!("{}: {e}", path.display())))
    }

    /// Compares every formula with the derivation.
    ///
    /// # Errors
    /// A formula that cannot be read, or is about something that the model does not have.
    pub fn judge(
        &self,
        derivation: &mut Derivation,
        arrangement: Arrangement,
    ) -> Result<Vec<Judgement>> {
        let abbreviations: Abbreviations = self
            .abbreviation
            .iter()
            .map(|a| (a.name.clone(), a.text.clone()))
            .collect();
        let judged = self.formula.iter().map(|entry| {
            let mut against = |text: &str| {
                let formula = entry.formula(text)?;
                compare(derivation, &abbreviations, &formula)
                    .map_err(|mistakes| Error::input(format!("{}\n\n{mistakes}", entry.number)))
            };
            let printed = against(&entry.printed)?;
            let unexplained = entry.unexplained(&printed, &mut against)?;
            let subject = entry.subject();
            let sides = |d| difference::sides(derivation, &subject, d, arrangement);
            Ok(Judgement {
                number: entry.number.clone(),
                about: entry.about(),
                printed: entry.printed.clone(),
                slips: entry.slip.clone(),
                terms: printed.terms,
                differences: printed.differences.iter().map(sides).collect(),
                unexplained,
            })
        });
        judged.collect()
    }
}

impl Entry {
    fn formula(&self, text: &str) -> Result<Formula> {
        let pair = |setting: &String| {
            let (name, value) = setting.split_once('=').ok_or_else(|| {
                let number = &self.number;
                Error::input(format!(
                    "{number}: `{setting}` is not of the form NAME=VALUE"
                ))
            })?;
            Ok((name.trim().to_owned(), value.trim().to_owned()))
        };
        Ok(Formula {
            subject: self.subject(),
            source: SourceFile {
                path: self.number.clone(),
                text: text.to_owned(),
            },
            setting: self.set.iter().map(pair).collect::<Result<_>>()?,
        })
    }

    fn subject(&self) -> Subject {
        let end = |place: Place| match place {
            Place::Lower => End::Lower,
            Place::Upper => End::Upper,
        };
        match self.about.clone() {
            About::Balance(name) => Subject::Balance(name),
            About::Law(name) => Subject::Law(name),
            About::Base(name) => Subject::Base(name),
            About::Linear { balance, field } => Subject::Linear(balance, field),
            About::Adjoint { row, field } => Subject::Adjoint(row, field),
            About::Nonlinear { degree, balance } => Subject::Nonlinear(degree, balance),
            About::Condition { at, field } => Subject::Condition(end(at), field),
            About::AdjointCondition { at, field } => Subject::AdjointCondition(end(at), field),
        }
    }

    fn about(&self) -> String {
        let end = |place: Place| match place {
            Place::Lower => "lower",
            Place::Upper => "upper",
        };
        match &self.about {
            About::Balance(name) => format!("balance {name}"),
            About::Law(name) => format!("law {name}"),
            About::Base(name) => format!("base state, {name}"),
            About::Linear { balance, field } => format!("L, {balance} on {field}"),
            About::Adjoint { row, field } => format!("L†, {row} on {field}†"),
            About::Nonlinear { degree, balance } => format!("N{degree}, {balance}"),
            About::Condition { at, field } => format!("{field} at the {} end", end(*at)),
            About::AdjointCondition { at, field } => format!("{field}† at the {} end", end(*at)),
        }
    }

    /// The printed text with the chosen slips mended.
    fn mended(&self, mend: impl Fn(usize) -> bool) -> Result<String> {
        let mut text = self.printed.clone();
        for (index, slip) in self.slip.iter().enumerate() {
            if !self.printed.contains(&slip.printed) {
                let (number, what) = (&self.number, &slip.printed);
                return Err(Error::input(format!(
                    "{number}: `{what}` is not in its text"
                )));
            }
            if mend(index) {
                text = text.replace(&slip.printed, &slip.derived);
            }
        }
        Ok(text)
    }

    /// What the slips leave open: terms that still differ, or a slip that is none.
    fn unexplained(
        &self,
        printed: &Comparison,
        against: &mut dyn FnMut(&str) -> Result<Comparison>,
    ) -> Result<Option<String>> {
        if self.slip.is_empty() {
            let count = printed.differences.len();
            return Ok((count > 0).then(|| format!("{count} term(s) differ, and no slip says why")));
        }
        let left = against(&self.mended(|_| true)?)?.differences.len();
        if left > 0 {
            return Ok(Some(format!(
                "{left} term(s) differ with every slip mended"
            )));
        }
        for (index, slip) in self.slip.iter().enumerate() {
            let others = against(&self.mended(|other| other != index)?)?;
            if others.differences.is_empty() {
                let what = &slip.printed;
                return Ok(Some(format!(
                    "`{what}` is no slip: the formula agrees with it"
                )));
            }
        }
        Ok(None)
    }
}

/// Every difference must be explained.
///
/// # Errors
/// Names the formulas where something is left open.
pub fn all_explained(judgements: &[Judgement]) -> Result<()> {
    let open: Vec<String> = judgements
        .iter()
        .filter_map(|j| Some(format!("{}: {}", j.number, j.unexplained.as_ref()?)))
        .collect();
    if open.is_empty() {
        return Ok(());
    }
    Err(Error::computation(open.join("\n")))
}
