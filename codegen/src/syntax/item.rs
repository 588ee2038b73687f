//! The statements and blocks of a spec.

use super::tree::*;
use super::{Parsed, Reader, spaced};
use crate::diagnostic::{Diagnostic, Location, nearest};
use syn::Token;
use syn::parse::ParseStream;

const MODEL_ITEMS: [&str; 13] = [
    "model",
    "use",
    "coordinates",
    "parameters",
    "fields",
    "let",
    "law",
    "balance",
    "base",
    "boundary",
    "amplitude",
    "outputs",
    "typical",
];
const MEAN: &str = "mean";
const LAW_ITEMS: [&str; 4] = ["use", "parameters", "let", "law"];

impl Reader<'_> {
    pub(super) fn model(&self, input: ParseStream) -> ModelTree {
        let mut tree = ModelTree::default();
        self.statements(input, |input| self.model_item(input, &mut tree));
        tree
    }

    fn model_item(&self, input: ParseStream, tree: &mut ModelTree) -> Parsed<()> {
        let keyword = self.name(input, "`balance`, `fields`, `let` or another item")?;
        match keyword.text.as_str() {
            "model" => {
                once(&keyword, tree.name.is_some())?;
                tree.name = Some(self.name(input, "the name of the model")?);
                tree.title = self.doc(input);
                self.punctuation(input, ";")
            }
            "use" => self.import(input).map(|import| tree.imports.push(import)),
            "coordinates" => self.block(input, |input| {
                self.coordinate(input)
                    .map(|item| tree.coordinates.push(item))
            }),
            "parameters" => self.block(input, |input| {
                self.parameter(input).map(|item| tree.parameters.push(item))
            }),
            "fields" => self.block(input, |input| {
                self.field(input).map(|i| tree.fields.push(i))
            }),
            "let" => self
                .definition(input, false)
                .map(|item| tree.definitions.push(item)),
            "law" => self
                .definition(input, true)
                .map(|item| tree.definitions.push(item)),
            "balance" => self.block(input, |input| {
                self.balance(input).map(|item| tree.balances.push(item))
            }),
            "base" => {
                tree.base.location = Some(keyword.location);
                self.block(input, |input| self.base_item(input, &mut tree.base))
            }
            "boundary" => self.block(input, |input| {
                self.wall(input).map(|item| tree.boundary.push(item))
            }),
            MEAN => self.block(input, |input| {
                self.mean(input).map(|item| tree.mean.push(item))
            }),
            "amplitude" => self.block(input, |input| {
                once(&keyword, tree.amplitude.is_some())?;
                tree.amplitude = Some(self.amplitude(input)?);
                Ok(())
            }),
            "outputs" => self.block(input, |input| {
                self.output(input).map(|item| tree.outputs.push(item))
            }),
            "typical" => {
                once(&keyword, tree.typical.is_some())?;
                let content = self.braced(input)?;
                tree.typical = Some(self.typical(&content)?);
                self.finished(&content, "`}`")
            }
            word => {
                let mut items = MODEL_ITEMS.to_vec();
                items.push(MEAN);
                Err(unknown_item(&keyword.location, word, &items))
            }
        }
    }

    pub(super) fn laws(&self, input: ParseStream) -> LawTree {
        let mut tree = LawTree::default();
        self.statements(input, |input| {
            let keyword = self.name(input, "`law`, `let`, `parameters` or `use`")?;
            match keyword.text.as_str() {
                "use" => self.import(input).map(|import| tree.imports.push(import)),
                "parameters" => self.block(input, |input| {
                    self.parameter(input).map(|item| tree.parameters.push(item))
                }),
                "let" => self
                    .definition(input, false)
                    .map(|item| tree.definitions.push(item)),
                "law" => self
                    .definition(input, true)
                    .map(|item| tree.definitions.push(item)),
                word => Err(unknown_item(&keyword.location, word, &LAW_ITEMS)),
            }
        });
        tree
    }

    /// `use laws::file::{law, law(fields) as alias};`
    fn import(&self, input: ParseStream) -> Parsed<Import> {
        self.word(input, "laws")?;
        self.punctuation(input, "::")?;
        let file = self.name(input, "the name of a law file")?;
        self.punctuation(input, "::")?;
        let content = self.braced(input)?;
        let mut items = Vec::new();
        while !content.is_empty() {
            let law = self.name(&content, "the name of a law")?;
            let arguments = if content.peek(syn::token::Paren) {
                Some(self.names(&content, "a field")?)
            } else {
                None
            };
            let alias = if self.peek_word(&content, "as") {
                self.skip(&content);
                self.name(&content, "the name to use in the model")?
            } else {
                law.clone()
            };
            items.push(ImportItem {
                law,
                arguments,
                alias,
            });
            if !content.is_empty() {
                self.punctuation(&content, ",")?;
            }
        }
        self.punctuation(input, ";")?;
        Ok(Import { file, items })
    }

    /// `(name, name, …)`
    pub(super) fn names(&self, input: ParseStream, expected: &str) -> Parsed<Vec<Name>> {
        let content = self.parenthesised(input)?;
        let mut names = Vec::new();
        while !content.is_empty() {
            names.push(self.name(&content, expected)?);
            if !content.is_empty() {
                self.punctuation(&content, ",")?;
            }
        }
        Ok(names)
    }

    /// `x: periodic;` or `y: lower..upper;`
    fn coordinate(&self, input: ParseStream) -> Parsed<CoordinateItem> {
        let name = self.name(input, "the name of a coordinate")?;
        self.punctuation(input, ":")?;
        let interval = if self.peek_word(input, "periodic") {
            self.skip(input);
            None
        } else {
            let lower = self.expression(input)?;
            self.punctuation(input, "..")?;
            Some((lower, self.expression(input)?))
        };
        self.punctuation(input, ";")?;
        Ok(CoordinateItem { name, interval })
    }

    /// `name = default in domain whole "doc";`
    fn parameter(&self, input: ParseStream) -> Parsed<ParameterItem> {
        let name = self.name(input, "the name of a parameter")?;
        let mut default = None;
        if self.peek_punctuation(input, "=") {
            self.punctuation(input, "=")?;
            default = Some(self.expression(input)?);
        }
        let mut domain = ParameterDomain::Any;
        if self.peek_word(input, "in") {
            self.skip(input);
            domain = if input.peek(syn::token::Brace) {
                let content = self.braced(input)?;
                let mut choices = Vec::new();
                while !content.is_empty() {
                    choices.push(self.name(&content, "a choice")?);
                    if !content.is_empty() {
                        self.punctuation(&content, ",")?;
                    }
                }
                ParameterDomain::Choices(choices)
            } else {
                let (lower, upper) = self.range(input)?;
                ParameterDomain::Range(lower, upper)
            };
        }
        let whole = if self.peek_word(input, "whole") {
            Some(self.word(input, "whole")?)
        } else {
            None
        };
        let doc = self.doc(input);
        self.punctuation(input, ";")?;
        let default = match (default, &domain) {
            (Some(value), ParameterDomain::Choices(_)) => match value.kind {
                ExpressionKind::Name(text) => Some(ParameterDefault::Choice(Name {
                    text,
                    location: value.location,
                })),
                _ => {
                    let message = "the default of a switch is one of its choices";
                    return Err(Diagnostic::new(
                        value.location,
                        message,
                        "the name of a choice",
                    ));
                }
            },
            (value, _) => value.map(ParameterDefault::Value),
        };
        Ok(ParameterItem {
            name,
            default,
            domain,
            whole,
            doc,
        })
    }

    /// `lower..upper`, either end open.
    fn range(&self, input: ParseStream) -> Parsed<(Option<Expression>, Option<Expression>)> {
        let ends = |input: ParseStream| {
            input.peek(Token![;]) || input.peek(syn::LitStr) || self.peek_word(input, "whole")
        };
        let lower = if input.peek(Token![..]) {
            None
        } else {
            Some(self.expression(input)?)
        };
        self.punctuation(input, "..")?;
        let upper = if ends(input) {
            None
        } else {
            Some(self.expression(input)?)
        };
        Ok((lower, upper))
    }

    /// `name "doc" in range;`
    fn field(&self, input: ParseStream) -> Parsed<FieldItem> {
        let name = self.name(input, "the name of a field")?;
        let mut doc = self.doc(input);
        let range = if self.peek_word(input, "in") {
            self.skip(input);
            Some(self.range(input)?)
        } else {
            None
        };
        if doc.is_empty() {
            doc = self.doc(input);
        }
        self.punctuation(input, ";")?;
        Ok(FieldItem { name, range, doc })
    }

    /// `let name(arguments) "doc" = body;`
    fn definition(&self, input: ParseStream, is_law: bool) -> Parsed<Definition> {
        let name = self.name(input, "a name")?;
        let arguments = if input.peek(syn::token::Paren) {
            Some(self.names(input, "the name of an argument")?)
        } else {
            None
        };
        let doc = self.doc(input);
        self.punctuation(input, "=")?;
        let body = self.expression(input)?;
        self.end_of_statement(input)?;
        Ok(Definition {
            name,
            arguments,
            body,
            is_law,
            doc,
        })
    }

    /// `name: left = right divide by q for field "doc";`
    fn balance(&self, input: ParseStream) -> Parsed<BalanceItem> {
        let name = self.name(input, "the name of a balance")?;
        self.punctuation(input, ":")?;
        let equation = self.equation(input)?;
        let (mut divide_by, mut paired_field) = (None, None);
        loop {
            if self.peek_word(input, "divide") {
                self.skip(input);
                self.word(input, "by")?;
                divide_by = Some(self.expression(input)?);
            } else if self.peek_word(input, "for") {
                self.skip(input);
                paired_field = Some(self.name(input, "a field")?);
            } else {
                break;
            }
        }
        let doc = self.doc(input);
        self.end_of_statement(input)?;
        Ok(BalanceItem {
            name,
            equation,
            divide_by,
            paired_field,
            doc,
        })
    }

    pub(super) fn end_of_statement(&self, input: ParseStream) -> Parsed<()> {
        if input.peek(Token![;]) {
            return self.punctuation(input, ";");
        }
        Err(self.missing(input, ";", "an operator or `;`"))
    }

    /// `left = right`
    pub(super) fn equation(&self, input: ParseStream) -> Parsed<Equation> {
        let left = self.expression(input)?;
        if input.peek(Token![==]) {
            let location = self.here(input);
            return Err(Diagnostic::new(
                location,
                "`==` is not part of the language",
                "`=`",
            ));
        }
        self.punctuation(input, "=")?;
        let right = self.expression(input)?;
        let location = spaced(&left.location, &right.location);
        Ok(Equation {
            left,
            right,
            location,
        })
    }
}

/// Refuses a second statement of a kind that gives one thing.
fn once(keyword: &Name, is_given: bool) -> Parsed<()> {
    if !is_given {
        return Ok(());
    }
    Err(Diagnostic::new(
        keyword.location.clone(),
        format!("`{}` is given twice", keyword.text),
        "one of them alone",
    ))
}

pub(super) fn unknown_item(location: &Location, name: &str, items: &[&str]) -> Diagnostic {
    let list: Vec<_> = items.iter().map(|item| format!("`{item}`")).collect();
    Diagnostic::new(
        location.clone(),
        format!("`{name}` is not known here"),
        format!("one of {}", list.join(", ")),
    )
    .maybe_hint(nearest(name, items.iter().copied()).map(|near| format!("did you mean `{near}`?")))
}
