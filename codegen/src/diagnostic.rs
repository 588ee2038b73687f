//! What is wrong with a spec, where, what was expected, and what to try.

use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};
use std::ops::Range;

/// A spec or law file as the user wrote it.
#[derive(Clone, Debug)]
pub struct SourceFile {
    /// Path as it appears in diagnostics.
    pub path: String,
    pub text: String,
}

/// A byte range of one source file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Location {
    /// Index into the list of source files.
    pub file: usize,
    pub range: Range<usize>,
}

/// One mistake.
#[derive(Clone, Debug)]
pub struct Diagnostic {
    pub location: Location,
    /// What is wrong, in the user's words.
    pub message: String,
    /// What was expected at the caret.
    pub expected: String,
    /// What to try.
    pub hint: Option<String>,
}

impl Diagnostic {
    pub fn new(
        location: Location,
        message: impl Into<String>,
        expected: impl Into<String>,
    ) -> Self {
        Diagnostic {
            location,
            message: message.into(),
            expected: expected.into(),
            hint: None,
        }
    }

    pub fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }

    /// Like [`Diagnostic::hint`], for a hint that may be missing.
    pub fn maybe_hint(mut self, hint: Option<String>) -> Self {
        self.hint = hint;
        self
    }
}

/// All mistakes found in one run, with the sources they point into.
#[derive(Clone, Debug, Default)]
pub struct Diagnostics {
    pub files: Vec<SourceFile>,
    pub list: Vec<Diagnostic>,
}

impl Diagnostics {
    /// `file:line:column` messages with source line, caret, expectation and hint.
    pub fn render(&self) -> String {
        let renderer = Renderer::plain();
        let mut list: Vec<&Diagnostic> = self.list.iter().collect();
        list.sort_by_key(|d| (d.location.file, d.location.range.start));
        list.dedup_by(|a, b| a.location == b.location && a.message == b.message);
        let mut text = String::new();
        for diagnostic in list {
            let file = &self.files[diagnostic.location.file];
            let range = clamp(&file.text, &diagnostic.location.range);
            let snippet = Snippet::source(file.text.as_str())
                .path(file.path.as_str())
                .annotation(
                    AnnotationKind::Primary
                        .span(range)
                        .label(diagnostic.expected.as_str()),
                );
            let mut group = Level::ERROR
                .primary_title(diagnostic.message.as_str())
                .element(snippet);
            if let Some(hint) = &diagnostic.hint {
                group = group.element(Level::HELP.message(hint.as_str()));
            }
            text += &renderer.render(&[group]);
            text += "\n\n";
        }
        text
    }
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

/// The candidate nearest to `name`, if it is near enough to be a slip of the keyboard.
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    candidates
        .into_iter()
        .map(|candidate| (distance(name, candidate), candidate))
        .filter(|&(d, candidate)| {
            d <= 1 + candidate.chars().count() / 4 && d < name.chars().count()
        })
        .min_by_key(|&(d, _)| d)
        .map(|(_, candidate)| candidate)
}

/// Levenshtein distance.
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, &y) in b.iter().enumerate() {
            let substitution = diagonal + usize::from(x != y);
            diagonal = row[j + 1];
            row[j + 1] = substitution.min(row[j] + 1).min(row[j + 1] + 1);
        }
    }
    row[b.len()]
}
