//! The journal of a sweep: finished chunks beside the output, one a line, from which an interrupted run goes on.
//!
//! The first line says what the journal was made for. Every other line carries its chunk, its rows and a checksum over
//! both; a line that does not fit is passed over, and its chunk computed again. Nothing that was written is written
//! again: of a journal that is opened, at most a torn last line is cut off. The file is locked while a run lives.

use super::identity::SweepIdentity;
use super::row::Row;
use crate::error::{Error, Result};
use crate::file::part::is_at;
use crate::file::{Overwrite, has_plain_file, hash, refused};
use crate::words::shown_path;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, BufRead, BufReader, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// The first line.
#[derive(Serialize, Deserialize)]
struct Header {
    /// Version of this format.
    landau_journal: u32,
    sweep: SweepIdentity,
}

const VERSION: u32 = 2;

/// Any other line.
#[derive(Serialize, Deserialize)]
struct Finished {
    chunk: usize,
    rows: Vec<Row>,
    sum: String,
}

/// Finished chunks beside an output.
pub(super) struct Journal {
    path: PathBuf,
    file: Mutex<File>,
    header: String,
    /// Rows of finished chunks, by chunk.
    pub finished: BTreeMap<usize, Vec<Row>>,
    /// Number of lines that did not fit.
    pub damaged: usize,
}

/// Where the journal of an output stands.
pub fn journal_path(out: &Path) -> PathBuf {
    let mut name = out.file_name().unwrap_or_default().to_os_string();
    name.push(".journal");
    out.with_file_name(name)
}

impl Journal {
    /// Opens the journal beside `out` for a sweep, or begins it; `fits` says whether rows belong to a chunk.
    ///
    /// # Errors
    /// A file that cannot be written; another run that has it open; a file that is no journal, or that of another sweep,
    /// unless `overwrite` allows anything; a link.
    pub fn open(
        out: &Path,
        sweep: &SweepIdentity,
        overwrite: Overwrite,
        fits: impl Fn(usize, &[Row]) -> bool,
    ) -> Result<Self> {
        let path = journal_path(out);
        let failure =
            |e: io::Error| Error::input(format!("{} cannot be written: {e}", shown_path(&path)));
        let mut file = locked(&path, out)?;
        let header = serde_json::to_string(&Header {
            landau_journal: VERSION,
            sweep: sweep.clone(),
        });
        let header = header.map_err(|e| Error::computation(e.to_string()))?;
        let mut lines = BufReader::new(&file);
        let first = next_line(&mut lines).map_err(failure)?;
        let mut contents = Contents::default();
        match judged(&first, &header, sweep) {
            First::Fits => contents = Contents::read(lines, &header, fits).map_err(failure)?,
            First::Torn => {}
            First::Foreign(reason) => {
                if overwrite == Overwrite::Recognised {
                    return Err(refused(&path, &reason));
                }
            }
        }
        if contents.length == 0 {
            // Nothing in it is of use.
            file.set_len(0).map_err(failure)?;
            file.seek(SeekFrom::Start(0)).map_err(failure)?;
            let line = format!("{header}\n");
            file.write_all(line.as_bytes()).map_err(failure)?;
        } else {
            // A line that an interruption cut off must not run into the next.
            let length = file.metadata().map_err(failure)?.len();
            if length > contents.length {
                file.set_len(contents.length).map_err(failure)?;
            }
            file.seek(SeekFrom::End(0)).map_err(failure)?;
            if !contents.ends_with_newline {
                file.write_all(b"\n").map_err(failure)?;
            }
        }
        Ok(Journal {
            path,
            file: Mutex::new(file),
            header,
            finished: contents.finished,
            damaged: contents.damaged,
        })
    }

    /// Adds a finished chunk.
    pub fn record(&self, chunk: usize, rows: &[Row]) {
        let finished = Finished {
            chunk,
            rows: rows.to_vec(),
            sum: checksum(&self.header, chunk, rows),
        };
        let (Ok(line), Ok(mut file)) = (serde_json::to_string(&finished), self.file.lock()) else {
            return;
        };
        // A journal that cannot be written costs the resumption, not the result; half a line must not spoil the next.
        if let Ok(end) = file.stream_position()
            && file.write_all(format!("{line}\n").as_bytes()).is_err()
        {
            let _ = file
                .set_len(end)
                .and_then(|()| file.seek(SeekFrom::Start(end)));
        }
    }

