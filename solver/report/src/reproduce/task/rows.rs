//! The rows that tasks are made of.

use crate::library::column;
use landau_solver::error::Result;
use landau_solver::study::row::Row;
use landau_solver::study::sweep::{Range, Sweep};
use landau_solver::study::{self, Setup, Silent};

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
