//! Where a study is worked on: the models, the folders, the cases of the study set up.

use super::study::{Case, Study, Task};
use super::symbols;
use crate::library::Library;
use landau_solver::error::Result;
use landau_solver::study::Setup;
use std::path::{Path, PathBuf};

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
    /// Models at hand.
    pub library: &'a Library,
    /// What is worked through.
    pub study: &'a Study,
    /// Folder of the study file: models by path stand relative to it.
    pub home: PathBuf,
    /// Folder of the report.
    pub out: PathBuf,
    /// Where finished tasks are kept: beside the report, not in it.
    pub kept: PathBuf,
    /// How the report is made.
    pub provenance: Provenance,
}

impl Workshop<'_> {
    /// A text as pictures have it: names of the study written as it says.
    pub(super) fn written(&self, text: &str) -> String {
        symbols::written(text, &self.study.symbol)
    }

    /// Every file that the study was made from, by the name it is delivered under: the study, its formulas, the specs.
    pub(super) fn sources(&self) -> Result<Vec<(String, String)>> {
        let mut files = self.study.files.clone();
        let cases = self.study.figure.iter().flat_map(|figure| &figure.task);
        for case in cases.flat_map(Task::cases) {
            for (path, text) in self.setup(case)?.model.sources() {
                let name = Path::new(&path).file_name().unwrap_or_default();
                let name = name.to_string_lossy().into_owned();
                if !files.iter().any(|(known, _)| *known == name) {
                    files.push((name, text));
                }
            }
        }
        Ok(files)
    }

    /// The model and parameters of a case.
    pub(super) fn setup(&self, case: &Case) -> Result<Setup> {
        let name = case.model.as_ref().unwrap_or(&self.study.model);
        let resolution = case.resolution.unwrap_or(self.study.resolution);
        let model = self.library.model(&beside(&self.home, name))?;
        let mut setup = Setup::new(model, resolution);
        setup.set(&case.set)?;
        Ok(setup)
    }
}

/// A model as a study names it: a file beside the study where there is one, a built model otherwise.
pub fn beside(home: &Path, name: &str) -> String {
    let file = home.join(name);
    match file.to_str() {
        Some(path) if file.is_file() => path.to_owned(),
        _ => name.to_owned(),
    }
}
