//! Spec text → syntax tree.
//!
//! Tokens are Rust's (so that `proc_macro2` gives places in the text), the grammar is this module's. A
//! mistake ends the statement it stands in; parsing goes on with the next, so that one run reports
//! many.

mod block;
mod expression;
mod item;
mod lexical;
mod printable;
mod tokens;
pub mod tree;

use crate::diagnostic::{Diagnostic, Location};
use std::cell::{Cell, RefCell};
use syn::ext::IdentExt;
use syn::parse::{ParseBuffer, ParseStream, Parser};
use tree::{Formula, LawTree, ModelTree, Name};

/// Mistakes after which a file is read no further.
const MOST_MISTAKES: usize = 200;

/// Parses a `.model` file; `file` is its index in the list of sources.
pub fn parse_model(file: usize, text: &str) -> (ModelTree, Vec<Diagnostic>) {
    parse(file, text, |reader, input| reader.model(input))
}

/// Parses a `.law` file.
pub fn parse_laws(file: usize, text: &str) -> (LawTree, Vec<Diagnostic>) {
    parse(file, text, |reader, input| reader.laws(input))
}

/// Parses `left = right`, or an expression alone, as it stands in a printed formula.
pub fn parse_formula(text: &str) -> (Option<Formula>, Vec<Diagnostic>) {
    parse(0, text, |reader, input| reader.formula(input))
}

fn parse<T: Default>(
    file: usize,
    text: &str,
    grammar: impl FnOnce(&Reader<'_>, ParseStream) -> T,
) -> (T, Vec<Diagnostic>) {
    let mistakes = lexical::check(file, text);
    if !mistakes.is_empty() {
        return (T::default(), mistakes);
    }
    let mut reader = Reader {
        file,
        text,
        ends: Vec::new(),
        mistakes: RefCell::new(Vec::new()),
        depth: Cell::new(0),
    };
    let tokens: proc_macro2::TokenStream = match text.parse() {
        Ok(tokens) => tokens,
        Err(error) => {
            let error: proc_macro2::LexError = error;
            let location = reader.location(error.span());
            let message = "this is not part of the language";
            return (
                T::default(),
                vec![Diagnostic::new(
                    location,
                    message,
                    "a name, a number or an operator",
                )],
            );
        }
    };
    let Some(ends) = tokens::token_ends(tokens.clone()) else {
        let start = Location { file, range: 0..0 };
        return (T::default(), vec![tokens::too_deep(start)]);
    };
    reader.ends = ends;
    let mut tree = T::default();
    let outcome = Parser::parse2(
        |input: ParseStream| {
            tree = grammar(&reader, input);
            Ok(())
        },
        tokens,
    );
    // syn repeats here what the reader has reported already, if in vaguer words.
    if let (Err(error), true) = (outcome, reader.mistakes.borrow().is_empty()) {
        reader.report(reader.syntax_error(&error));
    }
    (tree, reader.mistakes.into_inner())
}

/// One file being read.
struct Reader<'a> {
    file: usize,
    text: &'a str,
    /// Where each token ends, in the order of the text.
    ends: Vec<usize>,
    mistakes: RefCell<Vec<Diagnostic>>,
    /// Expressions being read, one inside another.
    depth: Cell<usize>,
}

type Parsed<T> = Result<T, Diagnostic>;

