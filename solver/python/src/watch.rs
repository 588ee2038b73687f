//! Long work away from the interpreter, which listens to Ctrl-C meanwhile; threads that a forked process can use.

use crate::raised;
use landau_solver::error::{Error, Result};
use landau_solver::study::Progress;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::ptr::null_mut;
use std::sync::atomic::{AtomicBool, AtomicPtr, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

/// How often the interpreter is asked for signals.
const PERIOD: Duration = Duration::from_millis(50);
/// How long interrupted work that reports its progress may take to end: a sweep closes its journal within one step.
const PATIENCE: Duration = Duration::from_secs(2);
/// Stack of a thread that computes, in bytes.
const STACK: usize = 16 << 20;

/// What a step that finds itself interrupted unwinds with.
struct Interrupted;

/// Asked by the work at every step whether it should go on.
#[derive(Default)]
pub struct Watch {
    stop: AtomicBool,
    has_steps: AtomicBool,
}

impl Progress for Watch {
    fn begin(&self, _: usize) {
        self.has_steps.store(true, Ordering::Relaxed);
    }

    fn advance(&self, _: usize) {
        if self.stop.load(Ordering::Relaxed) {
            resume_unwind(Box::new(Interrupted));
        }
    }

    fn end(&self) {
        self.has_steps.store(false, Ordering::Relaxed);
    }
}

/// Runs work without the interpreter's lock. On a signal whose handler raises, work in steps ends within one of them; any
/// other is abandoned: it goes on in the background, and its answer is dropped.
pub fn watched<R: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(&Watch) -> Result<R> + Send + 'static,
) -> PyResult<R> {
    let watch = Arc::new(Watch::default());
    let watch_of_worker = watch.clone();
    let pool = pool().map_err(raised)?;
    let (sender, receiver) = channel();
    let job = move || {
        let guarded = AssertUnwindSafe(|| pool.install(|| work(&watch_of_worker)));
        // Where nobody listens any more, the work was abandoned.
        let _ = sender.send(catch_unwind(guarded));
    };
    let spawned = thread::Builder::new().stack_size(STACK).spawn(job);
    spawned.map_err(|error| raised(no_thread(&error)))?;
    let receiver = Mutex::new(receiver);
    loop {
        match py.detach(|| answer(&receiver, PERIOD)) {
            Ok(Ok(answer)) => return answer.map_err(raised),
            Ok(Err(panic)) => resume_unwind(panic),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => {
                return Err(raised(Error::computation(
                    "the computation ended without an answer",
                )));
            }
        }
        if let Err(signal) = py.check_signals() {
            watch.stop.store(true, Ordering::Relaxed);
            let has_steps = watch.has_steps.load(Ordering::Relaxed);
            if !has_steps || py.detach(|| answer(&receiver, PATIENCE)).is_err() {
                leave_pool(pool);
            }
            return Err(signal);
        }
    }
}

/// Waits for an answer.
fn answer<T>(
    receiver: &Mutex<Receiver<T>>,
    patience: Duration,
) -> std::result::Result<T, RecvTimeoutError> {
    match receiver.lock() {
        Ok(receiver) => receiver.recv_timeout(patience),
        Err(_) => Err(RecvTimeoutError::Disconnected),
    }
}

/// Threads, and the process that they belong to: a fork copies the memory of a process, but none of its threads.
struct Pool {
    process: u32,
    threads: ThreadPool,
}

/// The threads of this process; null before the first use, or those of a parent. No lock guards them, for a fork might copy
/// it while it is held.
static POOL: AtomicPtr<Pool> = AtomicPtr::new(null_mut());

/// The threads of this process, started where there are none.
fn pool() -> Result<&'static ThreadPool> {
    let current = POOL.load(Ordering::Acquire);
    // SAFETY: the pointer is null or comes from `Box::leak` below, and what it points to is never freed or changed.
    if let Some(pool) = unsafe { current.as_ref() }
        && pool.process == std::process::id()
    {
        return Ok(&pool.threads);
    }
    let threads = ThreadPoolBuilder::new().stack_size(STACK).build();
    let process = std::process::id();
    let threads = threads.map_err(|error| no_thread(&error))?;
    let pool: &'static Pool = Box::leak(Box::new(Pool { process, threads }));
    let new = std::ptr::from_ref(pool).cast_mut();
    // If another thread was faster, its pool serves the calls after this one.
    let _ = POOL.compare_exchange(current, new, Ordering::AcqRel, Ordering::Acquire);
    Ok(&pool.threads)
}

/// Leaves threads to work that is abandoned; the next call starts others.
fn leave_pool(threads: &'static ThreadPool) {
    let current = POOL.load(Ordering::Acquire);
    // SAFETY: as in `pool`.
    if let Some(pool) = unsafe { current.as_ref() }
        && std::ptr::eq(&pool.threads, threads)
    {
        let _ = POOL.compare_exchange(current, null_mut(), Ordering::AcqRel, Ordering::Acquire);
    }
}

fn no_thread(error: &dyn std::error::Error) -> Error {
    Error::computation(format!("no thread can be started: {error}"))
}
