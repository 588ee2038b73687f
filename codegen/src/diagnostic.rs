//! What is wrong with a spec, where, what was expected, and what to try.

use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};
use std::collections::BTreeSet;
use std::ops::Range;

pub use landau_contract::nearest;

/// Mistakes that are told one by one.
const MOST_TOLD: usize = 20;
/// Longer texts are cut in the middle.
const LONGEST_TEXT: usize = 400;
/// Longer source lines are shown around the caret alone.
const LONGEST_LINE: usize = 200;
/// What is kept of a long source line on either side of the caret.
const WINDOW: usize = 60;

/// A spec or law file as the user wrote it.
#[derive(Clone, Debug)]
pub struct SourceFile {
    /// Path as it appears in diagnostics.
    pub path: String,
    /// Its text.
    pub text: String,
}

/// A byte range of one source file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Location {
    /// Index into the list of source files.
    pub file: usize,
    /// Bytes from and to.
    pub range: Range<usize>,
}

/// One mistake.
#[derive(Clone, Debug)]
pub struct Diagnostic {
    /// Where the spec says so.
    pub location: Location,
    /// What is wrong, in the user's words.
    pub message: String,
    /// What was expected at the caret.
    pub expected: String,
    /// What to try.
    pub hint: Option<String>,
    /// The undeclared name, if that is the mistake. It is reported once for a file.
    pub unknown: Option<String>,
}

impl Diagnostic {
    /// Of the given parts.
    pub fn new(
        location: Location,
        message: impl Into<String>,
        expected: impl Into<String>,
    ) -> Self {
        Diagnostic {
            location,
            message: shortened(&message.into()),
            expected: shortened(&expected.into()),
            hint: None,
            unknown: None,
        }
    }

    /// Marks the mistake as that of an undeclared name.
    pub fn about_unknown(mut self, name: &str) -> Self {
        self.unknown = Some(name.to_owned());
        self
    }

    /// Adds a hint.
    pub fn hint(self, hint: impl Into<String>) -> Self {
        self.maybe_hint(Some(hint.into()))
    }

    /// Like [`Diagnostic::hint`], for a hint that may be missing.
    pub fn maybe_hint(mut self, hint: Option<String>) -> Self {
        self.hint = hint.map(|text| shortened(&text));
        self
    }
}

/// All mistakes found in one run, with the sources they point into.
#[derive(Clone, Debug, Default)]
pub struct Diagnostics {
    /// Files that the messages point into.
    pub files: Vec<SourceFile>,
    /// In the order of the text.
    pub list: Vec<Diagnostic>,
}

impl Diagnostics {
    /// `file:line:column` messages with source line, caret, expectation and hint; the first of many, and how
    /// many there are more.
    pub fn render(&self) -> String {
        let mut list: Vec<&Diagnostic> = self.list.iter().collect();
        list.sort_by_key(|d| (d.location.file, d.location.range.start));
        list.dedup_by(|a, b| a.location == b.location && a.message == b.message);
        let list = self.one_for_each_name(list);
        let mut text = String::new();
        for diagnostic in list.iter().take(MOST_TOLD) {
            text += &self.render_one(diagnostic);
            text += "\n\n";
        }
        if list.len() > MOST_TOLD {
            text += &format!("and {} more mistakes\n\n", list.len() - MOST_TOLD);
        }
        text
    }

