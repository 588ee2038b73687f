//! The rows that tasks are made of.

use super::called;
use crate::library::column;
use landau_solver::error::{Error, Result};
use landau_solver::model::C64;
use landau_solver::study::accuracy::{Accuracy, accuracy, landau_error, stands};
use landau_solver::study::row::Row;
use landau_solver::study::sweep::{Range, RowMode, Sweep};
use landau_solver::study::{self, Setup, Silent};
use landau_solver::weakly::{Selection, equilibrium};

/// Why a case has no row at all: the reason of its first.
pub(super) fn nothing_in(label: &str, rows: &[Row]) -> Option<String> {
    let answered = rows.iter().any(|row| row.c0.is_some());
    let first = rows.first().filter(|_| !answered)?;
    let count = rows.len();
    let label = called(label);
    Some(format!(
        "{label}: none of {count} points came out; the first: {}",
        first.status
    ))
}

/// c0 and c2 of the leading mode, with their errors.
pub(super) struct Coefficients {
    pub c0: C64,
    pub c2: C64,
    /// Absolute errors of both.
    pub error: Accuracy,
}

impl Coefficients {
    /// Those of a case at a wavenumber.
    ///
    /// # Errors
    /// A mode that is not found, a coefficient that is not converged.
    pub fn at(setup: &Setup, k: f64) -> Result<Self> {
        let point = setup.point(&setup.base(None)?, k, Selection::Leading)?;
        let error = accuracy(setup, &point)?;
        let unconverged = |name: &str, error: f64, size: f64| {
            let how_far = format!("its error is {error:.1e}, its size {size:.1e}");
            Error::unresolved(name, setup.effective_resolution(), how_far)
        };
        let [size0, size2] = [point.c0, point.c2].map(|c| c.norm());
        if !stands(error.c0, size0, point.pair.scale) {
            return Err(unconverged("c0", error.c0, size0));
        }
        let c2 = landau_error(&point, error.c2);
        let c2 = c2.ok_or_else(|| unconverged("c2", error.c2, size2))?;
        Ok(Coefficients {
            c0: point.c0,
            c2: point.c2,
            error: Accuracy { c2, ..error },
        })
    }

    /// The equilibrium amplitude at cubic order.
    pub fn amplitude(&self) -> Option<f64> {
        equilibrium((self.c0, self.error.c0), (self.c2, self.error.c2))
    }
}

/// Landau points of one case over an axis.
pub(super) fn rows(
    setup: &Setup,
    k: Option<f64>,
    name: &str,
    values: Vec<f64>,
    mode: RowMode,
    columns: &[String],
) -> Result<Vec<Row>> {
    let axis = study::Axis::named(setup.model.as_ref(), name)?;
    let range = Range {
        name: name.to_owned(),
        axis,
        values,
    };
    let derived = columns
        .iter()
        .map(|text| column(setup.model.as_ref(), text))
        .collect::<Result<_>>()?;
    Ok(Sweep::new(setup, vec![range], k, mode, derived)?.run(&Silent))
}
