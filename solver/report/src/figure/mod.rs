//! Pictures, as SVG or PNG. The plotting library is used nowhere else.

mod atlas;
mod curves;
mod modes;
mod outline;
mod pattern;
mod plane;
mod raster;
mod ticks;

pub use atlas::atlas;
pub use curves::{Curve, Panel, Style, panels};
pub use modes::{POINTS, base, critical, modes, spectrum};
pub use pattern::{Part, View, pattern_lines, pattern_pair};
pub use plane::{Plane, planes};

use landau_solver::error::{Error, Result};
use landau_solver::file::seal::{BLANK, sealed};
use landau_solver::file::write_whole;
use landau_solver::words::shown_path;
use std::path::Path;

/// Colours that remain apart for colour-blind readers (Okabe & Ito), the darkest first.
const COLOURS: [&str; 7] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000",
];

/// A picture, not yet in any format.
pub struct Drawing {
    scene: kuva::render::render::Scene,
    /// What is seen, in a sentence.
    pub says: String,
}

impl Drawing {
    fn new(figure: kuva::prelude::Figure, says: String) -> Self {
        let scene = outline::outlined(figure.render());
        Drawing { scene, says }
    }

    /// As SVG.
    pub fn svg(&self) -> String {
        let svg = kuva::backend::svg::SvgBackend::default().render_scene(&self.scene);
        crate::shown_lines(numbered_anew(&svg))
    }

    /// As PNG.
    ///
    /// # Errors
    /// A picture that is too large.
    pub fn png(&self) -> Result<Vec<u8>> {
        let drawn = raster::png(&self.svg());
        drawn.map_err(|e| Error::computation(format!("the picture cannot be made: {e}")))
    }

    /// In the format that the path asks for, sealed.
    ///
    /// # Errors
    /// A path that is no .svg or .png, or cannot be written.
    pub fn write(&self, path: &Path) -> Result<()> {
        match path.extension().and_then(|e| e.to_str()) {
            Some("svg") => {
                let svg = self.svg();
                let body = svg.trim_end().trim_end_matches("</svg>");
                let text = format!("{body}<!-- {BLANK} -->\n</svg>\n");
                write_whole(path, &sealed(text.into_bytes()))
            }
            Some("png") => write_whole(path, &raster::sealed(self.png()?)),
            _ => Err(not_a_picture(path)),
        }
    }
}

/// The plotting library counts clipped regions over all pictures of a process; here over one, so that a picture is the
/// same whatever else was drawn.
fn numbered_anew(svg: &str) -> String {
    const NAME: &str = "kuva-clip-";
    let mut parts = svg.split(NAME);
    let mut text = parts.next().unwrap_or_default().to_owned();
    let mut numbers: Vec<&str> = Vec::new();
    for part in parts {
        let digits = part.len() - part.trim_start_matches(|c: char| c.is_ascii_digit()).len();
        let (number, after) = part.split_at(digits);
        let position = numbers.iter().position(|earlier| *earlier == number);
        let position = position.unwrap_or_else(|| {
            numbers.push(number);
            numbers.len() - 1
        });
        text += &format!("clip-{position}{after}");
    }
    text
}

/// Whether a path names a format that pictures are written in.
pub fn is_picture(path: &Path) -> bool {
    path.extension().is_some_and(|e| e == "svg" || e == "png")
}

fn not_a_picture(path: &Path) -> Error {
    Error::input(format!(
        "{}: a picture is an .svg or a .png",
        shown_path(path)
    ))
}

#[cfg(test)]
mod tests {
    use super::{Panel, Style, panels};

    /// A picture does not depend on those drawn before it.
    #[test]
    fn the_same_bytes_again() {
        let drawn = || {
            let mut panel = Panel::new("line", "x", "y");
            panel.curve("", Style::Line, vec![(0.0, 0.0), (1.0, 2.0)]);
            panels("", &[panel]).map(|drawing| drawing.svg())
        };
        let first = drawn();
        assert!(first.as_ref().is_some_and(|svg| svg.contains("#clip-0)")));
        assert_eq!(first, drawn());
    }
}
