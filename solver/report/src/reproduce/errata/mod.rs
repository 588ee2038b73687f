//! A file of printed formulas, each compared with the derivation.
//!
//! A formula is transcribed as it stands in print. Where it differs from the derivation, the file
//! names the slips that explain this: with all of them mended the formula agrees, and with any one
//! left it does not. So an erratum is proved, and a slip that is none does not stand.

mod verdict;

pub use verdict::{RULE, Verdict};

use super::study::{Fault, fault_of, words_can_be_shown};
use landau_codegen::derive::Derivation;
use landau_codegen::diagnostic::SourceFile;
use landau_codegen::emit::comparison;
use landau_codegen::errata::{Comparison, Formula, Language, Notation, Subject, compare, symbols};
use landau_codegen::formula::{Arrangement, Formula as Tree};
use landau_codegen::model::End;
use landau_solver::error::{Error, Result};
use landau_solver::file::{TEXT_LIMIT, read_text};
use serde::Deserialize;
use std::path::Path;
use verdict::{Change, File};

/// The whole file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Errata {
    /// Where the formulas are printed: a citation.
    pub source: String,
    #[serde(default)]
    abbreviation: Vec<Abbreviation>,
    #[serde(default)]
    vector: Vec<Vector>,
    #[serde(default)]
    lookalike: Vec<Lookalike>,
    formula: Vec<Entry>,
    /// What no model decides.
    #[serde(default)]
    pub remark: Vec<Remark>,
}

/// A letter of printed formulas, in the language of the spec.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Abbreviation {
    name: String,
    text: String,
}

/// A vector of printed formulas, by its components.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Vector {
    name: String,
    components: [String; 2],
}

/// Signs that a reader takes for others.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Lookalike {
    printed: Vec<String>,
    derived: Vec<String>,
}

/// A place where the source is wrong by what it says itself; read by eye, compared with nothing.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Remark {
    /// The formula's number.
    pub number: String,
    /// As it is printed, in LaTeX; nothing where it is no formula.
    pub latex: Option<String>,
    /// As it should be, in LaTeX.
    pub right: Option<String>,
    /// Why.
    pub why: String,
}

/// One printed formula.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    number: String,
    /// What the source calls it, in LaTeX.
    symbol: Option<String>,
    about: About,
    /// Parameters and switches that the formula is printed for.
    #[serde(default)]
    set: Vec<String>,
    /// In the language of the spec.
    printed: Option<String>,
    /// As the source has it.
    latex: Option<String>,
    /// What letters of it stand for, by the source: put in before it is read.
    #[serde(default, rename = "where")]
    meanings: Vec<[String; 2]>,
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
    verdict: Option<Verdict>,
    /// Where the source has it right.
    elsewhere: Option<String>,
    #[serde(default)]
    why: String,
}

/// A slip with whose it is.
#[derive(Clone, Debug)]
pub struct Found {
    /// The text as printed.
    pub printed: String,
    /// What it should be.
    pub derived: String,
    /// Whose slip it is.
    pub verdict: Verdict,
    /// How one knows.
    pub why: String,
}

/// A formula with what came of the comparison.
pub struct Judgement {
    /// Its number in the source.
    pub number: String,
    /// What the source calls it, in LaTeX.
    pub symbol: Option<String>,
    /// What the formula is about, in words.
    pub about: String,
    /// What it is written in.
    pub language: Language,
    /// As it is printed.
    pub printed: String,
    /// With every slip mended.
    pub mended: String,
    /// What letters of it stand for.
    pub meanings: Vec<[String; 2]>,
    /// What is wrong in it, named.
    pub slips: Vec<Found>,
    /// Terms of either side.
    pub terms: usize,
    /// Terms that differ: as printed, as derived.
    pub differences: Vec<[Tree; 2]>,
    /// Whether nothing differs.
    pub agrees: bool,
    /// The derived side whole.
    pub derived: Tree,
    /// What the slips do not explain.
    pub unexplained: Option<String>,
}

impl Errata {
    /// Reads a file of printed formulas.
    ///
    /// # Errors
    /// A file that is missing, or says what such a file does not (with line and column).
    pub fn read(path: &Path) -> Result<Self> {
        let text = read_text(path, TEXT_LIMIT)?;
        let wrong = |fault: Fault| Error::input(fault.pointed(path, &text));
        words_can_be_shown(&text).map_err(wrong)?;
        toml::from_str(&text).map_err(|e| wrong(fault_of(&text, &e)))
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
        let notation = self.notation();
        let file = File::new(
            self.formula
                .iter()
                .map(|e| (e.text(&|_| false), e.slip.as_slice())),
        );
        let mut judged = Vec::new();
        for entry in &self.formula {
            let mut against = |text: &str| {
                let formula = entry.formula(text)?;
                compare(derivation, &notation, &formula)
                    .map_err(|mistakes| Error::input(format!("{}\n\n{mistakes}", entry.number)))
            };
            entry.check()?;
            let printed = against(&entry.text(&|_| false))?;
            let unexplained = entry.unexplained(&printed, &mut against)?;
            let subject = entry.subject();
            let sides = |d| comparison::sides(derivation, &subject, d, arrangement);
            judged.push(Judgement {
                number: entry.number.clone(),
                symbol: entry.symbol.clone(),
                about: entry.about(),
                language: entry.language(),
                printed: entry.original().to_owned(),
                mended: entry.mended(entry.original(), &|_| true),
                meanings: entry.meanings.clone(),
                slips: entry.found(&file, &self.lookalike),
                terms: printed.terms,
                differences: printed.differences.iter().map(sides).collect(),
                agrees: printed.agrees(),
                derived: comparison::derived(derivation, &subject, &printed),
                unexplained,
            });
        }
        Ok(judged)
    }

