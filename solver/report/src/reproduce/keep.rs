//! Finished tasks, kept beside the report for the next run: sealed, and taken only for what they were made from.

use super::files::hash_of;
use super::outcome::Outcome;
use super::study::Task;
use super::workshop::Workshop;
use landau_solver::error::{Error, Result};
use landau_solver::file::{Overwrite, refused};
use landau_solver::words::shown_path;
use serde::{Deserialize, Serialize};
use std::fs;
use std::io::{self, ErrorKind, Read};
use std::path::Path;

/// What stands around the content of a kept task.
const SEAL: &str = "{\"seal\":\"";
const KEPT: &str = "\",\n\"kept\":";
const END: &str = "}\n";

/// A finished task.
#[derive(Serialize, Deserialize)]
struct Kept {
    /// Everything that the task was made from.
    made_from: String,
    /// Its files in the report, by name and the hash of their content.
    files: Vec<(String, String)>,
    outcome: Outcome,
}

/// What an earlier run has left of a task.
pub(super) enum Earlier {
    /// The task is finished, and nothing that it was made from has changed.
    Fits(Box<Outcome>),
    /// There is nothing, or it was made from something else.
    Outdated,
    /// The file was changed or cut: in words.
    Damaged(String),
    /// The file cannot be read, and stays as it is: in words.
    Unreadable(String),
}

/// The file of a kept task.
fn file_of(stem: &str) -> String {
    format!("{stem}.json")
}

impl Workshop<'_> {
    /// Refuses a folder in which a file of somebody else has the name of a task to be kept.
    ///
    /// # Errors
    /// Such a file, unless `overwrite` allows it to be replaced; a link or a folder in its place.
    pub(super) fn check_kept(&self, overwrite: Overwrite) -> Result<()> {
        for unit in self.tasks() {
            let path = self.kept.path(&file_of(&unit.stem()))?;
            let is_foreign = path.exists() && !is_kept(&path).unwrap_or(true);
            if is_foreign && overwrite == Overwrite::Recognised {
                return Err(refused(&path, "it is no finished task of a report"));
            }
        }
        Ok(())
    }

    /// What stands in the place of a kept task.
    pub(super) fn earlier(&self, stem: &str, made_from: &str) -> Earlier {
        let Ok(path) = self.kept.path(&file_of(stem)) else {
            return Earlier::Outdated;
        };
        let text = match fs::read(&path) {
            Err(error) if error.kind() == ErrorKind::NotFound => return Earlier::Outdated,
            Err(error) => {
                return Earlier::Unreadable(format!(
                    "{} cannot be read: {error}",
                    shown_path(&path)
                ));
            }
            Ok(bytes) => String::from_utf8(bytes).unwrap_or_default(),
        };
        let Some(content) = unsealed(&text) else {
            return Earlier::Damaged(format!("{} is damaged", shown_path(&path)));
        };
        match serde_json::from_str::<Kept>(content) {
            Ok(kept) if self.fits(&kept, made_from) => Earlier::Fits(Box::new(kept.outcome)),
            _ => Earlier::Outdated,
        }
    }

    /// Whether a task was made from the same, and its files in the report are as it left them.
    fn fits(&self, kept: &Kept, made_from: &str) -> bool {
        let unchanged = |(name, hash): &(String, String)| {
            let path = self.shelf.path(name).ok();
            let content = path.and_then(|path| fs::read(path).ok());
            content.is_some_and(|content| hash_of(&content) == *hash)
        };
        let named = kept
            .outcome
            .files()
            .eq(kept.files.iter().map(|(name, _)| name));
        kept.made_from == made_from && named && kept.files.iter().all(unchanged)
    }

    /// Keeps a finished task.
    ///
    /// # Errors
    /// A folder that cannot be written to.
    pub(super) fn keep(&self, stem: &str, made_from: &str, outcome: &Outcome) -> Result<()> {
        let mut files = Vec::new();
        for name in outcome.files() {
            let path = self.shelf.path(name)?;
            let content = fs::read(&path)
                .map_err(|e| Error::input(format!("{} cannot be read: {e}", shown_path(&path))))?;
            files.push((name.clone(), hash_of(&content)));
        }
        let kept = Kept {
            made_from: made_from.to_owned(),
            files,
            outcome: outcome.clone(),
        };
        let content =
            serde_json::to_string(&kept).map_err(|e| Error::computation(e.to_string()))?;
        self.kept.write(&file_of(stem), sealed(&content).as_bytes())
    }

    /// Everything that a task is made from: its own text, the models and references, how names are written, the program.
    pub(super) fn made_from(&self, stem: &str, task: &Task) -> Result<String> {
        let text = |value: serde_json::Result<String>| {
            value.map_err(|e| Error::computation(e.to_string()))
        };
        let mut parts = vec![stem.to_owned(), text(serde_json::to_string(task))?];
        for case in task.kind().cases() {
            let setup = self.setup(case)?;
            parts.push(format!("{} {}", setup.resolution(), setup.hash()));
        }
        for reference in task.kind().references() {
            let text = self.study.read_beside(&reference.file)?;
            parts.push(hash_of(text.as_bytes()));
        }
        parts.push(text(serde_json::to_string(&self.study.symbol))?);
        parts.push(landau_solver::BUILD.to_owned());
        parts.extend(self.provenance.commit.clone());
        Ok(parts.join(" "))
    }
}

/// Whether a file is a kept task, whole or not. An empty file is one that a full disk or a power cut has left.
///
/// # Errors
/// A file with the name of a kept task that cannot be opened.
pub(super) fn is_kept(path: &Path) -> io::Result<bool> {
    let is_json = path.extension().is_some_and(|e| e == "json");
    // Looked at before it is opened, for to open a pipe is to wait for its other end.
    let info = fs::symlink_metadata(path)?;
    if !is_json || !info.is_file() {
        return Ok(false);
    }
    if info.len() == 0 {
        return Ok(true);
    }
    let mut start = [0; SEAL.len()];
    let read = fs::File::open(path)?.read_exact(&mut start);
    Ok(read.is_ok() && start == *SEAL.as_bytes())
}

/// Content with its seal.
fn sealed(content: &str) -> String {
    let seal = hash_of(content.as_bytes());
    format!("{SEAL}{seal}{KEPT}{content}{END}")
}

/// The content, where its seal is whole.
fn unsealed(text: &str) -> Option<&str> {
    let (seal, content) = text.strip_prefix(SEAL)?.split_once(KEPT)?;
    let content = content.strip_suffix(END)?;
    (hash_of(content.as_bytes()) == seal).then_some(content)
}

#[cfg(test)]
mod tests {
    use super::{sealed, unsealed};

    #[test]
    fn a_changed_digit_breaks_the_seal() {
        let content = r#"{"ours":0.1745}"#;
        let text = sealed(content);
        assert_eq!(unsealed(&text), Some(content));
        serde_json::from_str::<serde_json::Value>(&text).expect("JSON");
        assert_eq!(unsealed(&text.replace("0.1745", "0.1746")), None);
        assert_eq!(unsealed(&text[..text.len() - 3]), None);
        assert_eq!(unsealed(content), None);
    }
}
