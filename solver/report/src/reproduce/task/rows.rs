//! The rows that tasks are made of.

use super::called;
use crate::library::column;
use landau_solver::error::Result;
use landau_solver::study::accuracy::Converged;
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

/// The Landau point of the leading mode of a case, converged.
///
/// # Errors
/// See [`Converged::new`].
pub(super) fn converged(setup: &Setup, k: f64) -> Result<Converged> {
    Converged::new(setup, &setup.base(None)?, k, Selection::Leading)
}

/// A_e at cubic order, where the errors leave both signs decided.
pub(super) fn amplitude(of: &Converged) -> Option<f64> {
    let Converged { point, error } = of;
    equilibrium((point.c0, error.c0), (point.c2, error.c2))
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
