//! Numbers beside the printed ones, and statements with what decides them.

use super::super::outcome::{Claim, Number, Verdict};
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

/// Ours, its error, and what is printed with the difference in units of its last digit.
fn cell(number: Option<&Number>) -> Markup {
    let Some(number) = number else {
        return html! { td { } };
    };
    let printed = number.printed_as.as_deref();
    let units = number
        .units()
        .map_or(String::new(), |u| format!(", {u:+.1}"));
    html! {
        @match number.ours {
            Some(ours) => td.number {
                (digits(ours)) @if let Some(e) = number.error { " ± " (format!("{e:.0e}")) }
                @if let Some(printed) = printed { small { "printed " (printed) (units) } }
            },
            None => td.failure {
                (number.status)
                @if let Some(printed) = printed { small { "printed " (printed) } }
            },
        }
    }
}

/// Six significant digits.
fn digits(value: f64) -> String {
    if value != 0.0 && !(1e-3..1e5).contains(&value.abs()) {
        format!("{value:.5e}")
    } else {
        let whole = value.abs().max(1e-3).log10().floor() as i32;
        format!("{value:.*}", (5 - whole).clamp(0, 8) as usize)
    }
}

/// What became of a statement, in a word.
pub(super) fn verdict(claim: &Claim) -> Markup {
    let word = match claim.verdict {
        Verdict::Holds => "holds",
        Verdict::Fails => "fails",
        Verdict::Undecided => "undecided",
    };
    html! { strong class=(word) { (word) } }
}

/// A statement with what became of it, and the numbers that decide.
pub(super) fn claim(claim: &Claim, symbols: &Symbols) -> Markup {
    html! {
        p { "“" (rich(&claim.says, symbols)) "” " (verdict(claim)) "." }
        details { summary { "the numbers that decide it" }
            ul { @for line in &claim.evidence { li { (rich(line, symbols)) } } } }
    }
}
