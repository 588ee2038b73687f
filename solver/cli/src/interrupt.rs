//! A run that is stopped from outside says what it has kept.

use landau_solver::study::journal_path;
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::iterator::Signals;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// The journal of the sweep that is running.
static JOURNAL: Mutex<Option<PathBuf>> = Mutex::new(None);

fn set(journal: Option<PathBuf>) {
    if let Ok(mut current) = JOURNAL.lock() {
        *current = journal;
    }
}

/// From now on rows are kept beside `out`.
pub fn keeping(out: &Path) {
    set(Some(journal_path(out)));
}

/// Nothing is half done any more.
pub fn finished() {
    set(None);
}

/// Ends the process with 128 + the signal's number, and a sentence, when a signal asks for it.
pub fn watch() {
    let Ok(mut signals) = Signals::new([SIGINT, SIGTERM, SIGHUP]) else {
        return;
    };
    std::thread::spawn(move || {
        if let Some(signal) = signals.forever().next() {
            eprintln!("\n{}", sentence());
            std::process::exit(128 + signal);
        }
    });
}

fn sentence() -> String {
    let journal = JOURNAL.lock().ok().and_then(|current| current.clone());
    match journal {
        Some(path) => {
            // The first line says what the journal was made for.
            let chunks = std::fs::read_to_string(&path)
                .map_or(0, |text| text.lines().count().saturating_sub(1));
            format!(
                "interrupted: {chunks} finished parts are kept in {}; the same command goes on from there",
                path.display()
            )
        }
        None => "interrupted: nothing was written".to_owned(),
    }
}
