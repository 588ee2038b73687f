//! A pattern: the fundamental alone beside the expansion through third order.

use super::{Panel, Plane, Style, panels, planes};
use landau_solver::model::{FieldId, Structure, Table};
use landau_solver::weakly::Pattern;

/// Linear beside nonlinear.
pub fn pattern_pair(
    structure: &Structure,
    found: &Pattern,
    shade: FieldId,
    arrows: Option<[FieldId; 2]>,
) -> String {
    let vertical = structure.coordinate.clone().unwrap_or_default();
    let labels = [structure.periodic.clone(), vertical];
    let panel = |title, fields| one(found, title, fields, shade, arrows, labels.clone());
    let title = format!("{}, A = {:.4}", structure.title, found.amplitude);
    planes(
        &title,
        &[
            panel("fundamental alone", &found.linear),
            panel("through third order", &found.nonlinear),
        ],
    )
}

/// The same along the periodic coordinate alone, one panel a field.
pub fn pattern_lines(structure: &Structure, found: &Pattern) -> Option<String> {
    let panel = |(field, name): (FieldId, &String)| {
        let mut panel = Panel::new(name, &structure.periodic, name);
        let curve = |values: &Table<FieldId, Vec<Vec<f64>>>| {
            let values = values[field].iter().flatten().copied();
            found.x.iter().copied().zip(values).collect()
        };
        panel.curve("through third order", Style::Line, curve(&found.nonlinear));
        panel.curve("fundamental alone", Style::Dashed, curve(&found.linear));
        panel
    };
    let drawn: Vec<Panel> = found.names.pairs().map(panel).collect();
    panels(
        &format!("{}, A = {:.4}", structure.title, found.amplitude),
        &drawn,
    )
}

fn one<'a>(
    found: &'a Pattern,
    title: &str,
    fields: &'a Table<FieldId, Vec<Vec<f64>>>,
    shade: FieldId,
    arrows: Option<[FieldId; 2]>,
    labels: [String; 2],
) -> Plane<'a> {
    Plane {
        title: title.to_owned(),
        labels,
        x: &found.x,
        y: &found.y,
        shade: (&found.names[shade], &fields[shade]),
        arrows: arrows.map(|pair| pair.map(|f| fields[f].as_slice())),
    }
}
