//! All tasks of a study, or one share of them, and the report.

use super::outcome::Outcome;
use super::page::{self, Formulas};
use super::study::{Figure, Task};
use super::task;
use super::workshop::Workshop;
use landau_solver::error::{Error, Result};
use landau_solver::file::write_whole;
use landau_solver::study::Progress;
use landau_solver::study::shard::Share;
use std::fs;
use std::path::Path;

/// A task and where it belongs.
#[derive(Clone, Copy)]
struct Unit<'a> {
    section: usize,
    figure: &'a Figure,
    index: usize,
    task: &'a Task,
}

impl Workshop<'_> {
    /// Works through the study and writes the report.
    ///
    /// # Errors
    /// A folder that cannot be written, a model that does not exist. What merely does not come out stays in the
    /// report where its number would stand, with the reason.
    pub fn run(&self, formulas: &Formulas, progress: &dyn Progress) -> Result<Outcome> {
        let tasks = self.tasks();
        let mut outcomes: Vec<Outcome> = Vec::new();
        outcomes.resize_with(self.study.figure.len(), Outcome::default);
        self.work(&tasks, progress, |task, outcome| {
            outcomes[task.section].add(outcome);
        })?;
        page::write(self, formulas, &outcomes)?;
        let mut whole = Outcome::default();
        outcomes.into_iter().for_each(|outcome| whole.add(outcome));
        self.write_json("numbers.json", &whole.numbers)?;
        self.write_json("claims.json", &whole.claims)?;
        Ok(whole)
    }

    /// Works through one share of the tasks, which are kept for a run of all.
    ///
    /// # Errors
    /// As [`Workshop::run`].
    pub fn run_share(&self, share: Share, progress: &dyn Progress) -> Result<usize> {
        let tasks = self.tasks();
        // One after another of the shares takes a task, for neighbours take alike long.
        let mine = tasks
            .iter()
            .enumerate()
            .filter(|(i, _)| i % share.count == share.index - 1);
        let mine: Vec<Unit> = mine.map(|(_, task)| *task).collect();
        self.work(&mine, progress, |_, _| ())?;
        Ok(mine.len())
    }

    /// Every task of the study, in order.
    fn tasks(&self) -> Vec<Unit<'_>> {
        let sections = self.study.figure.iter().enumerate();
        let tasks = sections.flat_map(|(section, figure)| {
            let own = figure.task.iter().enumerate();
            own.map(move |(index, task)| Unit {
                section,
                figure,
                index,
                task,
            })
        });
        tasks.collect()
    }

    fn work(
        &self,
        tasks: &[Unit],
        progress: &dyn Progress,
        mut take: impl FnMut(&Unit, Outcome),
    ) -> Result<()> {
        for folder in [&self.kept, &self.out.join("sources")] {
            fs::create_dir_all(folder)
                .map_err(|e| Error::input(format!("{} cannot be made: {e}", folder.display())))?;
        }
        progress.begin(tasks.len());
        for unit in tasks {
            let stem = format!("{}-{}", unit.figure.id, unit.index + 1);
            let path = self.kept.join(format!("{stem}.json"));
            take(unit, self.task(&unit.figure.id, &stem, unit.task, &path)?);
            progress.advance(1);
        }
        progress.end();
        Ok(())
    }

    fn write_json<T: serde::Serialize>(&self, name: &str, list: &[T]) -> Result<()> {
        let json = serde_json::to_string_pretty(list);
        let json = json.map_err(|e| Error::computation(e.to_string()))?;
        write_whole(&self.out.join(name), (json + "\n").as_bytes())
    }

    /// One task, from an earlier run where that has finished it.
    fn task(&self, figure: &str, stem: &str, task: &Task, path: &Path) -> Result<Outcome> {
        let key = self.key(stem, task)?;
        if let Ok(text) = fs::read_to_string(path)
            && let Ok((known, outcome)) = serde_json::from_str::<(String, Outcome)>(&text)
            && known == key
            && outcome.files().all(|file| self.out.join(file).is_file())
        {
            return Ok(outcome);
        }
        let outcome = task::run(self, figure, stem, task)?;
        let text = serde_json::to_string(&(key, &outcome))
            .map_err(|e| Error::computation(e.to_string()))?;
        write_whole(path, text.as_bytes())?;
        Ok(outcome)
    }

    /// What a kept task must have been made from.
    fn key(&self, stem: &str, task: &Task) -> Result<String> {
        let spec = serde_json::to_string(task).map_err(|e| Error::computation(e.to_string()))?;
        let mut hashes = Vec::new();
        for case in task.cases() {
            hashes.push(self.setup(case)?.hash());
        }
        hashes.dedup();
        let version = env!("CARGO_PKG_VERSION");
        let commit = self.provenance.commit.as_deref().unwrap_or_default();
        Ok(format!(
            "{stem} {spec} {} {} {version} {commit}",
            hashes.join(" "),
            self.study.resolution
        ))
    }
}
