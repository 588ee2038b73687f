//! Columns that a table may have besides those of every Landau point: outputs of the model at the equilibrium, and
//! expressions in the base state.

use crate::error::{Error, Result};
use crate::model::{End, Expression, OutputInfo};
use crate::weakly::{LandauPoint, outputs};
use std::sync::Arc;

/// Where an expression is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Location {
    /// At an end of the interval; of a model without one, at its point.
    End(End),
    /// ∫ … dy
    Integral,
}

/// What a column holds.
#[derive(Clone, Debug)]
enum Source {
    /// An output of the model, at the equilibrium amplitude.
    Output(usize),
    /// An expression in the base state.
    Base(Arc<Expression>, Location),
}

/// A column with its name.
#[derive(Clone, Debug)]
pub struct Derived {
    /// As it was asked for.
    pub name: String,
    source: Source,
}

/// What a text asks for: an output by name, or an expression with its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Wanted {
    /// An output by name.
    Output(usize),
    /// An expression that is still to be compiled.
    Expression(String, Location),
}

impl Wanted {
    /// `OUTPUT`, `EXPRESSION at lower`, `EXPRESSION at upper` or `integral(EXPRESSION)`.
    ///
    /// # Errors
    /// Anything else; names the outputs that there are.
    pub fn parse(known: &[OutputInfo], text: &str) -> Result<Self> {
        let text = text.trim();
        if let Some(index) = known.iter().position(|o| o.name == text) {
            return Ok(Wanted::Output(index));
        }
        let inside = text.strip_prefix("integral(");
        if let Some(inside) = inside.and_then(|rest| rest.strip_suffix(')')) {
            return Ok(Wanted::Expression(inside.to_owned(), Location::Integral));
        }
        match text.rsplit_once(" at ") {
            Some((expression, "lower")) => Ok(Wanted::at(expression, End::Lower)),
            Some((expression, "upper")) => Ok(Wanted::at(expression, End::Upper)),
            _ => {
                let names: Vec<&str> = known.iter().map(|o| o.name.as_str()).collect();
                let outputs = match names.is_empty() {
                    true => "the model has no outputs".to_owned(),
                    false => format!("the outputs are {}", names.join(", ")),
                };
                Err(Error::input(format!(
                    "`{text}` is no column: it is an output by name ({outputs}), `EXPRESSION at lower`, `EXPRESSION at \
                     upper` or `integral(EXPRESSION)`"
                )))
            }
        }
    }

    fn at(expression: &str, end: End) -> Self {
        Wanted::Expression(expression.trim().to_owned(), Location::End(end))
    }

    /// The column, its expression compiled by `compile`.
    ///
    /// # Errors
    /// Mistakes of the expression.
    pub fn column(
        self,
        name: &str,
        compile: impl FnOnce(&str) -> Result<Expression>,
    ) -> Result<Derived> {
        let source = match self {
            Wanted::Output(index) => Source::Output(index),
            Wanted::Expression(text, at) => Source::Base(Arc::new(compile(&text)?), at),
        };
        Ok(Derived {
            name: name.trim().to_owned(),
            source,
        })
    }
}

impl Derived {
    /// Its value at a point with its equilibrium amplitude; nothing where there is none, or no finite number.
    pub fn value(&self, point: &LandauPoint, amplitude: Option<f64>) -> Option<f64> {
        let value = match &self.source {
            Source::Output(index) => {
                let [base, correction] = outputs(point)[*index];
                base + correction * amplitude?.powi(2)
            }
            Source::Base(expression, at) => {
                let (problem, base) = (&point.problem, &point.problem.base);
                let structure = problem.structure();
                let value = |place| expression.at_base(structure, &base.at(place, point.pair.k));
                match at {
                    Location::End(end) => value(problem.space().end(*end)),
                    Location::Integral => {
                        let nodes = problem.quadrature().nodes.into_iter();
                        nodes.map(|(place, weight)| weight * value(place)).sum()
                    }
                }
            }
        };
        Some(value).filter(|v| v.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use super::{Location, Wanted};
    use crate::model::End;

    #[test]
    fn columns_are_read() {
        let parse = |text: &str| Wanted::parse(&[], text).ok();
        let expected = Wanted::Expression("S*T".to_owned(), Location::End(End::Upper));
        assert_eq!(parse(" S*T at upper "), Some(expected));
        let expected = Wanted::Expression("n^2".to_owned(), Location::Integral);
        assert_eq!(parse("integral(n^2)"), Some(expected));
        assert_eq!(parse("nusselt"), None);
        assert_eq!(parse("T at middle"), None);
    }
}
