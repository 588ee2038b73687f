//! What a study can ask for, one module a sort of answer.

mod beyond;
mod claims;
mod convergence;
mod curves;
mod draw;
pub(super) mod laws;
mod planes;
mod points;
mod profiles;
mod rows;

use super::outcome::Outcome;
use super::study::{Case, Task};
use super::workshop::Workshop;
use landau_solver::error::{Error, Result};
use landau_solver::study::sweep::RowMode;
use rayon::prelude::*;
use serde_json::{Map, Value, json};

/// Computes one task of a figure; files that it writes itself begin with `stem`.
pub(super) fn run(shop: &Workshop, figure: &str, stem: &str, task: &Task) -> Result<Outcome> {
    let mut outcome = answer(shop, figure, stem, task)?;
    outcome.demand_partners(figure, task.cases());
    let tables = outcome.pictures.iter_mut();
    for table in tables.filter_map(|picture| picture.table.as_mut()) {
        table.cases = described(shop, task.cases())?;
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

fn answer(shop: &Workshop, figure: &str, stem: &str, task: &Task) -> Result<Outcome> {
    match task {
        Task::Profiles {
            case,
            fields,
            logarithmic,
            tail,
            panel,
            mark,
        } => {
            let wanted = profiles::Wanted {
                figure,
                fields,
                logarithmic: *logarithmic,
                tail: tail.as_ref(),
                panel: *panel,
                marks: mark,
            };
            profiles::profiles(shop, case, &wanted)
        }
        Task::Law {
            case,
            expressions,
            over,
            at,
        } => laws::law(shop, case, expressions, over, at),
        Task::Convergence {
            case,
            over,
            resolutions,
        } => convergence::convergence(shop, figure, case, over, resolutions),
        Task::Spectrum {
            case,
            over,
            resolutions,
        } => profiles::spectrum(shop, figure, case, over, resolutions),
        Task::Sweep {
            case,
            over,
            columns,
            follow,
            mark,
            logarithmic,
            reference,
        } => {
            let wanted = curves::Wanted {
                figure,
                over,
                columns,
                mode: if *follow {
                    RowMode::Followed(None)
                } else {
                    RowMode::Leading
                },
                marks: mark,
                logarithmic: *logarithmic,
                reference,
            };
            curves::sweep(shop, case, &wanted)
        }
        Task::Resonance { case, over, mark } => curves::resonance(shop, figure, case, over, mark),
        Task::Orders {
            case,
            over,
            highest,
            reference,
        } => {
            let asked = beyond::Orders {
                figure,
                over,
                highest: *highest,
                reference,
            };
            beyond::orders(shop, case, &asked)
        }
        Task::SecondHarmonic { case, over } => beyond::second_harmonic(shop, case, over),
        Task::Critical {
            case,
            asked,
            against,
        } => points::critical(shop, figure, case, asked, against.as_ref()),
        Task::Claims { case, claim } => claims::claims(shop, figure, case, claim),
        Task::Values { case, columns } => points::values(shop, figure, case, columns),
        Task::PowerLaw {
            case,
            critical,
            distances,
            count,
        } => curves::power_law(shop, figure, case, critical, *distances, *count),
        Task::Pattern {
            case,
            shade,
            arrows,
            wavelengths,
        } => {
            let wanted = planes::Wanted {
                figure,
                stem,
                shade,
                arrows: arrows.as_ref(),
                wavelengths: *wavelengths,
            };
            planes::pattern(shop, case, &wanted)
        }
        Task::Circulation {
            case,
            over,
            k,
            arrows,
            side,
            shade,
        } => planes::circulation(shop, figure, case, over, *k, arrows, *side, shade),
    }
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
    let mut found = Vec::new();
    for (index, result) in results.into_iter().enumerate() {
        match result {
            Ok(value) => found.push((index, value)),
            // A study file that asks for what does not exist is wrong as a whole.
            Err(Error::Input(message)) => return Err(Error::Input(message)),
            Err(error) => failures.push(format!("{}: {error}", called(items[index].label()))),
        }
    }
    Ok(found)
}
