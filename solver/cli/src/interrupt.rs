//! A run that keeps what it has finished says so when it is stopped from outside. Any other command leaves signals as they
//! are, and ends at once.

use landau_solver::words::shown_path;
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::iterator::Signals;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, Once};

/// What a run keeps for the next one.
pub enum Kept {
    /// The journal of a sweep: a line for every finished part after the first line.
    Journal(PathBuf),
    /// The folder of the finished tasks of a study.
    Tasks(PathBuf),
}

/// What the run that is going on keeps.
static KEPT: Mutex<Option<Kept>> = Mutex::new(None);

fn set(kept: Option<Kept>) {
    if let Ok(mut current) = KEPT.lock() {
        *current = kept;
    }
}

/// From now on a signal ends the process with 128 + its number, and with a sentence about what is kept.
pub fn keeping(kept: Kept) {
    static WATCH: Once = Once::new();
    set(Some(kept));
    WATCH.call_once(watch);
}

/// Nothing is half done any more.
pub fn finished() {
    set(None);
}

fn watch() {
    // A signal that was ignored when the program began, as `nohup` does it, stays ignored.
    let heeded = [SIGINT, SIGTERM, SIGHUP]
        .into_iter()
        .filter(|signal| !is_ignored(*signal));
    let Ok(mut signals) = Signals::new(heeded) else {
        return;
    };
    std::thread::spawn(move || {
        if let Some(signal) = signals.forever().next() {
            note!("\n{}", sentence());
            std::process::exit(128 + signal);
        }
    });
}

/// Whether the process ignores a signal.
fn is_ignored(signal: i32) -> bool {
    let mut action = std::mem::MaybeUninit::<libc::sigaction>::uninit();
    // SAFETY: without a new action the call only writes the current one to the place that the last argument points to,
    // which has its size and alignment; where it succeeds, that place is initialised.
    unsafe {
        libc::sigaction(signal, std::ptr::null(), action.as_mut_ptr()) == 0
            && action.assume_init().sa_sigaction == libc::SIG_IGN
    }
}

fn sentence() -> String {
    let kept = KEPT.lock().ok().and_then(|mut kept| kept.take());
    match kept {
        Some(Kept::Journal(path)) => match lines(&path) {
            Some(count) => format!(
                "interrupted: {} kept in {}; the same command goes on from there",
                match count.saturating_sub(1) {
                    1 => "1 finished part is".to_owned(),
                    parts => format!("{parts} finished parts are"),
                },
                shown_path(&path)
            ),
            None => "interrupted".to_owned(),
        },
        Some(Kept::Tasks(path)) => format!(
            "interrupted: finished tasks are kept in {}; the same command goes on from there",
            shown_path(&path)
        ),
        None => "interrupted".to_owned(),
    }
}

/// Number of lines of a file.
fn lines(path: &Path) -> Option<usize> {
    let bytes = std::fs::read(path).ok()?;
    Some(bytes.iter().filter(|byte| **byte == b'\n').count())
}
