//! Whose slip it is, by one rule.
//!
//! 1. The source has it right elsewhere: a misprint.
//! 2. What stands there looks like what should: a misreading by the copy.
//! 3. One sign is missing: nobody can tell, for a sign can be lost in print and in the copy; where the same is
//!    missing three times or more and right nowhere, a misprint.
//! 4. Anything else, which was added or changed: a misprint.

use super::{Lookalike, Slip};
use landau_codegen::errata::symbols;
use serde::Deserialize;

/// Whose slip it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub enum Verdict {
    /// The source's own.
    #[serde(rename = "misprint")]
    Misprint,
    /// Of the copy that the formulas were taken from.
    #[serde(rename = "misreading by the copy")]
    Misreading,
    /// One or the other.
    #[serde(rename = "cannot tell")]
    CannotTell,
}

impl Verdict {
    /// In words, as a file says it.
    pub fn words(self) -> &'static str {
        match self {
            Verdict::Misprint => "misprint",
            Verdict::Misreading => "misreading by the copy",
            Verdict::CannotTell => "cannot tell",
        }
    }
}

/// The rule in a paragraph, for a reader.
pub const RULE: &str = "Whose slip it is follows one rule. What the source has right elsewhere is a misprint. What looks \
    like the right sign (m for nn, t for T, a prime for a nought) is a misreading by the copy. Where one sign is \
    missing nobody can tell, unless the same is missing three times or more and right nowhere: then it is a misprint. \
    Everything else was added or changed, and is a misprint.";

/// How often the same sign must be missing for a misprint.
const RECURRENT: usize = 3;

/// A slip, symbol by symbol.
pub(super) struct Change {
    printed: Vec<Vec<String>>,
    derived: Vec<Vec<String>>,
}

impl Change {
    pub(super) fn of(slip: &Slip) -> Self {
        Change {
            printed: symbols(&slip.printed),
            derived: symbols(&slip.derived),
        }
    }

    /// Signs of the printed side that go.
    pub(super) fn replaced(&self) -> usize {
        let (printed, derived) = (self.printed.concat(), self.derived.concat());
        printed.len() - common(&printed, &derived)
    }

    /// Where one sign is missing: what stands around the letter, and what should.
    fn missing(&self) -> Option<[&[String]; 2]> {
        let (printed, derived) = (self.printed.concat(), self.derived.concat());
        let one = derived.len() == printed.len() + 1 && self.replaced() == 0;
        let mut sides = self.printed.iter().zip(&self.derived);
        let differ = sides.find(|(a, b)| a != b).filter(|_| one);
        let around = |symbol: &'_ [String]| -> usize { usize::from(symbol.len() > 1) };
        match differ {
            Some((a, b)) => Some([&a[around(a)..], &b[around(b)..]]),
            None => one.then_some([&[], &[]]),
        }
    }

    /// Whether every difference is between signs that look alike.
    fn looks_alike(&self, lookalikes: &[Lookalike]) -> bool {
        let (printed, derived) = (self.printed.concat(), self.derived.concat());
        printed != derived && alike(&printed, &derived, lookalikes)
    }
}

/// Whether the second can be read as the first.
fn alike(printed: &[String], derived: &[String], lookalikes: &[Lookalike]) -> bool {
    if let ([a, rest @ ..], [b, others @ ..]) = (printed, derived)
        && a == b
        && alike(rest, others, lookalikes)
    {
        return true;
    }
    let mut taken = lookalikes.iter().filter_map(|pair| {
        let rest = printed.strip_prefix(pair.printed.as_slice())?;
        Some((rest, derived.strip_prefix(pair.derived.as_slice())?))
    });
    (printed.is_empty() && derived.is_empty())
        || taken.any(|(rest, others)| alike(rest, others, lookalikes))
}

/// What the rule needs of the whole file: the slips of every formula, and the formulas without them.
pub(super) struct File {
    changes: Vec<Change>,
    right: Vec<Vec<Vec<String>>>,
}

