//! Checks on raw text, before it is lexed as Rust tokens.
//!
//! Rust's lexer would answer an unbalanced bracket, a ∂ or a prime with a bare "lex error" and could
//! be made to recurse without bound; here each gets its place and a hint.

use crate::diagnostic::{Diagnostic, Location};

/// Deeper nesting than any model needs.
const DEEPEST_NESTING: usize = 64;
/// Longer than any model needs.
const LARGEST_FILE: usize = 1 << 20;
const LONGEST_NUMBER: usize = 320;
/// Mistakes after which the text is looked at no further.
const MOST_MISTAKES: usize = 200;

/// Characters that people write in formulas and Rust's lexer does not know.
const FOREIGN: [(char, &str); 12] = [
    ('∂', "write derivatives as dx(q), dy(q), dt(q)"),
    (
        '∇',
        "write the components with dx(q) and dy(q), for instance in a `let`",
    ),
    (
        '′',
        "write a y-derivative as dy(q); a perturbation needs no mark",
    ),
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
    ('∫', "write an integral over y as integral(q)"),
    ('½', "write the fraction as 1/2"),
];

/// Mistakes that make the text unfit for lexing.
pub fn check(file: usize, text: &str) -> Vec<Diagnostic> {
    let at = |start: usize, len: usize| Location {
        file,
        range: start..start + len,
    };
    if text.len() > LARGEST_FILE {
        let message = format!("the file has {} bytes", text.len());
        return vec![Diagnostic::new(at(0, 0), message, "at most 1 MiB")];
    }
    let mut found = Vec::new();
    let mut open: Vec<(usize, char)> = Vec::new();
    let mut characters = text.char_indices().peekable();
    while let Some((position, character)) = characters.next() {
        if found.len() >= MOST_MISTAKES {
            return found;
        }
        match character {
            '/' if characters.peek().is_some_and(|&(_, c)| c == '/') => {
                while characters.next_if(|&(_, c)| c != '\n').is_some() {}
            }
            '/' if characters.peek().is_some_and(|&(_, c)| c == '*') => {
                characters.next();
                let mut previous = ' ';
                let closed = characters.by_ref().any(|(_, c)| {
                    let end = previous == '*' && c == '/';
                    previous = c;
                    end
                });
                if !closed {
                    let message = "this comment is never closed";
                    found.push(Diagnostic::new(
                        at(position, 2),
                        message,
                        "`*/` further down",
                    ));
                }
            }
            '"' => {
                let mut escaped = false;
                let closed = characters.by_ref().any(|(_, c)| {
                    let end = c == '"' && !escaped;
                    escaped = c == '\\' && !escaped;
                    end
                });
                if !closed {
                    let message = "this text is never closed";
                    found.push(Diagnostic::new(at(position, 1), message, "a closing `\"`"));
                }
            }
            // Longer runs of digits are slow to read for what comes after.
            _ if character.is_ascii_digit() => {
                let mut length = 1;
                while characters
                    .next_if(|&(_, c)| c.is_ascii_alphanumeric())
                    .is_some()
                {
                    length += 1;
                }
                if length > LONGEST_NUMBER {
                    let message = format!("a number of {length} characters");
                    let expected = format!("at most {LONGEST_NUMBER}");
                    found.push(Diagnostic::new(at(position, 1), message, expected));
                }
            }
            '(' | '[' | '{' => {
                open.push((position, character));
                if open.len() > DEEPEST_NESTING {
                    let message = "brackets are nested too deeply";
                    let expected = format!("at most {DEEPEST_NESTING} levels");
                    found.push(
                        Diagnostic::new(at(position, 1), message, expected)
                            .hint("name the inner parts with `let`"),
                    );
                    return found;
                }
            }
            ')' | ']' | '}' => match open.pop() {
                Some((_, opening)) if closing(opening) == character => {}
                Some((start, opening)) => {
                    let message = format!("`{opening}` is closed by `{character}`");
                    let expected =
                        format!("`{}`, for the `{opening}` opened before", closing(opening));
                    let line = text[..start].matches('\n').count() + 1;
                    found.push(
                        Diagnostic::new(at(position, 1), message, expected)
                            .hint(format!("the `{opening}` stands in line {line}")),
                    );
                    return found;
                }
                None => {
                    let message = format!("`{character}` closes nothing");
                    let expected = "no bracket is open here";
                    found.push(Diagnostic::new(at(position, 1), message, expected));
                    return found;
                }
            },
            '\'' => found.push(
                Diagnostic::new(
                    at(position, 1),
                    "a prime is not part of the language",
                    "an operator or `;`",
                )
                .hint("write a y-derivative as dy(q); a perturbation needs no mark"),
            ),
            '#' | '`' | '\\' | '$' | '@' | '~' | '?' => found.push(Diagnostic::new(
                at(position, 1),
                format!("`{character}` is not part of the language"),
                "an operator, a name or a number",
            )),
            _ if character.is_ascii()
                || character.is_alphanumeric()
                || character.is_whitespace() =>
            {
                // ² and ³ count as numeric for Unicode.
                if let Some(hint) = foreign(character) {
                    found.push(
                        not_in_language(at(position, character.len_utf8()), character).hint(hint),
                    );
                }
            }
            _ => {
                let location = at(position, character.len_utf8());
                let hint = foreign(character).map(str::to_owned);
                found.push(not_in_language(location, character).maybe_hint(hint));
            }
        }
    }
    if let Some((start, opening)) = open.pop() {
        let message = format!("`{opening}` is never closed");
        let expected = format!("a matching `{}` further down", closing(opening));
        found.push(Diagnostic::new(at(start, 1), message, expected));
    }
    found
}

fn not_in_language(location: Location, character: char) -> Diagnostic {
    let message = format!("`{character}` is not part of the language");
    Diagnostic::new(location, message, "letters, digits and + - * / ^")
}

fn foreign(character: char) -> Option<&'static str> {
    FOREIGN
        .iter()
        .find(|(c, _)| *c == character)
        .map(|(_, hint)| *hint)
}

fn closing(opening: char) -> char {
    match opening {
        '(' => ')',
        '[' => ']',
        _ => '}',
    }
}
