//! Long work beside the interpreter: it is released while the work runs on a thread of its own, and looked in on for signals and for the
//! caller's progress.

use std::{
    ops::ControlFlow,
    sync::{
        Mutex, PoisonError,
        atomic::{AtomicBool, Ordering},
        mpsc::{RecvTimeoutError, sync_channel},
    },
    thread,
    time::Duration,
};

use chta::progress::{Progress, Step};
use pyo3::{exceptions::PyRuntimeError, prelude::*};
use rayon::ThreadPoolBuilder;

use crate::errors::{self, Class};

/// How often signals and the caller's progress are looked at.
const EVERY: Duration = Duration::from_millis(50);

/// As much as the main thread of a program has.
const STACK_BYTES: usize = 8 << 20;

/// Whether the work goes on, and how far it is.
#[derive(Default)]
pub(crate) struct Watch {
    cancelled: AtomicBool,
    last: Mutex<Option<(String, u64, Option<u64>)>>,
}

impl Watch {
    /// Whether the work is to end.
    pub(crate) fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }

    fn taken(&self) -> Option<(String, u64, Option<u64>)> {
        self.last.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

impl Progress for Watch {
    fn report(&self, step: &Step) -> ControlFlow<()> {
        let now = (step.stage.name().to_owned(), step.done, step.of);
        *self.last.lock().unwrap_or_else(PoisonError::into_inner) = Some(now);
        if self.is_cancelled() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// Does work without the interpreter. A signal, such as of Ctrl-C, ends it with the exception of its handler; so does a progress function
/// that returns `False`, with `Cancelled`, or raises.
pub(crate) fn watched<T: Send>(
    py: Python<'_>,
    threads: Option<usize>,
    progress: Option<&Py<PyAny>>,
    work: impl FnOnce(&Watch) -> T + Send,
) -> PyResult<T> {
    let pool = match threads {
        Some(0) => return Err(errors::input(py, "threads", 0, "a whole number of at least 1")),
        Some(count) => {
            let built = ThreadPoolBuilder::new().num_threads(count).build();
            Some(built.map_err(|error| PyRuntimeError::new_err(error.to_string()))?)
        }
        None => None,
    };
    let watch = Watch::default();
    let mut interrupted = None;
    let answer = py.detach(|| {
        thread::scope(|scope| {
            let (sender, receiver) = sync_channel(1);
            let watch = &watch;
            let run = move || {
                let answer = match pool {
                    Some(pool) => pool.install(|| work(watch)),
                    None => work(watch),
                };
                // The receiver waits for it.
                let _ = sender.send(answer);
            };
            if thread::Builder::new().name("chta".to_owned()).stack_size(STACK_BYTES).spawn_scoped(scope, run).is_err() {
                return None;
            }
            loop {
                match receiver.recv_timeout(EVERY) {
                    Ok(answer) => return Some(answer),
                    Err(RecvTimeoutError::Disconnected) => return None,
                    Err(RecvTimeoutError::Timeout) if interrupted.is_some() => {}
                    Err(RecvTimeoutError::Timeout) => {
                        if let Err(error) = Python::attach(|py| looked_in(py, watch, progress)) {
                            watch.cancelled.store(true, Ordering::Relaxed);
                            interrupted = Some(error);
                        }
                    }
                }
            }
        })
    });
    match (interrupted, answer) {
        (Some(error), _) => Err(error),
        (None, Some(answer)) => Ok(answer),
        (None, None) => Err(PyRuntimeError::new_err("the work ended without an answer; this is a defect of chta")),
    }
}

/// Looks at signals, and tells the caller how far the work is.
fn looked_in(py: Python<'_>, watch: &Watch, progress: Option<&Py<PyAny>>) -> PyResult<()> {
    py.check_signals()?;
    let (Some(progress), Some((stage, done, of))) = (progress, watch.taken()) else { return Ok(()) };
    let goes_on = progress.bind(py).call1((stage, done, of))?;
    let is_false = goes_on.extract::<bool>().is_ok_and(|goes_on| !goes_on);
    if is_false { Err(errors::plain(py, Class::Cancelled, "cancelled by the progress function")) } else { Ok(()) }
}
