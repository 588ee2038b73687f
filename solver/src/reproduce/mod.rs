//! A study file worked through: figures, numbers beside the printed ones, a report.
//!
//! `study` (the file) → `task` (what is computed) → `outcome` (pictures, tables, numbers) →
//! `report` (HTML, JSON). A figure that is finished is kept beside the report, so that an
//! interrupted run goes on where it was.

mod errata;
mod outcome;
mod report;
mod study;
mod task;

pub use errata::{Errata, Judgement, all_explained};
pub use outcome::{Number, Outcome, Picture, Table};
pub use report::Formulas;
pub use study::Study;

use crate::error::{Error, Result};
use crate::library::Library;
use crate::study::Setup;
use crate::study::sweep::write_whole;
use indicatif::ProgressBar;
use std::fs;
use std::path::{Path, PathBuf};
use study::{Case, Figure};

/// Where a study is worked on.
pub struct Workshop<'a> {
    pub library: &'a Library,
    pub study: &'a Study,
    /// Folder of the study file: models by path stand relative to it.
    pub home: PathBuf,
    pub out: PathBuf,
}

impl Workshop<'_> {
    /// Works through the study and writes the report.
    ///
    /// # Errors
    /// A folder that cannot be written, a model that does not exist. What merely does not come out is
    /// a sentence in the report.
    pub fn run(&self, formulas: &Formulas, progress: &ProgressBar) -> Result<Vec<Number>> {
        let kept = self.out.join("kept");
        fs::create_dir_all(&kept)
            .map_err(|e| Error::input(format!("{} cannot be made: {e}", kept.display())))?;
        progress.set_length(self.study.figure.len() as u64);
        let mut outcomes = Vec::new();
        for figure in &self.study.figure {
            progress.set_prefix(format!("figure {}", figure.id));
            progress.tick();
            outcomes.push(self.figure(figure, &kept)?);
            progress.inc(1);
        }
        progress.finish_and_clear();
        let numbers: Vec<Number> = outcomes.iter().flat_map(|o| o.numbers.clone()).collect();
        report::write(self, formulas, &outcomes)?;
        let json = serde_json::to_string_pretty(&numbers)
            .map_err(|e| Error::computation(e.to_string()))?;
        write_whole(&self.out.join("numbers.json"), (json + "\n").as_bytes())?;
        Ok(numbers)
    }

    /// One figure, from an earlier run where that has finished it.
    fn figure(&self, figure: &Figure, kept: &Path) -> Result<Outcome> {
        let path = kept.join(format!("{}.json", figure.id));
        let key = self.key(figure)?;
        if let Ok(text) = fs::read_to_string(&path)
            && let Ok((known, outcome)) = serde_json::from_str::<(String, Outcome)>(&text)
            && known == key
        {
            return Ok(outcome);
        }
        let mut outcome = Outcome::default();
        for task in &figure.task {
            outcome.add(task::run(self, &figure.id, task)?);
        }
        let text = serde_json::to_string(&(key, &outcome))
            .map_err(|e| Error::computation(e.to_string()))?;
        write_whole(&path, text.as_bytes())?;
        Ok(outcome)
    }

    /// What a kept figure must have been made from.
    fn key(&self, figure: &Figure) -> Result<String> {
        let spec = serde_json::to_string(figure).map_err(|e| Error::computation(e.to_string()))?;
        let mut hashes = Vec::new();
        for case in figure.task.iter().flat_map(task::cases) {
            hashes.push(self.with_setup(case, |setup| Ok(setup.hash()))?);
        }
        hashes.dedup();
        let version = env!("CARGO_PKG_VERSION");
        Ok(format!(
            "{spec} {} {} {version}",
            hashes.join(" "),
            self.study.resolution
        ))
    }

    /// Calls `action` with the model and parameters of a case.
    fn with_setup<R>(&self, case: &Case, action: impl FnOnce(&Setup) -> Result<R>) -> Result<R> {
        let name = case.model.as_ref().unwrap_or(&self.study.model);
        let beside = self.home.join(name);
        let name = match beside.to_str() {
            Some(path) if beside.is_file() => path,
            _ => name,
        };
        self.library.with_model(name, |model| {
            let resolution = case.resolution.unwrap_or(self.study.resolution);
            let mut setup = Setup::new(model, resolution);
            setup.set(&case.set)?;
            action(&setup)
        })
    }
}
