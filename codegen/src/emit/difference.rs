//! A term that was printed one way and derived another.

use super::text::Writer;
use crate::derive::Derivation;
use crate::errata::{Difference, Subject};
use crate::graph::{Id, Notation};

/// The term as printed and as derived, 0 where there is none.
pub fn sides(
    derivation: &Derivation,
    subject: &Subject,
    difference: &Difference,
    notation: &dyn Notation,
) -> [String; 2] {
    let writer = Writer::new(derivation, notation);
    let (fields, mark) = match subject {
        Subject::Adjoint(..) | Subject::AdjointCondition(..) => {
            let daggers = writer.fields().iter().map(|f| format!("{f}†"));
            (daggers.collect(), "")
        }
        Subject::Balance(_) | Subject::Law(_) | Subject::Base(_) => (writer.fields().to_vec(), ""),
        Subject::Linear(..) | Subject::Nonlinear(..) | Subject::Condition(..) => {
            (writer.fields().to_vec(), "'")
        }
    };
    let jets = difference.monomial.iter();
    let jets: Vec<String> = jets
        .map(|&jet| writer.printer(&fields).jet(jet, mark))
        .collect();
    let shown = |coefficient: Option<Id>| match coefficient {
        None => "0".to_owned(),
        Some(id) if jets.is_empty() => writer.printer(&fields).print(id),
        Some(id) => writer.scaled(id, &jets.join(" ")),
    };
    [difference.printed, difference.derived].map(shown)
}