    /// Removes the file, once the output is complete.
    pub fn remove(self) {
        let _ = fs::remove_file(&self.path);
    }
}

/// Opens a journal and locks it. A run that ends removes its journal, so that the file locked may stand under the name no
/// longer; then the name is opened again.
fn locked(path: &Path, out: &Path) -> Result<File> {
    let failure =
        |e: io::Error| Error::input(format!("{} cannot be written: {e}", shown_path(path)));
    loop {
        has_plain_file(path)?;
        let mut options = OpenOptions::new();
        options.read(true).write(true).create(true).truncate(false);
        let file = options.open(path).map_err(failure)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                return Err(Error::input(format!(
                    "{} is being written by another run; wait for it, or choose another --out",
                    shown_path(out)
                )));
            }
            Err(TryLockError::Error(error)) => return Err(failure(error)),
        }
        if is_at(&file, path) {
            return Ok(file);
        }
    }
}

/// What the first line of a journal says.
enum First {
    /// The journal was made for this sweep.
    Fits,
    /// It is empty, or the beginning of the line that this sweep writes.
    Torn,
    /// It belongs to something else, for this reason.
    Foreign(String),
}

fn judged(first: &[u8], header: &str, sweep: &SweepIdentity) -> First {
    if first.strip_suffix(b"\n") == Some(header.as_bytes()) {
        return First::Fits;
    }
    if header.as_bytes().starts_with(first) {
        return First::Torn;
    }
    let Ok(found) = serde_json::from_slice::<Header>(first) else {
        return First::Foreign("it is no journal of this version of Landau".to_owned());
    };
    let difference = sweep.difference(&found.sweep).unwrap_or_default();
    First::Foreign(format!(
        "it holds finished rows of another sweep ({difference}); the command that began that sweep goes on with it"
    ))
}

/// The next line with its end; empty at the end of the file.
fn next_line(lines: &mut impl BufRead) -> io::Result<Vec<u8>> {
    let mut line = Vec::new();
    lines.read_until(b'\n', &mut line)?;
    Ok(line)
}

/// What stands in a journal after its first line.
#[derive(Default)]
struct Contents {
    finished: BTreeMap<usize, Vec<Row>>,
    damaged: usize,
    /// Bytes up to the end of the last line that is whole, the first line included.
    length: u64,
    ends_with_newline: bool,
}

impl Contents {
    fn read(
        mut lines: impl BufRead,
        header: &str,
        fits: impl Fn(usize, &[Row]) -> bool,
    ) -> io::Result<Self> {
        let mut contents = Contents {
            length: header.len() as u64 + 1,
            ends_with_newline: true,
            ..Contents::default()
        };
        loop {
            let line = next_line(&mut lines)?;
            if line.is_empty() {
                return Ok(contents);
            }
            let is_whole = line.ends_with(b"\n");
            let entry = serde_json::from_slice::<Finished>(&line)
                .ok()
                .filter(|entry| {
                    entry.sum == checksum(header, entry.chunk, &entry.rows)
                        && fits(entry.chunk, &entry.rows)
                });
            if entry.is_some() || is_whole {
                contents.length += line.len() as u64;
                contents.ends_with_newline = is_whole;
            }
            match entry {
                Some(entry) => {
                    contents.finished.insert(entry.chunk, entry.rows);
                }
                None if line.trim_ascii().is_empty() => {}
                None => contents.damaged += 1,
            }
        }
    }
}

fn checksum(header: &str, chunk: usize, rows: &[Row]) -> String {
    let rows = serde_json::to_string(rows).unwrap_or_default();
    let text = format!("{header} {chunk} {rows}");
    format!("{:016x}", hash(text.into_bytes()))
}

#[cfg(test)]
mod tests {
    use super::{Journal, journal_path};
    use crate::file::Overwrite;
    use crate::study::identity::SweepIdentity;
    use crate::study::row::Row;
    use std::fs;
    use std::path::Path;

