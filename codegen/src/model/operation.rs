//! Sums, products and powers of an expression.

use super::scope::{Names, Resolved, View};
use crate::diagnostic::Diagnostic;
use crate::graph::{Function, Id};
use crate::syntax::tree::{Binary, Expression, ExpressionKind};
use num_traits::ToPrimitive;

impl Names<'_> {
    /// a ± b ± c …, a * b / c …: from left to right, without a level of recursion for each operand.
    pub(super) fn operations(&mut self, expression: &Expression, view: &View) -> Resolved<Id> {
        let (mut first, mut steps) = (expression, Vec::new());
        while let ExpressionKind::Binary(operator, left, right) = &first.kind {
            steps.push((operator, &**right));
            first = left;
        }
        let mut value = self.expression(first, view);
        for (operator, right) in steps.into_iter().rev() {
            let operand = self.expression(right, view);
            value = self
                .both(value, operand)
                .and_then(|(a, b)| self.operation(*operator, a, b, right));
        }
        value
    }

    fn operation(&mut self, operator: Binary, a: Id, b: Id, right: &Expression) -> Resolved<Id> {
        match operator {
            Binary::Add => Ok(self.graph.add(a, b)),
            Binary::Subtract => Ok(self.graph.sub(a, b)),
            Binary::Multiply => Ok(self.graph.mul(a, b)),
            Binary::Divide if self.graph.vanishes(b) => Err(Diagnostic::new(
                right.location.clone(),
                "division by zero",
                "a nonzero divisor",
            )),
            Binary::Divide => Ok(self.graph.div(a, b)),
            Binary::Power => self.power(a, b, right),
        }
    }

    /// Both results, or the first mistake; a second one is kept for the report.
    pub fn both(&mut self, a: Resolved<Id>, b: Resolved<Id>) -> Resolved<(Id, Id)> {
        match (a, b) {
            (Ok(a), Ok(b)) => Ok((a, b)),
            (Err(first), Err(second)) => {
                self.further.push(second);
                Err(first)
            }
            (Err(mistake), Ok(_)) | (Ok(_), Err(mistake)) => Err(mistake),
        }
    }

    fn power(&mut self, base: Id, exponent: Id, written: &Expression) -> Resolved<Id> {
        if let Some(value) = self.graph.as_number(exponent).cloned() {
            let size = value.to_f64().unwrap_or(f64::INFINITY);
            if size.abs() > 100.0 {
                let message = "the exponent is too large";
                return Err(Diagnostic::new(
                    written.location.clone(),
                    message,
                    "at most 100",
                ));
            }
            if size <= 0.0 && self.graph.vanishes(base) {
                let message = "zero to a power that is not positive";
                return Err(Diagnostic::new(
                    written.location.clone(),
                    message,
                    "a positive exponent",
                ));
            }
            return Ok(self.graph.pow(base, value));
        }
        if self.graph.vanishes(base) {
            let message = "zero to a power with a parameter in its exponent";
            let expected = "a positive number as exponent";
            return Err(Diagnostic::new(written.location.clone(), message, expected));
        }
        // a^b = exp(b log a)
        let log = self.graph.call(Function::Log, base);
        let argument = self.graph.mul(exponent, log);
        Ok(self.graph.call(Function::Exp, argument))
    }
}
