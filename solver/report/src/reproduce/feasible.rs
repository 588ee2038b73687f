//! Whether the models of a study have what its tasks ask for, before anything is computed.

use super::needs::{Needs, Read, refused};
use super::study::Spot;
use super::task::work;
use super::workshop::Workshop;
use landau_solver::error::Result;

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
            for reference in task.kind().references() {
                shop.study.read_beside(&reference.file)?;
            }
            for (index, case) in task.kind().cases().iter().enumerate() {
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
                work(task).needs(&mut asked)?;
            }
        }
    }
    Ok(())
}
