//! Statements decided by numbers: met, missed (where, by how much), or undecided.

use super::super::claim::{Claim, Decision};
use super::super::needs::Needs;
use super::super::outcome::{Number, Outcome};
use super::super::study::kinds::Claims;
use super::super::study::{Case, Quantity, Statement, Trend, named, percent};
use super::super::workshop::Workshop;
use super::planes::crest;
use super::points::critical_point;
use super::rows::{amplitude, converged, rows};
use super::{Place, Work, each};
use crate::library::column as derived_column;
use landau_solver::base::BaseState;
use landau_solver::error::{Error, Result};
use landau_solver::study::Setup;
use landau_solver::study::row::{Column, column};
use landau_solver::study::sweep::RowMode;
use landau_solver::weakly::Selection;
use std::sync::Arc;

/// A number with its error.
type Value = (f64, f64);

/// Relative error of a number that nothing else limits.
const ROUNDING: f64 = 1e-12;

/// What decides a statement in one case.
fn value(setup: &Setup, case: &Case, statement: &Statement) -> Result<Value> {
    let critical = match &statement.at {
        Some(asked) => Some(critical_point(setup, case, asked)?),
        None => None,
    };
    if statement.quantity == Quantity::Place {
        let missing = || Error::input("a statement about a place needs `at`: a critical point");
        let place = critical.ok_or_else(missing)?;
        return Ok((place.value, place.error));
    }
    let largest = match statement.quantity {
        Quantity::LargestAmplitude => Some(Column::Amplitude),
        Quantity::LargestGrowth => Some(Column::A0),
        _ => None,
    };
    if let Some(quantity) = largest {
        return where_largest(setup, case, statement, quantity);
    }
    // The critical point may lie along k, or along a parameter.
    let (mut setup, mut k) = (setup.clone(), case.k);
    if let (Some(point), Some(asked)) = (&critical, &statement.at) {
        k = Some(point.k);
        if asked.vary != "k" {
            setup.set(&[format!("{}={:e}", asked.vary, point.value)])?;
        }
    }
    let missing = || Error::input(format!("the case `{}` needs a wavenumber k", case.label));
    let k = k.ok_or_else(missing)?;
    if statement.quantity == Quantity::A0 {
        // Growth rates converge where c2 does not yet.
        let row = rows(&setup, None, "k", vec![k], RowMode::Leading, &[])?.remove(0);
        let c0 = row.c0.ok_or_else(|| Error::computation(row.status))?;
        return Ok((c0[0], row.c0_error.unwrap_or(f64::INFINITY)));
    }
    if statement.quantity == Quantity::Column {
        return column_value(&setup, k, statement);
    }
    let answer = converged(&setup, k)?;
    let (point, error) = (&answer.point, answer.error);
    if statement.quantity == Quantity::A2 {
        return Ok((point.c2.re, error.c2));
    }
    let none = || Error::computation("there is no equilibrium at cubic order");
    let amplitude = amplitude(&answer).ok_or_else(none)?;
    // A² = −a0/a2
    let relative = error.c0 / point.c0.re.abs() + error.c2 / point.c2.re.abs();
    Ok((amplitude, 0.5 * amplitude * relative))
}

/// A derived column, and how far the base state at another degree puts it.
fn column_value(setup: &Setup, k: f64, statement: &Statement) -> Result<Value> {
    let missing = || Error::input("a statement about a column needs `column`");
    let text = statement.column.as_ref().ok_or_else(missing)?;
    let derived = derived_column(setup.model.as_ref(), text)?;
    let value = |base: &Arc<BaseState>| -> Result<f64> {
        let point = setup.point(base, k, Selection::Leading)?;
        let none = || Error::computation(format!("`{text}` has no value there"));
        derived.value(&point, point.amplitude()).ok_or_else(none)
    };
    let base = setup.base(None)?;
    let here = value(&base)?;
    let refined = base
        .refined()
        .map(|base| value(&Arc::new(base)))
        .transpose()?;
    let error = refined.map_or(0.0, |refined| (refined - here).abs());
    Ok((here, error.max(ROUNDING * here.abs())))
}

/// Where a quantity is largest along an axis, to half a step of it.
fn where_largest(
    setup: &Setup,
    case: &Case,
    statement: &Statement,
    quantity: Column,
) -> Result<Value> {
    let missing = || Error::input("a statement about a largest value needs `over`: an axis");
    let over = statement.over.as_ref().ok_or_else(missing)?;
    // The wavenumber of a case is meant for statements that have no axis of k.
    let rows = rows(
        setup,
        case.k.filter(|_| over.name != "k"),
        &over.name,
        over.values(),
        RowMode::Leading,
        &[],
    )?;
    let mut points = column(&rows, quantity);
    points.retain(|p| p.1.is_finite());
    let (places, values): (Vec<f64>, Vec<f64>) = points.into_iter().unzip();
    let inside = || {
        Error::computation(format!(
            "it is largest at an end of the range of {}",
            over.name
        ))
    };
    let [place, _] = crest(&values, &places).ok_or_else(inside)?;
    let steps = over.values();
    let step = steps
        .windows(2)
        .map(|w| (w[1] - w[0]).abs())
        .fold(0.0, f64::max);
    Ok((place, 0.5 * step))
}

