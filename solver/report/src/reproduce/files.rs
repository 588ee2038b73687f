//! Files of a study and of its report: read up to a size, written only where they are the report's.

use super::study::Study;
use landau_solver::error::{Error, Result};
use landau_solver::file::{TEXT_LIMIT, hash, read_text, write_whole};
use std::fs;
use std::path::{Path, PathBuf};

/// The file by which a folder is known as one of a report.
const MARK: &str = ".landau-report";
/// How files begin that are on their way into a folder, the mark among them.
const ON_THE_WAY: &str = ".landau-";
const MARK_TEXT: &str =
    "landau reproduce writes its report here, and replaces files of an earlier one.\n";

/// A folder that belongs to a report: nothing of others is in it.
#[derive(Clone, Debug)]
pub struct Shelf {
    folder: PathBuf,
}

impl Shelf {
    /// A folder for a report: new, empty, or one that holds the mark of a report.
    ///
    /// # Errors
    /// A folder with anything else in it, a path that is no folder, one without a name of its own.
    pub fn new(folder: &Path) -> Result<Self> {
        let wrong = |what: &str| Err(Error::input(format!("{}: {what}", folder.display())));
        if folder.file_name().is_none() {
            return wrong("a report accepts a folder of its own, by its name");
        }
        if fs::symlink_metadata(folder).is_ok() && !folder.is_dir() {
            return wrong("this is no folder: a report accepts a new or empty one");
        }
        if let Ok(entries) = fs::read_dir(folder) {
            let mut paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
            let foreign = paths.any(|path| !is_on_the_way(&path));
            if foreign && !folder.join(MARK).is_file() {
                return wrong(
                    "this folder holds other files and no report: a report accepts a new or empty folder, or that of an \
                     earlier report",
                );
            }
        }
        Ok(Shelf {
            folder: folder.to_owned(),
        })
    }

    /// The folder beside a report in which its finished tasks are kept: new, empty, beside a report that is marked, or
    /// with kept tasks alone.
    ///
    /// # Errors
    /// A folder with anything else in it.
    pub fn beside(&self, is_kept: impl Fn(&Path) -> bool) -> Result<Self> {
        let mut name = self.folder.file_name().unwrap_or_default().to_owned();
        name.push(".kept");
        let folder = self.folder.with_file_name(name);
        let entries = fs::read_dir(&folder).into_iter().flatten();
        let mut paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
        let foreign = |path: PathBuf| !is_on_the_way(&path) && !is_kept(&path);
        let is_link = fs::symlink_metadata(&folder).is_ok() && !folder.is_dir();
        if is_link || (!self.folder.join(MARK).is_file() && paths.any(foreign)) {
            return Err(Error::input(format!(
                "{}: finished tasks are kept here, and it holds other files: a report accepts another --out, or this \
                 folder without them",
                folder.display()
            )));
        }
        Ok(Shelf { folder })
    }

    /// Makes the folder.
    ///
    /// # Errors
    /// Permissions, a full disk.
    pub fn make(&self) -> Result<()> {
        fs::create_dir_all(&self.folder)
            .map_err(|e| Error::input(format!("{} cannot be made: {e}", self.folder.display())))
    }

    /// Makes the folder, and marks it.
    ///
    /// # Errors
    /// Permissions, a full disk.
    pub fn open(&self) -> Result<()> {
        self.make()?;
        if self.folder.join(MARK).is_file() {
            return Ok(());
        }
        write_whole(&self.folder.join(MARK), MARK_TEXT.as_bytes())
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
                path.display()
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
                .map_err(|e| Error::input(format!("{} cannot be made: {e}", folder.display())))?;
        }
        write_whole(&path, bytes)
    }
}

/// Whether a file is on its way into a folder.
fn is_on_the_way(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default();
    name.to_string_lossy().starts_with(ON_THE_WAY)
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
        let shelf = Shelf::new(&report).expect("a new folder");
        shelf.open().expect("made");
        shelf.write("sources/a.toml", b"one").expect("written");
        assert!(report.join(MARK).is_file());
        Shelf::new(&report).expect("an earlier report");
        // A link in the place of a file, and a folder of others.
        let foreign = folder.path().join("mine.txt");
        fs::write(&foreign, "mine").expect("written");
        std::os::unix::fs::symlink(&foreign, report.join("index.html")).expect("a link");
        assert!(shelf.write("index.html", b"ours").is_err());
        assert_eq!(fs::read(&foreign).expect("read"), b"mine");
        assert!(shelf.write("../mine.txt", b"ours").is_err());
        assert!(Shelf::new(folder.path()).is_err());
        assert!(Shelf::new(&foreign).is_err());
        for path in [".", "/", ".."] {
            assert!(Shelf::new(Path::new(path)).is_err(), "{path}");
        }
    }
}
