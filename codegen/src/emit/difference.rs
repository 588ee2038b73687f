//! A term that was printed one way and derived another.

use crate::derive::Derivation;
use crate::errata::{Difference, Subject};
use crate::formula::{Arrangement, Formula, Mark};

/// The term as printed and as derived, 0 where there is none.
pub fn sides(
    derivation: &Derivation,
    subject: &Subject,
    difference: &Difference,
    arrangement: Arrangement,
) -> [Formula; 2] {
    let letters = derivation.model.letters(arrangement);
    let (dagger, mark) = match subject {
        Subject::Adjoint(..) | Subject::AdjointCondition(..) => ("†", Mark::None),
        Subject::Balance(_) | Subject::Law(_) | Subject::Base(_) => ("", Mark::None),
        Subject::Linear(..) | Subject::Nonlinear(..) | Subject::Condition(..) => ("", Mark::Prime),
    };
    let jets = difference.monomial.iter().map(|jet| {
        let name = format!("{}{dagger}", letters.fields[jet.of]);
        letters.named_jet(&name, *jet, mark)
    });
    let jets: Vec<Formula> = jets.collect();
    [difference.printed, difference.derived].map(|coefficient| match coefficient {
        None => Formula::zero(),
        Some(id) => letters.scaled(&derivation.model.graph, id, jets.clone()),
    })
}
