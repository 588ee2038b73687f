//! Pictures as SVG. The plotting library is used nowhere else.

mod curves;
mod plane;

pub use curves::{Curve, Panel, Style, bulk, panels};
pub use plane::{Plane, planes};

/// Colours that remain apart for colour-blind readers (Okabe & Ito), the darkest first.
const COLOURS: [&str; 7] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000",
];

fn svg(figure: kuva::prelude::Figure) -> String {
    let drawn = kuva::backend::svg::SvgBackend::default().render_scene(&figure.render());
    shorten_paths(&drawn)
}

/// Coordinates of paths to a tenth of a pixel: shadings are a fifth of the size.
fn shorten_paths(svg: &str) -> String {
    let mut short = String::with_capacity(svg.len() / 2);
    let mut rest = svg;
    while let Some(start) = rest.find(" d=\"") {
        let (before, path) = rest.split_at(start + 4);
        let end = path.find('"').unwrap_or(path.len());
        short.push_str(before);
        for part in path[..end].split_inclusive(|c: char| !c.is_ascii_digit() && c != '.') {
            let digits = part.find(|c: char| !c.is_ascii_digit() && c != '.');
            let (number, separator) = part.split_at(digits.unwrap_or(part.len()));
            let point = number.find('.').unwrap_or(number.len());
            short.push_str(&number[..number.len().min(point + 2)]);
            short.push_str(separator);
        }
        rest = &path[end..];
    }
    short.push_str(rest);
    short
}