impl Reader<'_> {
    fn report(&self, mistake: Diagnostic) {
        let mut mistakes = self.mistakes.borrow_mut();
        if mistakes.len() < MOST_MISTAKES {
            mistakes.push(mistake);
        }
    }

    /// Whether a file is so broken that reading on is of no use.
    fn has_given_up(&self) -> bool {
        self.mistakes.borrow().len() >= MOST_MISTAKES
    }

    fn location(&self, span: proc_macro2::Span) -> Location {
        let range = span.byte_range();
        // Past the last token, syn answers with an empty call-site span.
        let range = if range.is_empty() && range.start == 0 {
            self.text.len()..self.text.len()
        } else {
            range
        };
        Location {
            file: self.file,
            range,
        }
    }

    /// The place of the next token, or of the end of the enclosing block.
    fn here(&self, input: ParseStream) -> Location {
        let mut location = self.location(input.span());
        if input.is_empty() {
            location.range.end = location.range.end.min(location.range.start + 1);
        }
        location
    }

    fn syntax_error(&self, error: &syn::Error) -> Diagnostic {
        Diagnostic::new(
            self.location(error.span()),
            error.to_string(),
            "this is not expected here",
        )
    }

    fn unexpected(&self, input: ParseStream, expected: &str) -> Diagnostic {
        let location = self.here(input);
        let message = if input.is_empty() {
            "the statement ends too early".to_owned()
        } else {
            let token = input.cursor().token_tree().map(|(t, _)| match t {
                proc_macro2::TokenTree::Group(group) => match group.delimiter() {
                    proc_macro2::Delimiter::Brace => "{".to_owned(),
                    proc_macro2::Delimiter::Bracket => "[".to_owned(),
                    _ => "(".to_owned(),
                },
                token => token.to_string(),
            });
            format!("`{}` is not expected here", token.unwrap_or_default())
        };
        let mut location = location;
        if input.peek(syn::token::Brace) || input.peek(syn::token::Bracket) {
            location.range.end = location.range.start + 1;
        }
        Diagnostic::new(location, message, expected)
    }

    /// The mistake of a mark that is not there: at the end of the line that lacks it, where the next token
    /// stands on another.
    fn missing(&self, input: ParseStream, mark: &str, expected: &str) -> Diagnostic {
        let next = self.here(input).range.start;
        let before = self.ends.partition_point(|&end| end <= next);
        let end = before.checked_sub(1).map(|last| self.ends[last]);
        match end {
            Some(end) if self.text.get(end..next).is_some_and(|t| t.contains('\n')) => {
                let location = Location {
                    file: self.file,
                    range: end..end,
                };
                let message = format!("`{mark}` is missing at the end of this line");
                Diagnostic::new(location, message, expected)
            }
            _ => self.unexpected(input, expected),
        }
    }

    /// Consumes one token tree.
    fn skip(&self, input: ParseStream) {
        // A ParseStream over a non-empty cursor always yields a token tree.
        let _ = input.parse::<proc_macro2::TokenTree>();
    }

    /// Skips to the end of a statement: to just after the next `;` or `{ … }`.
    fn recover(&self, input: ParseStream) {
        while !input.is_empty() {
            let ends = input.peek(syn::Token![;]) || input.peek(syn::token::Brace);
            self.skip(input);
            if ends {
                break;
            }
        }
    }

    /// Consumes everything that is left.
    fn drain(&self, input: ParseStream) {
        while !input.is_empty() {
            self.skip(input);
        }
    }

    fn peek_name(&self, input: ParseStream) -> bool {
        input.peek(syn::Ident::peek_any)
    }

    /// Whether the next token is this word.
    fn peek_word(&self, input: ParseStream, word: &str) -> bool {
        input
            .cursor()
            .ident()
            .is_some_and(|(ident, _)| ident == word)
    }

    fn name(&self, input: ParseStream, expected: &str) -> Parsed<Name> {
        let location = self.here(input);
        match input.call(syn::Ident::parse_any) {
            Ok(ident) => Ok(Name {
                text: ident.to_string(),
                location,
            }),
            Err(_) => Err(self.unexpected(input, expected)),
        }
    }

    /// Consumes this word.
    fn word(&self, input: ParseStream, word: &str) -> Parsed<Location> {
        if self.peek_word(input, word) {
            let location = self.here(input);
            self.skip(input);
            Ok(location)
        } else {
            Err(self.unexpected(input, &format!("`{word}`")))
        }
    }

    /// Consumes punctuation of one or two characters.
    fn punctuation(&self, input: ParseStream, mark: &str) -> Parsed<()> {
        let mut cursor = input.cursor();
        for expected in mark.chars() {
            match cursor.punct() {
                Some((punct, after)) if punct.as_char() == expected => cursor = after,
                _ => return Err(self.missing(input, mark, &format!("`{mark}`"))),
            }
        }
        for _ in mark.chars() {
            self.skip_punct(input);
        }
        Ok(())
    }

    fn peek_punctuation(&self, input: ParseStream, mark: &str) -> bool {
        let mut cursor = input.cursor();
        mark.chars().all(|expected| match cursor.punct() {
            Some((punct, after)) if punct.as_char() == expected => {
                cursor = after;
                true
            }
            _ => false,
        })
    }

    fn skip_punct(&self, input: ParseStream) {
        let _ = input.parse::<proc_macro2::Punct>();
    }

    fn parenthesised<'a>(&self, input: &ParseBuffer<'a>) -> Parsed<ParseBuffer<'a>> {
        let result = (|| -> syn::Result<ParseBuffer<'a>> {
            let content;
            let _ = syn::parenthesized!(content in input);
            Ok(content)
        })();
        result.map_err(|_| self.unexpected(input, "`(`"))
    }

    fn braced<'a>(&self, input: &ParseBuffer<'a>) -> Parsed<ParseBuffer<'a>> {
        let result = (|| -> syn::Result<ParseBuffer<'a>> {
            let content;
            let _ = syn::braced!(content in input);
            Ok(content)
        })();
        result.map_err(|_| self.unexpected(input, "`{`"))
    }

    /// Reports what is left over.
    fn finished(&self, input: ParseStream, expected: &str) -> Parsed<()> {
        if input.is_empty() {
            return Ok(());
        }
        let mistake = self.unexpected(input, expected);
        self.drain(input);
        Err(mistake)
    }

    /// Reads statements until the block ends, going on after each mistake.
    fn statements(&self, input: ParseStream, mut statement: impl FnMut(ParseStream) -> Parsed<()>) {
        while !input.is_empty() {
            if self.has_given_up() {
                return self.drain(input);
            }
            let before = input.cursor();
            if let Err(mistake) = statement(input) {
                self.report(mistake);
                self.recover(input);
            } else if input.cursor() == before {
                self.skip(input);
            }
        }
    }

    /// Reads a braced block of statements.
    fn block(
        &self,
        input: ParseStream,
        statement: impl FnMut(ParseStream) -> Parsed<()>,
    ) -> Parsed<()> {
        let content = self.braced(input)?;
        self.statements(&content, statement);
        Ok(())
    }

    /// An optional doc string: one line, however many it is written over.
    fn doc(&self, input: ParseStream) -> String {
        let location = self.here(input);
        if !input.peek(syn::LitStr) {
            return String::new();
        }
        let Ok(literal) = input.parse::<syn::LitStr>() else {
            return String::new();
        };
        let text = literal.value();
        if !text.contains(printable::is_unprintable) {
            return text;
        }
        let words = text.split([' ', '\n', '\r', '\t']);
        let line = words.filter(|w| !w.is_empty()).collect::<Vec<_>>();
        let line = line.join(" ");
        if let Some(character) = line.chars().find(|&c| printable::is_unprintable(c)) {
            self.report(printable::not_printable(location, character));
        }
        line
    }
}

/// From the start of one place to the end of another.
fn spaced(start: &Location, end: &Location) -> Location {
    Location {
        file: start.file,
        range: start.range.start..end.range.end.max(start.range.end),
    }
}
