//! What a task may ask of the model of a case, each with its place in the study where the model does not have it.

use super::study::{Asked, Axis, Drawn, Spot, Statement, Together};
use super::workshop::Workshop;
use crate::library::{column, expression};
use landau_solver::error::{Error, Result};
use landau_solver::study::{self, Setup};
use std::collections::BTreeSet;

/// Expressions that were read for a model and are well formed: by the model's hash and the text.
#[derive(Default)]
pub(super) struct Read {
    expressions: BTreeSet<(String, String)>,
    columns: BTreeSet<(String, String)>,
}

/// The mistake of a place in the study.
pub(super) fn refused(shop: &Workshop, spot: &Spot, error: Error) -> Error {
    let Error::Input(message) = error else {
        return error;
    };
    let source = &shop.study.read_from;
    let fault = spot.mistake(message).fault(&source.text);
    Error::input(fault.pointed(&source.path, &source.text))
}

/// What a task needs of the model of one case.
pub(super) struct Needs<'a> {
    /// Where the study is worked on.
    pub shop: &'a Workshop<'a>,
    /// The model and the parameters of the case.
    pub setup: &'a Setup,
    /// The task.
    pub spot: &'a Spot,
    /// The case.
    pub case: &'a Spot,
    /// What was read before.
    pub read: &'a mut Read,
}

impl Needs<'_> {
    /// A model with a coordinate between two ends.
    pub fn bounded(&self, what: &str) -> Result<()> {
        let structure = self.setup.model.structure();
        if structure.coordinate.is_some() {
            return Ok(());
        }
        let message = format!(
            "the model `{}` has no bounded coordinate, and {what} goes along one: it accepts a model that has",
            structure.name
        );
        Err(refused(
            self.shop,
            &self.case.key("model"),
            Error::input(message),
        ))
    }

    /// Whether something holds that the task itself demands.
    pub fn demand(&self, outcome: Result<()>) -> Result<()> {
        outcome.map_err(|error| refused(self.shop, self.spot, error))
    }

    /// Both ends of an axis, k or a parameter.
    fn ends(&self, spot: &Spot, name: &str, ends: [f64; 2]) -> Result<()> {
        let axis = study::Axis::named(self.setup.model.as_ref(), name)
            .map_err(|error| refused(self.shop, spot, error))?;
        for end in ends {
            self.setup
                .moved(axis, end)
                .map_err(|error| refused(self.shop, spot, error))?;
        }
        Ok(())
    }

    /// An axis under a key of the task.
    pub fn axis(&self, key: &str, axis: &Axis) -> Result<()> {
        self.ends(&self.spot.key(key), &axis.name, [axis.from, axis.to])
    }

    /// A list of questions under a key.
    pub fn questions(&self, key: &str, list: &[Asked]) -> Result<()> {
        for (index, asked) in list.iter().enumerate() {
            let words = format!("question `{}`", asked.name);
            self.question(&self.spot.entry(key, index, words), asked)?;
        }
        Ok(())
    }

    /// A question for a critical point.
    pub fn question(&self, spot: &Spot, asked: &Asked) -> Result<()> {
        self.ends(&spot.key("vary"), &asked.vary, asked.between)
    }

    /// A statement of the source.
    pub fn statement(&mut self, spot: &Spot, statement: &Statement) -> Result<()> {
        if let Some(asked) = &statement.at {
            self.question(&spot.key("at"), asked)?;
        }
        if let Some(over) = &statement.over {
            self.ends(&spot.key("over"), &over.name, [over.from, over.to])?;
        }
        match &statement.column {
            Some(text) => self.column(&spot.key("column"), text),
            None => Ok(()),
        }
    }

    /// An expression in the base state.
    pub fn expression(&mut self, spot: &Spot, text: &str) -> Result<()> {
        if self
            .read
            .expressions
            .insert((self.setup.hash(), text.to_owned()))
        {
            expression(self.setup.model.as_ref(), text)
                .map_err(|error| refused(self.shop, spot, error))?;
        }
        Ok(())
    }

    /// A derived column.
    pub fn column(&mut self, spot: &Spot, text: &str) -> Result<()> {
        if self
            .read
            .columns
            .insert((self.setup.hash(), text.to_owned()))
        {
            column(self.setup.model.as_ref(), text)
                .map_err(|error| refused(self.shop, spot, error))?;
        }
        Ok(())
    }

    /// A field, or an expression.
    pub fn shade(&mut self, shade: &str) -> Result<()> {
        if self.setup.model.structure().field(shade).is_some() {
            return Ok(());
        }
        self.expression(&self.spot.key("shade"), shade)
    }

    /// The fields that arrows are made of.
    pub fn arrows(&self, pair: &[String; 2]) -> Result<()> {
        pair.iter().try_for_each(|name| self.field("arrows", name))
    }

    /// A field by name.
    pub fn field(&self, key: &str, name: &str) -> Result<()> {
        let structure = self.setup.model.structure();
        if structure.field(name).is_some() {
            return Ok(());
        }
        let names: Vec<&str> = structure.fields.iter().map(|f| f.name.as_str()).collect();
        let message = format!(
            "{key}: the model `{}` has no field `{name}`: it has {}",
            structure.name,
            names.join(", ")
        );
        Err(refused(
            self.shop,
            &self.spot.key(key),
            Error::input(message),
        ))
    }
}

/// Derived columns with the position of their panel.
pub(super) fn derived(columns: &[Together]) -> impl Iterator<Item = (usize, &String)> {
    let panels = columns.iter().enumerate();
    panels.flat_map(|(index, together)| {
        let texts = together.drawn().iter().filter_map(|drawn| match drawn {
            Drawn::Point(_) => None,
            Drawn::Derived(text) => Some(text),
        });
        texts.map(move |text| (index, text))
    })
}
