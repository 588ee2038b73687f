//! What several commands ask and say.

use crate::arguments::Common;
use landau_solver::error::{Error, Result};
use landau_solver::model::C64;
use landau_solver::study::Setup;
use landau_solver::study::sweep::Resumed;
use landau_solver::weakly::Selection;

/// The wavenumber and the mode that are asked for, or those that the model calls typical.
///
/// # Errors
/// No wavenumber from either.
pub fn asked(setup: &Setup, k: Option<f64>, common: &Common) -> Result<(f64, Selection<'static>)> {
    let structure = setup.model.structure();
    let typical = structure.typical.as_ref();
    let target = |near: &[f64]| match near {
        [re, im] => Some(C64::new(*re, *im)),
        _ => None,
    };
    let (k, near) = match (k, typical) {
        (Some(k), _) => (k, common.near),
        (None, Some(typical)) => (typical.k, common.near.or(target(&typical.near))),
        (None, None) => {
            return Err(Error::input(format!(
                "give the wavenumber with --k: the model `{}` names no typical one",
                structure.name
            )));
        }
    };
    Ok((k, near.map_or(Selection::Leading, Selection::Near)))
}

/// Says what an earlier run has left.
pub fn resumed(rows: Resumed) {
    if rows.taken > 0 {
        note!(
            "resumed: {} rows are taken from an interrupted run",
            rows.taken
        );
    }
    if rows.damaged > 0 {
        note!(
            "note: {} lines of its journal do not fit and are computed again",
            rows.damaged
        );
    }
}
