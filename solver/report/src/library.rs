//! The models at hand: those that are built in, and any other from its file.

use landau_codegen::build::read_sources;
use landau_codegen::diagnostic::SourceFile;
use landau_codegen::{Sources, tape};
use landau_solver::error::{Error, Result};
use landau_solver::model::{Model, nearest};
use std::path::Path;

/// The models of a crate.
pub struct Library {
    /// In the order of their names.
    pub models: Vec<Box<dyn Model>>,
}

impl Library {
    /// A spec with the law files beside it, and those of the built models where none beside it has their name.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn sources(&self, path: &Path) -> Result<Sources> {
        let mut sources = read_sources(path)
            .map_err(|e| Error::input(format!("{} cannot be read: {e}", path.display())))?;
        for (path, text) in self.models.iter().flat_map(|model| model.laws()) {
            let name = Path::new(&path).file_stem().unwrap_or_default();
            let name = name.to_string_lossy().into_owned();
            let file = SourceFile { path, text };
            sources.laws.entry(name).or_insert(file);
        }
        Ok(sources)
    }

    /// Calls `action` with a built model by name, or with one run from the tape of its `.model` file.
    ///
    /// # Errors
    /// A name that is neither, a spec with mistakes, whatever `action` fails with.
    pub fn with_model<R>(
        &self,
        name: &str,
        action: impl FnOnce(&dyn Model) -> Result<R>,
    ) -> Result<R> {
        let mut built = self.models.iter().map(AsRef::as_ref);
        if let Some(model) = built.find(|model| model.structure().name == name) {
            return action(model);
        }
        let path = Path::new(name);
        if name.ends_with(".model") || path.is_file() {
            let sources = self.sources(path)?;
            let model = tape(&sources)
                .map_err(|mistakes| Error::input(format!("the spec has mistakes\n\n{mistakes}")))?;
            return action(&model);
        }
        let names: Vec<&str> = self
            .models
            .iter()
            .map(|m| m.structure().name.as_str())
            .collect();
        let near = nearest(name, names.iter().copied())
            .map_or(String::new(), |n| format!("; did you mean `{n}`?"));
        Err(Error::input(format!(
            "there is no model `{name}`: built are {}; the path of a .model file is accepted too{near}",
            names.join(", ")
        )))
    }
}
