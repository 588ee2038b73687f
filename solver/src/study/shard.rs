//! A sweep in shares for many machines: each share computes whole chunks of the sweep and leaves a file that knows the
//! whole; merged, the shares are the table that one machine would have written, byte for byte.

use super::Progress;
use super::identity::SweepIdentity;
use super::row::{Row, Table, table};
use super::sweep::{Resumed, Sweep};
use crate::error::{Error, Result};
use crate::file::{
    Overwrite, destination, hash, read_text, refused, remove_abandoned_beside, write_whole,
};
use crate::words::shown_path;
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

/// The largest number of shares.
pub const MOST_SHARES: usize = 100_000;

/// Largest file of a share, in bytes.
const SHARE_LIMIT: u64 = 4 << 30;

impl Share {
    /// `I/N`
    ///
    /// # Errors
    /// Anything else, an index out of range, more than [`MOST_SHARES`] shares.
    pub fn parse(text: &str) -> Result<Self> {
        let wrong = || {
            Error::input(format!(
                "--shard {text}: it accepts I/N with 1 ≤ I ≤ N ≤ {MOST_SHARES}, or slurm"
            ))
        };
        let (index, count) = text.split_once('/').ok_or_else(wrong)?;
        let number = |text: &str| text.trim().parse::<usize>().map_err(|_| wrong());
        let share = Share {
            index: number(index)?,
            count: number(count)?,
        };
        if (1..=share.count).contains(&share.index) && share.count <= MOST_SHARES {
            Ok(share)
        } else {
            Err(wrong())
        }
    }

    /// Its part of so many chunks: contiguous, of sizes that differ by one at most.
    pub fn part(self, chunks: usize) -> Range<usize> {
        let start = |index: usize| {
            let start = index as u128 * chunks as u128 / self.count as u128;
            usize::try_from(start).unwrap_or(chunks)
        };
        start(self.index - 1)..start(self.index)
    }

    /// The index of the share, one of `count`, that holds a chunk: the least i with ⌊i·chunks/count⌋ > chunk.
    fn index_of(chunk: usize, chunks: usize, count: usize) -> usize {
        let index = ((chunk as u128 + 1) * count as u128).div_ceil(chunks as u128);
        usize::try_from(index).unwrap_or(count)
    }
}

/// What a share leaves.
#[derive(Serialize, Deserialize)]
struct Shard {
    /// Version of this format.
    landau_shard: u32,
    /// What the sweep is.
    sweep: SweepIdentity,
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

const VERSION: u32 = 3;

/// The version of a share alone.
#[derive(Deserialize)]
struct Format {
    landau_shard: u32,
}

impl Shard {
    /// A checksum over everything but `sum`.
    fn checksum(&self) -> Result<String> {
        let Shard {
            landau_shard,
            sweep,
            header,
            facts,
            chunks,
            share,
            rows,
            sum: _,
        } = self;
        let parts = (landau_shard, sweep, header, facts, chunks, share, rows);
        let text = serde_json::to_string(&parts).map_err(|e| Error::computation(e.to_string()))?;
        Ok(format!("{:016x}", hash(text.bytes())))
    }

