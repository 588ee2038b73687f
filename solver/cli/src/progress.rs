//! A bar for long work, on standard error.

use indicatif::{ProgressBar, ProgressStyle};
use landau_solver::study::Progress;
use std::io::Write;
use std::time::Duration;

/// How often the time that has passed is written anew.
const TICK: Duration = Duration::from_secs(1);

/// How far the work is.
pub struct Bar(ProgressBar);

impl Bar {
    pub fn new(what: &str) -> Self {
        let bar = ProgressBar::new(0);
        let style =
            ProgressStyle::with_template("{prefix} [{bar:40}] {pos}/{len}, {elapsed}, {eta} left");
        bar.set_style(
            style
                .unwrap_or_else(|_| ProgressStyle::default_bar())
                .progress_chars("=> "),
        );
        bar.set_prefix(what.to_owned());
        // Some steps take minutes: the time shows that the work goes on.
        bar.enable_steady_tick(TICK);
        Bar(bar)
    }
}

impl Progress for Bar {
    fn begin(&self, steps: usize) {
        self.0.set_length(steps as u64);
    }

    fn advance(&self, steps: usize) {
        self.0.inc(steps as u64);
    }

    fn done(&self, what: &str) {
        if self.0.is_hidden() {
            // Nobody may be reading any more, which is no reason to stop.
            let _ = writeln!(std::io::stderr(), "{what}");
        } else {
            self.0.println(what);
        }
    }

    fn end(&self) {
        self.0.finish_and_clear();
    }
}
