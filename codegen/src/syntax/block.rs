//! The blocks base, boundary, mean, amplitude, outputs and typical of a spec.

use super::item::unknown_item;
use super::tree::*;
use super::{Parsed, Reader, spaced};
use crate::diagnostic::Location;
use syn::parse::ParseStream;

impl Reader<'_> {
    pub(super) fn base_item(&self, input: ParseStream, base: &mut BaseBlock) -> Parsed<()> {
        if self.peek_word(input, "at") {
            return self.wall(input).map(|wall| base.walls.push(wall));
        }
        if self.peek_word(input, "integral") {
            return self
                .integral_condition(input)
                .map(|item| base.integrals.push(item));
        }
        if self.peek_word(input, "guess") {
            self.skip(input);
            return self.block(input, |input| {
                let field = self.name(input, "a field")?;
                self.punctuation(input, "=")?;
                base.guesses.push((field, self.expression(input)?));
                self.end_of_statement(input)
            });
        }
        if self.peek_word(input, "auto") {
            self.skip(input);
            let parameter = self.name(input, "a parameter")?;
            return self.block(input, |input| {
                let (_, place) = self.place(input)?;
                self.punctuation(input, ":")?;
                let equation = self.equation(input)?;
                base.automatic.push(AutomaticItem {
                    parameter: parameter.clone(),
                    place,
                    equation,
                });
                self.end_of_statement(input)
            });
        }
        let field = self.name(input, "a field, `at`, `integral`, `auto` or `guess`")?;
        self.punctuation(input, "=")?;
        base.closed.push((field, self.expression(input)?));
        self.end_of_statement(input)
    }

    /// `at y = place`
    fn place(&self, input: ParseStream) -> Parsed<(Name, Expression)> {
        self.word(input, "at")?;
        let coordinate = self.name(input, "the cross-stream coordinate")?;
        self.punctuation(input, "=")?;
        Ok((coordinate, self.expression(input)?))
    }

    /// `at y = place { conditions }`
    pub(super) fn wall(&self, input: ParseStream) -> Parsed<WallItem> {
        let (coordinate, place) = self.place(input)?;
        let mut conditions = Vec::new();
        self.block(input, |input| {
            self.condition(input).map(|item| conditions.push(item))
        })?;
        Ok(WallItem {
            coordinate,
            place,
            conditions,
        })
    }

    fn condition(&self, input: ParseStream) -> Parsed<ConditionItem> {
        if !self.peek_word(input, "select") {
            let equation = self.equation(input)?;
            self.end_of_statement(input)?;
            return Ok(ConditionItem::Equation(equation));
        }
        self.skip(input);
        let switch = self.name(input, "the name of a switch parameter")?;
        let mut branches = Vec::new();
        self.block(input, |input| {
            let choice = self.name(input, "a choice of the switch")?;
            let mut conditions = Vec::new();
            self.block(input, |input| {
                self.condition(input).map(|item| conditions.push(item))
            })?;
            branches.push((choice, conditions));
            Ok(())
        })?;
        Ok(ConditionItem::Select(switch, branches))
    }

    /// `integral(integrand) = value;`
    fn integral_condition(&self, input: ParseStream) -> Parsed<IntegralCondition> {
        let (integrand, start) = self.integral(input)?;
        self.punctuation(input, "=")?;
        let value = self.expression(input)?;
        let location = spaced(&start, &value.location);
        self.end_of_statement(input)?;
        Ok(IntegralCondition {
            integrand,
            value,
            location,
        })
    }

    /// `integral(integrand)`
    fn integral(&self, input: ParseStream) -> Parsed<(Expression, Location)> {
        let start = self.word(input, "integral")?;
        let content = self.parenthesised(input)?;
        let integrand = self.expression(&content)?;
        self.finished(&content, "an operator or `)`")?;
        Ok((integrand, start))
    }

    pub(super) fn mean(&self, input: ParseStream) -> Parsed<MeanItem> {
        let keyword = self.name(input, "`conserved`, `gauge` or `unknown`")?;
        match keyword.text.as_str() {
            "conserved" => {
                let (integrand, _) = self.integral(input)?;
                self.end_of_statement(input)?;
                Ok(MeanItem::Conserved(integrand))
            }
            "gauge" => {
                let field = self.name(input, "a field")?;
                self.end_of_statement(input)?;
                Ok(MeanItem::Gauge(field))
            }
            "unknown" => {
                let name = self.name(input, "the name of the unknown")?;
                self.punctuation(input, ":")?;
                let condition = self.integral_condition(input).map_err(|mistake| {
                    let form = format!("unknown {}: integral(u) = Q;", name.text);
                    mistake.hint(format!("an integral determines an unknown: `{form}`"))
                })?;
                Ok(MeanItem::Unknown(name, condition))
            }
            word => Err(unknown_item(
                &keyword.location,
                word,
                &["conserved", "gauge", "unknown"],
            )),
        }
    }

    pub(super) fn amplitude(&self, input: ParseStream) -> Parsed<AmplitudeItem> {
        if self.peek_word(input, "integral") {
            let condition = self.integral_condition(input)?;
            let (integrand, value) = (condition.integrand, condition.value);
            return Ok(AmplitudeItem::Integral { integrand, value });
        }
        if self.peek_word(input, "at") {
            let (_, place) = self.place(input)?;
            let content = self.braced(input)?;
            let Equation {
                left: field,
                right: value,
                ..
            } = self.equation(&content)?;
            self.end_of_statement(&content)?;
            self.finished(&content, "`}`")?;
            return Ok(AmplitudeItem::Point {
                place: Some(place),
                field,
                value,
            });
        }
        let Equation {
            left: field,
            right: value,
            ..
        } = self.equation(input)?;
        self.end_of_statement(input)?;
        Ok(AmplitudeItem::Point {
            place: None,
            field,
            value,
        })
    }

    /// `k = number; near = re, im;`, the second optional.
    pub(super) fn typical(&self, input: ParseStream) -> Parsed<TypicalItem> {
        self.word(input, "k")?;
        self.punctuation(input, "=")?;
        let k = self.expression(input)?;
        self.end_of_statement(input)?;
        if input.is_empty() {
            return Ok(TypicalItem { k, near: None });
        }
        self.word(input, "near")?;
        self.punctuation(input, "=")?;
        let real = self.expression(input)?;
        let imaginary = if self.peek_punctuation(input, ",") {
            self.punctuation(input, ",")?;
            Some(self.expression(input)?)
        } else {
            None
        };
        self.end_of_statement(input)?;
        Ok(TypicalItem {
            k,
            near: Some((real, imaginary)),
        })
    }

    /// `name "doc" = integral(q);` or `name = at y = place: q;` or `name = q;`
    pub(super) fn output(&self, input: ParseStream) -> Parsed<OutputItem> {
        let name = self.name(input, "the name of an output")?;
        let doc = self.doc(input);
        self.punctuation(input, "=")?;
        let (place, body) = if self.peek_word(input, "at") {
            let (_, place) = self.place(input)?;
            self.punctuation(input, ":")?;
            (Some(place), self.expression(input)?)
        } else if self.peek_word(input, "integral") {
            (None, self.integral(input)?.0)
        } else {
            (None, self.expression(input)?)
        };
        self.end_of_statement(input)?;
        Ok(OutputItem {
            name,
            place,
            body,
            doc,
        })
    }
}
