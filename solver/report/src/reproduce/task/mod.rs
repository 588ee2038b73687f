//! What a study can ask for, one module a sort of answer.

mod beyond;
mod circulation;
mod claims;
mod convergence;
mod curves;
mod draw;
mod follow;
mod laws;
mod marks;
mod planes;
mod points;
mod power_law;
mod profiles;
mod rows;
mod second_harmonic;
mod spectrum;

use super::needs::Needs;
use super::outcome::Outcome;
use super::study::kinds::{Kind, of_any_kind};
use super::study::{Case, Task};
use super::workshop::Workshop;
use landau_solver::error::{Error, Result};
use rayon::prelude::*;
use serde_json::{Map, Value, json};

/// Where the outcome of a task belongs.
pub(super) struct Place<'a> {
    /// The figure.
    pub figure: &'a str,
    /// How the names of files begin that the task writes itself.
    pub stem: &'a str,
}

/// A kind of task that models are asked.
pub(super) trait Work: Kind {
    /// Refuses a case whose model does not have what the task asks for. Nothing is computed.
    ///
    /// # Errors
    /// What the model does not have, with its place in the study.
    fn needs(&self, of: &mut Needs) -> Result<()>;

    /// Computes it. What does not come out is a failure of the outcome.
    ///
    /// # Errors
    /// Bad input; files that cannot be written.
    fn run(&self, shop: &Workshop, place: &Place) -> Result<Outcome>;
}

/// A task of any kind, to be asked and computed.
pub(super) fn work(task: &Task) -> &dyn Work {
    of_any_kind!(task, kind => kind)
}

/// Computes one task of a figure.
pub(super) fn run(shop: &Workshop, place: &Place, task: &Task) -> Result<Outcome> {
    let work = work(task);
    let mut outcome = work.run(shop, place)?;
    outcome.demand_partners(place.figure, work.cases());
    let tables = outcome.pictures.iter_mut();
    for table in tables.filter_map(|picture| picture.table.as_mut()) {
        table.cases = described(shop, work.cases())?;
    }
    Ok(outcome)
}

/// What each case was computed from, for the description of a table.
fn described(shop: &Workshop, cases: &[Case]) -> Result<Vec<Value>> {
    let described = cases.iter().enumerate().map(|(index, case)| {
        let setup = shop.setup(case)?;
        let structure = setup.model.structure();
        let parameters: Map<String, Value> = structure
            .parameters
            .pairs()
            .map(|(id, info)| {
                let automatic = setup.parameters.automatic[id];
                let value = setup.parameters.json(structure)[&info.name].clone();
                let value = if automatic {
                    Value::from("auto")
                } else {
                    value
                };
                (info.name.clone(), value)
            })
            .collect();
        Ok(json!({
            "case": index + 1,
            "label": case.label,
            "model": structure.name,
            "model_hash": setup.hash(),
            "parameters": parameters,
            "k": case.k,
            "resolution": setup.effective_resolution(),
            "normalization": structure.amplitude.description,
        }))
    });
    described.collect()
}

/// What a failure is named after.
trait Named {
    fn label(&self) -> &str;
}

impl Named for Case {
    fn label(&self) -> &str {
        &self.label
    }
}

/// A label, or what stands for none.
pub(super) fn called(label: &str) -> &str {
    if label.is_empty() { "the case" } else { label }
}

/// Every item by itself, in parallel; what fails becomes a sentence.
fn each<I: Named + Sync, R: Send>(
    items: &[I],
    failures: &mut Vec<String>,
    work: impl Fn(&I) -> Result<R> + Sync + Send,
) -> Result<Vec<(usize, R)>> {
    let results: Vec<Result<R>> = items.par_iter().map(&work).collect();
    let mut answers = Vec::new();
    for (index, result) in results.into_iter().enumerate() {
        match result {
            Ok(value) => answers.push((index, value)),
            // A study file that asks for what does not exist is wrong as a whole.
            Err(Error::Input(message)) => return Err(Error::Input(message)),
            Err(error) => failures.push(format!("{}: {error}", called(items[index].label()))),
        }
    }
    Ok(answers)
}
