//! The journal of a sweep: finished chunks beside the output, one a line, from which an interrupted run
//! goes on.
//!
//! A line carries its place and a checksum over it, the rows and what the journal was made for. What does not
//! fit is computed again. The file is locked while a run lives.

use super::row::Row;
use crate::error::{Error, Result};
use crate::file::hash;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{BufRead, BufReader, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

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
    fingerprint: String,
    pub known: BTreeMap<usize, Vec<Row>>,
    /// Lines that did not fit.
    pub damaged: usize,
}

/// Where the journal of an output stands.
pub fn journal_path(out: &Path) -> PathBuf {
    let mut name = out.file_name().unwrap_or_default().to_os_string();
    name.push(".journal");
    out.with_file_name(name)
}

impl Journal {
    /// The journal beside `out`, made for `fingerprint`; `fits` says whether rows belong to a chunk.
    ///
    /// # Errors
    /// A file that cannot be written; another run that has it open.
    pub fn open(
        out: &Path,
        fingerprint: String,
        fits: impl Fn(usize, &[Row]) -> bool,
    ) -> Result<Self> {
        let path = journal_path(out);
        let failure =
            |e: std::io::Error| Error::input(format!("{} cannot be written: {e}", path.display()));
        let mut options = OpenOptions::new();
        options.read(true).write(true).create(true).truncate(false);
        let mut file = options.open(&path).map_err(failure)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                return Err(Error::input(format!(
                    "{} is being written by another run; wait for it, or choose another --out",
                    out.display()
                )));
            }
            Err(TryLockError::Error(error)) => return Err(failure(error)),
        }
        let header = serde_json::to_string(&fingerprint).unwrap_or_default();
        let mut lines = BufReader::new(&file)
            .lines()
            .map_while(std::result::Result::ok);
        let mut known = BTreeMap::new();
        let mut damaged = 0;
        if lines.next().as_deref() == Some(&header) {
            for line in lines.filter(|line| !line.is_empty()) {
                match serde_json::from_str::<Finished>(&line) {
                    Ok(entry)
                        if entry.sum == checksum(&fingerprint, entry.chunk, &entry.rows)
                            && fits(entry.chunk, &entry.rows) =>
                    {
                        known.insert(entry.chunk, entry.rows);
                    }
                    _ => damaged += 1,
                }
            }
        }
        // Written anew with what is good: a line cut off by an interruption must not run into the next.
        file.set_len(0).map_err(failure)?;
        file.seek(SeekFrom::Start(0)).map_err(failure)?;
        writeln!(file, "{header}").map_err(failure)?;
        let journal = Journal {
            path: path.clone(),
            file: Mutex::new(file),
            fingerprint,
            known,
            damaged,
        };
        for (chunk, rows) in &journal.known {
            journal.record(*chunk, rows);
        }
        Ok(journal)
    }

    /// Adds a finished chunk.
    pub fn record(&self, chunk: usize, rows: &[Row]) {
        let finished = Finished {
            chunk,
            rows: rows.to_vec(),
            sum: checksum(&self.fingerprint, chunk, rows),
        };
        if let (Ok(line), Ok(mut file)) = (serde_json::to_string(&finished), self.file.lock()) {
            // A journal that cannot be written costs the resumption, not the result.
            let _ = file
                .write_all(format!("{line}\n").as_bytes())
                .and_then(|()| file.flush());
        }
    }

    /// The output is complete.
    pub fn remove(self) {
        let _ = fs::remove_file(&self.path);
    }
}

fn checksum(fingerprint: &str, chunk: usize, rows: &[Row]) -> String {
    let rows = serde_json::to_string(rows).unwrap_or_default();
    let text = format!("{fingerprint} {chunk} {rows}");
    format!("{:016x}", hash(text.into_bytes()))
}
