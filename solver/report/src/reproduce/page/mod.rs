//! The report: one HTML page that opens from disk, pictures and data beside it.

mod formulas;
mod numbers;
mod text;

pub use formulas::Formulas;

use super::outcome::{Outcome, Picture};
use super::study::Figure;
use super::workshop::{Provenance, Workshop};
use crate::data::csvw;
use landau_solver::error::Result;
use landau_solver::file::write_whole;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use text::rich;

const STYLE: &str = include_str!("style.css");

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
                    p { "Reproduced: " (study.source) ". M = " (study.resolution) " unless a figure says otherwise. “Printed” is "
                        "what the source has, with our difference in units of its last digit; P (2.28) is an equation of the "
                        "source. All numbers: " a href="numbers.json" { "numbers.json" } ", all statements: "
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
    write_whole(&shop.out.join("index.html"), page.into_string().as_bytes())
}

/// What a section is called: figures that the source has by their number, others by their own name.
fn heading(figure: &Figure) -> String {
    match figure.id.starts_with(|c: char| c.is_ascii_digit()) {
        true => format!("Figure {}.", figure.id),
        false => String::new(),
    }
}

fn short(figure: &Figure) -> String {
    match figure.id.starts_with(|c: char| c.is_ascii_digit()) {
        true => figure.id.clone(),
        false => figure.id.replace('-', " "),
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

/// Every statement of the source in one table.
fn statements(shop: &Workshop, outcomes: &[Outcome]) -> Markup {
    let sections = shop.study.figure.iter().zip(outcomes);
    let all =
        sections.flat_map(|(figure, outcome)| outcome.claims.iter().map(move |c| (figure, c)));
    html! {
        section id="statements" {
            h2 { "What the source says in words" a.back href="#top" { "contents" } }
            div.scroll { table {
                thead { tr { th { "statement" } th { } th { "decided in" } } }
                tbody { @for (figure, claim) in all {
                    tr {
                        td { (rich(&claim.says, &shop.study.symbol)) }
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
    write_whole(&shop.out.join(&svg), picture.svg.as_bytes())?;
    let mut files = picture.files.clone();
    if let Some(table) = &picture.table {
        let csv = format!("{stem}.csv");
        write_whole(&shop.out.join(&csv), table.csv().as_bytes())?;
        let described = csvw::beside(&csv);
        let about = format!("{} {}", heading(figure), figure.title);
        write_whole(
            &shop.out.join(&described),
            table.metadata(&csv, &about, shop.study).as_bytes(),
        )?;
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
            img class=(class) src=(svg) alt=(format!("{} {}: {}", heading(figure), figure.title, picture.says)) loading="lazy";
            figcaption {
                @if !picture.caption.is_empty() { (rich(&picture.caption, symbols)) ". " }
                (picture.says) " Data: "
                @for file in &files { a href=(file) { (file) } " " }
            }
        }
    })
}

/// How the page was made: command, date, version, and every source it was made from.
fn made(shop: &Workshop) -> Result<Markup> {
    let mut files = Vec::new();
    for (name, text) in shop.sources()? {
        let path = format!("sources/{name}");
        write_whole(&shop.out.join(&path), text.as_bytes())?;
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
            p { "From " @for file in &files { a href=(file) { (file) } " " } }
        }
    })
}
