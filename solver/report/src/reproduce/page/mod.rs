//! The report: one HTML page that opens from disk, pictures and data beside it.

mod formulas;
mod mathml;
mod numbers;
mod text;

pub use formulas::Formulas;

use super::claim::Claim;
use super::outcome::{Outcome, Picture};
use super::study::Figure;
use super::workshop::{Provenance, Workshop};
use crate::data::csvw;
use landau_solver::error::Result;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use text::{rich, stop};

const STYLE: &str = include_str!("style.css");

/// What a browser may do with the page: show it and its own pictures. No scripts, nothing from elsewhere.
const POLICY: &str = "default-src 'none'; img-src 'self' file:; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'";

pub(super) fn write(shop: &Workshop, formulas: &Formulas, outcomes: &[Outcome]) -> Result<()> {
    let study = shop.study;
    let mut sections = Vec::new();
    for (figure, outcome) in study.figure.iter().zip(outcomes) {
        sections.push(section(shop, figure, outcome)?);
    }
    let told = outcomes.iter().any(|outcome| !outcome.claims.is_empty());
    let extra = [
        told.then_some(("#statements", "statements")),
        (!formulas.errata.is_empty()).then_some(("#errata", "printed formulas")),
        (!formulas.sections.is_empty()).then_some(("#formulas", "derived operators")),
        Some(("#made", "how it was made")),
    ];
    let made = made(shop)?;
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(POLICY);
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (study.title) }
                style { (PreEscaped(STYLE)) }
            }
            body id="top" {
                nav aria-label="contents" {
                    a href="#top" { "top" }
                    @for figure in &study.figure {
                        a href=(format!("#figure-{}", figure.id)) title=(figure.title) { (short(figure)) }
                    }
                    @for (link, name) in extra.into_iter().flatten() { a href=(link) { (name) } }
                }
                main {
                    h1 { (study.title) }
                    p { (rich(&study.introduction, &study.symbol)) }
                    p { "Reproduced: " (study.source) (stop(&study.source)) " M = " (study.resolution) " unless a figure says otherwise. “Printed” is "
                        "what the source has, with our difference in units of its last printed digit. All numbers: " a href="numbers.json" { "numbers.json" } ", all statements: "
                        a href="claims.json" { "claims.json" } "." }
                    ul.contents { @for figure in &study.figure {
                        li { a href=(format!("#figure-{}", figure.id)) { (heading(figure)) " " (rich(&figure.title, &study.symbol)) } }
                    } }
                    @for section in &sections { (section) }
                    @if told { (statements(shop, outcomes)) }
                    @if !formulas.errata.is_empty() { (formulas::errata(formulas)?) }
                    @if !formulas.sections.is_empty() { (formulas::operators(formulas)?) }
                    (made)
                }
            }
        }
    };
    shop.shelf
        .write("index.html", page.into_string().as_bytes())
}

/// What a section is called: figures that the source has by their number, others by their own name.
fn heading(figure: &Figure) -> String {
    if figure.id.starts_with(|c: char| c.is_ascii_digit()) {
        format!("Figure {}.", figure.id)
    } else {
        String::new()
    }
}

fn short(figure: &Figure) -> String {
    if figure.id.starts_with(|c: char| c.is_ascii_digit()) {
        figure.id.clone()
    } else {
        figure.id.replace('-', " ")
    }
}

fn section(shop: &Workshop, figure: &Figure, outcome: &Outcome) -> Result<Markup> {
    let symbols = &shop.study.symbol;
    let mut pictures = Vec::new();
    for (index, picture) in outcome.pictures.iter().enumerate() {
        pictures.push(drawn(shop, figure, index + 1, picture)?);
    }
    Ok(html! {
        section id=(format!("figure-{}", figure.id)) {
            h2 { (heading(figure)) " " (rich(&figure.title, symbols)) a.back href="#top" { "contents" } }
            p { (rich(&figure.text, symbols)) }
            @for picture in &pictures { (picture) }
            @for claim in &outcome.claims { (numbers::claim(claim, symbols)) }
            (numbers::numbers(&outcome.numbers, symbols))
            @for failure in &outcome.failures { p.failure { "Did not come out: " (failure) } }
        }
    })
}

