//! The rows that tasks are made of.

use super::called;
use crate::library::column;
use landau_solver::error::Result;
use landau_solver::study::row::Row;
use landau_solver::study::sweep::{Range, Sweep};
use landau_solver::study::{self, Setup, Silent};

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

/// Landau points of one case over an axis.
pub(super) fn rows(
    setup: &Setup,
    k: Option<f64>,
    name: &str,
    values: Vec<f64>,
    columns: &[String],
) -> Result<Vec<Row>> {
    let axis = study::Axis::named(setup.model.as_ref(), name)?;
    let range = Range {
        name: name.to_owned(),
        axis,
        values,
    };
    let sweep = Sweep {
        setup,
        ranges: vec![range],
        near: None,
        k,
        derived: columns
            .iter()
            .map(|text| column(setup.model.as_ref(), text))
            .collect::<Result<_>>()?,
    };
    Ok(sweep.run(&Silent))
}
