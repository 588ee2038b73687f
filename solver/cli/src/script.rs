//! Scripts that run a sweep in shares: for Slurm a shell script, for HyperQueue a job file.

use crate::arguments::{Common, Engine, SweepOptions};
use crate::values::beside;
use landau_report::data::table;
use landau_solver::error::{Error, Result};
use landau_solver::file::seal::{BLANK, sealed};
use landau_solver::file::{Overwrite, check_companion, write_whole};
use landau_solver::study::shard::MOST_SHARES;
use landau_solver::study::sweep::Sweep;
use serde::Serialize;
use serde_json::json;
use std::collections::BTreeMap;
use std::ffi::{OsStr, OsString};
use std::path::Path;

/// Writes the script or job file that runs the sweep in `--tasks` shares and merges them, and says how to start it.
///
/// # Errors
/// A number of tasks or cores out of range; files that must not be replaced; names that the format cannot hold.
pub fn emit(engine: Engine, sweep: &Sweep, options: &SweepOptions, common: &Common) -> Result<()> {
    let (tasks, cpus) = (options.tasks, options.cpus);
    if !(1..=MOST_SHARES).contains(&tasks) {
        return Err(Error::input(format!(
            "--tasks {tasks}: it accepts 1 to {MOST_SHARES}"
        )));
    }
    if !(1..=MOST_CORES).contains(&cpus) {
        return Err(Error::input(format!(
            "--cpus {cpus}: it accepts 1 to {MOST_CORES}"
        )));
    }
    let overwrite = Overwrite::forced(options.force);
    table::check(&options.out, &sweep.identity(), overwrite)?;
    let job = Job::new(options)?;
    let text = match engine {
        Engine::Slurm => job.slurm(),
        Engine::Hq => job.hyperqueue()?.into_bytes(),
    };
    let path = beside(&options.out, engine.ending());
    check_companion(&path, overwrite)?;
    write_whole(&path, &sealed(text))?;
    let program = match engine {
        Engine::Slurm => "bash",
        Engine::Hq => "hq job submit-file",
    };
    let name = String::from_utf8_lossy(&quoted(path.as_os_str())).into_owned();
    let start = format!("{program} {name}");
    if common.json {
        say!(
            "{}",
            json!({"out": path.display().to_string(), "start": start})
        );
    } else {
        say!("{start}");
    }
    Ok(())
}

/// Cores that a share may ask for.
const MOST_CORES: usize = 100_000;

/// What a script says.
struct Job<'a> {
    /// The program and the options of the sweep, without `--out` and what makes scripts of it.
    command: Vec<OsString>,
    out: &'a Path,
    tasks: usize,
    cpus: usize,
    /// `--force` or nothing, for the merge; the shares have it in their command.
    force: Option<&'static str>,
}

impl<'a> Job<'a> {
    fn new(options: &'a SweepOptions) -> Result<Self> {
        let program = std::env::current_exe().map_err(|error| {
            Error::computation(format!("the path of the program is not to be had: {error}"))
        })?;
        let mut command = vec![program.into_os_string()];
        command.extend(words_of_sweep(std::env::args_os().skip(1)));
        Ok(Job {
            command,
            out: &options.out,
            tasks: options.tasks,
            cpus: options.cpus,
            force: options.force.then_some("--force"),
        })
    }

    /// The file of a share beside the whole.
    fn shard(&self, index: usize) -> OsString {
        beside(self.out, &format!(".shard-{index}")).into_os_string()
    }

