//! Files on their way: each is written beside its target and then renamed. The writer locks the file while it lives, so that
//! a later run tells one that a killed writer left, and removes it.

use std::fs::{self, File};
use std::io;
use std::path::Path;
use tempfile::{Builder, NamedTempFile};

/// How the name of every file on its way begins.
const PREFIX: &str = ".landau-";
/// Letters and digits after that.
const RANDOM: usize = 6;
/// The file by which a folder is known as one of a report. Its name has the form of a file on its way.
pub const REPORT_MARK: &str = ".landau-report";

/// Whether a file has the name of one on its way.
pub fn is_part(path: &Path) -> bool {
    let name = path.file_name().and_then(|name| name.to_str());
    let random = name.and_then(|name| name.strip_prefix(PREFIX));
    let is_random =
        |text: &str| text.len() == RANDOM && text.chars().all(|c| c.is_ascii_alphanumeric());
    random.is_some_and(is_random) && name != Some(REPORT_MARK)
}

/// A new file on its way in a folder, locked. `prepare` sets what a builder can.
pub(super) fn begin(
    folder: &Path,
    prepare: impl Fn(&mut Builder<'_, 'static>),
) -> io::Result<NamedTempFile> {
    loop {
        let mut builder = Builder::new();
        builder.prefix(PREFIX).rand_bytes(RANDOM);
        prepare(&mut builder);
        let part = builder.tempfile_in(folder)?;
        // Waits for a run that takes the file for an abandoned one. Some file systems have no locks; nothing is removed there.
        let locked = part.as_file().lock();
        if locked.is_err() || is_at(part.as_file(), part.path()) {
            return Ok(part);
        }
    }
}

/// Removes the files that killed writers left in a folder: plain files of such a name that no process has locked.
pub fn remove_abandoned(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
        if !is_file || !is_part(&path) {
            continue;
        }
        let Ok(file) = File::open(&path) else {
            continue;
        };
        // The lock is held until the file is gone: a writer that waits for it then sees that.
        if file.try_lock().is_ok() && is_at(&file, &path) {
            let _ = fs::remove_file(&path);
        }
    }
}

/// Whether an open file stands under a name, not through a link.
#[cfg(unix)]
pub(crate) fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let place = |info: fs::Metadata| (info.dev(), info.ino());
    match (file.metadata(), fs::symlink_metadata(path)) {
        (Ok(open), Ok(named)) => place(open) == place(named),
        _ => false,
    }
}

#[cfg(not(unix))]
pub(crate) fn is_at(_: &File, path: &Path) -> bool {
    path.is_file()
}

#[cfg(test)]
mod tests {
    use super::{begin, is_part, remove_abandoned};
    use std::fs;
    use std::os::unix::fs::symlink;
    use std::path::Path;

    /// An abandoned file goes. One that is being written, a folder, a link and files of any other name stay.
    #[test]
    fn abandoned_files_are_removed() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = folder.path();
        let writing = begin(at, |_| ()).expect("begun");
        assert!(is_part(writing.path()));
        fs::write(at.join("mine"), "mine").expect("written");
        let stay = [
            ".landau-report",
            ".landau-notes",
            ".landau-a b-cd",
            "landau-Eq9NGl",
            "mine",
        ];
        for name in stay {
            fs::write(at.join(name), "mine").expect("written");
            assert!(!is_part(Path::new(name)), "{name}");
        }
        fs::create_dir(at.join(".landau-folder")).expect("made");
        symlink(at.join("mine"), at.join(".landau-linked")).expect("a link");
        fs::write(at.join(".landau-Eq9NGl"), "half").expect("written");
        remove_abandoned(at);
        assert!(!at.join(".landau-Eq9NGl").exists());
        assert!(writing.path().exists());
        for name in stay.into_iter().chain([".landau-folder", ".landau-linked"]) {
            assert!(at.join(name).exists(), "{name}");
        }
    }

    /// Writers and cleaners at once: no file is lost between its beginning and its rename.
    #[test]
    fn writers_and_cleaners_at_once() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = folder.path();
        std::thread::scope(|scope| {
            let writers: Vec<_> = (0..2)
                .map(|writer| {
                    scope.spawn(move || {
                        for _ in 0..300 {
                            let path = at.join(format!("file-{writer}"));
                            super::super::write_whole(&path, b"whole").expect("written");
                        }
                    })
                })
                .collect();
            while writers.iter().any(|writer| !writer.is_finished()) {
                remove_abandoned(at);
            }
        });
        assert_eq!(fs::read_dir(at).expect("listed").count(), 2);
    }
}