    fn read(path: &Path) -> Result<Self> {
        let bad = |why: String| Error::input(format!("{}: {why}", shown_path(path)));
        let text = read_text(path, SHARE_LIMIT)?;
        // Read by itself, for another format has other keys.
        let format = serde_json::from_str::<Format>(&text).map(|f| f.landau_shard);
        if let Ok(format) = format
            && format != VERSION
        {
            return Err(bad(format!(
                "a share of format {format}: this is {VERSION}"
            )));
        }
        let shard: Shard = serde_json::from_str(&text).map_err(|_| {
            bad("this is no share of a sweep, as `sweep --shard` writes it".to_owned())
        })?;
        if shard.sum != shard.checksum()? {
            return Err(bad("it is damaged: its checksum does not fit".to_owned()));
        }
        Ok(shard)
    }
}

/// Whether a file holds this share of this sweep already.
fn is_done(path: &Path, sweep: &SweepIdentity, share: Share) -> bool {
    Shard::read(path).is_ok_and(|shard| shard.sweep == *sweep && shard.share == share)
}

impl Sweep<'_> {
    /// Computes one share into a file, whole or not at all, with a journal beside it as any sweep has; what is done is
    /// not done again.
    ///
    /// # Errors
    /// A file that is something else, unless `overwrite` allows it to be replaced, or that cannot be written.
    pub fn run_share(
        &self,
        share: Share,
        out: &Path,
        overwrite: Overwrite,
        progress: &dyn Progress,
        resumed: impl FnOnce(Resumed),
    ) -> Result<()> {
        let target = destination(out)?;
        remove_abandoned_beside(&target);
        let sweep = self.identity();
        if target.exists() {
            if is_done(&target, &sweep, share) {
                return Ok(());
            }
            if overwrite == Overwrite::Recognised {
                return Err(refused(out, "it is another share, or no share"));
            }
        }
        let part = share.part(self.chunk_count());
        let (rows, journal) = self.journalled(&target, overwrite, part, progress, resumed)?;
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

/// The table that all shares make together.
///
/// # Errors
/// Names the part in which sweeps differ, chunks that two shares hold, and what is missing.
pub fn merge(paths: &[PathBuf]) -> Result<Table> {
    let Some(first_path) = paths.first() else {
        return Err(Error::input("name the shares to merge"));
    };
    let first = Shard::read(first_path)?;
    let mut rows: BTreeMap<usize, (Vec<Row>, &PathBuf)> = BTreeMap::new();
    for path in paths {
        let shard = Shard::read(path)?;
        if let Some(difference) = difference(&first, &shard) {
            return Err(Error::input(format!(
                "{} and {} are shares of different sweeps: {difference}",
                shown_path(first_path),
                shown_path(path),
            )));
        }
        for (chunk, rows_of_chunk) in shard.rows {
            if let Some((_, first_holder)) = rows.get(&chunk) {
                return Err(Error::input(format!(
                    "{} and {} overlap: both hold part {} of {}",
                    shown_path(first_holder),
                    shown_path(path),
                    chunk + 1,
                    first.chunks
                )));
            }
            rows.insert(chunk, (rows_of_chunk, path));
        }
    }
    let missing = missing(rows.keys().copied(), first.chunks, first.share.count);
    if !missing.is_empty() {
        return Err(Error::input(format!(
            "the shares leave gaps: missing is {missing}"
        )));
    }
    let rows: Vec<Row> = rows.into_values().flat_map(|(rows, _)| rows).collect();
    Ok(Table {
        csv: table(first.header.iter().map(String::as_str), &rows)?,
        header: first.header,
        facts: first.facts,
        sweep: first.sweep,
    })
}

/// What keeps two shares from being parts of one table.
fn difference(first: &Shard, shard: &Shard) -> Option<String> {
    let of_layout = || {
        let layout = |shard: &Shard| (shard.chunks, shard.header.clone());
        (layout(first) != layout(shard)).then(|| "their columns or parts differ".to_owned())
    };
    first.sweep.difference(&shard.sweep).or_else(of_layout)
}

/// Shares that a message names at most.
const NAMED: usize = 20;

/// The shares, of `count`, whose chunks are not among those that are there, in ascending order; in words.
fn missing(there: impl Iterator<Item = usize>, chunks: usize, count: usize) -> String {
    let mut next = 0;
    let mut indices: Vec<usize> = Vec::new();
    let mut are_more = false;
    for chunk in there.chain([chunks]) {
        // The chunks from `next` to `chunk` are missing; one share after another.
        while next < chunk && !are_more {
            let index = Share::index_of(next, chunks, count);
            if indices.last() != Some(&index) {
                are_more = indices.len() == NAMED;
                indices.push(index);
            }
            next = Share { index, count }.part(chunks).end;
        }
        next = chunk.saturating_add(1);
    }
    indices.truncate(NAMED);
    let mut names: Vec<String> = indices.iter().map(|i| format!("{i}/{count}")).collect();
    if are_more {
        names.push("others".to_owned());
    }
    names.join(", ")
}

#[cfg(test)]
mod tests {
    use super::{Map, Shard, Share, SweepIdentity, VERSION, merge, missing};
    use std::collections::BTreeMap;

    /// Every chunk once, whatever the number of shares.
    #[test]
    fn shares_make_the_whole() {
        for chunks in [1, 7, 40, 101] {
            for count in [1, 2, 3, 8, 200] {
                let parts = (1..=count).flat_map(|index| Share { index, count }.part(chunks));
                assert_eq!(parts.collect::<Vec<_>>(), (0..chunks).collect::<Vec<_>>());
            }
        }
        for wrong in ["3/2", "0/2", "2", "1/1000000000000", "1/100001"] {
            assert!(Share::parse(wrong).is_err(), "{wrong}");
        }
        assert_eq!(
            Share::parse("2/3").expect("a share"),
            Share { index: 2, count: 3 }
        );
    }

    /// The index of a share from a chunk, beside the parts of all shares.
    #[test]
    fn the_share_of_a_chunk() {
        for chunks in [1, 7, 40, 101] {
            for count in [1, 2, 3, 8, 200] {
                for index in 1..=count {
                    for chunk in (Share { index, count }).part(chunks) {
                        assert_eq!(Share::index_of(chunk, chunks, count), index);
                    }
                }
            }
        }
    }

    /// Shares by different builds of one version are no parts of one table, and the message says so.
    #[test]
    fn shares_by_different_builds() {
        let folder = tempfile::tempdir().expect("a folder");
        let paths = ["a", "b"].map(|name| folder.path().join(name));
        for (index, path) in paths.iter().enumerate() {
            let mut shard = Shard {
                landau_shard: VERSION,
                sweep: SweepIdentity::example(),
                header: vec!["k".to_owned()],
                facts: Map::new(),
                chunks: 2,
                share: Share {
                    index: index + 1,
                    count: 2,
                },
                rows: BTreeMap::from([(index, Vec::new())]),
                sum: String::new(),
            };
            shard.sweep.build = format!("build{index}");
            shard.sum = shard.checksum().expect("a checksum");
            let text = serde_json::to_string(&shard).expect("JSON");
            std::fs::write(path, text).expect("written");
        }
        let error = merge(&paths).expect_err("refused").to_string();
        assert!(
            error.contains("the build of Landau is build0 here and build1 there"),
            "{error}"
        );
        assert!(
            merge(&paths[..1])
                .expect_err("a gap")
                .to_string()
                .contains("2/2")
        );
    }

    #[test]
    fn what_is_missing() {
        let said = |there: &[usize], chunks, count| missing(there.iter().copied(), chunks, count);
        assert_eq!(said(&[0, 1, 2, 3], 4, 2), "");
        assert_eq!(said(&[0, 2, 3], 4, 2), "1/2");
        assert_eq!(said(&[1, 3], 4, 2), "1/2, 2/2");
        // No work in proportion to the number of shares, or of chunks.
        let huge = said(&[5], usize::MAX, 1_000_000_000_000);
        assert!(huge.starts_with("1/1000000000000, 2/") && huge.ends_with("others"));
        assert!(huge.len() < 1000);
    }
}
