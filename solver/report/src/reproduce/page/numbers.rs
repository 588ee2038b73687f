//! Numbers beside the printed ones, and statements with what decides them.

use super::super::claim::{Claim, Verdict};
use super::super::outcome::Number;
use super::super::study::{Printed, Threshold, percent};
use super::super::symbols::Symbols;
use super::text::rich;
use maud::{Markup, html};

/// Rows of a table that is shown at once.
const LONG: usize = 12;

/// Distinct values in the order in which they come.
fn distinct<'n>(list: &[&'n Number], of: fn(&Number) -> &str) -> Vec<&'n str> {
    let mut known: Vec<&str> = Vec::new();
    for number in list {
        if !known.contains(&of(number)) {
            known.push(of(number));
        }
    }
    known
}

/// A table: a row a case and a column a quantity, or a row a quantity where there is one case. Quantities that the
/// same cases have stand together. What decides a statement stands there.
pub(super) fn numbers(list: &[Number], symbols: &Symbols) -> Markup {
    let shown: Vec<&Number> = list.iter().filter(|n| n.decides.is_none()).collect();
    let mut tables: Vec<(Vec<&str>, Vec<&Number>)> = Vec::new();
    for name in distinct(&shown, |n| &n.name) {
        let own: Vec<&Number> = shown.iter().copied().filter(|n| n.name == name).collect();
        let cases = distinct(&own, |n| &n.case);
        match tables.iter_mut().find(|(known, _)| *known == cases) {
            Some((_, numbers)) => numbers.extend(own),
            None => tables.push((cases, own)),
        }
    }
    html! {
        @for (cases, numbers) in &tables {
            // The points of a curve are drawn; who wants them in digits opens them.
            @if cases.len() > LONG {
                details { summary { (cases.len()) " rows" } (table(cases, numbers, symbols)) }
            } @else { (table(cases, numbers, symbols)) }
        }
    }
}

fn table(cases: &[&str], numbers: &[&Number], symbols: &Symbols) -> Markup {
    let names = distinct(numbers, |n| &n.name);
    let find = |case: &str, name: &str| numbers.iter().find(|n| n.case == case && n.name == name);
    let mut notes: Vec<&str> = numbers
        .iter()
        .map(|n| n.note.as_str())
        .filter(|n| !n.is_empty())
        .collect();
    let mut seen = Vec::new();
    notes.retain(|note| {
        !seen.contains(note) && {
            seen.push(*note);
            true
        }
    });
    html! {
        div.scroll { table {
            @if let [case] = cases {
                thead { tr { th { (rich(case, symbols)) } th { "ours" } } }
                tbody { @for name in &names {
                    tr { th scope="row" { (rich(name, symbols)) } (cell(find(case, name).copied())) }
                } }
            } @else {
                thead { tr { th { } @for name in &names { th { (rich(name, symbols)) } } } }
                tbody { @for case in cases {
                    tr { th scope="row" { (rich(case, symbols)) } @for name in &names { (cell(find(case, name).copied())) } }
                } }
            }
        } }
        @for note in &notes { p.note { (rich(note, symbols)) } }
    }
}

/// Ours, its error, and what is printed or computed elsewhere with the difference.
fn cell(number: Option<&Number>) -> Markup {
    let Some(number) = number else {
        return html! { td { } };
    };
    let beside = beside(number);
    html! {
        @match number.ours {
            Some(ours) => td.number {
                (digits(ours, number)) @if let Some(e) = number.error { " ± " (format!("{e:.0e}")) }
                @if let Some(beside) = &beside { small { (beside) } }
            },
            None => td.failure {
                (number.status)
                @if let Some(beside) = &beside { small { (beside) } }
            },
        }
    }
}

/// Differences from a print that are larger than so many units of its last digit are said in per cent.
const UNITS: f64 = 1000.0;

/// What is printed, with the difference in units of its last digit; or what somebody else computed, in per cent.
fn beside(number: &Number) -> Option<String> {
    let relative = |reference: f64| {
        number.ours.map_or(String::new(), |ours| {
            let share = percent((ours - reference) / reference);
            let sign = if ours >= reference { "+" } else { "" };
            format!(", {sign}{share}")
        })
    };
    if let Some(reference) = &number.reference {
        let value = significant(reference.value, SIGNIFICANT);
        return Some(format!(
            "{} {value}{}",
            reference.label,
            relative(reference.value)
        ));
    }
    let printed = number.printed_as.as_deref()?;
    let difference = match (number.units(), number.printed) {
        (Some(units), _) if units.abs() < UNITS => format!(", {units:+.1}"),
        (Some(_), Some(printed)) => relative(printed),
        _ => String::new(),
    };
    Some(format!("printed {printed}{difference}"))
}

