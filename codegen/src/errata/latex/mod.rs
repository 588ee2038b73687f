//! A formula in LaTeX, as a source prints it, in the language of the spec.
//!
//! The reader knows what papers write: ∂n'²/∂y, n'_y, p⁰_nT, (u'·∇)v', ∇·u', operators that act on what
//! follows and, where a formula prints an entry of L, on the field that is not written. It mends nothing: brackets
//! that are not closed stay open and are counted.

mod operator;
mod symbol;
mod token;

pub use token::symbols;

use operator::{Operator, Value};
use std::ops::Range;
use token::{Kind, Token, tokens};

/// What letters stand for in a formula.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Letters {
    /// The full state: n is n.
    State,
    /// The base state alone: n is n⁰.
    Base,
    /// Perturbations carry a prime, adjoint fields a dagger, base values a nought; n alone is n⁰ + n'.
    Perturbation,
}

/// What the reader has to know of a model.
pub(super) struct Vocabulary<'a> {
    /// Fields, by name.
    pub fields: &'a [String],
    /// Laws, by name.
    pub laws: &'a [String],
    /// Parameters and abbreviations.
    pub constants: &'a [String],
    /// Vectors by letter, their components along the two coordinates.
    pub vectors: &'a [(String, [String; 2])],
    /// The periodic and the cross-stream coordinate.
    pub coordinates: [&'a str; 2],
    pub letters: Letters,
    /// The field that an operator's entry acts on.
    pub operand: Option<&'a str>,
}

/// A formula in the language of the spec.
pub(super) struct Reading {
    pub text: String,
    /// Brackets that are never closed.
    pub unclosed: usize,
}

/// What is wrong, and where.
pub(super) struct Unreadable {
    pub message: String,
    pub range: Range<usize>,
}

type Read<T> = Result<T, Unreadable>;

/// Bytes of a formula.
const LONGEST_FORMULA: usize = 1 << 14;
/// Brackets, fractions and roots inside one another.
const DEEPEST_NESTING: usize = 64;
/// Factors of one product.
const MOST_FACTORS: usize = 256;
/// Bytes of what a formula is read as.
const LONGEST_READING: usize = 1 << 18;

/// Reads a formula.
pub(super) fn read(text: &str, vocabulary: &Vocabulary) -> Read<Reading> {
    if text.len() > LONGEST_FORMULA {
        return Err(Unreadable {
            message: format!(
                "a formula of {} bytes; at most {LONGEST_FORMULA}",
                text.len()
            ),
            range: 0..0,
        });
    }
    let tokens = tokens(text);
    let mut reader = Reader {
        tokens: &tokens,
        position: 0,
        end: text.len(),
        vocabulary,
        unclosed: 0,
        perturbed: false,
        depth: 0,
    };
    let mut sides = vec![reader.sum()?];
    while reader.sign('=') || reader.command("equiv") {
        sides.push(reader.sum()?);
    }
    if let Some(token) = reader.peek() {
        return Err(reader.unreadable("this closes nothing", token.range.clone()));
    }
    // A condition that names its field is no operator.
    let operand = vocabulary.operand.filter(|_| !reader.perturbed);
    let mut texts = Vec::new();
    for side in sides {
        texts.push(match (side, operand) {
            (Value::Plain(text), None) => text,
            (Value::Plain(text), Some(field)) => format!("({text})*{field}"),
            (Value::Acting(operator), Some(field)) => {
                reader.applied(&operator, field, &(0..text.len()))?
            }
            (Value::Acting(_), None) => {
                return Err(reader.unreadable("this operator acts on nothing", 0..text.len()));
            }
        });
    }
    Ok(Reading {
        text: texts.join(" = "),
        unclosed: reader.unclosed,
    })
}

struct Reader<'a> {
    tokens: &'a [Token],
    position: usize,
    end: usize,
    vocabulary: &'a Vocabulary<'a>,
    unclosed: usize,
    /// Whether a perturbation has been named.
    perturbed: bool,
    /// Sums being read, one inside another.
    depth: usize,
}

