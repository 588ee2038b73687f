//! Modes over the cross-stream coordinate, spectra in the complex plane, base states.

use super::{Drawing, Panel, Style, panels, ticks};
use landau_solver::model::{C64, Structure};
use landau_solver::study::critical::Curve;
use landau_solver::study::modes::{ModeProfile, Modes};
use landau_solver::study::profiles::BaseReport;
use landau_solver::study::spectrum::SpectrumReport;
use landau_solver::words::short;

/// Below this part of the largest value of a mode a part counts as zero.
const NOTHING: f64 = 1e-9;
/// Points of a base profile that is drawn.
pub const POINTS: usize = 401;
/// How far beyond the slowest eigenvalues a spectrum is drawn.
const REACH: f64 = 12.0;

/// Real or imaginary part.
type Side = fn(&C64) -> f64;

/// One panel a mode: real parts as lines, imaginary parts dashed, each field over its largest modulus, which the legend
/// says: a pressure would flatten all others.
pub fn modes(structure: &Structure, found: &Modes) -> Option<Drawing> {
    let vertical = structure.coordinate.as_deref()?;
    let panel = |profile: &ModeProfile| {
        let mut panel = Panel::new(&profile.name, vertical, "");
        let size = |values: &[C64]| values.iter().map(|v| v.norm()).fold(0.0, f64::max);
        let largest = profile.values.iter().map(|v| size(v)).fold(0.0, f64::max);
        for (part, values) in profile.parts.iter().zip(&profile.values) {
            let size = size(values);
            if size <= NOTHING * largest {
                continue;
            }
            let scaled = |of: Side| {
                let values = values.iter().map(|v| of(v) / size);
                found.heights.iter().copied().zip(values).collect()
            };
            let seen = |of: Side| values.iter().any(|v| of(v).abs() > NOTHING * size);
            let divided = format!("{part} / {}", ticks::size(size));
            match (seen(|v| v.re), seen(|v| v.im)) {
                (true, both) => {
                    panel.curve(&divided, Style::Line, scaled(|v| v.re));
                    if both {
                        let label = format!("i {part}");
                        panel.curve_beside(&label, Style::Dashed, scaled(|v| v.im));
                    }
                }
                (false, _) => {
                    panel.curve(&format!("i {divided}"), Style::Dashed, scaled(|v| v.im));
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

/// One panel a field; unknown numbers are none.
pub fn base(found: &BaseReport) -> Option<Drawing> {
    let vertical = found.coordinate.as_deref()?;
    let panel = |(name, values): &(String, Vec<f64>)| {
        let mut panel = Panel::new(name, vertical, name);
        let points = found.heights.iter().copied().zip(values.iter().copied());
        panel.curve("", Style::Line, points.collect());
        panel
    };
    let profiles = found.profiles.iter().take(found.varying);
    let drawn: Vec<Panel> = profiles.map(panel).collect();
    panels(&format!("{}: base state", found.title), &drawn)
}

/// A quantity over the range in which it was asked to vanish, and where it does.
pub fn critical(title: &str, axis: &str, quantity: &str, found: &Curve) -> Option<Drawing> {
    let mut panel = Panel::new(title, axis, quantity);
    panel.curve_with_poles(quantity, Style::Line, found.points.clone());
    let roots = found.roots.iter().map(|root| (*root, 0.0)).collect();
    panel.curve("critical points", Style::Dots, roots);
    panels("", &[panel])
}
