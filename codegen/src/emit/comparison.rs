//! The two sides of a comparison as formulas.

use crate::derive::Derivation;
use crate::errata::{Comparison, Difference, Subject};
use crate::formula::{self, Arrangement, Formula, Letters, Mark};
use crate::graph::Jet;

/// A term as it was printed and as it was derived; 0 on a side that does not have it.
pub fn sides(
    derivation: &Derivation,
    subject: &Subject,
    difference: &Difference,
    arrangement: Arrangement,
) -> [Formula; 2] {
    let letters = derivation.model.letters(arrangement);
    let jets = factors(&letters, subject, &difference.monomial);
    [difference.printed, difference.derived].map(|coefficient| match coefficient {
        None => Formula::zero(),
        Some(id) => letters.scaled(&derivation.graph, id, jets.clone()),
    })
}

/// The derived side whole, as [`crate::emit::text::latex`] writes it.
pub fn derived(derivation: &Derivation, subject: &Subject, comparison: &Comparison) -> Formula {
    let (model, letters) = (
        &derivation.model,
        derivation.model.letters(Arrangement::Grouped),
    );
    let graph = &derivation.graph;
    let side = match subject {
        Subject::Balance(_) | Subject::Law(_) | Subject::Base(_) => {
            letters.formula(graph, comparison.subject)
        }
        Subject::Nonlinear(_, balance) if !comparison.derived.terms.is_empty() => {
            let row = model.balances.position(|b| b.name == *balance);
            let divisor = row.map_or(comparison.subject, |row| derivation.operators.divisors[row]);
            Formula::Lines(formula::grouped(
                graph,
                &letters,
                &comparison.derived,
                divisor,
            ))
        }
        _ => {
            let terms = comparison.derived.terms.iter();
            let terms = terms.map(|(jets, &id)| (id, factors(&letters, subject, jets)));
            formula::over_common_denominator(graph, &letters, &terms.collect::<Vec<_>>())
        }
    };
    if subject.is_equation() {
        Formula::equation(side, Formula::zero())
    } else {
        side
    }
}

/// Jets by the names that the subject's fields have.
fn factors(letters: &Letters, subject: &Subject, jets: &[Jet]) -> Vec<Formula> {
    let (dagger, mark) = match subject {
        Subject::Adjoint(..) | Subject::AdjointCondition(..) => ("†", Mark::None),
        Subject::Balance(_) | Subject::Law(_) | Subject::Base(_) => ("", Mark::None),
        Subject::Linear(..) | Subject::Nonlinear(..) | Subject::Condition(..) => ("", Mark::Prime),
    };
    let jet = |jet: &Jet| {
        let name = format!("{}{dagger}", letters.fields[jet.of]);
        letters.named_jet(&name, *jet, mark)
    };
    jets.iter().map(jet).collect()
}
