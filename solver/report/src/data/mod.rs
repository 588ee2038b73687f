//! Arrays with their axes and what they were computed from, for other programs.

pub mod csvw;
pub mod lines;
pub mod names;
mod netcdf;
mod npz;
pub mod plane;
pub mod table;
mod vtk;

use landau_solver::error::{Error, Result};
use landau_solver::file::seal::sealed;
use landau_solver::file::write_whole;
use landau_solver::words::shown_path;
use std::path::Path;

/// What is said of a dataset or of an array.
#[derive(Clone, Debug, PartialEq)]
pub enum Fact {
    /// In words.
    Text(String),
    /// A number, as a number.
    Number(f64),
}

/// Facts by name.
pub type Facts = Vec<(String, Fact)>;

/// An axis.
pub struct Axis {
    /// As it is declared.
    pub name: String,
    /// What it is, in words.
    pub long_name: String,
    /// In ascending order.
    pub values: Vec<f64>,
}

/// A labelled array over some of the axes, the last varying fastest.
pub struct Array {
    /// As it is declared.
    pub name: String,
    /// What it is, in words.
    pub long_name: String,
    /// Positions of its axes, the last varying fastest.
    pub axes: Vec<usize>,
    /// Its numbers.
    pub values: Vec<f64>,
}

/// Axes, arrays over them, and attributes.
pub struct Dataset {
    /// Of the whole.
    pub attributes: Facts,
    /// The axes, the last varying fastest.
    pub axes: Vec<Axis>,
    /// What there is.
    pub arrays: Vec<Array>,
    /// Vectors: a name, and the names of the components along x and y.
    pub vectors: Vec<(String, [String; 2])>,
}

/// The conventions that attributes follow.
pub const CONVENTIONS: &str = "CF-1.8";

/// Units of every number: models are dimensionless, or in units that their specs say.
pub const UNITS: &str = "1";

/// File formats by extension.
pub const FORMATS: [&str; 3] = ["npz", "nc", "vtk"];

impl Dataset {
    /// Writes the file whole or not at all, sealed, in the format of its extension.
    ///
    /// # Errors
    /// An extension that is none of [`FORMATS`], a folder that does not exist.
    pub fn write(&self, path: &Path) -> Result<()> {
        let extension = path.extension().and_then(|e| e.to_str()).unwrap_or("");
        let bytes = match extension {
            "npz" => npz::encode(self),
            "nc" => netcdf::encode(self),
            "vtk" => vtk::encode(self),
            _ => {
                return Err(Error::input(format!(
                    "{}: data is written as .{}",
                    shown_path(path),
                    FORMATS.join(", .")
                )));
            }
        };
        let bytes = bytes.map_err(|reason| {
            Error::computation(format!("{} cannot be encoded: {reason}", shown_path(path)))
        })?;
        write_whole(path, &sealed(bytes))
    }
}
