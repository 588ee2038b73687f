//! The models at hand: those that are built in, and any other from its file.

use landau_codegen::build::read_sources;
use landau_codegen::diagnostic::{SourceFile, shortened};
use landau_codegen::expression::compile;
use landau_codegen::{Sources, tape};
use landau_solver::error::{Error, Result};
use landau_solver::model::{Expression, Model, TapeModel, nearest};
use landau_solver::study::derived::{Derived, Wanted};
use landau_solver::words::shown_path;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A spec as a model that interprets its kernels.
///
/// # Errors
/// Every mistake of the spec, with its place.
pub fn taped(sources: &Sources) -> Result<TapeModel> {
    tape(sources).map_err(|mistakes| Error::input(format!("the spec has mistakes\n\n{mistakes}")))
}

/// The sources of a model as it carries them, its own law files by name.
///
/// # Errors
/// A model that carries none.
pub fn sources(model: &dyn Model) -> Result<Sources> {
    let mut files = model
        .sources()
        .into_iter()
        .map(|(path, text)| SourceFile { path, text });
    let spec = files
        .next()
        .ok_or_else(|| Error::input("the model has no source"))?;
    let stem = |path: &str| {
        let stem = Path::new(path).file_stem().unwrap_or_default();
        stem.to_string_lossy().into_owned()
    };
    let laws = files.map(|file| (stem(&file.path), file)).collect();
    Ok(Sources {
        spec,
        laws,
        unreadable: BTreeMap::new(),
    })
}

/// An expression in the names of a model's spec, compiled for it.
///
/// # Errors
/// Mistakes of the expression, with their place.
pub fn expression(model: &dyn Model, text: &str) -> Result<Expression> {
    let state = model.structure().state();
    compile(&sources(model)?, state, text).map_err(|mistakes| {
        Error::input(format!(
            "`{}` is no expression of the model\n\n{mistakes}",
            shortened(text)
        ))
    })
}

/// A column of a table, as a text asks for it.
///
/// # Errors
/// As [`Wanted::parse`] and [`expression`].
pub fn column(model: &dyn Model, text: &str) -> Result<Derived> {
    let wanted = Wanted::parse(&model.structure().outputs, text)?;
    wanted.column(text, |text| expression(model, text))
}

/// The models of a crate.
pub struct Library {
    /// In the order of their names.
    pub models: Vec<Arc<dyn Model>>,
}

impl Library {
    /// A spec with the law files beside it, and those of the built models where none beside it has their name.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn sources(&self, path: &Path) -> Result<Sources> {
        let mut sources = read_sources(path)
            .map_err(|e| Error::input(format!("{} cannot be read: {e}", shown_path(path))))?;
        for (path, text) in self.models.iter().flat_map(|model| model.laws()) {
            let name = Path::new(&path).file_stem().unwrap_or_default();
            let name = name.to_string_lossy().into_owned();
            let file = SourceFile { path, text };
            sources.laws.entry(name).or_insert(file);
        }
        Ok(sources)
    }

    /// The files that a model is read from: its spec and the laws beside it; none for a built model.
    pub fn inputs(&self, name: &str) -> Vec<PathBuf> {
        if self
            .models
            .iter()
            .any(|model| model.structure().name == name)
        {
            return Vec::new();
        }
        let spec = PathBuf::from(name);
        let folder = spec.parent().unwrap_or(Path::new("."));
        let folders = [folder.join("laws"), folder.join("..").join("laws")];
        let entries = folders.iter().flat_map(std::fs::read_dir).flatten();
        let laws = entries.filter_map(|entry| Some(entry.ok()?.path()));
        let laws = laws.filter(|path| path.extension().is_some_and(|e| e == "law"));
        laws.chain([spec.clone()]).collect()
    }

    /// A built model by name, or one run from the tape of its `.model` file.
    ///
    /// # Errors
    /// A name that is neither, a spec with mistakes.
    pub fn model(&self, name: &str) -> Result<Arc<dyn Model>> {
        let mut built = self.models.iter();
        if let Some(model) = built.find(|model| model.structure().name == name) {
            return Ok(model.clone());
        }
        let path = Path::new(name);
        if name.ends_with(".model") || path.is_file() {
            return Ok(Arc::new(taped(&self.sources(path)?)?));
        }
        let names: Vec<&str> = self
            .models
            .iter()
            .map(|m| m.structure().name.as_str())
            .collect();
        let near = nearest(name, names.iter().copied())
            .map_or(String::new(), |n| format!("; did you mean `{n}`?"));
        Err(Error::input(format!(
            "there is no model `{}`: built are {}; the path of a .model file is accepted too{near}",
            shortened(name),
            names.join(", ")
        )))
    }
}