/// Values that a statement compares one with.
#[derive(Clone, Copy, Default)]
struct Others {
    /// Of the first case, where this is another and it has an answer.
    first: Option<Value>,
    /// Of the case before, where it has an answer.
    before: Option<Value>,
    /// Whether this is the first case, with which others are compared.
    is_first: bool,
}

/// A demand on a value: whether it is met, and the bound with what stands against it.
struct Demand {
    met: Option<bool>,
    bound: String,
    measured: String,
    /// How far the value lies on the wrong side, relative to the bound.
    missed_by: f64,
}

impl Demand {
    /// A demand that a distance be positive, beyond its error.
    fn positive(distance: f64, error: f64, bound: (String, f64), measured: String) -> Self {
        let (bound, size) = bound;
        Demand {
            met: if distance.abs() > error {
                Some(distance > 0.0)
            } else {
                None
            },
            bound,
            measured,
            missed_by: -distance / size.abs().max(f64::MIN_POSITIVE),
        }
    }

    /// One that cannot be looked at: what it compares with is missing.
    fn open() -> Self {
        Demand {
            met: None,
            bound: String::new(),
            measured: String::new(),
            missed_by: 0.0,
        }
    }
}

/// A number as evidence has it.
fn short(value: f64) -> String {
    let digits: f64 = format!("{value:.4e}").parse().unwrap_or(value);
    if digits != 0.0 && !(1e-4..1e6).contains(&digits.abs()) {
        format!("{digits:e}")
    } else {
        digits.to_string()
    }
}

/// Everything that a statement demands of a value.
fn demands(statement: &Statement, others: Others, (value, error): Value) -> Vec<Demand> {
    let mut demands = Vec::new();
    let bound = |bound: f64| (short(bound), bound);
    if let Some(above) = statement.above {
        demands.push(Demand::positive(
            value - above,
            error,
            bound(above),
            short(value),
        ));
    }
    if let Some(below) = statement.below {
        demands.push(Demand::positive(
            below - value,
            error,
            bound(below),
            short(value),
        ));
    }
    // Shares of the first case's value, which is known to its own error.
    let shares = [
        (statement.as_first_within, 1.0),
        (statement.apart_from_first, -1.0),
    ];
    for (share, sign) in shares {
        let Some(share) = share.filter(|_| !others.is_first) else {
            continue;
        };
        demands.push(match others.first {
            Some((first, also)) => {
                let (size, apart) = (first.abs(), (value - first).abs());
                let error = error + (1.0 + share) * also;
                let measured = percent(apart / size);
                let bound = (percent(share), share * size);
                Demand::positive(sign * (share * size - apart), error, bound, measured)
            }
            None => Demand::open(),
        });
    }
    if let Some(trend) = statement.trend.filter(|_| !others.is_first) {
        demands.push(match others.before {
            Some((last, also)) => {
                let gain = match trend {
                    Trend::Rising => value - last,
                    Trend::Falling => last - value,
                };
                let bound = (short(last), last);
                Demand::positive(gain, error + also, bound, short(value))
            }
            None => Demand::open(),
        });
    }
    demands
}

/// Whether all demands are met; nothing where one is open and none is missed.
fn all_met(demands: &[Demand]) -> Option<bool> {
    if demands.iter().any(|demand| demand.met == Some(false)) {
        return Some(false);
    }
    let met: Option<Vec<bool>> = demands.iter().map(|demand| demand.met).collect();
    met.map(|_| true)
}

/// What the values of all cases say of a statement; `missing` says why others have none.
fn decided(
    statement: &Statement,
    cases: &[Case],
    values: &[(usize, Value)],
    missing: &[String],
) -> Decision {
    let of = |index: usize| values.iter().find(|(i, _)| *i == index).map(|(_, v)| *v);
    let mut evidence = missing.to_vec();
    let (mut verdicts, mut worst): (Vec<Option<bool>>, Option<(f64, String)>) = (Vec::new(), None);
    for (index, value) in values {
        let others = Others {
            first: of(0),
            before: index.checked_sub(1).and_then(of),
            is_first: *index == 0,
        };
        let demands = demands(statement, others, *value);
        let met = all_met(&demands);
        let label = named(&cases[*index], &statement.name);
        let word = match met {
            _ if demands.is_empty() => "the case that others are compared with",
            Some(true) => "met",
            Some(false) => "missed",
            None => "undecided",
        };
        evidence.push(format!(
            "{label} is {:.6} ± {:.1e}: {word}",
            value.0, value.1
        ));
        for demand in demands.iter().filter(|demand| demand.met == Some(false)) {
            if worst
                .as_ref()
                .is_none_or(|(most, _)| demand.missed_by > *most)
            {
                worst = Some((
                    demand.missed_by,
                    format!("at {}: {}", demand.bound, demand.measured),
                ));
            }
        }
        verdicts.push(met);
    }
    let met = if verdicts.contains(&Some(false)) {
        Some(false)
    } else if missing.is_empty() && verdicts.iter().all(|v| *v == Some(true)) {
        Some(true)
    } else {
        None
    };
    Decision {
        met,
        measured: worst.map(|(_, measured)| measured),
        evidence,
    }
}

