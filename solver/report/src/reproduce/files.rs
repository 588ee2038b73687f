//! Files of a study and of its report: read up to a size, written only where they are the report's.

use super::ledger::{self, MARK};
use super::study::Study;
use landau_solver::error::{Error, Result};
use landau_solver::file::part::{is_part, remove_abandoned};
use landau_solver::file::{Overwrite, TEXT_LIMIT, hash, read_text, write_whole};
use landau_solver::words::shown_path;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// A folder that belongs to a report: nothing of others is in it.
#[derive(Clone, Debug)]
pub struct Shelf {
    folder: PathBuf,
    /// Whether it is the report itself, which lists its files.
    has_ledger: bool,
}

impl Shelf {
    /// A folder for a report: new, empty, or one that holds the mark of a report.
    ///
    /// # Errors
    /// A folder with anything else in it, a path that is no folder, one without a name of its own; in the folder of a
    /// report a file that would be replaced and is not the report's, unless `overwrite` allows it.
    pub fn new(folder: &Path, overwrite: Overwrite) -> Result<Self> {
        let wrong = |what: &str| Err(Error::input(format!("{}: {what}", shown_path(folder))));
        if folder.file_name().is_none() {
            return wrong("a report accepts a folder of its own, by its name");
        }
        if fs::symlink_metadata(folder).is_ok() && !folder.is_dir() {
            return wrong("this is no folder: a report accepts a new or empty one");
        }
        if let Ok(entries) = fs::read_dir(folder) {
            let mut paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
            let foreign = paths.any(|path| !is_part(&path) && !path.ends_with(MARK));
            if foreign && !folder.join(MARK).is_file() {
                return wrong(
                    "this folder holds other files and no report: a report accepts a new or empty folder, or that of an \
                     earlier report",
                );
            }
        }
        ledger::check(folder, overwrite)?;
        Ok(Shelf {
            folder: folder.to_owned(),
            has_ledger: true,
        })
    }

    /// The folder beside a report in which its finished tasks are kept: new, empty, beside a report that is marked, or
    /// with kept tasks alone. `is_kept` fails where a file cannot be read; such a file may be a kept task, and stays.
    ///
    /// # Errors
    /// A folder with anything else in it.
    pub fn beside(&self, is_kept: impl Fn(&Path) -> io::Result<bool>) -> Result<Self> {
        let mut name = self.folder.file_name().unwrap_or_default().to_owned();
        name.push(".kept");
        let folder = self.folder.with_file_name(name);
        let wrong = |what: &str| {
            Err(Error::input(format!(
                "{}: finished tasks are kept here, and {what}: a report accepts another --out, or this folder without it",
                shown_path(&folder)
            )))
        };
        if fs::symlink_metadata(&folder).is_ok() && !folder.is_dir() {
            return wrong("this is no folder");
        }
        if !self.folder.join(MARK).is_file() {
            let entries = fs::read_dir(&folder).into_iter().flatten();
            let mut paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
            let is_foreign = |path: &PathBuf| !is_part(path) && !is_kept(path).unwrap_or(true);
            if let Some(path) = paths.find(is_foreign) {
                return wrong(&format!("{} is none", shown_path(&path)));
            }
        }
        Ok(Shelf {
            folder,
            has_ledger: false,
        })
    }

    /// Makes the folder.
    ///
    /// # Errors
    /// Permissions, a full disk.
    pub fn make(&self) -> Result<()> {
        fs::create_dir_all(&self.folder).map_err(|e| {
            Error::input(format!("{} cannot be made: {e}", shown_path(&self.folder)))
        })?;
        if self.has_ledger {
            ledger::clean(&self.folder);
        } else {
            remove_abandoned(&self.folder);
        }
        Ok(())
    }

    /// Makes the folder, and marks it.
    ///
    /// # Errors
    /// Permissions, a full disk.
    pub fn open(&self) -> Result<()> {
        self.make()?;
        ledger::mark(&self.folder)
    }

    /// Everything is written: each file of the report is listed once.
    ///
    /// # Errors
    /// Permissions, a full disk.
    pub fn close(&self) -> Result<()> {
        ledger::settle(&self.folder)
    }

