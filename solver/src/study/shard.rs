//! A sweep in shares for many machines: each share computes whole chunks of the sweep and leaves a file that knows the
//! whole; merged, the shares are the table that one machine would have written, byte for byte.

use super::Progress;
use super::row::{Row, table};
use super::sweep::{Resumed, Sweep};
use crate::error::{Error, Result};
use crate::file::{destination, hash, write_whole};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// The i-th of n shares, from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Share {
    /// Which one, from 1.
    pub index: usize,
    /// How many there are.
    pub count: usize,
}

impl Share {
    /// `I/N`
    ///
    /// # Errors
    /// Anything else, an index out of range.
    pub fn parse(text: &str) -> Result<Self> {
        let wrong = || {
            Error::input(format!(
                "--shard {text}: it accepts I/N with 1 ≤ I ≤ N, or slurm"
            ))
        };
        let (index, count) = text.split_once('/').ok_or_else(wrong)?;
        let number = |text: &str| text.trim().parse::<usize>().map_err(|_| wrong());
        let share = Share {
            index: number(index)?,
            count: number(count)?,
        };
        match (1..=share.count).contains(&share.index) {
            true => Ok(share),
            false => Err(wrong()),
        }
    }

    /// Its part of so many chunks: contiguous, of sizes that differ by one at most.
    pub fn part(self, chunks: usize) -> Range<usize> {
        let start = |index: usize| index * chunks / self.count;
        start(self.index - 1)..start(self.index)
    }
}

/// What a share leaves.
#[derive(Serialize, Deserialize)]
struct Shard {
    /// Version of this format.
    landau_shard: u32,
    /// What the sweep was made for.
    sweep: String,
    header: Vec<String>,
    /// What the whole was computed from.
    facts: Map<String, Value>,
    /// Chunks of the whole.
    chunks: usize,
    share: Share,
    rows: BTreeMap<usize, Vec<Row>>,
    /// Checksum over the rest.
    sum: String,
}

const VERSION: u32 = 2;

impl Shard {
    fn checksum(&self) -> Result<String> {
        let rows =
            serde_json::to_string(&self.rows).map_err(|e| Error::computation(e.to_string()))?;
        let text = format!(
            "{} {:?} {:?} {} {:?} {rows}",
            self.sweep, self.header, self.facts, self.chunks, self.share
        );
        Ok(format!("{:016x}", hash(text.bytes())))
    }

    fn read(path: &Path) -> Result<Self> {
        let bad = |why: String| Error::input(format!("{}: {why}", path.display()));
        let text =
            std::fs::read_to_string(path).map_err(|e| bad(format!("it cannot be read: {e}")))?;
        let shard: Shard = serde_json::from_str(&text).map_err(|_| {
            bad("this is no share of a sweep, as `sweep --shard` writes it".to_owned())
        })?;
        if shard.landau_shard != VERSION {
            return Err(bad(format!(
                "a share of format {}: this is {VERSION}",
                shard.landau_shard
            )));
        }
        if shard.sum != shard.checksum()? {
            return Err(bad("it is damaged: its checksum does not fit".to_owned()));
        }
        Ok(shard)
    }
}

/// Whether a file holds this share of this sweep already.
fn is_done(path: &Path, sweep: &str, share: Share) -> bool {
    Shard::read(path).is_ok_and(|known| known.sweep == sweep && known.share == share)
}

