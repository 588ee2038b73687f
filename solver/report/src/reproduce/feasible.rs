//! Whether the models of a study have what its tasks ask for, before anything is computed.

use super::study::{Asked, Axis, Drawn, Spot, Statement, Task, Together, pointed_at};
use super::task::laws;
use super::workshop::Workshop;
use crate::library::{column, expression};
use landau_solver::error::{Error, Result};
use landau_solver::study::{self, Setup};
use std::collections::BTreeSet;

/// Every case of every task: its model, parameters, axes and expressions.
///
/// # Errors
/// The first thing that a model does not have, with its place in the study.
pub(super) fn check(shop: &Workshop) -> Result<()> {
    let mut read = Read::default();
    let top = Spot::default().key("model");
    shop.model().map_err(|error| refused(shop, &top, error))?;
    for (position, figure) in shop.study.figure.iter().enumerate() {
        for (number, task) in figure.task.iter().enumerate() {
            let spot = Spot::task((position, figure), (number, task));
            for reference in task.references() {
                shop.study.read_beside(reference)?;
            }
            for (index, case) in task.cases().iter().enumerate() {
                let here = spot.case(index, case);
                let setup = shop.setup(case);
                let key = if case.model.is_some() { "model" } else { "set" };
                let setup = setup.map_err(|error| refused(shop, &here.key(key), error))?;
                let mut asked = Needs {
                    shop,
                    setup: &setup,
                    spot: &spot,
                    case: &here,
                    read: &mut read,
                };
                asked.task(task)?;
            }
        }
    }
    Ok(())
}

/// Expressions that were read for a model and are well formed: by the model's hash and the text.
#[derive(Default)]
struct Read {
    expressions: BTreeSet<(String, String)>,
    columns: BTreeSet<(String, String)>,
}

/// The mistake of a place in the study.
fn refused(shop: &Workshop, spot: &Spot, error: Error) -> Error {
    let Error::Input(message) = error else {
        return error;
    };
    let place = pointed_at(&shop.study.read_from.text, &spot.mistake(message));
    Error::input(format!("{}: {place}", shop.study.read_from.path.display()))
}

/// What a task needs of the model of one case.
struct Needs<'a> {
    shop: &'a Workshop<'a>,
    setup: &'a Setup,
    /// The task.
    spot: &'a Spot,
    /// The case.
    case: &'a Spot,
    read: &'a mut Read,
}

impl Needs<'_> {
    fn task(&mut self, task: &Task) -> Result<()> {
        match task {
            Task::Profiles { fields, tail, .. } => {
                self.bounded("profiles")?;
                for (index, text) in fields.iter().enumerate() {
                    let spot = self.spot.entry("fields", index, "fields".to_owned());
                    self.expression(&spot, text)?;
                }
                match tail.as_ref().and_then(|tail| tail.predicted.as_ref()) {
                    Some(text) => self.expression(&self.spot.key("tail").key("predicted"), text),
                    None => Ok(()),
                }
            }
            Task::Law {
                expressions,
                over,
                at,
                ..
            } => laws::check(self.setup, expressions, over, at)
                .map_err(|error| refused(self.shop, self.spot, error)),
            Task::Convergence { over, .. } => self.axis("over", over),
            Task::Sweep {
                over,
                columns,
                mark,
                ..
            } => {
                self.axis("over", over)?;
                for (index, text) in derived(columns) {
                    let spot = self.spot.entry("columns", index, "columns".to_owned());
                    self.column(&spot, text)?;
                }
                self.questions("mark", mark)
            }
            Task::Resonance { mark, .. } => self.questions("mark", mark),
            Task::Critical { asked, against, .. } => {
                if let Some(over) = against {
                    self.axis("against", over)?;
                }
                self.questions("asked", asked)
            }
            Task::Claims { claim, .. } => {
                for (index, statement) in claim.iter().enumerate() {
                    let spot = self
                        .spot
                        .entry("claim", index, format!("claim {}", index + 1));
                    self.statement(&spot, statement)?;
                }
                Ok(())
            }
            Task::Values { columns, .. } => {
                for (index, text) in columns.iter().enumerate() {
                    let spot = self.spot.entry("columns", index, "columns".to_owned());
                    self.column(&spot, text)?;
                }
                Ok(())
            }
            Task::PowerLaw { critical, .. } => self.question(&self.spot.key("critical"), critical),
            Task::Pattern { shade, arrows, .. } => {
                self.shade(shade)?;
                arrows.as_ref().map_or(Ok(()), |pair| self.arrows(pair))
            }
            Task::Circulation {
                over,
                arrows,
                shade,
                ..
            } => {
                self.bounded("a circulation")?;
                self.axis("over", over)?;
                self.field("shade", shade)?;
                self.arrows(arrows)
            }
            Task::Spectrum { .. } | Task::Orders { .. } | Task::SecondHarmonic { .. } => Ok(()),
        }
    }

    /// A model with a coordinate between two ends.
    fn bounded(&self, what: &str) -> Result<()> {
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

    fn axis(&self, key: &str, axis: &Axis) -> Result<()> {
        self.ends(&self.spot.key(key), &axis.name, [axis.from, axis.to])
    }

    fn questions(&self, key: &str, list: &[Asked]) -> Result<()> {
        for (index, asked) in list.iter().enumerate() {
            let words = format!("question `{}`", asked.name);
            self.question(&self.spot.entry(key, index, words), asked)?;
        }
        Ok(())
    }

    fn question(&self, spot: &Spot, asked: &Asked) -> Result<()> {
        self.ends(&spot.key("vary"), &asked.vary, asked.between)
    }

    fn statement(&mut self, spot: &Spot, statement: &Statement) -> Result<()> {
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

    fn expression(&mut self, spot: &Spot, text: &str) -> Result<()> {
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

    fn column(&mut self, spot: &Spot, text: &str) -> Result<()> {
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
    fn shade(&mut self, shade: &str) -> Result<()> {
        if self.setup.model.structure().field(shade).is_some() {
            return Ok(());
        }
        self.expression(&self.spot.key("shade"), shade)
    }

    fn arrows(&self, pair: &[String; 2]) -> Result<()> {
        pair.iter().try_for_each(|name| self.field("arrows", name))
    }

    /// A field by name.
    fn field(&self, key: &str, name: &str) -> Result<()> {
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
fn derived(columns: &[Together]) -> impl Iterator<Item = (usize, &String)> {
    let panels = columns.iter().enumerate();
    panels.flat_map(|(index, together)| {
        let texts = together.drawn().iter().filter_map(|drawn| match drawn {
            Drawn::Point(_) => None,
            Drawn::Derived(text) => Some(text),
        });
        texts.map(move |text| (index, text))
    })
}
