//! Where a study is worked on: the models, the folders, the cases of the study set up.

use super::feasible;
use super::files::Shelf;
use super::keep::is_kept;
use super::ledger::is_of_a_report;
use super::study::{Case, Study};
use super::symbols;
use crate::library::Library;
use landau_solver::error::{Error, Result};
use landau_solver::file::Overwrite;
use landau_solver::model::Model;
use landau_solver::study::Setup;
use landau_solver::words::shown_path;
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
        shop.check_inputs()?;
        shop.check_kept(overwrite)?;
        Ok(shop)
    }

    /// The folder in which finished tasks are kept.
    pub fn kept(&self) -> &Path {
        self.kept.folder()
    }

    /// Refuses a report whose files would replace what it is made from, whatever may be replaced otherwise.
    fn check_inputs(&self) -> Result<()> {
        let study = self.study;
        let beside = |name: &String| study.home().join(name);
        let mut inputs = vec![study.read_from.path.clone()];
        inputs.extend(study.errata.iter().map(beside));
        let tasks = || study.figure.iter().flat_map(|figure| &figure.task);
        let references = tasks().flat_map(|task| task.kind().references());
        inputs.extend(references.map(|reference| beside(&reference.file)));
        let cases = tasks().flat_map(|task| task.kind().cases());
        let models = cases.filter_map(|case| case.model.as_ref());
        for name in [&study.model].into_iter().chain(models) {
            inputs.extend(self.library.inputs(&self.place_of_model(name)));
        }
        let folder = self.shelf.folder().canonicalize();
        let Ok(folder) = folder else { return Ok(()) };
        for input in inputs {
            let place = input.canonicalize().ok();
            let name = place
                .as_ref()
                .and_then(|place| place.strip_prefix(&folder).ok());
            if name.is_some_and(|name| is_of_a_report(&name.to_string_lossy())) {
                return Err(Error::input(format!(
                    "{} is what the report is made from, and the report would replace it: choose another --out",
                    shown_path(&input)
                )));
            }
        }
        Ok(())
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

    /// The name by which the library has a model of the study: the path of a file beside the study where there is one.
    fn place_of_model(&self, name: &str) -> String {
        let file = self.study.home().join(name);
        match file.to_str() {
            Some(path) if file.is_file() => path.to_owned(),
            _ => name.to_owned(),
        }
    }

    /// A model at the defaults of its parameters; setups made from it share the base states that were solved.
    fn defaults(&self, name: &str) -> Result<Setup> {
        let mut setups = self.setups.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(setup) = setups.get(name) {
            return Ok(setup.clone());
        }
        let model = self.library.model(&self.place_of_model(name))?;
        let setup = Setup::new(model, self.study.resolution)?;
        setups.insert(name.to_owned(), setup.clone());
        Ok(setup)
    }
}
