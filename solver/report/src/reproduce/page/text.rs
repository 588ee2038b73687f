//! Words, names and formulas as a page has them.

use super::super::symbols::{Piece, Symbols, pieces};
use landau_solver::error::{Error, Result};
use maud::{Markup, PreEscaped, html};
use pulldown_latex::config::DisplayMode;
use pulldown_latex::{Parser, RenderConfig, Storage, push_mathml};

/// A colour that nothing else has: what is marked is told by it.
const MARK: &str = "magenta";
/// The same as it is drawn.
const MARK_DRAWN: &str = "rgb(255 0 255)";

/// A text with its names typeset.
pub(super) fn rich(text: &str, symbols: &Symbols) -> Markup {
    html! {
        @for piece in pieces(text, symbols) {
            @match piece {
                Piece::Plain(text) => (text),
                Piece::Name(symbol) => (inline(&symbol.latex)),
                Piece::Formula(latex) => (inline(latex)),
            }
        }
    }
}

/// A formula in a line; as it is written where it cannot be typeset.
pub(super) fn inline(latex: &str) -> Markup {
    match mathml(latex, DisplayMode::Inline) {
        Ok(formula) => PreEscaped(formula),
        Err(_) => html! { code { (latex) } },
    }
}

/// A formula on lines of its own.
///
/// # Errors
/// LaTeX that cannot be typeset.
pub(super) fn displayed(latex: &str) -> Result<Markup> {
    let formula = mathml(&whole(latex), DisplayMode::Block)?;
    Ok(html! { div.formula { (PreEscaped(formula)) } })
}

/// Parts of a formula between marks.
pub(super) fn marked(latex: &str, parts: impl Iterator<Item = String>) -> String {
    let mut text = latex.to_owned();
    for part in parts.filter(|part| balanced(part)) {
        text = text.replace(&part, &format!("\\textcolor{{{MARK}}}{{{part}}}"));
    }
    text
}

/// Several lines as LaTeX wants them.
fn whole(latex: &str) -> String {
    match latex.contains('&') || latex.contains("\\\\") {
        true if !latex.contains("\\begin") => {
            format!("\\begin{{aligned}} {latex} \\end{{aligned}}")
        }
        _ => latex.to_owned(),
    }
}

/// Whether a part of a formula can stand in braces.
fn balanced(part: &str) -> bool {
    let count = |text: &str| part.matches(text).count();
    count("{") == count("}") && count("\\left") == count("\\right") && count("\\Big") == 0
}

fn mathml(latex: &str, display_mode: DisplayMode) -> Result<String> {
    let storage = Storage::new();
    let parser = Parser::new(latex, &storage);
    let config = RenderConfig {
        display_mode,
        ..RenderConfig::default()
    };
    let mut text = String::new();
    push_mathml(&mut text, parser, config)
        .map_err(|e| Error::computation(format!("a formula cannot be typeset: {e}: {latex}")))?;
    if text.contains("<merror") {
        return Err(Error::computation(format!(
            "a formula cannot be typeset: {latex}"
        )));
    }
    Ok(text.replace(
        &format!(" style=\"color: {MARK_DRAWN}\""),
        " class=\"marked\"",
    ))
}
