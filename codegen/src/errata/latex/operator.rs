//! What acts on what follows: ∂/∂x, ∂²/∂x∂y, u·∇, and sums and products of these.

use super::token::{Kind, Token};
use super::{Read, Reader};

/// Order of a derivative that a formula has use for.
const HIGHEST_ORDER: usize = 64;

/// Something that waits for what it acts on.
pub(super) enum Operator {
    /// ∂ by one coordinate after another.
    Derivative(Vec<String>),
    /// |∂x|
    Modulus,
    /// u ∂x + v ∂y
    Advection(Vec<(String, String)>),
    /// a factor before an operator
    Scaled(String, Box<Operator>),
    /// the second, then the first
    Composed(Box<Operator>, Box<Operator>),
    /// Σ ±, plain terms multiply
    Sum(Vec<(bool, Value)>),
}

pub(super) enum Value {
    Plain(String),
    Acting(Operator),
}

impl Operator {
    /// About how many bytes [`Operator::on`] writes for an operand of so many.
    pub(super) fn length(&self, operand: usize) -> usize {
        match self {
            Operator::Derivative(coordinates) => operand.saturating_add(4 * coordinates.len()),
            Operator::Modulus => operand.saturating_add(8),
            Operator::Advection(components) => {
                let names: usize = components.iter().map(|(q, u)| q.len() + u.len() + 7).sum();
                operand
                    .saturating_mul(components.len())
                    .saturating_add(names)
            }
            Operator::Scaled(factor, operator) => {
                operator.length(operand).saturating_add(factor.len() + 1)
            }
            Operator::Composed(outer, inner) => outer.length(inner.length(operand)),
            Operator::Sum(terms) => {
                let lengths = terms.iter().map(|(_, term)| match term {
                    Value::Plain(text) => operand.saturating_add(text.len() + 4),
                    Value::Acting(operator) => operator.length(operand).saturating_add(3),
                });
                lengths.fold(2, usize::saturating_add)
            }
        }
    }

    /// In the language of the spec, on an operand.
    pub(super) fn on(&self, operand: &str) -> String {
        match self {
            Operator::Derivative(coordinates) => {
                let derivative = |inner: String, q: &String| format!("d{q}({inner})");
                coordinates
                    .iter()
                    .rev()
                    .fold(operand.to_owned(), derivative)
            }
            Operator::Modulus => format!("absdx({operand})"),
            Operator::Advection(components) => {
                let parts = components
                    .iter()
                    .map(|(q, u)| format!("{u}*d{q}({operand})"));
                format!("({})", parts.collect::<Vec<_>>().join(" + "))
            }
            Operator::Scaled(factor, operator) => format!("{factor}*{}", operator.on(operand)),
            Operator::Composed(outer, inner) => outer.on(&inner.on(operand)),
            Operator::Sum(terms) => {
                let mut text = String::new();
                for (negative, term) in terms {
                    text += if *negative { " - " } else { " + " };
                    text += &match term {
                        Value::Plain(text) => format!("{text}*{operand}"),
                        Value::Acting(operator) => operator.on(operand),
                    };
                }
                format!("({})", text.trim_start_matches(" + ").trim_start())
            }
        }
    }
}

impl Reader<'_> {
    /// A quotient, or a derivative: ∂²u/∂x∂y, d/dy.
    pub(super) fn fraction(&mut self) -> Read<Value> {
        let (above, below) = (self.argument()?, self.argument()?);
        let range = above
            .first()
            .or(below.first())
            .map_or(0..0, |t| t.range.clone());
        let Some(coordinates) = self.coordinates(below) else {
            let (above, below) = (self.within(above)?, self.within(below)?);
            return Ok(Value::Plain(format!("({above})/({below})")));
        };
        let Some(operand) = differential(above) else {
            return Err(self.unreadable("∂ stands below and not above", range));
        };
        let (order, operand) = match operand {
            [
                Token {
                    kind: Kind::Sign('^'),
                    ..
                },
                Token {
                    kind: Kind::Number(order),
                    ..
                },
                operand @ ..,
            ] => (order.parse().unwrap_or(0), operand),
            operand => (1, operand),
        };
        if order != coordinates.len() {
            return Err(self.unreadable("the orders above and below differ", range));
        }
        let operator = Operator::Derivative(coordinates);
        if operand.is_empty() {
            return Ok(Value::Acting(operator));
        }
        let inside = self.within(operand)?;
        Ok(Value::Plain(operator.on(&inside)))
    }

    /// ∂x², ∂x∂y, dy: the coordinates of a derivative, as often as they stand there.
    fn coordinates(&self, tokens: &[Token]) -> Option<Vec<String>> {
        let (mut denominator, mut coordinates) = (tokens, Vec::new());
        while !denominator.is_empty() {
            let [
                Token {
                    kind: Kind::Letter(letter),
                    ..
                },
                after @ ..,
            ] = differential(denominator)?
            else {
                return None;
            };
            let name = letter.to_string();
            if name != "t" && !self.vocabulary.coordinates.contains(&name.as_str()) {
                return None;
            }
            let (times, after) = match after {
                [
                    Token {
                        kind: Kind::Sign('^'),
                        ..
                    },
                    Token {
                        kind: Kind::Number(times),
                        ..
                    },
                    after @ ..,
                ] => (times.parse().ok().filter(|&n| n <= HIGHEST_ORDER)?, after),
                after => (1, after),
            };
            coordinates.extend(vec![name; times]);
            denominator = after;
        }
        (!coordinates.is_empty()).then_some(coordinates)
    }
}

/// What follows ∂ or d.
fn differential(tokens: &[Token]) -> Option<&[Token]> {
    match tokens {
        [
            Token {
                kind: Kind::Command(name),
                ..
            },
            after @ ..,
        ] if name == "partial" => Some(after),
        [
            Token {
                kind: Kind::Letter('d'),
                ..
            },
            after @ ..,
        ] => Some(after),
        _ => None,
    }
}
