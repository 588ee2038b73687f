//! Long work away from the interpreter, which listens to Ctrl-C meanwhile.

use crate::raised;
use landau_solver::error::Result;
use landau_solver::study::Progress;
use pyo3::prelude::*;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Duration;

/// How often the interpreter is asked for signals.
const PERIOD: Duration = Duration::from_millis(2);

/// What a step that finds itself interrupted unwinds with.
struct Interrupted;

/// Told by the work how far it is; tells it to stop.
#[derive(Default)]
pub struct Watch {
    stop: AtomicBool,
    done: AtomicUsize,
}

impl Progress for Watch {
    fn begin(&self, _: usize) {}

    fn advance(&self, steps: usize) {
        self.done.fetch_add(steps, Ordering::Relaxed);
        if self.stop.load(Ordering::Relaxed) {
            resume_unwind(Box::new(Interrupted));
        }
    }

    fn end(&self) {}
}

/// Runs work without the interpreter's lock; on a signal whose handler raises it ends within one step.
pub fn watched<R: Send>(
    py: Python<'_>,
    work: impl FnOnce(&Watch) -> Result<R> + Send,
) -> PyResult<R> {
    let watch = Watch::default();
    std::thread::scope(|scope| {
        let guarded = || catch_unwind(AssertUnwindSafe(|| work(&watch)));
        let worker = scope.spawn(guarded);
        let mut signal = None;
        while !worker.is_finished() {
            py.detach(|| std::thread::sleep(PERIOD));
            if signal.is_none()
                && let Err(raised) = py.check_signals()
            {
                watch.stop.store(true, Ordering::Relaxed);
                signal = Some(raised);
            }
        }
        let ended = py.detach(|| worker.join());
        match (signal, ended) {
            (Some(signal), _) => Err(signal),
            (None, Ok(Ok(answer))) => answer.map_err(raised),
            (None, Ok(Err(panic)) | Err(panic)) => resume_unwind(panic),
        }
    })
}