/// Digits of a number beside which nothing is printed.
const SIGNIFICANT: usize = 6;
/// Digits that a number of double precision has at most.
const MOST_SIGNIFICANT: usize = 15;

/// Ours with at least one digit more than the print has, or six.
fn digits(value: f64, number: &Number) -> String {
    let printed = number.printed_as.as_deref().map(Printed::of);
    // One place beyond the last printed one.
    let beyond = printed.map_or(SIGNIFICANT, |printed| {
        let places = value.abs().log10().floor() - printed.last_digit().log10().round();
        (places + 2.0).clamp(0.0, MOST_SIGNIFICANT as f64) as usize
    });
    significant(value, beyond.max(SIGNIFICANT))
}

/// A number with so many significant digits.
fn significant(value: f64, count: usize) -> String {
    if value == 0.0 {
        "0".to_owned()
    } else if !(1e-3..1e6).contains(&value.abs()) {
        format!("{value:.*e}", count - 1)
    } else {
        let whole = value.abs().max(1e-3).log10().floor() as i32;
        let decimals = (count as i32 - 1 - whole).clamp(0, 16);
        format!("{value:.*}", decimals as usize)
    }
}

/// What became of a statement, and the number that led to it.
pub(super) fn verdict(claim: &Claim) -> Markup {
    let class = match claim.verdict {
        Verdict::Contradicted | Verdict::NotMet => "fails",
        Verdict::Undecided => "undecided",
        Verdict::Holds => "holds",
    };
    html! { strong class=(class) { (claim.verdict_in_words()) } }
}

/// A statement: in quotation marks where it is quoted, with its place.
pub(super) fn words(claim: &Claim, symbols: &Symbols) -> Markup {
    html! {
        @if claim.quoted { "“" (rich(&claim.says, symbols)) "”" } @else { (rich(&claim.says, symbols)) }
        @if let Some(section) = &claim.section { " (" (section) ")" }
        @if !claim.says.ends_with(['.', '!', '?']) || claim.section.is_some() { "." }
    }
}

/// What decides a statement, and who set its bound.
pub(super) fn criterion(claim: &Claim, symbols: &Symbols) -> Markup {
    let whose = match claim.threshold {
        Threshold::Ours => "our bound",
        Threshold::Source => "the source’s",
    };
    html! { (rich(&claim.criterion, symbols)) " (" (whose) ")" }
}

/// A statement with its criterion, what became of it, and the numbers that decide.
pub(super) fn claim(claim: &Claim, symbols: &Symbols) -> Markup {
    html! {
        p { (words(claim, symbols)) " Criterion: " (criterion(claim, symbols)) ". " (verdict(claim)) "." }
        details { summary { "the numbers that decide it" }
            ul { @for line in &claim.evidence { li { (rich(line, symbols)) } } } }
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::outcome::Beside;
    use super::super::super::study::Case;
    use super::{Number, beside, digits};

    fn number(ours: f64, printed: Option<&str>) -> Number {
        let number = Number::new("1", &Case::default(), "a", "a".to_owned());
        Number {
            printed: printed.and_then(|text| text.parse().ok()),
            printed_as: printed.map(str::to_owned),
            ..number.answered(ours, None)
        }
    }

    /// Ours has a digit more than the print, and six at least.
    #[test]
    fn as_many_digits_as_the_print() {
        for (ours, printed, shown) in [
            (1_707.761_777, Some("1707.762"), "1707.7618"),
            (0.174_541_23, Some("0.1748"), "0.174541"),
            (64.230_004, Some("64.23"), "64.2300"),
            (1_461_686.84, None, "1.46169e6"),
            (0.053_931_349, Some("0.05393135"), "0.053931349"),
            (0.0, None, "0"),
        ] {
            assert_eq!(digits(ours, &number(ours, printed)), shown);
        }
    }

    /// What is no print has no last digit.
    #[test]
    fn references_are_compared_in_per_cent() {
        let mut reference = number(0.5, None);
        reference.reference = Some(Beside {
            label: "fully nonlinear".to_owned(),
            value: 0.486_482_80,
        });
        let said = beside(&reference).expect("a reference");
        assert_eq!(said, "fully nonlinear 0.486483, +2.8 %");
        let said = |ours, printed| beside(&number(ours, Some(printed))).expect("a print");
        assert_eq!(said(0.1746, "0.1748"), "printed 0.1748, -2.0");
        assert_eq!(said(0.3, "0.1790"), "printed 0.1790, +68 %");
    }
}
