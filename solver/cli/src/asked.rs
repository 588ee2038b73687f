//! What several commands ask and say.

use landau_solver::error::{Error, Result};
use landau_solver::model::C64;
use landau_solver::study::Setup;
use landau_solver::study::sweep::Resumed;
use landau_solver::weakly::Selection;
use landau_solver::words::counted;

/// The wavenumber and the mode that are asked for, or those that the model calls typical.
///
/// # Errors
/// No wavenumber from either.
pub fn asked(
    setup: &Setup,
    k: Option<f64>,
    near: Option<C64>,
) -> Result<(f64, Selection<'static>)> {
    let structure = setup.model.structure();
    let typical = structure.typical.as_ref();
    let target = |typical: &[f64]| match typical {
        [re, im] => Some(C64::new(*re, *im)),
        _ => None,
    };
    let (k, near) = match (k, typical) {
        (Some(k), _) => (k, near),
        (None, Some(typical)) => (typical.k, near.or(target(&typical.near))),
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
            "resumed: {} {} taken from an interrupted run",
            counted(rows.taken, "row"),
            if rows.taken == 1 { "is" } else { "are" }
        );
    }
    if rows.damaged > 0 {
        note!(
            "note: {} of its journal {} computed again",
            counted(rows.damaged, "line"),
            if rows.damaged == 1 {
                "does not fit and is"
            } else {
                "do not fit and are"
            }
        );
    }
}