    fn notation(&self) -> Notation {
        let abbreviations = self.abbreviation.iter();
        let vectors = self.vector.iter();
        Notation {
            abbreviations: abbreviations
                .map(|a| (a.name.clone(), a.text.clone()))
                .collect(),
            vectors: vectors
                .map(|v| (v.name.clone(), v.components.clone()))
                .collect(),
        }
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
            language: self.language(),
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

    /// What the source has, as it stands in the file.
    fn original(&self) -> &str {
        let text = self.latex.as_ref().or(self.printed.as_ref());
        text.map_or("", String::as_str)
    }

    /// The same with the chosen slips mended, in it and in the meanings of its letters, which are put in.
    fn text(&self, mend: &dyn Fn(usize) -> bool) -> String {
        let text = self.mended(self.original(), mend);
        let put = |text: String, [letter, meaning]: &[String; 2]| {
            text.replace(letter, &self.mended(meaning, mend))
        };
        self.meanings.iter().fold(text, put)
    }

    /// Everything that the source has of it: the formula and what its letters stand for.
    fn stands(&self) -> impl Iterator<Item = &str> {
        let meanings = self.meanings.iter().map(|[_, meaning]| meaning.as_str());
        std::iter::once(self.original()).chain(meanings)
    }

    fn language(&self) -> Language {
        match self.latex {
            Some(_) => Language::Latex,
            None => Language::Spec,
        }
    }

    /// Whether the entry says what it has to, and its slips leave the formula standing.
    fn check(&self) -> Result<()> {
        let refused = |what: String| Err(Error::input(format!("{}: {what}", self.number)));
        if self.latex.is_some() == self.printed.is_some() {
            return refused("a formula has `latex` or `printed`, one of the two".to_owned());
        }
        let mut text = self.original().to_owned();
        for [letter, meaning] in &self.meanings {
            if !text.contains(letter) {
                return refused(format!("`{letter}` is not in its text"));
            }
            text = text.replace(letter, meaning);
        }
        let signs: usize = self.stands().map(|text| symbols(text).concat().len()).sum();
        let mut replaced = 0;
        for slip in &self.slip {
            let printed = &slip.printed;
            let times: usize = self
                .stands()
                .map(|text| text.matches(printed).count())
                .sum();
            if times == 0 {
                return refused(format!("`{printed}` is not in its text"));
            }
            if self.latex.is_some() && slip.verdict.is_some() {
                return refused(
                    "whose slip it is follows from its LaTeX by the rule, and is not said"
                        .to_owned(),
                );
            }
            if self.printed.is_some() && slip.verdict.is_none() {
                let known = "`misprint`, `misreading by the copy` or `cannot tell`";
                return refused(format!("the slip `{printed}` needs a `verdict`: {known}"));
            }
            replaced += times * Change::of(slip).replaced();
        }
        if 2 * replaced > signs {
            return refused(
                "its slips replace most of the formula, which would make any formula right"
                    .to_owned(),
            );
        }
        Ok(())
    }

    /// The slips, each with whose it is.
    fn found(&self, file: &File, lookalikes: &[Lookalike]) -> Vec<Found> {
        let found = self.slip.iter().map(|slip| Found {
            printed: slip.printed.clone(),
            derived: slip.derived.clone(),
            verdict: slip
                .verdict
                .unwrap_or_else(|| file.verdict(slip, lookalikes)),
            why: match (&slip.elsewhere, slip.why.as_str()) {
                (None, why) => why.to_owned(),
                (Some(number), "") => format!("{number} has it right"),
                (Some(number), why) => format!("{number} has it right; {why}"),
            },
        });
        found.collect()
    }

    /// A text of the formula with the chosen slips mended.
    fn mended(&self, text: &str, mend: &dyn Fn(usize) -> bool) -> String {
        let mut text = text.to_owned();
        for (index, slip) in self.slip.iter().enumerate() {
            if mend(index) {
                text = text.replace(&slip.printed, &slip.derived);
            }
        }
        text
    }

    /// What the slips leave open: terms that still differ, or a slip that is none.
    fn unexplained(
        &self,
        printed: &Comparison,
        against: &mut dyn FnMut(&str) -> Result<Comparison>,
    ) -> Result<Option<String>> {
        let count =
            |comparison: &Comparison| match (comparison.differences.len(), comparison.unclosed) {
                (terms, 0) => format!("{terms} term(s) differ"),
                (terms, brackets) => {
                    format!("{terms} term(s) differ and {brackets} bracket(s) stay open")
                }
            };
        if self.slip.is_empty() {
            let open = !printed.agrees();
            return Ok(open.then(|| format!("{}, and no slip says why", count(printed))));
        }
        let mut mended = |mend: &dyn Fn(usize) -> bool| against(&self.text(mend));
        let left = mended(&|_| true)?;
        if !left.agrees() {
            return Ok(Some(format!("{} with every slip mended", count(&left))));
        }
        for (index, slip) in self.slip.iter().enumerate() {
            if mended(&|other| other != index)?.agrees() {
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
