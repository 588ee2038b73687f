//! A pattern: the fundamental alone beside the expansion through third order.

use super::{Drawing, Panel, Plane, Style, panels, planes};
use landau_solver::model::Structure;
use landau_solver::weakly::{Pattern, PlaneField};

/// What of a pattern is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Base state and perturbation.
    Total,
    /// The perturbation alone.
    Perturbation,
}

impl Part {
    /// The part of a quantity over the plane.
    fn of(self, total: &[Vec<f64>], base: &[f64]) -> Vec<Vec<f64>> {
        let row = |(row, base): (&Vec<f64>, &f64)| match self {
            Part::Total => row.clone(),
            Part::Perturbation => row.iter().map(|value| value - base).collect(),
        };
        total.iter().zip(base).map(row).collect()
    }

    /// A quantity as a picture names it.
    fn name(self, name: &str) -> String {
        match self {
            Part::Total => name.to_owned(),
            Part::Perturbation => format!("{name} − base"),
        }
    }
}

/// What of a pattern is looked at, and how names are written.
pub struct View<'a> {
    /// What stands above the picture.
    pub title: String,
    /// The shaded quantity.
    pub shade: &'a PlaneField,
    /// What of it.
    pub part: Part,
    /// The two components of what arrows show.
    pub arrows: Option<[&'a PlaneField; 2]>,
    /// How a name is written.
    pub written: &'a dyn Fn(&str) -> String,
}

/// Linear beside nonlinear.
pub fn pattern_pair(structure: &Structure, found: &Pattern, view: &View) -> Drawing {
    let (part, written) = (view.part, view.written);
    let vertical = structure.coordinate.clone().unwrap_or_default();
    let labels = [written(&structure.periodic), written(&vertical)];
    type Chosen = fn(&PlaneField) -> &[Vec<f64>];
    let panel = |title: &str, of: Chosen| Plane {
        title: title.to_owned(),
        labels: labels.clone(),
        x: &found.x,
        y: &found.y,
        shade: (
            part.name(&written(&view.shade.name)),
            part.of(of(view.shade), &view.shade.base),
        ),
        arrows: view
            .arrows
            .map(|pair| pair.map(|field| part.of(of(field), &field.base))),
        key: view.arrows.map(|[along, across]| {
            format!("({}, {})", written(&along.name), written(&across.name))
        }),
    };
    planes(
        &view.title,
        &[
            panel("(a) fundamental alone", |field| &field.linear),
            panel("(b) through third order", |field| &field.nonlinear),
        ],
    )
}

/// The same along the periodic coordinate alone, one panel a field.
pub fn pattern_lines(
    structure: &Structure,
    found: &Pattern,
    title: &str,
    part: Part,
) -> Option<Drawing> {
    let panel = |field: &PlaneField| {
        let name = part.name(&field.name);
        let mut panel = Panel::new(&name, &structure.periodic, &name);
        let curve = |values: &[Vec<f64>]| {
            let values = part.of(values, &field.base).into_iter().flatten();
            found.x.iter().copied().zip(values).collect()
        };
        panel.curve("through third order", Style::Line, curve(&field.nonlinear));
        panel.curve("fundamental alone", Style::Dashed, curve(&field.linear));
        panel
    };
    let all = found.fields.iter().chain(&found.derived);
    let drawn: Vec<Panel> = all.map(panel).collect();
    panels(title, &drawn)
}
