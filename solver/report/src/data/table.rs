//! The table of a sweep as a file, with its description beside it.
//!
//! The description holds what the table was computed from and a hash of the table, and is sealed: by it a table that Landau
//! wrote for the same sweep, and that nobody changed since, is told from any other file.

use super::csvw;
use landau_solver::error::Result;
use landau_solver::file::{
    Overwrite, check_companion, destination, hash, read_bounded, refused, remove_abandoned_beside,
    write_whole,
};
use landau_solver::study::Progress;
use landau_solver::study::identity::SweepIdentity;
use landau_solver::study::row::{Row, Table};
use landau_solver::study::sweep::{Resumed, Sweep};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Largest table that is looked at before it is replaced, in bytes.
const TABLE_LIMIT: u64 = 64 << 30;
/// Largest description, in bytes.
const DESCRIPTION_LIMIT: u64 = 16 << 20;

/// Where a table goes, if it may go there; asked before anything is computed. A link is followed.
///
/// # Errors
/// A folder, a device; unless `overwrite` allows it, a file that is no table of this sweep, or was changed since Landau
/// wrote it, and a description that Landau did not write.
pub fn check(out: &Path, sweep: &SweepIdentity, overwrite: Overwrite) -> Result<PathBuf> {
    let target = destination(out)?;
    check_companion(&csvw::path_beside(&target), overwrite)?;
    if overwrite == Overwrite::Recognised
        && target.exists()
        && let Some(reason) = objection(&target, sweep)
    {
        return Err(refused(out, &reason));
    }
    remove_abandoned_beside(&target);
    Ok(target)
}

/// Why a file is not the table of this sweep as Landau wrote it.
fn objection(target: &Path, sweep: &SweepIdentity) -> Option<String> {
    let Some(description) = description(target) else {
        return Some(
            "it is no table of this sweep, for no description stands beside it".to_owned(),
        );
    };
    let described = description.get(csvw::SWEEP).cloned();
    let described = described.and_then(|v| serde_json::from_value::<SweepIdentity>(v).ok());
    let Some(described) = described else {
        return Some("the description beside it is not that of a sweep".to_owned());
    };
    if !sweep.is_same_table(&described) {
        let difference = sweep.difference(&described).unwrap_or_default();
        return Some(format!("it is the table of another sweep ({difference})"));
    }
    let table = read_bounded(target, TABLE_LIMIT).ok()?;
    let has_hash = description.get(csvw::TABLE) == Some(&Value::String(hashed(&table)));
    (!has_hash).then(|| "it was changed since Landau wrote it".to_owned())
}

fn description(target: &Path) -> Option<Value> {
    let text = read_bounded(&csvw::path_beside(target), DESCRIPTION_LIMIT).ok()?;
    serde_json::from_slice(&text).ok()
}

fn hashed(table: &[u8]) -> String {
    format!("{:016x}", hash(table.iter().copied()))
}

/// Writes a table and its description. The description comes first: an interruption between the two leaves a table that
/// the same command replaces.
///
/// # Errors
/// A folder that cannot be written to.
pub fn write(target: &Path, table: &Table) -> Result<()> {
    let description = csvw::describe_sweep(target, table, &hashed(&table.csv));
    write_whole(&csvw::path_beside(target), &description)?;
    write_whole(target, &table.csv)
}

/// Computes a sweep into a table with its description; what an interrupted run has left is not computed again.
///
/// # Errors
/// As [`check`] and [`Sweep::run_to`].
pub fn sweep_into(
    out: &Path,
    sweep: &Sweep,
    overwrite: Overwrite,
    progress: &dyn Progress,
    resumed: impl FnOnce(Resumed),
) -> Result<Vec<Row>> {
    let target = check(out, &sweep.identity(), overwrite)?;
    sweep.run_to(&target, overwrite, progress, resumed, write)
}

/// Writes the table that merged shares make.
///
/// # Errors
/// As [`check`] and [`write()`].
pub fn write_merged(out: &Path, table: &Table, overwrite: Overwrite) -> Result<()> {
    let target = check(out, &table.sweep, overwrite)?;
    write(&target, table)
}
