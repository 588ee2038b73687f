//! Checks on raw text, before it is lexed as Rust tokens.
//!
//! Rust's lexer would answer an unbalanced bracket, a ∂ or a prime with a bare "lex error" and could
//! be made to recurse without bound; here each gets its place and a hint.

use super::printable::unprintable;
use super::tokens::{DEEPEST_NESTING, too_deep};
use crate::diagnostic::{Diagnostic, Location};
use crate::sources::LARGEST_FILE;
use std::iter::Peekable;
use std::str::CharIndices;

/// Characters of a number.
const LONGEST_NUMBER: usize = 320;
/// Blanks before a line that are counted.
const WIDEST_INDENT: usize = 200;
/// Mistakes after which the text is looked at no further.
pub(super) const MOST_MISTAKES: usize = 200;

const PRIME: &str = "write a {y}-derivative as d{y}(q); a perturbation needs no mark";

/// Characters that people write in formulas and Rust's lexer does not know. In the hints, `{x}` and `{y}` stand for the names
/// of the coordinates.
const FOREIGN: [(char, &str); 12] = [
    ('∂', "write derivatives as d{x}(q), d{y}(q), dt(q)"),
    (
        '∇',
        "write the components with d{x}(q) and d{y}(q), for instance in a `let`",
    ),
    ('′', PRIME),
    ('²', "write a power as q^2"),
    ('³', "write a power as q^3"),
    (
        '⁰',
        "base-state values need no mark: the generator expands around them",
    ),
    ('·', "write a product with *"),
    ('×', "write a product with *"),
    ('−', "write a minus with the ASCII hyphen -"),
    ('√', "write a root as sqrt(q)"),
    ('∫', "write an integral over {y} as integral(q)"),
    ('½', "write the fraction as 1/2"),
];

/// Mistakes that make the text unfit for lexing.
pub fn check(file: usize, text: &str) -> Vec<Diagnostic> {
    if text.len() > LARGEST_FILE {
        let message = format!("the file has {} bytes", text.len());
        let start = Location { file, range: 0..0 };
        return vec![Diagnostic::new(start, message, "at most 1 MiB")];
    }
    let mistakes = unprintable(file, text);
    if !mistakes.is_empty() {
        return mistakes;
    }
    let mut scan = Scan {
        file,
        text,
        characters: text.char_indices().peekable(),
        mistakes: Vec::new(),
        open: Vec::new(),
        pairs: Vec::new(),
        first_long_text: None,
    };
    if scan.run().is_some() {
        scan.end();
    }
    scan.mistakes
}

/// Names of the periodic and of the bounded coordinate as the block `coordinates` of a text declares them, as far as
/// that can be told before the text is parsed.
fn coordinates(text: &str) -> [Option<&str>; 2] {
    let block = text.split("coordinates").nth(1);
    let block = block.and_then(|after| after.split_once('{')?.1.split('}').next());
    let mut names = [None, None];
    for declaration in block.unwrap_or_default().split(';') {
        if let Some((name, kind)) = declaration.split_once(':') {
            let is_bounded = kind.trim() != "periodic";
            let is_name = !name.trim().is_empty() && name.trim().chars().all(char::is_alphanumeric);
            names[usize::from(is_bounded)] = is_name.then(|| name.trim());
        }
    }
    names
}

/// The text of one file, read once from its start to its end.
struct Scan<'a> {
    file: usize,
    text: &'a str,
    characters: Peekable<CharIndices<'a>>,
    mistakes: Vec<Diagnostic>,
    /// Brackets that are open.
    open: Vec<(usize, char)>,
    /// Braces that are closed: where each opens and closes.
    pairs: Vec<(usize, usize)>,
    /// Where the first text begins that goes on over the end of its line.
    first_long_text: Option<usize>,
}

