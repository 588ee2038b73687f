//! A pattern: the fundamental alone beside the expansion through third order.

use super::{Plane, planes};
use landau_solver::model::Structure;
use landau_solver::weakly::Pattern;

/// Linear beside nonlinear.
pub fn pattern_pair(
    structure: &Structure,
    found: &Pattern,
    shade: usize,
    arrows: Option<[usize; 2]>,
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

fn one<'a>(
    found: &'a Pattern,
    title: &str,
    fields: &'a [Vec<Vec<f64>>],
    shade: usize,
    arrows: Option<[usize; 2]>,
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
