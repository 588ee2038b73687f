//! LaTeX as tokens, layout left out.

use std::ops::Range;

/// What a token is.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum Kind {
    /// `\name`, without the backslash.
    Command(String),
    /// One letter.
    Letter(char),
    /// Digits, with a decimal point among them.
    Number(String),
    /// An opening bracket of a formula, of any size: ( [ {
    Open(char),
    /// A closing one: ) ] }
    Close(char),
    /// A brace of LaTeX itself.
    Begin,
    /// Its end.
    End,
    /// + − = / ^ _ ' | :
    Sign(char),
}

/// A token and where it stands.
#[derive(Clone, Debug)]
pub(super) struct Token {
    pub kind: Kind,
    pub range: Range<usize>,
}

/// Commands that say how a formula is set, and nothing of what it is.
const LAYOUT: [&str; 10] = [
    "quad",
    "qquad",
    "displaystyle",
    "mathrm",
    "mathcal",
    "boldsymbol",
    "nonumber",
    "mathit",
    "rm",
    "bm",
];

/// Sizes of the bracket that follows.
const SIZES: [&str; 10] = [
    "left", "right", "big", "Big", "bigg", "Bigg", "bigl", "bigr", "Bigl", "Bigr",
];

/// The tokens of a formula; what separates lines and columns is skipped, and so is punctuation at its end.
pub(super) fn tokens(text: &str) -> Vec<Token> {
    let mut tokens = Vec::new();
    let mut unread = text;
    let mut sized = false;
    while let Some(first) = unread.chars().next() {
        let start = text.len() - unread.len();
        let (kind, length) = next(unread, first, sized);
        sized = matches!(&kind, Next::Size);
        if let Next::Token(kind) = kind {
            let range = start..start + length;
            tokens.push(Token { kind, range });
        }
        unread = &unread[length..];
    }
    tokens
}

enum Next {
    Token(Kind),
    /// The next character is a bracket, or a full stop for none.
    Size,
    Skip,
}

fn next(text: &str, first: char, sized: bool) -> (Next, usize) {
    let token = |kind| Next::Token(kind);
    match first {
        '\\' => command(text),
        '.' if sized => (Next::Skip, 1),
        '0'..='9' => {
            let decimal = |c: char| c.is_ascii_digit() || c == '.';
            let length = text.find(|c| !decimal(c)).unwrap_or(text.len());
            let number = text[..length].trim_end_matches('.');
            (token(Kind::Number(number.to_owned())), number.len())
        }
        '(' | '[' => (token(Kind::Open(first)), 1),
        ')' | ']' => (token(Kind::Close(first)), 1),
        '{' => (token(Kind::Begin), 1),
        '}' => (token(Kind::End), 1),
        '+' | '-' | '=' | '/' | '^' | '_' | '\'' | '|' | ':' => (token(Kind::Sign(first)), 1),
        c if c.is_alphabetic() => (token(Kind::Letter(c)), c.len_utf8()),
        c => (Next::Skip, c.len_utf8()),
    }
}

fn command(text: &str) -> (Next, usize) {
    let name = &text[1..];
    let length = name
        .find(|c: char| !c.is_ascii_alphabetic())
        .unwrap_or(name.len());
    if length == 0 {
        let escaped = name.chars().next().unwrap_or(' ');
        let next = match escaped {
            '{' => Next::Token(Kind::Open('{')),
            '}' => Next::Token(Kind::Close('}')),
            _ => Next::Skip,
        };
        return (next, 1 + escaped.len_utf8().min(name.len()));
    }
    let (name, after) = name.split_at(length);
    match name {
        "begin" | "end" | "tag" => {
            let braces = after.find('}').map_or(after.len(), |end| end + 1);
            (Next::Skip, 1 + length + braces)
        }
        name if SIZES.contains(&name) => (Next::Size, 1 + length),
        name if LAYOUT.contains(&name) => (Next::Skip, 1 + length),
        name => (Next::Token(Kind::Command(name.to_owned())), 1 + length),
    }
}

/// A formula as the symbols that are seen: each a letter, then the signs above and below it in a fixed
/// order, so that formulas that look the same are the same.
pub fn symbols(text: &str) -> Vec<Vec<String>> {
    let tokens = tokens(text);
    let (mut symbols, mut unread) = (Vec::new(), tokens.as_slice());
    while let Some(first) = unread.first() {
        let name = match &first.kind {
            // {D} ends before its scripts, and scripts may stand alone in a part of a formula.
            Kind::Begin | Kind::End => None,
            Kind::Sign('^' | '_' | '\'') => Some(String::new()),
            kind => Some(shown(kind)),
        };
        if name.as_deref() != Some("") {
            unread = &unread[1..];
        }
        if let Some(name) = name {
            let (scripts, after) = scripts(unread);
            unread = after;
            let named = std::iter::once(name).filter(|name| !name.is_empty());
            symbols.push(named.chain(scripts).collect());
        }
    }
    symbols
}

/// The signs above and below a symbol: marks, subscripts, powers.
fn scripts(mut unread: &[Token]) -> (Vec<String>, &[Token]) {
    let (mut marks, mut below, mut powers) = (Vec::new(), Vec::new(), Vec::new());
    loop {
        let after_braces = unread.iter().position(|token| token.kind != Kind::End);
        let at = &unread[after_braces.unwrap_or(unread.len())..];
        match at.first().map(|token| &token.kind) {
            Some(Kind::Sign('\'')) => {
                marks.push("'".to_owned());
                unread = &at[1..];
            }
            Some(Kind::Sign(sign @ ('^' | '_'))) => {
                let (inside, after) = group(&at[1..]);
                unread = after;
                let mut inside: Vec<String> = inside.iter().map(|t| shown(&t.kind)).collect();
                let marked = |sign: &String| ["0", "dagger", "prime"].contains(&sign.as_str());
                if *sign == '_' {
                    below.extend(inside);
                    continue;
                }
                if inside.first().is_some_and(marked) {
                    marks.push(inside.remove(0));
                }
                if !inside.is_empty() {
                    powers.push(format!("^{}", inside.concat().trim_start_matches('^')));
                }
            }
            _ => break,
        }
    }
    marks.extend(below);
    marks.extend(powers);
    (marks, unread)
}

/// The next pair of braces, or the next token, and what comes after it.
fn group(tokens: &[Token]) -> (&[Token], &[Token]) {
    let [first, after @ ..] = tokens else {
        return (&[], &[]);
    };
    if first.kind != Kind::Begin {
        return (&tokens[..1], after);
    }
    let mut depth = 1;
    let end = after.iter().position(|token| {
        depth += match token.kind {
            Kind::Begin => 1,
            Kind::End => -1,
            _ => 0,
        };
        depth == 0
    });
    let end = end.unwrap_or(after.len());
    (&after[..end], after.get(end + 1..).unwrap_or_default())
}

fn shown(kind: &Kind) -> String {
    match kind {
        Kind::Letter(letter) => letter.to_string(),
        Kind::Command(text) | Kind::Number(text) => text.clone(),
        Kind::Open(sign) | Kind::Close(sign) | Kind::Sign(sign) => sign.to_string(),
        Kind::Begin | Kind::End => String::new(),
    }
}