impl Sweep<'_> {
    /// Computes one share into a file, whole or not at all, with a journal beside it as any sweep has; what is done is
    /// not done again.
    ///
    /// # Errors
    /// A file that is something else, or cannot be written.
    pub fn run_share(
        &self,
        share: Share,
        out: &Path,
        progress: &dyn Progress,
        resumed: impl FnOnce(Resumed),
    ) -> Result<()> {
        let target = destination(out)?;
        let sweep = self.fingerprint();
        if target.exists() {
            if is_done(&target, &sweep, share) {
                return Ok(());
            }
            return Err(Error::input(format!(
                "{} exists and is another share, or no share: remove it, or choose another --out",
                out.display()
            )));
        }
        let part = share.part(self.chunk_count());
        let (rows, journal) = self.journalled(&target, part, progress, resumed)?;
        let mut shard = Shard {
            landau_shard: VERSION,
            sweep,
            header: self.header().map(str::to_owned).collect(),
            facts: self.facts(),
            chunks: self.chunk_count(),
            share,
            rows,
            sum: String::new(),
        };
        shard.sum = shard.checksum()?;
        let text = serde_json::to_string(&shard).map_err(|e| Error::computation(e.to_string()))?;
        write_whole(&target, text.as_bytes())?;
        journal.remove();
        Ok(())
    }
}

/// What all shares make together.
pub struct Merged {
    /// The table, as CSV.
    pub table: Vec<u8>,
    /// Names of its columns.
    pub header: Vec<String>,
    /// What it was computed from.
    pub facts: Map<String, Value>,
}

/// The table that all shares make together.
///
/// # Errors
/// Names shares of different sweeps, chunks that two of them hold, and what is missing.
pub fn merge(paths: &[PathBuf]) -> Result<Merged> {
    let Some(first_path) = paths.first() else {
        return Err(Error::input("name the shares to merge"));
    };
    let first = Shard::read(first_path)?;
    let mut rows: BTreeMap<usize, (Vec<Row>, &PathBuf)> = BTreeMap::new();
    for path in paths {
        let shard = Shard::read(path)?;
        if (&shard.sweep, &shard.header, shard.chunks)
            != (&first.sweep, &first.header, first.chunks)
        {
            return Err(Error::input(format!(
                "{} and {} are shares of different sweeps: model, laws, parameters, axes, M and version have to \
                 agree\n  {}\n  {}",
                first_path.display(),
                path.display(),
                first.sweep,
                shard.sweep
            )));
        }
        for (chunk, own) in shard.rows {
            if let Some((_, other)) = rows.get(&chunk) {
                return Err(Error::input(format!(
                    "{} and {} overlap: both hold part {} of {}",
                    other.display(),
                    path.display(),
                    chunk + 1,
                    first.chunks
                )));
            }
            rows.insert(chunk, (own, path));
        }
    }
    let missing: Vec<usize> = (0..first.chunks)
        .filter(|c| !rows.contains_key(c))
        .collect();
    if !missing.is_empty() {
        let count = first.share.count;
        let shares = (1..=count).filter(|&index| {
            let part = Share { index, count }.part(first.chunks);
            missing.iter().any(|chunk| part.contains(chunk))
        });
        let shares: Vec<String> = shares.map(|index| format!("{index}/{count}")).collect();
        return Err(Error::input(format!(
            "the shares leave gaps: missing is {}",
            shares.join(", ")
        )));
    }
    let rows: Vec<Row> = rows.into_values().flat_map(|(own, _)| own).collect();
    Ok(Merged {
        table: table(first.header.iter().map(String::as_str), &rows)?,
        header: first.header,
        facts: first.facts,
    })
}

#[cfg(test)]
mod tests {
    use super::Share;

    /// Every chunk once, whatever the number of shares.
    #[test]
    fn shares_make_the_whole() {
        for chunks in [1, 7, 40, 101] {
            for count in [1, 2, 3, 8, 200] {
                let parts = (1..=count).flat_map(|index| Share { index, count }.part(chunks));
                assert_eq!(parts.collect::<Vec<_>>(), (0..chunks).collect::<Vec<_>>());
            }
        }
        assert!(
            Share::parse("3/2").is_err()
                && Share::parse("0/2").is_err()
                && Share::parse("2").is_err()
        );
        assert_eq!(
            Share::parse("2/3").expect("a share"),
            Share { index: 2, count: 3 }
        );
    }
}
