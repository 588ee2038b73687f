//! The command `reproduce`: a study file worked through.

use crate::cluster::share;
use crate::inspect;
use crate::interrupt::{self, Kept};
use crate::progress::Bar;
use landau_report::library::Library;
use landau_report::reproduce::{Errata, Outcome, Provenance, Study, Verdict, Workshop};
use landau_solver::error::{Error, Result};
use landau_solver::file::Overwrite;
use landau_solver::study::shard::Share;
use landau_solver::words::{counted, shown_path};
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};

pub fn reproduce(
    library: &Library,
    study: Option<&Path>,
    out: &Path,
    shard: Option<&str>,
    overwrite: Overwrite,
    json: bool,
) -> Result<()> {
    let path = match study {
        Some(path) => path.to_owned(),
        None => only_study()?,
    };
    let study = Study::read(&path)?;
    let errata = study.errata.as_ref();
    let errata = errata.map(|file| Errata::read(&study.home().join(file)));
    let errata = errata.transpose()?;
    let shop = Workshop::new(library, &study, out, overwrite, provenance())?;
    let formulas = inspect::formulas(shop.model()?.as_ref(), errata.as_ref())?;
    interrupt::keeping(Kept::Tasks(shop.kept().to_owned()));
    if let Some(text) = shard {
        return run_share(&shop, share(text)?, json);
    }
    let outcome = shop.run(&formulas, &Bar::new("reproducing"))?;
    let page = out.join("index.html");
    if json {
        say!("{}", counts(&path, &page, &study, &outcome));
    } else {
        print(&page, &study, &outcome);
    }
    match outcome.failures.as_slice() {
        [] => Ok(()),
        [first, further @ ..] => Err(Error::computation(format!(
            "the report is written, but {first}{}",
            match further.len() {
                0 => String::new(),
                more => format!("; and {more} more that did not come out, named there"),
            }
        ))),
    }
}

/// Computes one share of the tasks.
fn run_share(shop: &Workshop, share: Share, json: bool) -> Result<()> {
    let count = shop.run_share(share, &Bar::new("reproducing"))?;
    let (Share { index, count: of }, kept) = (share, shown_path(shop.kept()));
    if json {
        let object = json!({"share": [index, of], "tasks": count, "kept": kept.to_string()});
        say!("{object}");
    } else {
        say!(
            "share {index} of {of}: {} kept in {kept}; when all shares are there, the same command without --shard writes the report",
            counted(count, "task")
        );
    }
    Ok(())
}

/// The JSON object that is printed.
fn counts(path: &Path, page: &Path, study: &Study, outcome: &Outcome) -> Value {
    let count = |verdict: Verdict| {
        let claims = outcome.claims.iter();
        claims.filter(|claim| claim.verdict == verdict).count()
    };
    json!({
        "study": path.display().to_string(),
        "report": page.display().to_string(),
        "figures": study.figure.len(),
        "numbers": outcome.numbers.len(),
        "claims": outcome.claims.len(),
        "claims_contradicted": count(Verdict::Contradicted),
        "claims_not_met": count(Verdict::NotMet),
        "failures": outcome.failures,
    })
}

/// Printed numbers beside ours, statements that do not hold, and how much there is.
fn print(page: &Path, study: &Study, outcome: &Outcome) {
    say!(
        "{:<8} {:<52} {:>14} {:>12}",
        "figure",
        "quantity",
        "ours",
        "printed"
    );
    for number in outcome.numbers.iter().filter(|n| n.printed.is_some()) {
        let ours = number.ours.map_or("-".to_owned(), |v| format!("{v:.6}"));
        say!(
            "{:<8} {:<52} {ours:>14} {:>12}",
            number.figure,
            number.quantity,
            number.printed_as.as_deref().unwrap_or("")
        );
    }
    let claims = outcome.claims.iter();
    let mut against: Vec<_> = claims.filter(|c| c.verdict.is_against()).collect();
    against.sort_by_key(|claim| claim.verdict);
    for claim in against {
        say!(
            "figure {}: {}: {}",
            claim.figure,
            claim.verdict_in_words(),
            claim.says
        );
    }
    say!(
        "{}, {}, {}: {}",
        counted(study.figure.len(), "figure"),
        counted(outcome.numbers.len(), "number"),
        counted(outcome.claims.len(), "statement"),
        shown_path(page)
    );
}

/// The command, the time and the commit.
fn provenance() -> Provenance {
    let words = std::env::args_os().map(|word| word.to_string_lossy().into_owned());
    let mut command: Vec<String> = words.collect();
    if let Some(program) = command.first_mut() {
        *program = "landau".to_owned();
    }
    let now = std::time::SystemTime::now();
    Provenance {
        command: command.join(" "),
        date: humantime::format_rfc3339_seconds(now).to_string(),
        commit: option_env!("LANDAU_COMMIT").map(str::to_owned),
    }
}

/// The study that stands in a folder `studies` here or one level below.
fn only_study() -> Result<PathBuf> {
    let entries = |folder: &Path| -> Vec<PathBuf> {
        let read = fs::read_dir(folder).into_iter().flatten();
        let mut paths: Vec<PathBuf> = read.filter_map(|e| e.ok().map(|e| e.path())).collect();
        paths.sort();
        paths
    };
    let mut folders = vec![PathBuf::from("studies")];
    folders.extend(
        entries(Path::new("."))
            .into_iter()
            .map(|p| p.join("studies")),
    );
    let mut studies: Vec<PathBuf> = folders.iter().flat_map(|folder| entries(folder)).collect();
    studies.retain(|path| path.extension().is_some_and(|e| e == "toml"));
    // Where there are several, one may say that it is the one.
    if studies.len() > 1 {
        let default = |path: &PathBuf| Study::read(path).is_ok_and(|study| study.default);
        let chosen: Vec<PathBuf> = studies.iter().filter(|p| default(p)).cloned().collect();
        if chosen.len() == 1 {
            studies = chosen;
        }
    }
    match studies.len() {
        1 => Ok(studies.swap_remove(0)),
        0 => Err(Error::input(
            "no study file was found in a folder `studies` here: name one",
        )),
        _ => {
            let names: Vec<String> = studies.iter().map(|p| p.display().to_string()).collect();
            Err(Error::input(format!(
                "name one of the study files {}",
                names.join(", ")
            )))
        }
    }
}
