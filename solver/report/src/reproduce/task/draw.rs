//! What the tasks draw: names of quantities, pictures with their tables.

use super::super::outcome::{Outcome, Picture, Table};
use super::super::study::Case;
use crate::figure::{Panel, panels};

/// `label: quantity`
pub(super) fn named(case: &Case, quantity: &str) -> String {
    if case.label.is_empty() {
        quantity.to_owned()
    } else {
        format!("{}: {quantity}", case.label)
    }
}

/// Adds the panels with their table, where there is anything to draw.
pub(super) fn picture(outcome: &mut Outcome, caption: &str, drawn: &[Panel], table: Table) {
    if let Some(svg) = panels(caption, drawn) {
        outcome.pictures.push(Picture {
            caption: caption.to_owned(),
            svg,
            table: Some(table),
            files: Vec::new(),
        });
    }
}
