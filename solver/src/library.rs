//! The models at hand: those that are built in, and any other from its file.

use crate::error::{Error, Result};
use crate::model::{Model, TapeModel};
use landau_codegen::build::read_sources;
use landau_codegen::diagnostic::nearest;
use std::path::Path;

/// The models of a crate.
pub struct Library {
    pub models: Vec<Box<dyn Model>>,
}

impl Library {
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
            let sources = read_sources(path)
                .map_err(|e| Error::input(format!("{name} cannot be read: {e}")))?;
            let model = TapeModel::new(&sources)
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
