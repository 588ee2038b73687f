//! Pictures as SVG. The plotting library is used nowhere else.

mod compact;
mod curves;
mod modes;
mod pattern;
mod plane;

pub use curves::{Curve, Panel, Style, panels};
pub use modes::{base, modes, spectrum};
pub use pattern::{Part, pattern_lines, pattern_pair};
pub use plane::{Plane, planes};

/// Colours that remain apart for colour-blind readers (Okabe & Ito), the darkest first.
const COLOURS: [&str; 7] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000",
];

fn svg(figure: kuva::prelude::Figure) -> String {
    let drawn = kuva::backend::svg::SvgBackend::default().render_scene(&figure.render());
    compact::paths(&drawn)
}
