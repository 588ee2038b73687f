//! One sweep on many machines: shares of it, merged; scripts for Slurm and HyperQueue.

use crate::arguments::{Common, Engine, MergeOptions, SweepOptions};
use crate::asked::resumed;
use crate::interrupt;
use crate::progress::Bar;
use landau_report::data::csvw::write_beside;
use landau_solver::error::{Error, Result};
use landau_solver::file::{destination, write_whole};
use landau_solver::study::shard::{self, Share};
use landau_solver::study::sweep::Sweep;
use serde_json::json;
use std::path::{Path, PathBuf};

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
    interrupt::keeping(&options.out);
    sweep.run_share(share, &options.out, &Bar::new("sweeping"), resumed)?;
    interrupt::finished();
    let out = options.out.display();
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
    let target = destination(&options.out)?;
    let merged = shard::merge(&options.shards)?;
    let bytes = merged.table;
    let other = target.exists() && std::fs::read(&target).is_ok_and(|known| known != bytes);
    if other && !options.force {
        return Err(Error::input(format!(
            "{} exists and is another file: remove it, choose another --out, or give --force",
            options.out.display()
        )));
    }
    write_whole(&target, &bytes)?;
    let header = merged.header.iter().map(String::as_str);
    write_beside(&target, header, &merged.facts)?;
    say!("{} shares: {}", options.shards.len(), options.out.display());
    Ok(())
}

/// The command line of this sweep without what makes scripts of it, quoted for a shell.
fn own_command() -> Vec<String> {
    let mut words = Vec::new();
    let mut skip = false;
    for (index, word) in std::env::args().enumerate() {
        if index == 0 {
            let own = std::env::current_exe().map(|path| path.display().to_string());
            words.push(own.unwrap_or(word));
            continue;
        }
        let scripted = ["--emit", "--tasks", "--cpus", "--out"];
        let joined = scripted
            .iter()
            .any(|option| word.starts_with(&format!("{option}=")));
        if skip || joined {
            skip = false;
        } else if scripted.contains(&word.as_str()) {
            skip = true;
        } else {
            words.push(word);
        }
    }
    words
}

/// A word as a shell takes it.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_=:./,+@%".contains(c);
    match !word.is_empty() && word.chars().all(plain) {
        true => word.to_owned(),
        false => format!("'{}'", word.replace('\'', "'\\''")),
    }
}

/// The file of a share beside the whole.
fn shard_path(out: &Path, index: &str) -> String {
    format!("{}.shard-{index}", out.display())
}

/// Writes the script or job file that runs the sweep in `tasks` shares and merges them, and says how to start it.
pub fn emit(engine: Engine, options: &SweepOptions) -> Result<()> {
    let tasks = options.tasks;
    if !(1..=100_000).contains(&tasks) {
        return Err(Error::input(format!(
            "--tasks {tasks}: it accepts 1 to 100000"
        )));
    }
    destination(&options.out)?;
    let (extension, text) = match engine {
        Engine::Slurm => ("slurm.sh", slurm(options)),
        Engine::Hq => ("hq.toml", hyperqueue(options)),
    };
    let path = PathBuf::from(format!("{}.{extension}", options.out.display()));
    write_whole(&path, text.as_bytes())?;
    let start = match engine {
        Engine::Slurm => "bash",
        Engine::Hq => "hq job submit-file",
    };
    say!("{start} {}", quoted(&path.display().to_string()));
    Ok(())
}

/// Started by hand it submits itself as a job array, and the merge as a job that waits for it.
fn slurm(options: &SweepOptions) -> String {
    let command: Vec<String> = own_command().iter().map(|w| quoted(w)).collect();
    let landau = command[0].clone();
    let command = command.join(" ");
    let (tasks, cpus) = (options.tasks, options.cpus);
    let out = quoted(&options.out.display().to_string());
    format!(
        "#!/bin/bash
#SBATCH --job-name=landau
#SBATCH --cpus-per-task={cpus}
#SBATCH --requeue
set -euo pipefail
out={out}
if [ -z \"${{SLURM_ARRAY_TASK_ID:-}}\" ]; then
    job=$(sbatch --parsable --array=1-{tasks} \"$0\")
    sbatch --dependency=afterok:\"${{job%%;*}}\" --job-name=landau-merge \\
        --wrap \"{landau} merge $(printf '%q' \"$out\").shard-* --out $(printf '%q' \"$out\") --force\"
    exit
fi
export RAYON_NUM_THREADS=${{SLURM_CPUS_PER_TASK:-{cpus}}}
{command} --shard slurm --out \"$out.shard-$SLURM_ARRAY_TASK_ID\"
"
    )
}

/// A job definition: one task a share, and the merge that depends on all of them.
fn hyperqueue(options: &SweepOptions) -> String {
    let command = own_command();
    let list = |words: &[String]| {
        let words: Vec<String> = words.iter().map(|w| format!("{w:?}")).collect();
        format!("[{}]", words.join(", "))
    };
    let (tasks, cpus) = (options.tasks, options.cpus);
    let mut text = "name = \"landau\"\n".to_owned();
    for index in 1..=tasks {
        let mut own = command.clone();
        own.extend(["--shard".to_owned(), format!("{index}/{tasks}")]);
        own.extend([
            "--out".to_owned(),
            shard_path(&options.out, &index.to_string()),
        ]);
        text += &format!(
            "\n[[task]]\nid = {index}\ncommand = {}\nenv = {{ RAYON_NUM_THREADS = \"{cpus}\" }}\ncrash_limit = 10\n\
             [[task.request]]\nresources = {{ \"cpus\" = \"{cpus}\" }}\n",
            list(&own)
        );
    }
    let mut merge = vec![command[0].clone(), "merge".to_owned()];
    merge.extend((1..=tasks).map(|index| shard_path(&options.out, &index.to_string())));
    merge.extend([
        "--out".to_owned(),
        options.out.display().to_string(),
        "--force".to_owned(),
    ]);
    let all: Vec<String> = (1..=tasks).map(|index| index.to_string()).collect();
    text + &format!(
        "\n[[task]]\nid = {}\ncommand = {}\ndeps = [{}]\n",
        tasks + 1,
        list(&merge),
        all.join(", ")
    )
}

#[cfg(test)]
mod tests {
    use super::quoted;

    #[test]
    fn words_for_a_shell() {
        assert_eq!(quoted("--over"), "--over");
        assert_eq!(quoted("k=0.1:0.2:3"), "k=0.1:0.2:3");
        assert_eq!(quoted("my file"), "'my file'");
        assert_eq!(quoted("it's"), "'it'\\''s'");
    }
}
