//! Finished tasks, kept beside the report for the next run: sealed, and taken only for what they were made from.

use super::files::hash_of;
use super::outcome::Outcome;
use super::study::Task;
use super::workshop::Workshop;
use landau_solver::error::{Error, Result};
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

impl Workshop<'_> {
    /// The file of a kept task that is there and cannot be read, and why: it stays as it is.
    pub(super) fn unreadable(&self, stem: &str) -> Option<String> {
        let path = self.kept.path(&format!("{stem}.json")).ok()?;
        match fs::File::open(&path) {
            Err(error) if error.kind() != ErrorKind::NotFound => {
                Some(format!("{} cannot be read: {error}", path.display()))
            }
            _ => None,
        }
    }

    /// A finished task, where it is kept as it was left and was made from the same.
    pub(super) fn kept_task(&self, stem: &str, made_from: &str) -> Option<Outcome> {
        let path = self.kept.path(&format!("{stem}.json")).ok()?;
        let text = fs::read_to_string(path).ok()?;
        let kept: Kept = serde_json::from_str(unsealed(&text)?).ok()?;
        let unchanged = |(name, hash): &(String, String)| {
            let path = self.shelf.path(name).ok();
            let content = path.and_then(|path| fs::read(path).ok());
            content.is_some_and(|content| hash_of(&content) == *hash)
        };
        let named = kept
            .outcome
            .files()
            .eq(kept.files.iter().map(|(name, _)| name));
        let whole = kept.made_from == made_from && named && kept.files.iter().all(unchanged);
        whole.then_some(kept.outcome)
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
                .map_err(|e| Error::input(format!("{} cannot be read: {e}", path.display())))?;
            files.push((name.clone(), hash_of(&content)));
        }
        let kept = Kept {
            made_from: made_from.to_owned(),
            files,
            outcome: outcome.clone(),
        };
        let content =
            serde_json::to_string(&kept).map_err(|e| Error::computation(e.to_string()))?;
        let name = format!("{stem}.json");
        self.kept.write(&name, sealed(&content).as_bytes())
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

/// Whether a file is a kept task, whole or not.
///
/// # Errors
/// A file with the name of a kept task that cannot be opened.
pub(super) fn is_kept(path: &Path) -> io::Result<bool> {
    let is_json = path.extension().is_some_and(|e| e == "json");
    // Looked at before it is opened, for to open a pipe is to wait for its other end.
    if !is_json || !fs::symlink_metadata(path)?.is_file() {
        return Ok(false);
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
