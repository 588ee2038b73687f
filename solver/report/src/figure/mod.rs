//! Pictures, as SVG or PNG. The plotting library is used nowhere else.

mod atlas;
mod curves;
mod modes;
mod outline;
mod pattern;
mod plane;
mod ticks;

pub use atlas::atlas;
pub use curves::{Curve, Panel, Style, panels};
pub use modes::{base, critical, modes, spectrum};
pub use pattern::{Part, View, pattern_lines, pattern_pair};
pub use plane::{Plane, planes};

use landau_solver::error::{Error, Result};
use landau_solver::file::write_whole;
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

/// Pixels of a PNG a pixel of the drawing.
const SCALE: f32 = 1.5;

impl Drawing {
    fn new(figure: kuva::prelude::Figure, says: String) -> Self {
        let scene = outline::outlined(figure.render());
        Drawing { scene, says }
    }

    /// As SVG.
    pub fn svg(&self) -> String {
        kuva::backend::svg::SvgBackend::default().render_scene(&self.scene)
    }

    /// As PNG.
    ///
    /// # Errors
    /// A picture that is too large.
    pub fn png(&self) -> Result<Vec<u8>> {
        let backend = kuva::backend::png::PngBackend::new().with_scale(SCALE);
        let drawn = backend.render_scene(&self.scene);
        drawn.map_err(|e| Error::computation(format!("the picture cannot be made: {e}")))
    }

    /// In the format that the path asks for.
    ///
    /// # Errors
    /// A path that is no .svg or .png, or cannot be written.
    pub fn write(&self, path: &Path) -> Result<()> {
        match path.extension().and_then(|e| e.to_str()) {
            Some("svg") => write_whole(path, self.svg().as_bytes()),
            Some("png") => write_whole(path, &self.png()?),
            _ => Err(not_a_picture(path)),
        }
    }
}

/// Whether a path names a format that pictures are written in.
pub fn is_picture(path: &Path) -> bool {
    path.extension().is_some_and(|e| e == "svg" || e == "png")
}

fn not_a_picture(path: &Path) -> Error {
    Error::input(format!(
        "{}: a picture is an .svg or a .png",
        path.display()
    ))
}