    /// The mistakes with one for all uses of an unknown name; it lists the lines of the further uses.
    fn one_for_each_name(&self, list: Vec<&Diagnostic>) -> Vec<Diagnostic> {
        let mut told: Vec<(Diagnostic, BTreeSet<usize>)> = Vec::new();
        for diagnostic in list {
            let same = |(first, _): &&mut (Diagnostic, BTreeSet<usize>)| {
                diagnostic.unknown.is_some()
                    && first.unknown == diagnostic.unknown
                    && first.location.file == diagnostic.location.file
            };
            match told.iter_mut().find(same) {
                Some((_, lines)) => {
                    lines.insert(self.line(&diagnostic.location));
                }
                None => told.push((diagnostic.clone(), BTreeSet::new())),
            }
        }
        let with_lines = |(mut diagnostic, mut lines): (Diagnostic, BTreeSet<usize>)| {
            lines.remove(&self.line(&diagnostic.location));
            if let Some(name) = diagnostic.unknown.as_ref().filter(|_| !lines.is_empty()) {
                let plural = if lines.len() > 1 { "s" } else { "" };
                let lines: Vec<String> = lines.iter().map(usize::to_string).collect();
                let further = format!("`{name}` stands in line{plural} {} too", lines.join(", "));
                diagnostic.hint = Some(match diagnostic.hint {
                    Some(hint) => format!("{hint} ({further})"),
                    None => further,
                });
            }
            diagnostic
        };
        told.into_iter().map(with_lines).collect()
    }

    /// The line of a place, from 1.
    fn line(&self, place: &Location) -> usize {
        let text = &self.files[place.file].text;
        let before = &text[..clamp(text, &place.range).start];
        before.matches('\n').count() + 1
    }

    fn render_one(&self, diagnostic: &Diagnostic) -> String {
        let file = &self.files[diagnostic.location.file];
        let range = clamp(&file.text, &diagnostic.location.range);
        // The lines of the place alone, so that a long file costs nothing.
        let start = file.text[..range.start].rfind('\n').map_or(0, |at| at + 1);
        let end = file.text[range.end..]
            .find('\n')
            .map_or(file.text.len(), |at| range.end + at);
        let number = file.text[..start].matches('\n').count() + 1;
        let lines = &file.text[start..end];
        let mut span = range.start - start..range.end - start;
        let mut path = file.path.clone();
        let mut shown = lines.to_owned();
        let longest = lines.lines().map(str::len).max().unwrap_or(0);
        if longest > LONGEST_LINE || lines.len() > LONGEST_TEXT {
            // The path names line and column, because columns of the excerpt are not those of the file.
            let column = file.text[start..range.start].chars().count() + 1;
            path = format!("{path}:{number}:{column}, in an excerpt");
            let window = span.start.saturating_sub(WINDOW)..span.start + WINDOW;
            let window = clamp(lines, &window);
            shown = lines[window.clone()].replace('\n', " ");
            span = span.start - window.start..(span.end - window.start).min(shown.len());
        }
        let shown: String = shown.chars().map(visible).collect();
        let snippet = Snippet::source(shown.as_str())
            .path(path.as_str())
            .line_start(number)
            .annotation(
                AnnotationKind::Primary
                    .span(span)
                    .label(diagnostic.expected.as_str()),
            );
        let mut group = Level::ERROR
            .primary_title(diagnostic.message.as_str())
            .element(snippet);
        if let Some(hint) = &diagnostic.hint {
            group = group.element(Level::HELP.message(hint.as_str()));
        }
        Renderer::plain().render(&[group])
    }
}

/// Stands in for marks that turn the direction of a line, with as many bytes.
fn visible(character: char) -> char {
    match character {
        '\u{61c}' => '¿',
        '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => '\u{fffd}',
        plain => plain,
    }
}

/// A text of readable length, its middle left out if need be.
pub fn shortened(text: &str) -> String {
    if text.len() <= LONGEST_TEXT {
        return text.to_owned();
    }
    let part = |range: Range<usize>| &text[clamp(text, &range)];
    let side = LONGEST_TEXT / 2;
    format!(
        "{} … {}",
        part(0..side),
        part(text.len() - side..text.len())
    )
}

impl std::fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.render().trim_end())
    }
}

impl std::error::Error for Diagnostics {}

/// The range, moved onto character boundaries inside the text.
fn clamp(text: &str, range: &Range<usize>) -> Range<usize> {
    let floor = |mut at: usize| {
        at = at.min(text.len());
        while !text.is_char_boundary(at) {
            at -= 1;
        }
        at
    };
    let start = floor(range.start);
    let end = floor(range.end).max(start);
    start..end
}