impl File {
    pub(super) fn new<'a>(formulas: impl Iterator<Item = (String, &'a [Slip])>) -> Self {
        let (mut changes, mut right) = (Vec::new(), Vec::new());
        for (mut text, slips) in formulas {
            changes.extend(slips.iter().map(Change::of));
            for slip in slips {
                text = text.replace(&slip.printed, "");
            }
            right.push(symbols(&text));
        }
        File { changes, right }
    }

    /// Steps 1 to 4 of the rule.
    pub(super) fn verdict(&self, slip: &Slip, lookalikes: &[Lookalike]) -> Verdict {
        let change = Change::of(slip);
        if slip.elsewhere.is_some() {
            Verdict::Misprint
        } else if change.looks_alike(lookalikes) {
            Verdict::Misreading
        } else if let Some(missing) = change.missing() {
            let same = |other: &&Change| other.missing() == Some(missing);
            let times = self.changes.iter().filter(same).count();
            let stands = |symbol: &Vec<String>| symbol.len() > 1 && symbol[1..] == *missing[1];
            match times >= RECURRENT && !self.right.iter().flatten().any(stands) {
                true => Verdict::Misprint,
                false => Verdict::CannotTell,
            }
        } else {
            Verdict::Misprint
        }
    }
}

/// Length of the longest common subsequence.
fn common(a: &[String], b: &[String]) -> usize {
    let mut row = vec![0; b.len() + 1];
    for x in a {
        let mut diagonal = 0;
        for (j, y) in b.iter().enumerate() {
            let above = row[j + 1];
            row[j + 1] = if x == y {
                diagonal + 1
            } else {
                above.max(row[j])
            };
            diagonal = above;
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::{File, Lookalike, Slip, Verdict};

    fn slip(printed: &str, derived: &str, elsewhere: Option<&str>) -> Slip {
        Slip {
            printed: printed.to_owned(),
            derived: derived.to_owned(),
            verdict: None,
            elsewhere: elsewhere.map(str::to_owned),
            why: String::new(),
        }
    }

    fn verdict(slips: &[Slip]) -> Verdict {
        let word = |w: &str| vec![w.to_owned()];
        let lookalikes = [
            Lookalike {
                printed: word("m"),
                derived: vec!["n".to_owned(); 2],
            },
            Lookalike {
                printed: word("'"),
                derived: word("0"),
            },
        ];
        let formulas = slips
            .iter()
            .map(|s| (s.printed.clone(), std::slice::from_ref(s)));
        File::new(formulas).verdict(&slips[0], &lookalikes)
    }

    #[test]
    fn one_rule_for_all() {
        let lost = slip("\\mu_{ny}^0 n'^2", "\\mu_{nny}^0 n'^2", None);
        assert_eq!(verdict(std::slice::from_ref(&lost)), Verdict::CannotTell);
        assert_eq!(
            verdict(&[slip("a", "a^2", Some("(2.13)"))]),
            Verdict::Misprint
        );
        assert_eq!(
            verdict(&[slip("\\mu_{my}^0", "\\mu_{nny}^0", None)]),
            Verdict::Misreading
        );
        assert_eq!(verdict(&[slip("T'_y", "T_y^0", None)]), Verdict::Misreading);
        assert_eq!(
            verdict(&[slip("p_{nTT}^0", "p_{nnT}^0", None)]),
            Verdict::Misprint
        );
        assert_eq!(
            verdict(&[slip("\\kappa_y", "\\kappa_y^0", None)]),
            Verdict::CannotTell
        );
        // The same sign lost again and again, by the laws one after another.
        let of = |law: &str| {
            slip(
                &format!("{law}_{{Ty}}^0"),
                &format!("{law}_{{TTy}}^0"),
                None,
            )
        };
        let laws: Vec<Slip> = ["\\mu", "p", "\\kappa"].map(of).into();
        assert_eq!(verdict(&laws), Verdict::Misprint);
        assert_eq!(verdict(&laws[..2]), Verdict::CannotTell);
    }
}