impl Scan<'_> {
    /// Reads on to the end; `None` after a mistake that leaves the meaning of the text behind it open.
    fn run(&mut self) -> Option<()> {
        while let Some((position, character)) = self.characters.next() {
            if self.mistakes.len() >= MOST_MISTAKES {
                return None;
            }
            let next = self.characters.peek().map(|&(_, c)| c);
            match character {
                '/' if next == Some('/') => {
                    while self.characters.next_if(|&(_, c)| c != '\n').is_some() {}
                }
                '/' if next == Some('*') => self.comment(position),
                '"' => self.quoted(position),
                // Longer runs of digits are slow to read for what comes after.
                _ if character.is_ascii_digit() => self.number(position),
                '(' | '[' | '{' => self.opens(position, character)?,
                ')' | ']' | '}' => self.closes(position, character)?,
                ';' => self.ends_statement(position)?,
                _ => self.single(position, character),
            }
        }
        Some(())
    }

    fn at(&self, start: usize, len: usize) -> Location {
        Location {
            file: self.file,
            range: start..start + len,
        }
    }

    fn report(&mut self, position: usize, message: impl Into<String>, expected: impl Into<String>) {
        let location = self.at(position, 1);
        self.mistakes
            .push(Diagnostic::new(location, message, expected));
    }

    /// Skips a comment whose `/` has been read, with the comments inside it.
    fn comment(&mut self, position: usize) {
        self.characters.next();
        let mut depth = 1;
        while let Some((_, character)) = self.characters.next() {
            match (character, self.characters.peek().map(|&(_, c)| c)) {
                ('/', Some('*')) => depth += 1,
                ('*', Some('/')) => depth -= 1,
                _ => continue,
            }
            self.characters.next();
            if depth == 0 {
                return;
            }
        }
        // What it hides may close the brackets before it.
        self.open.clear();
        let message = "this comment is never closed";
        let place = self.at(position, 2);
        self.mistakes
            .push(Diagnostic::new(place, message, "`*/` further down"));
    }

    /// Skips a text whose `"` has been read.
    fn quoted(&mut self, position: usize) {
        let (mut escaped, mut lines) = (false, 0);
        let closed = self.characters.by_ref().any(|(_, c)| {
            let end = c == '"' && !escaped;
            escaped = c == '\\' && !escaped;
            lines += usize::from(c == '\n');
            end
        });
        if closed {
            if lines > 0 {
                self.first_long_text.get_or_insert(position);
            }
            return;
        }
        self.open.clear();
        // The quotation mark that is missing may be that of an earlier text, which then ends at the next one.
        match self.first_long_text {
            Some(first) => self.report(
                first,
                "this text goes on over the end of its line, and a later one is never closed",
                "a closing `\"`",
            ),
            None => self.report(position, "this text is never closed", "a closing `\"`"),
        }
    }

    fn number(&mut self, position: usize) {
        let mut length = 1;
        let is_part = |&(_, c): &(usize, char)| c.is_ascii_alphanumeric();
        while self.characters.next_if(is_part).is_some() {
            length += 1;
        }
        if length > LONGEST_NUMBER {
            let message = format!("a number of {length} characters");
            self.report(position, message, format!("at most {LONGEST_NUMBER}"));
        }
    }

    fn opens(&mut self, position: usize, character: char) -> Option<()> {
        self.open.push((position, character));
        if self.open.len() > DEEPEST_NESTING {
            self.mistakes.push(too_deep(self.at(position, 1)));
            return None;
        }
        Some(())
    }

    fn closes(&mut self, position: usize, character: char) -> Option<()> {
        match self.open.pop() {
            Some((start, opening)) if closing(opening) == character => {
                if character == '}' {
                    self.pairs.push((start, position));
                }
                return Some(());
            }
            Some((start, opening)) => {
                let message = format!("`{opening}` is closed by `{character}`");
                let expected = format!("`{}`, for the `{opening}` opened before", closing(opening));
                let hint = format!("the `{opening}` stands in line {}", self.line(start));
                let place = self.at(position, 1);
                self.mistakes
                    .push(Diagnostic::new(place, message, expected).hint(hint));
            }
            None => {
                let message = format!("`{character}` closes nothing");
                let hint = self.misplaced_brace();
                let place = self.at(position, 1);
                self.mistakes.push(
                    Diagnostic::new(place, message, "no bracket is open here").maybe_hint(hint),
                );
            }
        }
        None
    }

    /// A `;` ends a statement, and the brackets that the statement has opened.
    fn ends_statement(&mut self, position: usize) -> Option<()> {
        match self.open.last() {
            Some(&(start, opening)) if opening != '{' => {
                let message = format!("`{opening}` is never closed");
                let line = self.line(position);
                let expected = format!(
                    "a matching `{}` before the `;` in line {line}",
                    closing(opening)
                );
                self.report(start, message, expected);
                None
            }
            _ => Some(()),
        }
    }

    /// A character that stands for itself.
    fn single(&mut self, position: usize, character: char) {
        let place = self.at(position, character.len_utf8());
        let mistake = match character {
            '\'' => Diagnostic::new(
                place,
                "a prime is not part of the language",
                "an operator or `;`",
            )
            .hint(self.named(PRIME)),
            '#' | '`' | '\\' | '$' | '@' | '~' | '?' => Diagnostic::new(
                place,
                format!("`{character}` is not part of the language"),
                "an operator, a name or a number",
            ),
            _ => {
                let hint = FOREIGN.iter().find(|(foreign, _)| *foreign == character);
                let is_plain = character.is_ascii()
                    || character.is_alphanumeric()
                    || character.is_whitespace();
                // ² and ³ count as numeric for Unicode.
                if is_plain && hint.is_none() {
                    return;
                }
                let message = format!("`{character}` is not part of the language");
                Diagnostic::new(place, message, "letters, digits and + - * / ^")
                    .maybe_hint(hint.map(|(_, hint)| self.named(hint)))
            }
        };
        self.mistakes.push(mistake);
    }

    /// A hint with the names of the coordinates for `{x}` and `{y}`.
    fn named(&self, hint: &str) -> String {
        let [periodic, bounded] = coordinates(self.text);
        hint.replace("{x}", periodic.unwrap_or("x"))
            .replace("{y}", bounded.unwrap_or("y"))
    }

    /// Reports what is open at the end of the file.
    fn end(&mut self) {
        if let Some((start, opening)) = self.open.pop() {
            let message = format!("`{opening}` is never closed");
            let expected = format!("a matching `{}` further down", closing(opening));
            let hint = self.misplaced_brace();
            let place = self.at(start, 1);
            self.mistakes
                .push(Diagnostic::new(place, message, expected).maybe_hint(hint));
        }
    }

    /// The first pair of braces that are not indented alike: the missing or surplus one is likely between them.
    fn misplaced_brace(&self) -> Option<String> {
        let breaks = self.text.match_indices('\n').map(|(at, _)| at + 1);
        let starts: Vec<usize> = std::iter::once(0).chain(breaks).collect();
        let line = |position: usize| starts.partition_point(|&start| start <= position);
        let indent = |line: usize| {
            let text = self.text[starts[line - 1]..].bytes();
            text.take(WIDEST_INDENT)
                .take_while(|b| matches!(b, b' ' | b'\t'))
                .count()
        };
        let is_askew = |&(start, end): &(usize, usize)| {
            let (opening, closing) = (line(start), line(end));
            let begins_line = starts[closing - 1] + indent(closing) == end;
            opening != closing && begins_line && indent(opening) != indent(closing)
        };
        let mut pairs = self.pairs.clone();
        pairs.sort_by_key(|&(_, end)| end);
        let (start, end) = pairs.into_iter().find(is_askew)?;
        Some(format!(
            "the `}}` in line {} closes the `{{` in line {}, which is indented otherwise",
            line(end),
            line(start)
        ))
    }

    fn line(&self, position: usize) -> usize {
        self.text[..position].matches('\n').count() + 1
    }
}

fn closing(opening: char) -> char {
    match opening {
        '(' => ')',
        '[' => ']',
        _ => '}',
    }
}
