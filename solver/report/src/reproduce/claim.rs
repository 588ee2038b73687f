//! Statements of a source, and what became of them.

use super::study::{Statement, Threshold};
use serde::{Deserialize, Serialize};

/// What became of a statement. In the order in which a reader wants them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Verdict {
    /// The numbers say otherwise than the source itself.
    #[serde(rename = "contradicted")]
    Contradicted,
    /// The numbers miss a bound that the study set.
    #[serde(rename = "not met")]
    NotMet,
    /// An error or a missing number leaves it open.
    #[serde(rename = "undecided")]
    Undecided,
    /// In every case, beyond the error.
    #[serde(rename = "holds")]
    Holds,
}

impl Verdict {
    /// As files and pages have it.
    pub fn word(self) -> &'static str {
        match self {
            Verdict::Contradicted => "contradicted",
            Verdict::NotMet => "not met",
            Verdict::Undecided => "undecided",
            Verdict::Holds => "holds",
        }
    }

    /// Whether the numbers speak against the statement.
    pub fn is_against(self) -> bool {
        matches!(self, Verdict::Contradicted | Verdict::NotMet)
    }
}

/// A statement, decided by numbers.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Claim {
    /// The figure that it is about.
    pub figure: String,
    /// The statement: words of the source where they are quoted.
    pub says: String,
    /// Whether they are.
    pub quoted: bool,
    /// Where the source has them.
    pub section: Option<String>,
    /// What has to be true of the numbers.
    pub criterion: String,
    /// Who set its bound.
    pub threshold: Threshold,
    /// What became of it.
    pub verdict: Verdict,
    /// The bound and the number that misses it: `at 1 %: 1.5 %`.
    pub measured: Option<String>,
    /// The number of every case that decides it.
    pub evidence: Vec<String>,
}

impl Claim {
    /// The verdict with the number that led to it: `not met at 1 %: 1.5 %`.
    pub fn verdict_in_words(&self) -> String {
        match &self.measured {
            Some(measured) => format!("{} {measured}", self.verdict.word()),
            None => self.verdict.word().to_owned(),
        }
    }

    /// A statement with what became of it.
    pub(super) fn new(figure: &str, statement: &Statement, decision: Decision) -> Self {
        let against = if statement.threshold == Threshold::Source {
            Verdict::Contradicted
        } else {
            Verdict::NotMet
        };
        Claim {
            figure: figure.to_owned(),
            says: statement.words().to_owned(),
            quoted: statement.quote.is_some(),
            section: statement.section.clone(),
            criterion: statement.criterion(),
            threshold: statement.threshold,
            verdict: match decision.met {
                Some(true) => Verdict::Holds,
                Some(false) => against,
                None => Verdict::Undecided,
            },
            measured: decision.measured,
            evidence: decision.evidence,
        }
    }
}

/// What the numbers of all cases say.
pub(super) struct Decision {
    /// Nothing where an error or a missing number leaves it open.
    pub met: Option<bool>,
    /// The bound and the number that misses it farthest.
    pub measured: Option<String>,
    /// A sentence a case.
    pub evidence: Vec<String>,
}