    /// A script that, started by hand, submits itself as a job array, and once more as the merge, which waits for the
    /// array. Every name stands in it once, quoted.
    fn slurm(&self) -> Vec<u8> {
        let (tasks, cpus) = (self.tasks, self.cpus);
        let mut text = format!(
            "#!/bin/bash
#SBATCH --job-name=landau
#SBATCH --cpus-per-task={cpus}
#SBATCH --requeue
# {BLANK}
set -euo pipefail
out="
        )
        .into_bytes();
        text.extend(quoted(self.out.as_os_str()));
        text.extend(b"\ncommand=(");
        for (index, word) in self.command.iter().enumerate() {
            if index > 0 {
                text.push(b' ');
            }
            text.extend(quoted(word));
        }
        let force = self
            .force
            .map_or(String::new(), |force| format!(" {force}"));
        text.extend(
            format!(
                ")
if [ \"${{1:-}}\" = merge ]; then
    shards=()
    for ((index = 1; index <= {tasks}; index++)); do shards+=(\"$out.shard-$index\"); done
    \"${{command[0]}}\" merge \"${{shards[@]}}\" --out \"$out\"{force}
    exit
fi
if [ -z \"${{SLURM_ARRAY_TASK_ID:-}}\" ]; then
    job=$(sbatch --parsable --array=1-{tasks} \"$0\")
    sbatch --dependency=afterok:\"${{job%%;*}}\" --job-name=landau-merge --cpus-per-task=1 \"$0\" merge
    exit
fi
export RAYON_NUM_THREADS=${{SLURM_CPUS_PER_TASK:-{cpus}}}
\"${{command[@]}}\" --shard slurm --out \"$out.shard-$SLURM_ARRAY_TASK_ID\"
"
            )
            .bytes(),
        );
        text
    }

    /// A job definition: one task a share, and the merge that depends on all of them.
    ///
    /// # Errors
    /// A name that is not UTF-8, which TOML cannot hold.
    fn hyperqueue(&self) -> Result<String> {
        let cpus = self.cpus.to_string();
        let mut tasks = Vec::new();
        for index in 1..=self.tasks {
            let mut command = utf8(&self.command)?;
            command.extend(["--shard".to_owned(), format!("{index}/{}", self.tasks)]);
            command.extend(["--out".to_owned(), name(&self.shard(index))?]);
            tasks.push(Task {
                id: index,
                command,
                crash_limit: Some(10),
                deps: Vec::new(),
                env: BTreeMap::from([("RAYON_NUM_THREADS", cpus.clone())]),
                request: vec![Request {
                    resources: BTreeMap::from([("cpus", cpus.clone())]),
                }],
            });
        }
        let mut merge = vec![name(&self.command[0])?, "merge".to_owned()];
        for index in 1..=self.tasks {
            merge.push(name(&self.shard(index))?);
        }
        merge.extend(["--out".to_owned(), name(self.out.as_os_str())?]);
        merge.extend(self.force.map(str::to_owned));
        tasks.push(Task {
            id: self.tasks + 1,
            command: merge,
            crash_limit: None,
            deps: (1..=self.tasks).collect(),
            env: BTreeMap::new(),
            request: Vec::new(),
        });
        let file = JobFile {
            name: "landau",
            task: tasks,
        };
        let text = toml::to_string(&file).map_err(|e| Error::computation(e.to_string()))?;
        Ok(format!("# {BLANK}\n{text}"))
    }
}

/// A job file of HyperQueue.
#[derive(Serialize)]
struct JobFile {
    name: &'static str,
    task: Vec<Task>,
}

#[derive(Serialize)]
struct Task {
    id: usize,
    command: Vec<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    crash_limit: Option<usize>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    deps: Vec<usize>,
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    env: BTreeMap<&'static str, String>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    request: Vec<Request>,
}

#[derive(Serialize)]
struct Request {
    resources: BTreeMap<&'static str, String>,
}

/// The words of a sweep's command line without those that make scripts of it, and without `--out`.
fn words_of_sweep(words: impl Iterator<Item = OsString>) -> Vec<OsString> {
    let removed = ["--emit", "--tasks", "--cpus", "--out"];
    let mut kept = Vec::new();
    let mut is_value = false;
    for word in words {
        let bytes = word.as_encoded_bytes();
        let names = |option: &&str| bytes == option.as_bytes();
        let assigns = |option: &&str| {
            let value = bytes.strip_prefix(option.as_bytes());
            value.is_some_and(|value| value.starts_with(b"="))
        };
        if is_value || removed.iter().any(assigns) {
            is_value = false;
        } else if removed.iter().any(names) {
            is_value = true;
        } else {
            kept.push(word);
        }
    }
    kept
}

fn utf8(words: &[OsString]) -> Result<Vec<String>> {
    words.iter().map(|word| name(word)).collect()
}

fn name(word: &OsStr) -> Result<String> {
    word.to_str().map(str::to_owned).ok_or_else(|| {
        Error::input(format!(
            "{} is not UTF-8, and a job file of HyperQueue can hold nothing else: choose another name, or --emit slurm",
            word.to_string_lossy()
        ))
    })
}

/// A word as a shell takes it: nothing in it is expanded.
fn quoted(word: &OsStr) -> Vec<u8> {
    let bytes = word.as_encoded_bytes();
    let is_plain = |c: &u8| c.is_ascii_alphanumeric() || b"-_=:./,+@%".contains(c);
    if !bytes.is_empty() && bytes.iter().all(is_plain) {
        return bytes.to_vec();
    }
    let mut quoted = vec![b'\''];
    for byte in bytes {
        match byte {
            b'\'' => quoted.extend(b"'\\''"),
            byte => quoted.push(*byte),
        }
    }
    quoted.push(b'\'');
    quoted
}

#[cfg(test)]
mod tests {
    use super::{quoted, words_of_sweep};
    use std::ffi::{OsStr, OsString};
    use std::os::unix::ffi::OsStrExt;
    use std::process::Command;

    /// What a shell reads is what was quoted.
    #[test]
    fn words_for_a_shell() {
        let words: [&[u8]; 9] = [
            b"--over",
            b"k=0.1:0.2:3",
            b"",
            b"my file",
            b"it's",
            b"$(touch x) `y` \"z\" \\",
            b"a\nb\tc\x01",
            b"\xff\xfe",
            b"*?[!~#;&|<>",
        ];
        for word in words {
            let mut script = b"printf %s ".to_vec();
            script.extend(quoted(OsStr::from_bytes(word)));
            let shell = Command::new("sh")
                .arg("-c")
                .arg(OsStr::from_bytes(&script))
                .output();
            assert_eq!(shell.expect("a shell").stdout, word);
        }
        assert_eq!(quoted(OsStr::new("k=0.1:0.2:3")), b"k=0.1:0.2:3");
    }

    #[test]
    fn the_command_without_its_script() {
        let line = "sweep m --emit slurm --over k=1:2:3 --tasks=3 --out a b --cpus 2 --outer --set S=1 --out=c";
        let kept = words_of_sweep(line.split(' ').map(OsString::from));
        let kept: Vec<String> = kept
            .iter()
            .map(|w| w.to_string_lossy().into_owned())
            .collect();
        assert_eq!(kept.join(" "), "sweep m --over k=1:2:3 b --outer --set S=1");
    }
}
