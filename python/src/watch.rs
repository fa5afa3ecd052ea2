//! Work on a thread of its own, while Python goes on.

use crate::error::Failure;
use phase::sweep::work;
use pyo3::prelude::*;
use std::any::Any;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, Thread};
use std::time::Duration;

/// Time between two looks at signals and progress.
const BETWEEN_LOOKS: Duration = Duration::from_millis(100);

/// What work tells of itself, and what is wished of it.
#[derive(Default)]
pub(crate) struct Watch {
    stop: AtomicBool,
    progress: Mutex<Option<Progress>>,
}

/// How far work is.
struct Progress {
    /// The part that is done, from 0 to 1.
    share: f64,
    /// What is done, in words.
    text: String,
}

impl Watch {
    /// Set once the work is to end.
    pub(crate) fn stop(&self) -> &AtomicBool {
        &self.stop
    }

    /// Whether the work is to end.
    pub(crate) fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Tells how far the work is: a part from 0 to 1, and words.
    pub(crate) fn tell(&self, share: f64, text: String) {
        if let Ok(mut progress) = self.progress.lock() {
            *progress = Some(Progress { share, text });
        }
    }

    /// Shows what was told last.
    fn show(&self, py: Python<'_>, callback: Option<&Py<PyAny>>) -> PyResult<()> {
        let latest = self.progress.lock().ok().and_then(|mut it| it.take());
        match (callback, latest) {
            (Some(callback), Some(Progress { share, text })) => {
                callback.call1(py, (share, text)).map(drop)
            }
            _ => Ok(()),
        }
    }
}

/// Does work on a thread of its own. Meanwhile other threads of Python run, `progress` is called
/// with what the work tells, and Ctrl-C asks the work to stop and is raised when it has.
///
/// # Errors
/// Those of the work; what a signal raised; a bug, in place of a panic.
pub(crate) fn watched<T: Send>(
    py: Python<'_>,
    progress: Option<&Py<PyAny>>,
    work: impl FnOnce(&Watch) -> Result<T, Failure> + Send,
) -> PyResult<T> {
    let watch = Watch::default();
    let has_ended = AtomicBool::new(false);
    thread::scope(|scope| {
        let end = WakeAtEnd {
            has_ended: &has_ended,
            sleeper: thread::current(),
        };
        let watch = &watch;
        let worker = scope.spawn(move || {
            let _end = end;
            work(watch)
        });
        let mut raised = None;
        while !has_ended.load(Ordering::Acquire) {
            py.detach(|| thread::park_timeout(BETWEEN_LOOKS));
            let looked = py.check_signals().and_then(|()| watch.show(py, progress));
            if let Err(error) = looked {
                watch.stop.store(true, Ordering::Relaxed);
                raised.get_or_insert(error);
            }
        }
        if let (None, Err(error)) = (&raised, watch.show(py, progress)) {
            raised = Some(error);
        }
        let done = worker.join().unwrap_or_else(|panic| Err(bug(&*panic)));
        match (raised, done) {
            (None, done) => Ok(done?),
            (Some(error), Ok(_)) => Err(error),
            (Some(error), Err(failure)) => {
                error.set_cause(py, Some(failure.into()));
                Err(error)
            }
        }
    })
}

/// Wakes the thread that waits, also after a panic.
struct WakeAtEnd<'a> {
    has_ended: &'a AtomicBool,
    sleeper: Thread,
}

impl Drop for WakeAtEnd<'_> {
    fn drop(&mut self) {
        self.has_ended.store(true, Ordering::Release);
        self.sleeper.unpark();
    }
}

/// The number of threads that is asked for; by default one for each core.
pub(crate) fn threads_or_all(threads: Option<usize>) -> Result<usize, Failure> {
    match threads {
        Some(0) => Err(Failure::refused("`threads` is 0").help("use 1 or more")),
        Some(threads) => Ok(threads),
        None => Ok(work::default_workers()),
    }
}

/// The failure that a panic is.
fn bug(panic: &(dyn Any + Send)) -> Failure {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    let text = text.or_else(|| panic.downcast_ref::<&str>().copied());
    Failure::failed(format_args!(
        "a bug in phase: {}",
        text.unwrap_or("panicked")
    ))
}
