//! Modes over the cross-stream coordinate, spectra in the complex plane, base states.

use super::{Drawing, Panel, Style, panels};
use landau_solver::base::BaseState;
use landau_solver::model::{C64, FieldId, Structure};
use landau_solver::space::Place;
use landau_solver::study::Setup;
use landau_solver::study::critical::Scan;
use landau_solver::study::modes::{ModeProfile, Modes};
use landau_solver::study::spectrum::SpectrumReport;
use landau_solver::words::short;

/// Below this part of the largest value of a mode a part counts as zero.
const NOTHING: f64 = 1e-9;
/// Points of a base profile.
const POINTS: usize = 401;
/// How far beyond the slowest eigenvalues a spectrum is drawn.
const REACH: f64 = 12.0;

/// Real or imaginary part.
type Side = fn(&C64) -> f64;

/// One panel a mode: real parts as lines, imaginary parts dashed.
pub fn modes(structure: &Structure, found: &Modes) -> Option<Drawing> {
    let vertical = structure.coordinate.as_deref()?;
    let panel = |profile: &ModeProfile| {
        let mut panel = Panel::new(&profile.name, vertical, "");
        let sizes = profile.values.iter().flatten().map(|v| v.norm());
        let largest = sizes.fold(0.0, f64::max);
        for (part, values) in profile.parts.iter().zip(&profile.values) {
            let sides: [(&str, Style, Side); 2] =
                [("", Style::Line, |v| v.re), ("i ", Style::Dashed, |v| v.im)];
            for (unit, style, of) in sides {
                if values.iter().any(|v| of(v).abs() > NOTHING * largest) {
                    let points = found.heights.iter().copied().zip(values.iter().map(of));
                    panel.curve(&format!("{unit}{part}"), style, points.collect());
                }
            }
        }
        panel
    };
    let drawn: Vec<Panel> = found.profiles.iter().map(panel).collect();
    panels(
        &format!("{}, k = {}", structure.title, short(found.k)),
        &drawn,
    )
}

/// The slow eigenvalues of L and L† in the complex plane.
pub fn spectrum(found: &SpectrumReport) -> Option<Drawing> {
    let reach = REACH * found.direct.scale();
    let shown = |c: &&C64| reach == 0.0 || c.norm() <= reach;
    let mut panel = Panel::new(
        &format!("{}, k = {}", found.title, short(found.k)),
        "growth rate",
        "frequency",
    );
    let direct = found.direct.values.iter().filter(shown);
    panel.curve("L", Style::Discs, direct.map(|c| (c.re, c.im)).collect());
    if let Ok(adjoint) = &found.adjoint {
        let conjugate = adjoint.values.iter().filter(shown).map(|c| (c.re, -c.im));
        panel.curve("L†, conjugate", Style::Dots, conjugate.collect());
    }
    panels("", &[panel])
}

/// One panel a field.
pub fn base(setup: &Setup, state: &BaseState) -> Option<Drawing> {
    let structure = setup.model.structure();
    let vertical = structure.coordinate.as_deref()?;
    let places = state.space.evenly(POINTS);
    let points: Vec<Vec<f64>> = places.iter().map(|&place| state.at(place, 0.0)).collect();
    let profiles = structure.profiles();
    let panel = |field: FieldId| {
        let name = &structure.fields[field].name;
        let mut panel = Panel::new(name, vertical, name);
        let value = |(place, point): (&Place, &Vec<f64>)| {
            let y = state.space.y(*place);
            (y, structure.base_value(point, field, 0))
        };
        panel.curve(
            "",
            Style::Line,
            places.iter().zip(&points).map(value).collect(),
        );
        panel
    };
    let drawn: Vec<Panel> = profiles.map(panel).collect();
    panels(&format!("{}: base state", structure.title), &drawn)
}

/// A quantity over the range in which it was asked to vanish, and where it does.
pub fn critical(title: &str, axis: &str, quantity: &str, found: &Scan) -> Option<Drawing> {
    let mut panel = Panel::new(title, axis, quantity);
    panel.curve_with_poles(quantity, Style::Line, found.curve.clone());
    let roots = found.found.iter().map(|point| (point.value, 0.0)).collect();
    panel.curve("critical points", Style::Dots, roots);
    panels("", &[panel])
}
