//! The files that a command is going to write, looked at before it computes anything.

use landau_report::data::FORMATS;
use landau_report::figure::is_picture;
use landau_solver::error::{Error, Result};
use landau_solver::file::{Overwrite, check_replaceable, destination};
use landau_solver::words::shown_path;
use std::path::{Path, PathBuf};

/// Refuses files that a command must not write: two under one name, and those that Landau did not write, unless
/// `overwrite` allows it.
///
/// # Errors
/// Names the file, and says what to do.
pub fn check<'p>(paths: impl IntoIterator<Item = &'p Path>, overwrite: Overwrite) -> Result<()> {
    let mut targets: Vec<PathBuf> = Vec::new();
    for path in paths {
        check_replaceable(path, overwrite)?;
        let target = place(path)?;
        if targets.contains(&target) {
            return Err(named_twice(path));
        }
        targets.push(target);
    }
    Ok(())
}

/// Where a file stands or will stand, whichever way its folder is written.
fn place(path: &Path) -> Result<PathBuf> {
    let target = destination(path)?;
    let folder = target
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new(".")).canonicalize();
    let name = target.file_name().unwrap_or_default();
    Ok(folder.map_or_else(|_| target.clone(), |folder| folder.join(name)))
}

/// Refuses files that would replace what the command reads, whatever the user allows.
///
/// # Errors
/// One of `paths` is one of `inputs`, perhaps through a link.
pub fn check_inputs(paths: &[PathBuf], inputs: &[PathBuf]) -> Result<()> {
    let inputs: Vec<PathBuf> = inputs
        .iter()
        .filter_map(|i| i.canonicalize().ok())
        .collect();
    let is_input = |path: &&PathBuf| {
        let place = path.canonicalize();
        place.is_ok_and(|place| inputs.contains(&place))
    };
    match paths.iter().find(is_input) {
        Some(path) => Err(Error::input(format!(
            "{} is what the command reads, and is not replaced: choose another name for the result",
            shown_path(path)
        ))),
        None => Ok(()),
    }
}

fn named_twice(path: &Path) -> Error {
    Error::input(format!(
        "{} is named twice: one file would replace the other",
        shown_path(path)
    ))
}

/// Refuses a result that would replace another file of the same command.
///
/// # Errors
/// `out` is one of `files`, perhaps through a link; see [`destination`].
pub fn check_apart<'p>(out: &Path, files: impl IntoIterator<Item = &'p Path>) -> Result<()> {
    let target = place(out)?;
    let mut files = files.into_iter();
    if files.any(|file| place(file).is_ok_and(|place| place == target)) {
        return Err(named_twice(out));
    }
    Ok(())
}

/// Refuses a picture in a format that is not written.
///
/// # Errors
/// A path that is no .svg or .png.
pub fn check_picture(path: Option<&Path>) -> Result<()> {
    match path {
        Some(path) if !is_picture(path) => Err(Error::input(format!(
            "--plot {}: it accepts .svg, .png",
            shown_path(path)
        ))),
        _ => Ok(()),
    }
}

/// Refuses data in a format that a command does not write.
///
/// # Errors
/// A path whose extension is none of `extensions`.
pub fn check_data(paths: &[PathBuf], extensions: &[&str]) -> Result<()> {
    let has_format = |path: &&PathBuf| {
        let extension = path.extension().and_then(|e| e.to_str());
        extension.is_some_and(|e| extensions.contains(&e))
    };
    match paths.iter().find(|path| !has_format(path)) {
        Some(path) => Err(Error::input(format!(
            "--out {}: it accepts .{}",
            shown_path(path),
            extensions.join(", .")
        ))),
        None => Ok(()),
    }
}

/// What data over one coordinate are written as.
pub const LINE_FORMATS: [&str; 2] = ["npz", "nc"];

/// What a pattern is written as: pictures, then data.
pub fn plane_formats() -> Vec<&'static str> {
    ["svg", "png"].into_iter().chain(FORMATS).collect()
}
