//! A term that was printed one way and derived another.

use super::text::Writer;
use crate::derive::Derivation;
use crate::errata::{Difference, Subject};
use crate::graph::{Id, Jet, Notation};

/// The term as printed and as derived, 0 where there is none.
pub fn sides(
    derivation: &Derivation,
    subject: &Subject,
    difference: &Difference,
    notation: &dyn Notation,
) -> [String; 2] {
    let writer = Writer::new(derivation, notation);
    let (dagger, mark) = match subject {
        Subject::Adjoint(..) | Subject::AdjointCondition(..) => ("†", ""),
        Subject::Balance(_) | Subject::Law(_) | Subject::Base(_) => ("", ""),
        Subject::Linear(..) | Subject::Nonlinear(..) | Subject::Condition(..) => ("", "'"),
    };
    let printer = writer.printer();
    let name = |jet: &Jet| format!("{}{dagger}", writer.fields()[jet.of]);
    let jets = difference.monomial.iter();
    let jets: Vec<String> = jets
        .map(|jet| printer.named_jet(&name(jet), *jet, mark))
        .collect();
    let shown = |coefficient: Option<Id>| match coefficient {
        None => "0".to_owned(),
        Some(id) if jets.is_empty() => printer.print(id),
        Some(id) => writer.scaled(id, &jets.join(" ")),
    };
    [difference.printed, difference.derived].map(shown)
}
