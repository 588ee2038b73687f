//! Words, names and formulas as a page has them.

use super::super::symbols::{Piece, Symbols, pieces};
use super::mathml::is_mathml;
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

/// A formula longer or nested deeper than this is shown as it is written.
const LONGEST: usize = 20_000;
const DEEPEST: usize = 60;
/// Stack of the thread that typesets a formula, in bytes.
const STACK: usize = 256 << 20;

/// How deep brackets of a formula stand in one another, and commands that take what follows them.
fn depth(latex: &str) -> usize {
    let (mut open, mut deepest) = (0_usize, 0);
    for c in latex.chars() {
        match c {
            '{' | '[' | '(' => open += 1,
            '}' | ']' | ')' => open = open.saturating_sub(1),
            _ => {}
        }
        deepest = deepest.max(open);
    }
    let nested = [r"\frac", r"\sqrt", r"\left", r"\begin", r"\not", r"^", r"_"];
    let bare = |command: &&str| latex.contains(&command.repeat(DEEPEST));
    if nested.iter().any(bare) {
        usize::MAX
    } else {
        deepest
    }
}

/// MathML as the renderer writes it, or its complaint.
fn rendered(latex: &str, display_mode: DisplayMode) -> std::result::Result<String, String> {
    let storage = Storage::new();
    let parser = Parser::new(latex, &storage);
    let config = RenderConfig {
        display_mode,
        ..RenderConfig::default()
    };
    let mut text = String::new();
    push_mathml(&mut text, parser, config).map_err(|e| e.to_string())?;
    Ok(text)
}

/// Runs work that recurses once for each nested script or command of a formula.
fn on_a_large_stack(
    work: impl FnOnce() -> std::result::Result<String, String> + Send,
) -> std::result::Result<String, String> {
    std::thread::scope(|scope| {
        let thread = std::thread::Builder::new().stack_size(STACK);
        let thread = thread
            .spawn_scoped(scope, work)
            .map_err(|e| e.to_string())?;
        thread
            .join()
            .unwrap_or_else(|_| Err("the renderer failed".to_owned()))
    })
}

fn mathml(latex: &str, display_mode: DisplayMode) -> Result<String> {
    let refused = |why: &str| {
        let start: String = latex.chars().take(200).collect();
        Error::input(format!("a formula cannot be typeset: {why}: {start}"))
    };
    if latex.len() > LONGEST || depth(latex) > DEEPEST {
        return Err(refused("it is too long or nested too deep"));
    }
    let text = on_a_large_stack(|| rendered(latex, display_mode)).map_err(|e| refused(&e))?;
    if text.contains("<merror") {
        return Err(refused("a command or a bracket is not understood"));
    }
    if !is_mathml(&text) {
        return Err(refused("it brings elements that are no MathML"));
    }
    Ok(text.replace(
        &format!(" style=\"color: {MARK_DRAWN}\""),
        " class=\"marked\"",
    ))
}

/// The full stop behind a text that does not end as a sentence does.
pub(super) fn stop(text: &str) -> &'static str {
    if text.ends_with(['.', '!', '?']) {
        ""
    } else {
        "."
    }
}

#[cfg(test)]
mod tests {
    use super::{inline, stop};

    #[test]
    fn no_full_stop_is_doubled() {
        let ends = ["J. Fluid Mech. 23 (1965)", "It grows.", "Why?", ""].map(stop);
        assert_eq!(ends, [".", "", "", "."]);
    }

    /// A formula brings no elements, scripts or styles of its own; it is shown as it is written.
    #[test]
    fn formulas_bring_no_elements() {
        for latex in [
            r"\operatorname{<img src=x onerror=alert(1)>}",
            r"\mathop{<img src=x onerror=alert(1)>}",
            r"\operatorname{</mi></math><script>alert(1)</script>}",
            r"\operatorname{&lt;b&gt;<b>}",
            r"\text{<script>alert(1)</script>}",
            r#"\operatorname{a" onclick="x}"#,
            "<script>alert(1)</script>",
            r"x\color{red;background:url(x)} y",
        ] {
            let page = inline(latex).into_string();
            for element in ["<img", "<script", "<b>", "style=", "<a"] {
                assert!(!page.contains(element), "{latex}: {page}");
            }
        }
        assert!(
            inline(r"\frac{a^2}{b} \le \operatorname{Re} c")
                .into_string()
                .contains("<mfrac")
        );
    }

    #[test]
    fn formulas_of_any_depth_end() {
        for piece in [
            "{",
            r"\frac",
            r"\sqrt{",
            r"\left(",
            "x^",
            r"\begin{matrix}",
            r"\hat",
            "^",
        ] {
            for count in [50, 5000, 100_000] {
                inline(&piece.repeat(count));
            }
        }
    }
}