impl<'a> Reader<'a> {
    fn peek(&self) -> Option<&'a Token> {
        self.tokens.get(self.position)
    }

    fn kind(&self) -> Option<&'a Kind> {
        self.peek().map(|token| &token.kind)
    }

    fn take(&mut self, kind: &Kind) -> bool {
        let is_next = self.kind() == Some(kind);
        self.position += usize::from(is_next);
        is_next
    }

    fn sign(&mut self, sign: char) -> bool {
        self.take(&Kind::Sign(sign))
    }

    fn command(&mut self, name: &str) -> bool {
        let is_next = matches!(self.kind(), Some(Kind::Command(command)) if command == name);
        self.position += usize::from(is_next);
        is_next
    }

    fn unreadable(&self, message: &str, range: Range<usize>) -> Unreadable {
        Unreadable {
            message: message.to_owned(),
            range,
        }
    }

    fn here(&self) -> Range<usize> {
        self.peek()
            .map_or(self.end..self.end, |token| token.range.clone())
    }

    /// The tokens of the next pair of braces, or the next token alone.
    fn argument(&mut self) -> Read<&'a [Token]> {
        let start = self.position;
        if !self.take(&Kind::Begin) {
            self.position += 1;
            return match self.tokens.get(start..start + 1) {
                Some(one) => Ok(one),
                None => Err(self.unreadable("something is missing here", self.end..self.end)),
            };
        }
        let mut depth = 1;
        while depth > 0 {
            match self.kind() {
                Some(Kind::Begin) => depth += 1,
                Some(Kind::End) => depth -= 1,
                Some(_) => {}
                None => {
                    return Err(self.unreadable(
                        "this brace is never closed",
                        self.tokens[start].range.clone(),
                    ));
                }
            }
            self.position += 1;
        }
        Ok(&self.tokens[start + 1..self.position - 1])
    }

    /// The same reader on part of the tokens, which has to be plain.
    fn within(&mut self, tokens: &'a [Token]) -> Read<String> {
        let mut inner = Reader {
            tokens,
            position: 0,
            end: tokens.last().map_or(self.end, |token| token.range.end),
            ..*self
        };
        let value = inner.sum()?;
        let (left, range) = (inner.position < tokens.len(), inner.here());
        (self.unclosed, self.perturbed) = (inner.unclosed, inner.perturbed);
        match value {
            _ if left => Err(self.unreadable("this closes nothing", range)),
            Value::Plain(text) => Ok(text),
            Value::Acting(_) => Err(self.unreadable("this operator acts on nothing", range)),
        }
    }

    /// An operator applied to an operand, which the text may repeat.
    fn applied(&self, operator: &Operator, operand: &str, range: &Range<usize>) -> Read<String> {
        if operator.length(operand.len()) > LONGEST_READING {
            let message = "these operators multiply out to too many terms";
            return Err(self.unreadable(message, range.clone()));
        }
        Ok(operator.on(operand))
    }

    /// A sum, at most [`DEEPEST_NESTING`] of them inside one another.
    fn sum(&mut self) -> Read<Value> {
        if self.depth > DEEPEST_NESTING {
            let message = format!("nested too deeply; at most {DEEPEST_NESTING} levels");
            return Err(self.unreadable(&message, self.here()));
        }
        self.depth += 1;
        let sum = self.terms();
        self.depth -= 1;
        sum
    }

    /// ± term ± term …
    fn terms(&mut self) -> Read<Value> {
        let mut terms = Vec::new();
        loop {
            let negative = match (self.sign('+'), self.sign('-')) {
                (_, true) => true,
                (true, false) => false,
                (false, false) if terms.is_empty() => false,
                _ => break,
            };
            terms.push((negative, self.product()?));
        }
        if terms.len() == 1 && !terms[0].0 {
            return Ok(terms.remove(0).1);
        }
        if terms
            .iter()
            .any(|(_, term)| matches!(term, Value::Acting(_)))
        {
            return Ok(Value::Acting(Operator::Sum(terms)));
        }
        let mut text = String::new();
        for (negative, term) in &terms {
            let Value::Plain(term) = term else { continue };
            text += match (text.is_empty(), negative) {
                (true, false) => "",
                (true, true) => "-",
                (false, false) => " + ",
                (false, true) => " - ",
            };
            text += term;
        }
        Ok(Value::Plain(text))
    }

    /// Factors side by side: an operator acts on the next, or waits where none follows.
    fn product(&mut self) -> Read<Value> {
        let start = self.here();
        let mut factors = Vec::new();
        while let Some(kind) = self.kind() {
            match kind {
                Kind::Sign('+' | '-' | '=') | Kind::Close(_) | Kind::End => break,
                Kind::Command(name) if name == "equiv" => break,
                Kind::Command(name) if name == "times" || name == "cdot" => self.position += 1,
                Kind::Sign('/') => {
                    self.position += 1;
                    let below = self.factor()?;
                    match (factors.pop(), below) {
                        (Some(Value::Plain(above)), Value::Plain(below)) => {
                            factors.push(Value::Plain(format!("({above})/({below})")));
                        }
                        _ => {
                            return Err(self
                                .unreadable("only numbers and symbols are divided", self.here()));
                        }
                    }
                }
                Kind::Sign('|') => factors.extend(self.bar()?.map(Value::Acting)),
                _ => factors.push(self.factor()?),
            }
        }
        if factors.is_empty() {
            return Err(self.unreadable("a term is missing here", start));
        }
        if factors.len() > MOST_FACTORS {
            let message = format!(
                "a product of {} factors; at most {MOST_FACTORS}",
                factors.len()
            );
            return Err(self.unreadable(&message, start));
        }
        let (mut right, mut waiting): (Vec<String>, Option<Operator>) = (Vec::new(), None);
        for factor in factors.into_iter().rev() {
            match (factor, waiting.take()) {
                (Value::Plain(text), None) => right.insert(0, text),
                (Value::Plain(text), Some(operator)) => {
                    waiting = Some(Operator::Scaled(text, Box::new(operator)));
                }
                (Value::Acting(outer), Some(inner)) => {
                    waiting = Some(Operator::Composed(Box::new(outer), Box::new(inner)));
                }
                (Value::Acting(operator), None) => match right.first_mut() {
                    Some(next) => *next = self.applied(&operator, next, &start)?,
                    None => waiting = Some(operator),
                },
            }
        }
        Ok(match waiting {
            Some(operator) => Value::Acting(operator),
            None => Value::Plain(right.join("*")),
        })
    }

    /// |∂x|; or |_{y=0}, the place that a value is taken at, which what the formula is about says.
    fn bar(&mut self) -> Read<Option<Operator>> {
        self.position += 1;
        let range = self.here();
        if self.command("partial") {
            let closed = self.sign('_') && self.argument().is_ok() && self.sign('|');
            return if closed {
                Ok(Some(Operator::Modulus))
            } else {
                Err(self.unreadable("`|` goes round ∂ by the periodic coordinate", range))
            };
        }
        if self.sign('_') {
            self.argument()?;
        }
        Ok(None)
    }

    fn factor(&mut self) -> Read<Value> {
        let range = self.here();
        let Some(token) = self.peek() else {
            return Err(self.unreadable("a factor is missing here", range));
        };
        match &token.kind {
            Kind::Number(digits) => {
                self.position += 1;
                let power = self.power()?;
                Ok(Value::Plain(format!("{digits}{power}")))
            }
            Kind::Open(open) => self.bracket(*open),
            Kind::Command(name) if name == "frac" || name == "tfrac" || name == "dfrac" => {
                self.position += 1;
                self.fraction()
            }
            Kind::Command(name) if name == "sqrt" => {
                self.position += 1;
                let inside = self.argument()?;
                Ok(Value::Plain(format!("sqrt({})", self.within(inside)?)))
            }
            Kind::Command(name) if name == "nabla" => {
                self.position += 1;
                self.command("cdot");
                match self.vector()? {
                    Some(components) => {
                        let parts = components.iter().map(|(q, u)| format!("d{q}({u})"));
                        let sum = parts.collect::<Vec<_>>().join(" + ");
                        Ok(Value::Plain(format!("({sum}){}", self.power()?)))
                    }
                    None => Err(self.unreadable("∇ stands before `\\cdot` and a vector", range)),
                }
            }
            Kind::Command(name) if name == "mathbf" => match self.vector()? {
                Some(components) if self.command("cdot") && self.command("nabla") => {
                    Ok(Value::Acting(Operator::Advection(components)))
                }
                _ => Err(self.unreadable(
                    "a vector stands before `\\cdot \\nabla` or after `\\nabla \\cdot`",
                    range,
                )),
            },
            Kind::Begin if self.is_name_in_braces() => self.symbol(),
            Kind::Begin => {
                let inside = self.argument()?;
                let text = self.within(inside)?;
                Ok(Value::Plain(format!("({text}){}", self.power()?)))
            }
            Kind::Letter(_) | Kind::Command(_) => self.symbol(),
            _ => Err(self.unreadable("this stands in no formula here", range)),
        }
    }

    /// (…), […], {…}; one that is never closed goes to the end.
    fn bracket(&mut self, open: char) -> Read<Value> {
        self.position += 1;
        let close = match open {
            '(' => ')',
            '[' => ']',
            _ => '}',
        };
        let value = self.sum()?;
        if !self.take(&Kind::Close(close)) {
            match self.peek() {
                None => self.unclosed += 1,
                Some(token) => {
                    let message = format!("`{open}` is closed by something else");
                    return Err(self.unreadable(&message, token.range.clone()));
                }
            }
        }
        match value {
            Value::Acting(operator) => Ok(Value::Acting(operator)),
            Value::Plain(text) => Ok(Value::Plain(format!("({text}){}", self.power()?))),
        }
    }

    /// ^exponent, where it is no mark of a symbol.
    fn power(&mut self) -> Read<String> {
        if !self.sign('^') {
            return Ok(String::new());
        }
        let exponent = self.argument()?;
        Ok(format!("^({})", self.within(exponent)?))
    }
}
