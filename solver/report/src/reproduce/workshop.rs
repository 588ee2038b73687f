//! Where a study is worked on: the models, the folders, the cases of the study set up.

use super::feasible;
use super::files::Shelf;
use super::keep::is_kept;
use super::study::{Case, Study};
use super::symbols;
use crate::library::Library;
use landau_solver::error::Result;
use landau_solver::file::Overwrite;
use landau_solver::model::Model;
use landau_solver::study::Setup;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

/// Where the page came from.
pub struct Provenance {
    /// The command that made it.
    pub command: String,
    /// When, by RFC 3339.
    pub date: String,
    /// The commit that the program was built from, where that was known.
    pub commit: Option<String>,
}

/// Where a study is worked on.
pub struct Workshop<'a> {
    /// What is worked through.
    pub study: &'a Study,
    /// How the report is made.
    pub provenance: Provenance,
    library: &'a Library,
    /// The folder of the report.
    pub(super) shelf: Shelf,
    /// Where finished tasks are kept: beside the report, not in it.
    pub(super) kept: Shelf,
    /// Models by the names that the study gives them, each read once.
    setups: Mutex<BTreeMap<String, Setup>>,
}

impl<'a> Workshop<'a> {
    /// A study, the models for it and the folder of its report. Nothing is computed or written.
    ///
    /// # Errors
    /// A folder that holds other things than a report, or files of it that were changed since and that `overwrite` does
    /// not allow to replace; a study that asks its models for what they do not have.
    pub fn new(
        library: &'a Library,
        study: &'a Study,
        out: &Path,
        overwrite: Overwrite,
        provenance: Provenance,
    ) -> Result<Self> {
        let shelf = Shelf::new(out, overwrite)?;
        let shop = Workshop {
            study,
            provenance,
            library,
            kept: shelf.beside(is_kept)?,
            shelf,
            setups: Mutex::default(),
        };
        feasible::check(&shop)?;
        Ok(shop)
    }

    /// The folder in which finished tasks are kept.
    pub fn kept(&self) -> &Path {
        self.kept.folder()
    }

    /// The model of the whole study.
    ///
    /// # Errors
    /// A name that is none, a spec with mistakes.
    pub fn model(&self) -> Result<Arc<dyn Model>> {
        self.model_named(&self.study.model)
    }

    /// A text as pictures have it: names of the study written as it says.
    pub(super) fn written(&self, text: &str) -> String {
        symbols::written(text, &self.study.symbol)
    }

    /// The model and parameters of a case.
    pub(super) fn setup(&self, case: &Case) -> Result<Setup> {
        let name = case.model.as_ref().unwrap_or(&self.study.model);
        let resolution = case.resolution.unwrap_or(self.study.resolution);
        let mut setup = self.defaults(name)?.at_resolution(resolution)?;
        setup.set(&case.set)?;
        Ok(setup)
    }

    /// A model as the study names it: a file beside the study where there is one, a built model otherwise.
    pub(super) fn model_named(&self, name: &str) -> Result<Arc<dyn Model>> {
        Ok(self.defaults(name)?.model)
    }

    /// A model at the defaults of its parameters; setups made from it share the base states that were solved.
    fn defaults(&self, name: &str) -> Result<Setup> {
        let mut setups = self.setups.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(setup) = setups.get(name) {
            return Ok(setup.clone());
        }
        let file = self.study.home().join(name);
        let model = match file.to_str() {
            Some(path) if file.is_file() => self.library.model(path)?,
            _ => self.library.model(name)?,
        };
        let setup = Setup::new(model, self.study.resolution)?;
        setups.insert(name.to_owned(), setup.clone());
        Ok(setup)
    }
}