impl Work for Claims {
    fn needs(&self, of: &mut Needs) -> Result<()> {
        for (index, statement) in self.claim.iter().enumerate() {
            let words = format!("claim {}", index + 1);
            let spot = of.spot.entry("claim", index, words);
            of.statement(&spot, statement)?;
        }
        Ok(())
    }

    fn run(&self, shop: &Workshop, place: &Place) -> Result<Outcome> {
        let (figure, cases) = (place.figure, &self.case);
        let mut outcome = Outcome::default();
        for statement in &self.claim {
            // What has no answer leaves the statement undecided: said there, not as a failure of the study.
            let mut missing = Vec::new();
            let values = each(cases, &mut missing, |case| {
                value(&shop.setup(case)?, case, statement)
            })?;
            for (index, value) in &values {
                let label = named(&cases[*index], &statement.name);
                let number = Number::new(figure, &cases[*index], &statement.name, label);
                outcome.numbers.push(Number {
                    decides: Some(statement.words().to_owned()),
                    ..number.answered(value.0, Some(value.1))
                });
            }
            let decision = decided(statement, cases, &values, &missing);
            outcome.claims.push(Claim::new(figure, statement, decision));
        }
        Ok(outcome)
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::study::Threshold;
    use super::{Case, Quantity, Statement, Trend, Value, decided};

    fn statement() -> Statement {
        Statement {
            quote: None,
            section: None,
            says: None,
            threshold: Threshold::Ours,
            name: "a".to_owned(),
            quantity: Quantity::A0,
            at: None,
            over: None,
            above: None,
            below: None,
            as_first_within: None,
            apart_from_first: None,
            column: None,
            trend: None,
        }
    }

    /// The verdict on values of one case after another, and what misses the bound.
    fn verdict(statement: &Statement, values: &[Value]) -> (Option<bool>, Option<String>) {
        let cases = vec![Case::default(); values.len()];
        let values: Vec<(usize, Value)> = values.iter().copied().enumerate().collect();
        let decision = decided(statement, &cases, &values, &[]);
        (decision.met, decision.measured)
    }

    #[test]
    fn what_an_error_leaves_open_is_open() {
        let above = Statement {
            above: Some(1.0),
            ..statement()
        };
        assert_eq!(verdict(&above, &[(1.5, 0.1)]), (Some(true), None));
        let missed = Some("at 1: 0.5".to_owned());
        assert_eq!(verdict(&above, &[(0.5, 0.1)]), (Some(false), missed));
        assert_eq!(verdict(&above, &[(1.05, 0.1)]), (None, None));
        let band = Statement {
            below: Some(2.0),
            ..above.clone()
        };
        assert_eq!(verdict(&band, &[(1.5, 0.1)]).0, Some(true));
        assert_eq!(verdict(&band, &[(3.0, 0.1)]).0, Some(false));
    }

    #[test]
    fn cases_are_compared_with_one_another() {
        let rising = Statement {
            trend: Some(Trend::Rising),
            ..statement()
        };
        let step = |last, value| verdict(&rising, &[(last, 0.1), (value, 0.1)]).0;
        assert_eq!(
            [step(1.0, 2.0), step(2.0, 1.0), step(1.0, 1.15)],
            [Some(true), Some(false), None]
        );
        let same = Statement {
            as_first_within: Some(0.01),
            ..statement()
        };
        let first = (2.0, 0.0);
        assert_eq!(verdict(&same, &[first, (2.01, 1e-3)]).0, Some(true));
        let missed = Some("at 1 %: 1.5 %".to_owned());
        assert_eq!(
            verdict(&same, &[first, (2.03, 1e-3)]),
            (Some(false), missed)
        );
        // The error of the first case counts too.
        assert_eq!(verdict(&same, &[(2.0, 0.1), (2.03, 0.0)]).0, None);
        // A case equal to the first is not apart from it.
        let apart = Statement {
            apart_from_first: Some(0.01),
            ..statement()
        };
        assert_eq!(verdict(&apart, &[first, (2.5, 0.0)]).0, Some(true));
        assert_eq!(verdict(&apart, &[first, first]).0, Some(false));
    }

    /// Without the first case nothing is decided about the others.
    #[test]
    fn a_missing_case_leaves_the_statement_open() {
        let same = Statement {
            as_first_within: Some(0.01),
            ..statement()
        };
        let cases = vec![Case::default(); 2];
        let missing = ["lost".to_owned()];
        let decision = decided(&same, &cases, &[(1, (2.0, 0.0))], &missing);
        assert_eq!(decision.met, None);
    }
}
