//! The derived operators, and printed formulas beside them.

use super::super::errata::{Found, Judgement, RULE, Remark};
use super::text::{displayed, inline, marked};
use landau_codegen::emit::text::Typeset;
use landau_codegen::errata::Language;
use landau_codegen::formula::latex;
use landau_solver::error::Result;
use maud::{Markup, html};

/// Derived operators and printed formulas.
#[derive(Default)]
pub struct Formulas {
    /// A title, then rows.
    pub sections: Vec<(String, Vec<Typeset>)>,
    /// Where the formulas are printed.
    pub source: String,
    /// Printed formulas beside the derivation.
    pub errata: Vec<Judgement>,
    /// What no model decides.
    pub remarks: Vec<Remark>,
}

/// Every section of the derivation.
pub(super) fn operators(formulas: &Formulas) -> Result<Markup> {
    let mut sections = Vec::new();
    for (title, rows) in &formulas.sections {
        let mut set = Vec::new();
        for row in rows {
            set.push(match row {
                Typeset::Heading(words) => html! { h4 { (words) } },
                Typeset::Words(words) => html! { p.case { (words) } },
                Typeset::Formula(latex) => displayed(latex)?,
            });
        }
        sections.push((title, set));
    }
    Ok(html! {
        section id="formulas" {
            h2 { "The derived operators" a.back href="#top" { "contents" } }
            @for (title, rows) in &sections {
                h3 { (title) }
                @for row in rows { (row) }
            }
        }
    })
}

/// Each printed formula beside the derivation: whether it agrees, and if not, where and why.
pub(super) fn errata(formulas: &Formulas) -> Result<Markup> {
    let mut articles = Vec::new();
    for judgement in &formulas.errata {
        articles.push(article(judgement)?);
    }
    let agree = formulas.errata.iter().filter(|j| j.agrees).count();
    let slips: Vec<&Judgement> = formulas.errata.iter().filter(|j| !j.agrees).collect();
    let remarks = formulas
        .remarks
        .iter()
        .map(remark)
        .collect::<Result<Vec<_>>>()?;
    Ok(html! {
        section id="errata" {
            h2 { "The printed formulas" a.back href="#top" { "contents" } }
            p { (agree) " of " (formulas.errata.len()) " printed formulas (" (formulas.source) ") agree with the derivation, term "
                "by term. Of each other one the slips are named: mended, all of them together, the formula agrees, and "
                "with any one left it does not. A formula is shown as the copy has it that it was taken from; "
                "what is wrong is " span.slip { "marked" } ", and so is what " span.mended { "mends" } " it." }
            p { (RULE) }
            @if !slips.is_empty() {
                p { "With slips: " @for j in &slips { a href=(format!("#{}", anchor(j))) { (j.number) } " " } }
            }
            @for article in &articles { (article) }
            @if !remarks.is_empty() {
                h3 { "Not compared by machine" }
                @for remark in &remarks { (remark) }
            }
        }
    })
}

/// A name for a link.
fn anchor(judgement: &Judgement) -> String {
    let kept = |c: char| if c.is_ascii_alphanumeric() { c } else { '-' };
    format!(
        "formula-{}",
        judgement.number.chars().map(kept).collect::<String>()
    )
}

fn article(judgement: &Judgement) -> Result<Markup> {
    let differing = judgement.differences.len();
    Ok(html! {
        article.erratum id=(anchor(judgement)) {
            p { strong { (judgement.number) } " " (judgement.about) ": "
                @if judgement.agrees { strong.holds { "agrees" } }
                @else if differing == 0 { strong.fails { "does not close" } }
                @else { strong.fails { (differing) " of " (judgement.terms) " terms differ" } } }
            (sides(judgement)?)
            @for [letter, meaning] in &judgement.meanings {
                p.note.slips { "where " (inline(term(letter))) " is " (inline(&shown(term(meaning), judgement, |s| &s.printed))) }
            }
            @if !judgement.slips.is_empty() { ul { @for slip in &judgement.slips { (erratum(slip, judgement)) } } }
            @if let Some(open) = &judgement.unexplained { p.failure { "Not explained: " (open) } }
            details { summary { "as it is derived here" } (displayed(&named(judgement, &latex(&judgement.derived)))?) }
        }
    })
}