    fn identity(resolution: usize) -> SweepIdentity {
        SweepIdentity {
            resolution,
            ..SweepIdentity::example()
        }
    }

    fn open(out: &Path) -> crate::error::Result<Journal> {
        Journal::open(out, &identity(50), Overwrite::Recognised, |_, _| true)
    }

    fn row(x: f64) -> Vec<Row> {
        vec![Row {
            coordinates: vec![x],
            ..Row::default()
        }]
    }

    /// Whatever byte a run was stopped at, the lines that were whole stay in the file while it is opened, and what is
    /// added later is read.
    #[test]
    fn a_journal_that_is_cut_anywhere() {
        let folder = tempfile::tempdir().expect("a folder");
        let out = folder.path().join("a.csv");
        let journal = open(&out).expect("begun");
        for chunk in 0..3 {
            journal.record(chunk, &row(chunk as f64));
        }
        drop(journal);
        let path = journal_path(&out);
        let whole = fs::read(&path).expect("a journal");
        let ends: Vec<usize> = (0..whole.len()).filter(|&i| whole[i] == b'\n').collect();
        for length in 0..=whole.len() {
            fs::write(&path, &whole[..length]).expect("written");
            let journal = open(&out).expect("opened");
            let lines = ends[1..].iter().filter(|&&end| end <= length).count();
            assert_eq!(journal.finished.len(), lines, "at byte {length}");
            journal.record(7, &row(7.0));
            drop(journal);
            let again = open(&out).expect("opened");
            assert_eq!(again.finished.len(), lines + 1, "at byte {length}");
            assert_eq!(again.finished.get(&7), Some(&row(7.0)));
            assert_eq!(again.damaged, 0);
        }
    }

    /// Bytes that are no text, an empty line, a line of something else: passed over, the lines around them kept.
    #[test]
    fn damaged_lines_are_passed_over() {
        let folder = tempfile::tempdir().expect("a folder");
        let out = folder.path().join("a.csv");
        let journal = open(&out).expect("begun");
        journal.record(0, &row(0.0));
        journal.record(1, &row(1.0));
        drop(journal);
        let path = journal_path(&out);
        let whole = fs::read(&path).expect("a journal");
        let lines: Vec<&[u8]> = whole.split_inclusive(|&b| b == b'\n').collect();
        let parts = [
            lines[0],
            b"\xff\xfe\x00\n",
            lines[1],
            b"\n",
            b"{}\n",
            lines[2],
        ];
        fs::write(&path, parts.concat()).expect("written");
        let journal = open(&out).expect("opened");
        assert_eq!((journal.finished.len(), journal.damaged), (2, 2));
        assert_eq!(fs::read(&path).expect("a journal"), parts.concat());
    }

    #[test]
    fn files_that_are_no_journal_of_this_sweep() {
        let folder = tempfile::tempdir().expect("a folder");
        let out = folder.path().join("a.csv");
        let path = journal_path(&out);
        let refused = |text: &[u8]| {
            fs::write(&path, text).expect("written");
            let error = open(&out).err().expect("refused").to_string();
            assert_eq!(fs::read(&path).expect("there"), text);
            error
        };
        refused(b"a diary\n");
        refused(b"a diary");
        refused(b"\xff\xfe");
        fs::remove_file(&path).expect("removed");
        let (recognised, anything) = (Overwrite::Recognised, Overwrite::Anything);
        let begun = Journal::open(&out, &identity(60), recognised, |_, _| true);
        begun.expect("begun").record(0, &row(0.0));
        let said = refused(&fs::read(&path).expect("there"));
        assert!(said.contains("M is 50 here and 60 there"), "{said}");
        let forced = Journal::open(&out, &identity(50), anything, |_, _| true);
        assert_eq!(forced.expect("opened").finished.len(), 0);
        // A link is never written through.
        let diary = folder.path().join("diary");
        fs::write(&diary, "mine").expect("written");
        fs::remove_file(&path).expect("removed");
        std::os::unix::fs::symlink(&diary, &path).expect("a link");
        for overwrite in [recognised, anything] {
            assert!(Journal::open(&out, &identity(50), overwrite, |_, _| true).is_err());
        }
        assert_eq!(fs::read(&diary).expect("there"), b"mine");
    }
}
