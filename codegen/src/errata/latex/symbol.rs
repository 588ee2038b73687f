//! Names with their marks, subscripts and powers, and vectors.

use super::operator::Value;
use super::token::{Kind, Token};
use super::{Letters, Read, Reader, Vocabulary};
use landau_contract::names_a_letter;
use std::ops::Range;

impl Reader<'_> {
    /// \mathbf{u}' or \mathbf{u}: its components by coordinate.
    pub(super) fn vector(&mut self) -> Read<Option<Vec<(String, String)>>> {
        if !self.command("mathbf") {
            return Ok(None);
        }
        let range = self.here();
        let name = match self.argument()? {
            [
                Token {
                    kind: Kind::Letter(letter),
                    ..
                },
            ] => letter.to_string(),
            _ => return Err(self.unreadable("a vector is one letter", range)),
        };
        let mut vectors = self.vocabulary.vectors.iter();
        let Some((_, components)) = vectors.find(|(vector, _)| *vector == name) else {
            return Err(self.unreadable("a vector that the file does not name", range));
        };
        while self.sign('\'') {
            self.perturbed = true;
        }
        let coordinates = self.vocabulary.coordinates.iter().map(|q| (*q).to_owned());
        Ok(Some(coordinates.zip(components.iter().cloned()).collect()))
    }

    /// A name with its marks, subscripts and power.
    pub(super) fn symbol(&mut self) -> Read<Value> {
        let range = self.here();
        let name = self.name()?;
        let mut marks = Marks::default();
        loop {
            if self.sign('\'') {
                marks.prime = true;
            } else if self.sign('_') {
                let below = self.argument()?;
                marks.below = below.iter().map(spelling).collect();
            } else if self.kind() == Some(&Kind::Sign('^')) && self.marked(&mut marks)? {
            } else {
                break;
            }
        }
        if marks.dagger || marks.prime || marks.order {
            self.perturbed = true;
            self.skip_argument();
        }
        let text = self.meaning(&name, &marks, range)?;
        let power = match &marks.power {
            Some(power) => format!("^({power})"),
            None => self.power()?,
        };
        Ok(Value::Plain(text + &power))
    }

    /// Reads a superscript that is a mark (⁰, ′, †, [1;1]), perhaps with a power after the mark. Any other superscript
    /// is a power: it is left to be read, and the answer is false.
    fn marked(&mut self, marks: &mut Marks) -> Read<bool> {
        let start = self.position;
        self.position += 1;
        let Some((mark, after)) = self.argument()?.split_first() else {
            self.position = start;
            return Ok(false);
        };
        match &mark.kind {
            Kind::Number(zero) if zero == "0" => marks.base = true,
            Kind::Command(name) if name == "dagger" => marks.dagger = true,
            Kind::Command(name) if name == "prime" => marks.prime = true,
            Kind::Open('[') => {
                marks.order = true;
                return Ok(true);
            }
            _ => {
                self.position = start;
                return Ok(false);
            }
        }
        if let Some((sign, exponent)) = after.split_first()
            && sign.kind == Kind::Sign('^')
        {
            marks.power = Some(self.within(exponent)?);
        }
        Ok(true)
    }

    /// (H), the place that a perturbation is taken at.
    fn skip_argument(&mut self) {
        if let [
            Token {
                kind: Kind::Open('('),
                ..
            },
            Token {
                kind: Kind::Letter(_) | Kind::Number(_),
                ..
            },
            Token {
                kind: Kind::Close(')'),
                ..
            },
            ..,
        ] = &self.tokens[self.position..]
            && self.vocabulary.operand.is_some()
        {
            self.position += 3;
        }
    }

    /// {D}, as a letter of another alphabet leaves it.
    pub(super) fn is_name_in_braces(&self) -> bool {
        let inside = &self.tokens[self.position + 1..];
        let letter = |token: &&Token| matches!(token.kind, Kind::Letter(_));
        let letters = inside.iter().take_while(letter).count();
        let end = inside.get(letters).map(|token| &token.kind);
        letters > 0 && end == Some(&Kind::End)
    }

    /// The longest name of the vocabulary, or one letter. Hats are left out.
    fn name(&mut self) -> Read<String> {
        let range = self.here();
        if self.kind() == Some(&Kind::Begin) {
            return Ok(self.argument()?.iter().map(spelling).collect());
        }
        if let Some(Kind::Command(command)) = self.kind() {
            self.position += 1;
            return match command.as_str() {
                "widehat" | "hat" | "tilde" | "widetilde" => {
                    let inside = self.argument()?;
                    Ok(inside.iter().map(spelling).collect())
                }
                name if self.names(name) || names_a_letter(&name.to_lowercase()) => {
                    Ok(name.to_owned())
                }
                name => Err(self.unreadable(&format!("`\\{name}` is not known"), range)),
            };
        }
        let letter = |token: &&Token| matches!(token.kind, Kind::Letter(_));
        let tokens = &self.tokens[self.position..];
        let run: Vec<String> = tokens.iter().take_while(letter).map(spelling).collect();
        let longest = (2..=run.len())
            .rev()
            .find(|&n| self.names(&run[..n].concat()));
        let length = longest.unwrap_or(1);
        self.position += length;
        Ok(run[..length].concat())
    }

    /// Whether the vocabulary holds a name.
    fn names(&self, name: &str) -> bool {
        let Vocabulary { constants, .. } = self.vocabulary;
        self.varies(name) || constants.iter().any(|constant| constant == name)
    }

    /// Whether a name is a field or a law, which have base values.
    fn varies(&self, name: &str) -> bool {
        let Vocabulary { fields, laws, .. } = self.vocabulary;
        fields.iter().chain(*laws).any(|varying| varying == name)
    }

    /// The symbol in the language of the spec.
    fn meaning(&self, name: &str, marks: &Marks, range: Range<usize>) -> Read<String> {
        let below = &marks.below;
        let joined = format!("{name}_{below}");
        if !below.is_empty() && self.names(&joined) {
            return Ok(joined);
        }
        let based = || match below.as_str() {
            "" => format!("{name}0"),
            below => format!("{name}0_{below}"),
        };
        let is_field = self.vocabulary.fields.iter().any(|field| field == name);
        let derived = |text: String| -> Read<String> {
            let is_coordinate = |q: &str| q == "t" || self.vocabulary.coordinates.contains(&q);
            below
                .chars()
                .rev()
                .map(String::from)
                .try_fold(text, |inner, q| {
                    if is_coordinate(&q) {
                        Ok(format!("d{q}({inner})"))
                    } else {
                        Err(self
                            .unreadable(&format!("`{q}` below is no coordinate"), range.clone()))
                    }
                })
        };
        if marks.base {
            return Ok(based());
        }
        if marks.prime || marks.dagger || marks.order {
            return derived(name.to_owned());
        }
        match self.vocabulary.letters {
            Letters::Base if self.varies(name) => Ok(based()),
            Letters::Perturbation if is_field => derived(format!("({name}0 + {name})")),
            _ => derived(name.to_owned()),
        }
    }
}

/// The marks of a name, its subscripts, and the power that follows a mark.
#[derive(Default)]
struct Marks {
    prime: bool,
    base: bool,
    dagger: bool,
    /// [1;1], a term of the expansion.
    order: bool,
    below: String,
    power: Option<String>,
}

/// A token as it stands in a name.
fn spelling(token: &Token) -> String {
    match &token.kind {
        Kind::Letter(letter) => letter.to_string(),
        Kind::Number(text) | Kind::Command(text) => text.clone(),
        _ => String::new(),
    }
}