/// What a letter stands for, without the sign of equality that tells it from the same letter elsewhere.
fn term(text: &str) -> &str {
    text.trim().trim_end_matches('=').trim_end()
}

/// A piece of a formula as it can be set by itself: brackets without their partners are signs.
fn piece(latex: &str) -> String {
    let count = |word: &str| latex.matches(word).count();
    if count(r"\left") == count(r"\right") {
        return latex.to_owned();
    }
    let mut text = latex.to_owned();
    for nothing in [r"\left.", r"\right."] {
        text = text.replace(nothing, "");
    }
    text.replace(r"\left", "").replace(r"\right", "")
}

/// The formula as printed, and mended where it has to be.
fn sides(judgement: &Judgement) -> Result<Markup> {
    if judgement.language == Language::Spec {
        return Ok(html! { pre { (judgement.printed) } });
    }
    let printed = displayed(&named(
        judgement,
        &shown(&judgement.printed, judgement, |s| &s.printed),
    ))?;
    // Slips may be in what letters stand for alone.
    if judgement.mended == judgement.printed {
        return Ok(html! { div.slips { (printed) } });
    }
    let mended = displayed(&named(
        judgement,
        &shown(&judgement.mended, judgement, |s| &s.derived),
    ))?;
    Ok(html! {
        div.slips { (printed) }
        div.mends { (mended) }
    })
}

/// What the source calls it, and the formula.
fn named(judgement: &Judgement, formula: &str) -> String {
    match (&judgement.symbol, judgement.language) {
        // Lines are aligned behind the sign.
        (Some(symbol), Language::Latex)
            if formula.contains('&') && !formula.contains(r"\begin") =>
        {
            format!("{symbol} ={{}}& {formula}")
        }
        (Some(symbol), _) => format!("{symbol} = {formula}"),
        (None, _) => formula.to_owned(),
    }
}

/// A formula with its slips marked on one side.
fn shown(formula: &str, judgement: &Judgement, side: fn(&Found) -> &String) -> String {
    marked(
        formula,
        judgement.slips.iter().map(|slip| side(slip).clone()),
    )
}

/// A slip in a sentence.
fn erratum(slip: &Found, judgement: &Judgement) -> Markup {
    let side = |text: &str| match judgement.language {
        Language::Spec => html! { code { (text) } },
        Language::Latex => inline(&piece(text)),
    };
    html! {
        li { span.slip { (side(&slip.printed)) } " for " span.mended { (side(&slip.derived)) } ": "
            strong { (slip.verdict.words()) } @if !slip.why.is_empty() { " (" (slip.why) ")" } }
    }
}

fn remark(remark: &Remark) -> Result<Markup> {
    let formula = |latex: &Option<String>| latex.as_deref().map(displayed).transpose();
    let (printed, right) = (formula(&remark.latex)?, formula(&remark.right)?);
    Ok(html! {
        article.erratum {
            p { strong { (remark.number) } ": " (remark.why) }
            @if let Some(printed) = printed { div.slips { (printed) } }
            @if let Some(right) = right { div.mends { (right) } }
        }
    })
}

#[cfg(test)]
mod tests {
    use super::{piece, term};

    #[test]
    fn pieces_stand_by_themselves() {
        assert_eq!(piece(r"\right] \Big]"), r"] \Big]");
        assert_eq!(piece(r"\left. a \right)  \right)"), r" a )  )");
        assert_eq!(piece(r"\left(a\right)"), r"\left(a\right)");
        assert_eq!(term(r"\mathbf{u} ="), r"\mathbf{u}");
    }
}