    /// The folder itself.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Where a file of the report stands: by a plain name, or by one in a folder of the report's.
    ///
    /// # Errors
    /// A name that leads out of the folder, a link.
    pub fn path(&self, name: &str) -> Result<PathBuf> {
        if !name.split('/').all(is_plain) {
            return Err(Error::input(format!(
                "{name:?} is no name of a report's file"
            )));
        }
        let path = self.folder.join(name);
        // A link leads to a file of somebody else.
        if fs::symlink_metadata(&path).is_ok_and(|info| !info.is_file()) {
            return Err(Error::input(format!(
                "{}: this is no plain file: a report replaces nothing else",
                shown_path(&path)
            )));
        }
        Ok(path)
    }

    /// Writes a file whole or not at all.
    ///
    /// # Errors
    /// As [`Shelf::path`]; permissions, a full disk.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<()> {
        let path = self.path(name)?;
        if let Some(folder) = path.parent().filter(|folder| !folder.is_dir()) {
            fs::create_dir_all(folder)
                .map_err(|e| Error::input(format!("{} cannot be made: {e}", shown_path(folder))))?;
        }
        if self.has_ledger {
            ledger::add(&self.folder, name, bytes)?;
        }
        write_whole(&path, bytes)
    }
}

/// Whether a name is one of a file: no way to another folder, nothing that cannot be seen.
pub(super) fn is_plain(name: &str) -> bool {
    let letters = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_' | '.' | ' ' | '(' | ')');
    !name.is_empty() && name.len() <= 200 && !name.starts_with('.') && name.chars().all(letters)
}

/// A short number of a file's content.
pub(super) fn hash_of(bytes: &[u8]) -> String {
    format!("{:016x}", hash(bytes.iter().copied()))
}

impl Study {
    /// A file that the study names, relative to the study.
    ///
    /// # Errors
    /// As [`read_text`].
    pub(super) fn read_beside(&self, name: &str) -> Result<String> {
        read_text(&self.home().join(name), TEXT_LIMIT)
    }

    /// The folder of the study file: what it names stands relative to it.
    pub fn home(&self) -> &Path {
        let parent = self.read_from.path.parent();
        parent
            .filter(|path| !path.as_os_str().is_empty())
            .unwrap_or(Path::new("."))
    }
}

#[cfg(test)]
mod tests {
    use super::{MARK, Shelf, is_plain};
    use landau_solver::file::Overwrite::Recognised;
    use std::fs;
    use std::path::Path;

    #[test]
    fn names_stay_in_their_folder() {
        for name in ["figure6-1.svg", "errata/shukla2014.toml", "κ (2).csv"] {
            assert!(name.split('/').all(is_plain), "{name}");
        }
        for name in [
            "",
            "..",
            "../x",
            "/etc/passwd",
            "a//b",
            "a\0",
            "a\nb",
            ".x",
            "a\\b",
        ] {
            assert!(!name.split('/').all(is_plain), "{name:?}");
        }
    }

    #[test]
    fn folders_of_others_are_left_alone() {
        let folder = tempfile::tempdir().expect("a folder");
        let report = folder.path().join("report");
        let shelf = Shelf::new(&report, Recognised).expect("a new folder");
        shelf.open().expect("made");
        shelf.write("sources/a.toml", b"one").expect("written");
        assert!(report.join(MARK).is_file());
        Shelf::new(&report, Recognised).expect("an earlier report");
        // A link in the place of a file, and a folder of others.
        let foreign = folder.path().join("mine.txt");
        fs::write(&foreign, "mine").expect("written");
        std::os::unix::fs::symlink(&foreign, report.join("index.html")).expect("a link");
        assert!(shelf.write("index.html", b"ours").is_err());
        assert_eq!(fs::read(&foreign).expect("read"), b"mine");
        assert!(shelf.write("../mine.txt", b"ours").is_err());
        assert!(Shelf::new(folder.path(), Recognised).is_err());
        assert!(Shelf::new(&foreign, Recognised).is_err());
        for path in [".", "/", ".."] {
            assert!(Shelf::new(Path::new(path), Recognised).is_err(), "{path}");
        }
    }
}
