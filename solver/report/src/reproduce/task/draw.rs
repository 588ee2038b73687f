//! What the tasks draw: pictures with their tables.

use super::super::outcome::{Outcome, Picture, Table};
use crate::figure::{Panel, panels};

/// Adds the panels with their table, where there is anything to draw.
pub(super) fn picture(outcome: &mut Outcome, caption: &str, drawn: &[Panel], table: Table) {
    if let Some(drawing) = panels("", drawn) {
        outcome.pictures.push(Picture {
            caption: caption.to_owned(),
            says: drawing.says.clone(),
            svg: drawing.svg(),
            table: Some(table),
            files: Vec::new(),
        });
    }
}
