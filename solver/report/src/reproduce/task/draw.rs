//! What the tasks draw: pictures with their tables.

use super::super::outcome::{Outcome, Picture};
use super::super::table::Table;
use super::super::workshop::Workshop;
use crate::figure::{Panel, panels};

/// Adds the panels with their table; the table alone where no panel has a value.
pub(super) fn picture(
    shop: &Workshop,
    outcome: &mut Outcome,
    caption: &str,
    drawn: &[Panel],
    table: Table,
) {
    let written = |panel: &Panel| {
        let mut panel = panel.clone();
        for text in [&mut panel.title, &mut panel.x, &mut panel.y] {
            *text = shop.written(text);
        }
        let labels = panel.curves.iter_mut().map(|curve| &mut curve.label);
        let marks = panel.marks.iter_mut().map(|(_, name)| name);
        labels
            .chain(marks)
            .for_each(|text| *text = shop.written(text));
        panel
    };
    let drawn: Vec<Panel> = drawn.iter().map(written).collect();
    let drawing = panels("", &drawn);
    let says = match &drawing {
        Some(drawing) => drawing.says.clone(),
        None => "Nothing to draw: no value in the columns that are shown.".to_owned(),
    };
    outcome.pictures.push(Picture {
        caption: caption.to_owned(),
        says,
        svg: drawing.map(|drawing| drawing.svg()),
        table: Some(table),
        files: Vec::new(),
    });
}
