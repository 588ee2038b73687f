//! The precedence parser for expressions.
//!
//! `syn::Expr` reads `a * b^2 + c` as an exclusive or; this grammar is the mathematician's:
//! `^` binds tightest and to the right, then unary minus, then `* /`, then `+ -`.

use super::tokens::{DEEPEST_NESTING, too_deep};
use super::tree::{Binary, Expression, ExpressionKind, Formula, Name};
use super::{Reader, spaced};
use crate::diagnostic::{Diagnostic, Location};
use crate::graph::Rational;
use num_traits::Zero;
use syn::Token;
use syn::parse::ParseStream;

type Parsed<T> = Result<T, Diagnostic>;

/// Decimal exponents beyond this are out of the range of double precision.
const LARGEST_EXPONENT: i32 = 307;
/// Terms of one sum, factors of one product.
const MOST_PARTS: usize = 2000;
/// Signs before one factor, powers of powers.
const MOST_SIGNS: usize = 64;
/// Height of a syntax tree: a long sum, and the brackets around it.
const TALLEST_TREE: usize = 2500;
/// Characters of a number.
const LONGEST_NUMBER: usize = 320;

impl Reader<'_> {
    /// formula := sum ('=' sum)?
    pub(super) fn formula(&self, input: ParseStream) -> Option<Formula> {
        let read = || {
            let left = self.expression(input)?;
            let right = if input.peek(Token![=]) {
                self.skip(input);
                Some(self.expression(input)?)
            } else {
                None
            };
            self.finished(input, "an operator or `=`")?;
            Ok(Formula { left, right })
        };
        let formula = read();
        if formula.is_err() {
            self.drain(input);
        }
        formula.map_err(|mistake| self.report(mistake)).ok()
    }

    /// expression := sum, at most [`DEEPEST_NESTING`] of them inside one another
    pub(super) fn expression(&self, input: ParseStream) -> Parsed<Expression> {
        let depth = self.depth.get();
        if depth > DEEPEST_NESTING {
            return Err(too_deep(self.here(input)));
        }
        self.depth.set(depth + 1);
        let sum = self.sum(input);
        self.depth.set(depth);
        sum
    }

    /// sum := product (('+' | '-') product)*
    fn sum(&self, input: ParseStream) -> Parsed<Expression> {
        let mut left = self.product(input)?;
        for _ in 0..MOST_PARTS {
            let operator = if input.peek(Token![+]) {
                Binary::Add
            } else if input.peek(Token![-]) {
                Binary::Subtract
            } else {
                return Ok(left);
            };
            self.skip(input);
            left = self.binary(operator, left, self.product(input)?)?;
        }
        Err(self.too_long(input))
    }

    fn binary(&self, operator: Binary, left: Expression, right: Expression) -> Parsed<Expression> {
        let location = spaced(&left.location, &right.location);
        let kind = ExpressionKind::Binary(operator, Box::new(left), Box::new(right));
        let whole = Expression::new(kind, location);
        if whole.height > TALLEST_TREE {
            return Err(too_deep(whole.location));
        }
        Ok(whole)
    }

    fn too_long(&self, input: ParseStream) -> Diagnostic {
        let message = "the expression is too long";
        let expected = format!("at most {MOST_PARTS} terms or factors");
        Diagnostic::new(self.here(input), message, expected)
    }

    /// product := unary (('*' | '/') unary)*
    fn product(&self, input: ParseStream) -> Parsed<Expression> {
        let mut left = self.unary(input)?;
        for _ in 0..MOST_PARTS {
            let operator = if input.peek(Token![*]) {
                Binary::Multiply
            } else if input.peek(Token![/]) {
                Binary::Divide
            } else {
                return Ok(left);
            };
            self.skip(input);
            left = self.binary(operator, left, self.unary(input)?)?;
        }
        Err(self.too_long(input))
    }

    /// unary := '-'* power
    fn unary(&self, input: ParseStream) -> Parsed<Expression> {
        let mut signs = Vec::new();
        while input.peek(Token![-]) || input.peek(Token![+]) {
            if signs.len() == MOST_SIGNS {
                return Err(self.unexpected(input, "a number, a name or `(`"));
            }
            signs.push((input.peek(Token![-]), self.here(input)));
            self.skip(input);
        }
        let mut value = self.power(input)?;
        for (negative, place) in signs.into_iter().rev() {
            if negative {
                value = negated(&place, value);
            }
        }
        Ok(value)
    }

    /// power := primary ('^' '-'? power)?
    fn power(&self, input: ParseStream) -> Parsed<Expression> {
        let mut bases = Vec::new();
        let mut value = self.primary(input)?;
        while input.peek(Token![^]) {
            if bases.len() == MOST_SIGNS {
                return Err(self.too_long(input));
            }
            self.skip(input);
            let minus = input.peek(Token![-]).then(|| self.here(input));
            if minus.is_some() {
                self.skip(input);
            }
            bases.push((value, minus));
            value = self.primary(input)?;
        }
        // Powers bind to the right.
        for (base, minus) in bases.into_iter().rev() {
            if let Some(place) = minus {
                value = negated(&place, value);
            }
            value = self.binary(Binary::Power, base, value)?;
        }
        Ok(value)
    }

    fn primary(&self, input: ParseStream) -> Parsed<Expression> {
        let location = self.here(input);
        if input.peek(syn::token::Paren) {
            let content = self.parenthesised(input)?;
            let inner = self.expression(&content)?;
            self.finished(&content, "an operator or `)`")?;
            return Ok(Expression { location, ..inner });
        }
        if input.peek(Token![|]) {
            self.skip(input);
            let inner = self.expression(input)?;
            let end = self.here(input);
            self.punctuation(input, "|")?;
            let location = spaced(&location, &end);
            let kind = ExpressionKind::Modulus(Box::new(inner));
            return Ok(Expression::new(kind, location));
        }
        if input.peek(syn::Lit) {
            return self.number(input);
        }
        if !self.peek_name(input) {
            return Err(self.unexpected(input, "a number, a name or `(`"));
        }
        let name = self.name(input, "a name")?;
        if name.text == "select" && self.peek_name(input) {
            return self.select(input, location);
        }
        if !input.peek(syn::token::Paren) {
            return Ok(Expression::new(ExpressionKind::Name(name.text), location));
        }
        let end = self.here(input);
        let content = self.parenthesised(input)?;
        let mut arguments = Vec::new();
        while !content.is_empty() {
            arguments.push(self.expression(&content)?);
            if content.is_empty() {
                break;
            }
            self.punctuation(&content, ",")?;
        }
        let location = spaced(&location, &end);
        let kind = ExpressionKind::Call(name, arguments);
        Ok(Expression::new(kind, location))
    }

    fn select(&self, input: ParseStream, start: Location) -> Parsed<Expression> {
        let switch = self.name(input, "the name of a switch parameter")?;
        let end = self.here(input);
        let content = self.braced(input)?;
        let mut branches: Vec<(Name, Expression)> = Vec::new();
        while !content.is_empty() {
            let choice = self.name(&content, "a choice of the switch")?;
            self.punctuation(&content, ":")?;
            branches.push((choice, self.expression(&content)?));
            if !content.is_empty() {
                self.punctuation(&content, ",")?;
            }
        }
        let kind = ExpressionKind::Select(switch, branches);
        Ok(Expression::new(kind, spaced(&start, &end)))
    }

    fn number(&self, input: ParseStream) -> Parsed<Expression> {
        let location = self.here(input);
        let literal: syn::Lit = input.parse().map_err(|e| self.syntax_error(&e))?;
        let (digits, suffix) = match &literal {
            syn::Lit::Int(l) => (l.base10_digits().to_owned(), l.suffix().to_owned()),
            syn::Lit::Float(l) => (l.base10_digits().to_owned(), l.suffix().to_owned()),
            _ => {
                let message = "this is not a number";
                return Err(Diagnostic::new(
                    location,
                    message,
                    "a number, a name or `(`",
                ));
            }
        };
        if !suffix.is_empty() {
            let message = format!("`{digits}{suffix}` is not a number");
            return Err(Diagnostic::new(location, message, "digits alone")
                .hint(format!("write a product as {digits}*{suffix}")));
        }
        match decimal(&digits) {
            Some(value) => Ok(Expression::new(ExpressionKind::Number(value), location)),
            None => {
                let message = format!("`{digits}` is out of range");
                Err(Diagnostic::new(
                    location,
                    message,
                    "a number from 1e-307 to 1e307 with at most 300 digits",
                ))
            }
        }
    }
}

fn negated(minus: &Location, value: Expression) -> Expression {
    let location = spaced(minus, &value.location);
    Expression::new(ExpressionKind::Negative(Box::new(value)), location)
}

/// The exact rational value of a decimal literal that double precision has room for.
fn decimal(digits: &str) -> Option<Rational> {
    if digits.len() > LONGEST_NUMBER {
        return None;
    }
    let (mantissa, exponent) = match digits.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, exponent.parse::<i32>().ok()?),
        None => (digits, 0),
    };
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let value: Rational = format!("{whole}{fraction}").parse().ok()?;
    if value.is_zero() {
        return Some(value);
    }
    let shift = exponent.checked_sub(i32::try_from(fraction.len()).ok()?)?;
    let leading = whole.trim_start_matches('0');
    let size = match leading.len() {
        0 => exponent - (fraction.len() - fraction.trim_start_matches('0').len()) as i32,
        length => exponent.checked_add(length as i32)?,
    };
    if size.abs() > LARGEST_EXPONENT {
        return None;
    }
    Some(value * Rational::from_integer(10.into()).pow(shift))
}
