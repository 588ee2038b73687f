//! All tasks of a study, or one share of them, and the report.

use super::keep::Earlier;
use super::outcome::Outcome;
use super::page::{self, Formulas};
use super::study::{Figure, Task};
use super::task::{self, Place};
use super::workshop::Workshop;
use landau_solver::error::{Error, Result};
use landau_solver::study::Progress;
use landau_solver::study::shard::Share;
use std::time::Instant;

/// A task and where it belongs.
#[derive(Clone, Copy)]
pub(super) struct Unit<'a> {
    section: usize,
    figure: &'a Figure,
    index: usize,
    task: &'a Task,
}

impl Unit<'_> {
    /// How the names of its files end.
    pub(super) fn stem(&self) -> String {
        format!("{}-{}", self.figure.id, self.index + 1)
    }
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
        self.shelf.close()?;
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
    pub(super) fn tasks(&self) -> Vec<Unit<'_>> {
        let sections = self.study.figure.iter().enumerate();
        let tasks = sections.flat_map(|(section, figure)| {
            let tasks = figure.task.iter().enumerate();
            tasks.map(move |(index, task)| Unit {
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
        self.shelf.open()?;
        self.kept.make()?;
        progress.begin(tasks.len());
        for unit in tasks {
            let started = Instant::now();
            take(unit, self.task(unit, progress)?);
            progress.done(&format!(
                "figure {}, task {} ({}): {:.1} s",
                unit.figure.id,
                unit.index + 1,
                unit.task.kind().name(),
                started.elapsed().as_secs_f64()
            ));
            progress.advance(1);
        }
        progress.end();
        Ok(())
    }

    fn write_json<T: serde::Serialize>(&self, name: &str, list: &[T]) -> Result<()> {
        let json = serde_json::to_string_pretty(list);
        let json = json.map_err(|e| Error::computation(e.to_string()))?;
        self.shelf.write(name, (json + "\n").as_bytes())
    }

    /// One task, from an earlier run where that has finished it.
    fn task(&self, unit: &Unit, progress: &dyn Progress) -> Result<Outcome> {
        let figure = &unit.figure.id;
        let stem = unit.stem();
        let made_from = self.made_from(&stem, unit.task)?;
        let earlier = self.earlier(&stem, &made_from);
        if let Earlier::Fits(outcome) = earlier {
            return Ok(*outcome);
        }
        let place = Place {
            figure,
            stem: &stem,
        };
        let outcome = task::run(self, &place, unit.task)?;
        match earlier {
            Earlier::Unreadable(reason) => {
                progress.done(&format!(
                    "note: {reason}; its task is computed again, and the file stays as it is"
                ));
                return Ok(outcome);
            }
            Earlier::Damaged(reason) => progress.done(&format!(
                "note: {reason}; its task is computed again, and the file is replaced"
            )),
            Earlier::Fits(_) | Earlier::Outdated => {}
        }
        self.keep(&stem, &made_from, &outcome)?;
        Ok(outcome)
    }
}