/// Every statement in one table: first what the numbers contradict.
fn statements(shop: &Workshop, outcomes: &[Outcome]) -> Markup {
    let sections = shop.study.figure.iter().zip(outcomes);
    let mut all: Vec<(&Figure, &Claim)> = sections
        .flat_map(|(figure, outcome)| outcome.claims.iter().map(move |c| (figure, c)))
        .collect();
    all.sort_by_key(|(_, claim)| claim.verdict);
    let symbols = &shop.study.symbol;
    html! {
        section id="statements" {
            h2 { "What the source says in words" a.back href="#top" { "contents" } }
            p { @if all.iter().any(|(_, claim)| claim.quoted) { "Words in quotation marks are the source’s, from the section that is named. " }
                "The criterion by which a statement is decided is ours. A statement is contradicted where the source itself sets the bound, a number, a sign or a trend; where "
                "the bound is ours, it is not met." }
            div.scroll { table {
                thead { tr { th { "statement" } th { "criterion" } th { } th { "decided in" } } }
                tbody { @for (figure, claim) in &all {
                    tr {
                        td { (numbers::words(claim, symbols)) }
                        td { (numbers::criterion(claim, symbols)) }
                        td { (numbers::verdict(claim)) }
                        td { a href=(format!("#figure-{}", figure.id)) { (short(figure)) } }
                    }
                } }
            } }
        }
    }
}

/// A picture with what is seen in it and the data it was drawn from.
fn drawn(shop: &Workshop, figure: &Figure, number: usize, picture: &Picture) -> Result<Markup> {
    let stem = format!("figure{}-{number}", figure.id);
    let svg = format!("{stem}.svg");
    if let Some(drawing) = &picture.svg {
        shop.shelf.write(&svg, drawing.as_bytes())?;
    }
    let mut files = picture.files.clone();
    if let Some(table) = &picture.table {
        let csv = format!("{stem}.csv");
        shop.shelf.write(&csv, table.csv().as_bytes())?;
        let described = csvw::beside(&csv);
        let about = format!("{} {}", heading(figure), figure.title);
        let metadata = table.metadata(&csv, about.trim(), shop.study);
        shop.shelf.write(&described, metadata.as_bytes())?;
        files.extend([csv, described]);
    }
    let class = if picture.table.is_some() {
        "plot"
    } else {
        "field"
    };
    let symbols = &shop.study.symbol;
    Ok(html! {
        figure {
            @if picture.svg.is_some() {
                img class=(class) src=(svg) alt=(format!("{} {}: {}", heading(figure), figure.title, picture.says).trim()) loading="lazy";
            }
            figcaption {
                @if !picture.caption.is_empty() { (rich(&picture.caption, symbols)) (stop(&picture.caption)) " " }
                (picture.says) " Data: "
                @for file in &files { a href=(file) { (file) } " " }
            }
        }
    })
}

/// What the delivered files are, in words.
fn kinds(shop: &Workshop, files: &[String]) -> String {
    let tasks = shop.study.figure.iter().flat_map(|figure| &figure.task);
    let has_references = tasks
        .clone()
        .any(|task| !task.kind().references().is_empty());
    let has_laws = files.iter().any(|file| file.ends_with(".law"));
    let kinds = [
        (true, "the study"),
        (shop.study.errata.is_some(), "printed formulas"),
        (has_references, "points of others"),
        (true, "models"),
        (has_laws, "their laws"),
    ];
    let present: Vec<&str> = kinds.iter().filter(|k| k.0).map(|k| k.1).collect();
    let (last, before) = present.split_last().unwrap_or((&"", &[]));
    format!("{} and {last}", before.join(", "))
}

/// How the page was made: command, date, version, and every source it was made from.
fn made(shop: &Workshop) -> Result<Markup> {
    let mut files = Vec::new();
    for (name, text) in shop.sources()? {
        let path = format!("sources/{name}");
        shop.shelf.write(&path, text.as_bytes())?;
        files.push(path);
    }
    let Provenance {
        command,
        date,
        commit,
    } = &shop.provenance;
    Ok(html! {
        section.made id="made" {
            h2 { "How it was made" a.back href="#top" { "contents" } }
            p { code { (command) } " on " time datetime=(date) { (date) } ", Landau " (env!("CARGO_PKG_VERSION"))
                @if let Some(commit) = commit { ", commit " (commit) } "." }
            p { "From " @for file in &files { a href=(file) { (file) } " " } "— " (kinds(shop, &files)) "." }
        }
    })
}
