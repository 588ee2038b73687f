//! Names of a study, written as it says: `k_u` as kₓᵤ in pictures, typeset on the page.

use super::study::Symbol;
use std::collections::BTreeMap;

/// Names by how they are written.
pub(super) type Symbols = BTreeMap<String, Symbol>;

/// A piece of a text.
pub(super) enum Piece<'a> {
    /// As it stands.
    Plain(&'a str),
    /// A name that the study writes otherwise.
    Name(&'a Symbol),
    /// Between dollar signs: LaTeX.
    Formula(&'a str),
}

/// The pieces of a text. A name is a whole word; what stands between dollar signs is a formula.
pub(super) fn pieces<'a>(text: &'a str, symbols: &'a Symbols) -> Vec<Piece<'a>> {
    let mut pieces = Vec::new();
    for (index, part) in text.split('$').enumerate() {
        match index % 2 {
            1 => pieces.push(Piece::Formula(part)),
            _ => pieces.extend(named(part, symbols)),
        }
    }
    pieces
}

fn named<'a>(text: &'a str, symbols: &'a Symbols) -> Vec<Piece<'a>> {
    let in_word = |c: char| c.is_alphanumeric() || c == '_';
    let (mut pieces, mut plain, mut at) = (Vec::new(), 0, 0);
    while at < text.len() {
        let rest = &text[at..];
        let word = rest.find(|c| !in_word(c)).unwrap_or(rest.len());
        let other = rest.find(in_word).unwrap_or(rest.len());
        if let Some(symbol) = symbols.get(&rest[..word]).filter(|_| word > 0) {
            if plain < at {
                pieces.push(Piece::Plain(&text[plain..at]));
            }
            pieces.push(Piece::Name(symbol));
            plain = at + word;
        }
        at += word.max(other).max(1);
    }
    if plain < text.len() {
        pieces.push(Piece::Plain(&text[plain..]));
    }
    pieces
}

/// A text as pictures have it.
pub(super) fn written(text: &str, symbols: &Symbols) -> String {
    let piece = |piece| match piece {
        Piece::Plain(text) | Piece::Formula(text) => text.to_owned(),
        Piece::Name(symbol) => symbol.text.clone(),
    };
    pieces(text, symbols).into_iter().map(piece).collect()
}

#[cfg(test)]
mod tests {
    use super::{Symbol, Symbols, written};

    #[test]
    fn names_are_whole_words() {
        let symbol = |text: &str| Symbol {
            text: text.to_owned(),
            latex: String::new(),
        };
        let symbols = Symbols::from([
            ("a2".to_owned(), symbol("a⁽²⁾")),
            ("k".to_owned(), symbol("kₓ")),
        ]);
        assert_eq!(
            written("a2 over k: a2(k), k_u, k2", &symbols),
            "a⁽²⁾ over kₓ: a⁽²⁾(kₓ), k_u, k2"
        );
        assert_eq!(written("", &symbols), "");
        assert_eq!(written("† k", &symbols), "† kₓ");
    }
}
