//! One sweep on many machines: shares of it, merged.

use crate::arguments::{Common, MergeOptions, SweepOptions};
use crate::asked::resumed;
use crate::interrupt::{self, Kept};
use crate::outputs;
use crate::progress::Bar;
use landau_report::data::table;
use landau_solver::error::{Error, Result};
use landau_solver::file::{Overwrite, destination};
use landau_solver::study::journal_path;
use landau_solver::study::shard::{self, Share};
use landau_solver::study::sweep::Sweep;
use landau_solver::words::{counted, shown_path};
use serde_json::json;
use std::path::PathBuf;

/// The share that is asked for: `I/N`, or `slurm` for that of the task of a job array.
///
/// # Errors
/// A text that is neither; Slurm's variables missing.
pub fn share(text: &str) -> Result<Share> {
    if text != "slurm" {
        return Share::parse(text);
    }
    let number = |name: &str| -> Result<usize> {
        let value = std::env::var(name).ok().and_then(|v| v.parse().ok());
        value.ok_or_else(|| {
            Error::input(format!(
                "--shard slurm: {name} is not set to a number; is this a job array?"
            ))
        })
    };
    let (id, count) = (
        number("SLURM_ARRAY_TASK_ID")?,
        number("SLURM_ARRAY_TASK_COUNT")?,
    );
    let first = number("SLURM_ARRAY_TASK_MIN").unwrap_or(1);
    Share::parse(&format!("{}/{count}", (id + 1).saturating_sub(first)))
}

/// Computes one share of a sweep.
pub fn run_share(sweep: &Sweep, text: &str, options: &SweepOptions, common: &Common) -> Result<()> {
    let share = share(text)?;
    let overwrite = Overwrite::forced(options.force);
    interrupt::keeping(Kept::Journal(journal_path(&destination(&options.out)?)));
    let bar = Bar::new("sweeping");
    sweep.run_share(share, &options.out, overwrite, &bar, resumed)?;
    interrupt::finished();
    let out = shown_path(&options.out);
    if common.json {
        say!(
            "{}",
            json!({"out": out.to_string(), "share": [share.index, share.count]})
        );
    } else {
        say!("share {} of {}: {out}", share.index, share.count);
    }
    Ok(())
}

/// Puts shares together.
pub fn merge(options: &MergeOptions) -> Result<()> {
    outputs::check_apart(&options.out, options.shards.iter().map(PathBuf::as_path))?;
    let merged = shard::merge(&options.shards)?;
    table::write_merged(&options.out, &merged, Overwrite::forced(options.force))?;
    say!(
        "{}: {}",
        counted(options.shards.len(), "share"),
        shown_path(&options.out)
    );
    Ok(())
}
