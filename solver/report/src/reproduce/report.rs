//! The report: one HTML page that opens from disk, pictures and data beside it.

use super::Workshop;
use super::errata::Judgement;
use super::outcome::{Claim, Number, Outcome, Verdict};
use landau_codegen::emit::text::Typeset;
use landau_codegen::formula::latex;
use landau_solver::error::{Error, Result};
use landau_solver::file::write_whole;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use pulldown_latex::config::DisplayMode;
use pulldown_latex::{Parser, RenderConfig, Storage, push_mathml};

/// Derived operators and printed formulas.
pub struct Formulas {
    /// A title, then rows.
    pub sections: Vec<(String, Vec<Typeset>)>,
    /// Printed formulas beside the derivation, terms in LaTeX.
    pub errata: Vec<Judgement>,
}

const STYLE: &str = "
:root { color-scheme: light } math { font-family: 'Latin Modern Math', 'STIX Two Math', 'DejaVu Math TeX Gyre', math }
.scroll { overflow-x: auto } img { background: #fff }
@media print { nav { display: none } figure, tr, details, .formula { break-inside: avoid } h2, h3, h4 { break-after: avoid } .formula { overflow: visible } }
@media (max-width: 40rem) { nav { columns: 1 } th, td { padding: 0.2rem 0.4rem } .about { white-space: normal } }
body { background: #fff; font: 16px/1.5 Georgia, 'DejaVu Serif', serif; max-width: 62rem; margin: 2rem auto; padding: 0 1rem; color: #1a1a1a }
h1, h2, h3 { line-height: 1.2 } h2 { margin-top: 3rem; border-top: 1px solid #ccc; padding-top: 1rem }
nav { columns: 2; font-size: 0.9rem } figure { margin: 1.5rem 0; overflow-x: auto } img { max-width: 100% }
figcaption { font-size: 0.9rem; color: #444 } table { border-collapse: collapse; font-size: 0.9rem }
th, td { padding: 0.2rem 0.8rem; border-bottom: 1px solid #ddd; text-align: left; vertical-align: top }
td.number { font-variant-numeric: tabular-nums; text-align: right } .failure { color: #a33 }
.formula { overflow-x: auto; overflow-y: hidden; padding: 0.3rem 0 } .formula math, td math { display: inline math; math-style: normal } mtd { text-align: left }
h4 { margin: 1.2rem 0 0.2rem } p.case { margin: 0.5rem 0 0; color: #444 }
strong.fails { color: #a33 } td p { margin: 0 } .about { white-space: nowrap } summary { cursor: pointer }";

pub(super) fn write(shop: &Workshop, formulas: &Formulas, outcomes: &[Outcome]) -> Result<()> {
    let study = shop.study;
    let mut sections = Vec::new();
    for (figure, outcome) in study.figure.iter().zip(outcomes) {
        let mut pictures = Vec::new();
        for (index, picture) in outcome.pictures.iter().enumerate() {
            let stem = format!("figure{}-{}", figure.id, index + 1);
            let svg = format!("{stem}.svg");
            write_whole(&shop.out.join(&svg), picture.svg.as_bytes())?;
            let mut files = picture.files.clone();
            if let Some(table) = &picture.table {
                let csv = format!("{stem}.csv");
                write_whole(&shop.out.join(&csv), table.csv().as_bytes())?;
                files.push(csv);
            }
            let alt = format!("Figure {}: {} {}", figure.id, figure.title, picture.caption);
            pictures.push(html! {
                figure {
                    img src=(svg) alt=(alt);
                    figcaption {
                        (picture.caption) " Data: "
                        @for file in &files { a href=(file) { (file) } " " }
                    }
                }
            });
        }
        sections.push(html! {
            section id=(format!("figure-{}", figure.id)) {
                h2 { "Figure " (figure.id) ". " (figure.title) }
                p { (figure.text) }
                @for picture in &pictures { (picture) }
                @if !outcome.claims.is_empty() { (claims(&outcome.claims)) }
                @if !outcome.numbers.is_empty() { (numbers(&outcome.numbers)) }
                @for failure in &outcome.failures { p.failure { "Did not come out: " (failure) } }
            }
        });
    }
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (study.title) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                h1 { (study.title) }
                p { (study.introduction) }
                p { "Reproduced: " (study.source) ". Computed with Landau " (env!("CARGO_PKG_VERSION"))
                    ", M = " (study.resolution) " unless a figure says otherwise. All numbers: "
                    a href="numbers.json" { "numbers.json" } "." }
                nav {
                    @for figure in &study.figure {
                        div { a href=(format!("#figure-{}", figure.id)) { "Figure " (figure.id) } " " (figure.title) }
                    }
                    @if !formulas.errata.is_empty() { div { a href="#errata" { "The printed formulas" } } }
                    @if !formulas.sections.is_empty() { div { a href="#formulas" { "The derived operators" } } }
                }
                @for section in &sections { (section) }
                @if !formulas.errata.is_empty() { (errata(&formulas.errata)?) }
                @if !formulas.sections.is_empty() { (operators(formulas)?) }
            }
        }
    };
    let path = shop.out.join("index.html");
    write_whole(&path, page.into_string().as_bytes())
}

/// Numbers beside the printed ones; columns that say nothing are left out.
fn numbers(list: &[Number]) -> Markup {
    let printed = list.iter().any(|n| n.printed.is_some());
    let notes = list.iter().any(|n| !n.note.is_empty());
    let difference = |n: &Number| n.units().map_or(String::new(), |u| format!("{u:+.1}"));
    html! {
        div.scroll { table {
            thead { tr {
                th { "Quantity" } th { "Ours" }
                @if printed { th { "Printed" } th { "Difference in units of its last digit" } }
                @if notes { th { "Note" } }
            } }
            tbody {
                @for n in list {
                    tr {
                        td { (n.quantity) }
                        @match n.ours {
                            Some(ours) => td.number { (digits(ours)) @if let Some(e) = n.error { " ± " (format!("{e:.0e}")) } },
                            None => td.failure { (n.status) },
                        }
                        @if printed {
                            td.number { (n.printed_as.as_deref().unwrap_or("")) } td.number { (difference(n)) }
                        }
                        @if notes { td { (n.note) } }
                    }
                }
            }
        } }
    }
}

/// Statements with what became of them, and the numbers that decide.
fn claims(list: &[Claim]) -> Markup {
    let word = |claim: &Claim| match claim.verdict {
        Verdict::Holds => "holds",
        Verdict::Fails => "fails",
        Verdict::Undecided => "undecided",
    };
    html! {
        @for claim in list {
            p { "“" (claim.says) "” " strong class=(word(claim)) { (word(claim)) } "." }
            details { summary { "the numbers that decide it" }
                ul { @for line in &claim.evidence { li { (line) } } } }
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

fn operators(formulas: &Formulas) -> Result<Markup> {
    let mut sections = Vec::new();
    for (title, rows) in &formulas.sections {
        let mut set = Vec::new();
        for row in rows {
            set.push(match row {
                Typeset::Heading(words) => html! { h4 { (words) } },
                Typeset::Words(words) => html! { p.case { (words) } },
                Typeset::Formula(latex) => html! { div.formula { (PreEscaped(mathml(latex)?)) } },
            });
        }
        sections.push((title, set));
    }
    Ok(html! {
        section id="formulas" {
            h2 { "The derived operators" }
            @for (title, rows) in &sections {
                h3 { (title) }
                @for row in rows { (row) }
            }
        }
    })
}

/// Each printed formula: whether it agrees, and if not, why.
fn errata(judgements: &[Judgement]) -> Result<Markup> {
    let mut rows = Vec::new();
    for judgement in judgements {
        let mut differences = Vec::new();
        for [printed, derived] in &judgement.differences {
            differences.push([mathml(&latex(printed))?, mathml(&latex(derived))?]);
        }
        rows.push(html! {
            tr {
                td.about { (judgement.number) }
                td.about { (judgement.about) }
                td {
                    @if differences.is_empty() { "agrees" } @else {
                        (erratum(judgement))
                        details {
                            summary { (differences.len()) " of " (judgement.terms) " terms differ" }
                            table {
                                thead { tr { th { "Printed" } th { "Derived" } } }
                                tbody { @for [printed, derived] in &differences {
                                    tr { td { (PreEscaped(printed)) } td { (PreEscaped(derived)) } }
                                } }
                            }
                        }
                    }
                    @if let Some(open) = &judgement.unexplained { p.failure { "Not explained: " (open) } }
                }
            }
        });
    }
    let agree = judgements.iter().filter(|j| j.agrees);
    Ok(html! {
        section id="errata" {
            h2 { "The printed formulas" }
            p { (agree.count()) " of " (judgements.len()) " printed formulas agree with the derivation, term by term. "
                "Of each other one the slips are named: mended, all of them together, the formula agrees, and with any "
                "one left it does not. Letters with a nought are base values; in L, N2, N3 and the conditions the others "
                "are perturbations, in L† adjoint fields." }
            div.scroll { table {
                thead { tr { th { "Formula" } th { "About" } th { "Comparison" } } }
                tbody { @for row in &rows { (row) } }
            } }
        }
    })
}

/// The slips of a formula, one sentence each.
fn erratum(judgement: &Judgement) -> Markup {
    html! {
        @for slip in &judgement.slips {
            p { "printed " code { (slip.printed) } ", derived " code { (slip.derived) } ": "
                strong { (slip.verdict.words()) }
                @if !slip.why.is_empty() { " (" (slip.why) ")" } }
        }
    }
}

fn mathml(latex: &str) -> Result<String> {
    let storage = Storage::new();
    let parser = Parser::new(latex, &storage);
    let config = RenderConfig {
        display_mode: DisplayMode::Block,
        ..RenderConfig::default()
    };
    let mut text = String::new();
    push_mathml(&mut text, parser, config)
        .map_err(|e| Error::computation(format!("a formula cannot be typeset: {e}: {latex}")))?;
    Ok(text)
}
