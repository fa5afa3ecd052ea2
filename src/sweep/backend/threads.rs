//! Threads of this process.

use super::{Backend, BackendError, Batch, Claim, Event, Permit};
use crate::resume::Ending;
use crate::run::{Progress, Run};
use crate::simulation::BuildError;
use crate::store::StoreError;
use crate::sweep::{Job, work};
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Makes the run of a job, at its start.
pub type Begin<'a> = &'a (dyn Fn(&Job) -> Result<Run, BuildError> + Sync);

/// Threads of this process, each of which runs one job at a time.
pub struct LocalThreads<'a> {
    count: usize,
    begin: Begin<'a>,
}

impl LocalThreads<'_> {
    /// That many threads.
    pub fn new(count: usize) -> Self {
        Self {
            count,
            begin: &|job| Run::new(&job.scene()),
        }
    }
}

impl<'a> LocalThreads<'a> {
    /// The same with runs that `begin` makes.
    pub fn beginning(self, begin: Begin<'a>) -> Self {
        Self { begin, ..self }
    }

    fn run_job(&self, batch: &Batch<'_>, permit: Permit<'_>) {
        let job = permit.job();
        batch.tell(Event::Started(job));
        let run = || (self.begin)(job).map(|run| drive(batch, job, resumed(batch, job, run)));
        match catch_unwind(AssertUnwindSafe(run)) {
            Ok(Ok(Ending::Finished(record))) => permit.finish(&record),
            Ok(Ok(Ending::Failed(reason))) => permit.fail(reason),
            Ok(Ok(Ending::Lost(error))) => batch.tell(Event::NoCheckpoint(job, &error)),
            Ok(Ok(Ending::Interrupted | Ending::EarlierKept)) => {}
            Ok(Err(error)) => permit.fail(error.to_string()),
            Err(panic) => permit.fail(format!("a bug in phase: {}", panic_message(&*panic))),
        }
    }
}

impl Backend for LocalThreads<'_> {
    fn run(&self, batch: &Batch<'_>) -> Result<(), BackendError> {
        let done = work::each(self.count, batch.jobs(), |job| {
            if let Claim::Granted(permit) = batch.claim(job) {
                self.run_job(batch, permit);
            }
        });
        done.map_err(|error| BackendError::new(format!("cannot start the workers: {error}")))
    }
}

/// The run of a job: at its checkpoint, if there is a good one and it may be used.
fn resumed(batch: &Batch<'_>, job: &Job, mut run: Run) -> Run {
    if batch.resumes() {
        match batch.checkpoints(job).restore(&mut run) {
            Ok(true) => batch.tell(Event::Resumed(job, job.work_at(&run.progress()))),
            Ok(false) => {}
            Err(error) => batch.tell(Event::CheckpointRefused(job, &error)),
        }
    }
    run
}

/// Advances a run to its end and tells its progress.
fn drive(batch: &Batch<'_>, job: &Job, run: Run) -> Ending {
    let (mut frame, mut work) = (run.progress().frame, job.work_at(&run.progress()));
    let mut control = |progress: Progress| {
        // A frame may take less than a millisecond: too often for people, and for locks.
        let frames = progress.frames;
        if progress.frame == frames || (progress.frame - frame) * 100 >= frames {
            let now = job.work_at(&progress);
            batch.tell(Event::Advanced(job, now.saturating_sub(work)));
            (frame, work) = (progress.frame, now);
        }
        match batch.is_stopped() {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    };
    let mut warn = |error: StoreError| batch.tell(Event::NoCheckpoint(job, &error));
    batch.checkpoints(job).run(run, &mut control, &mut warn)
}

/// What a panic said.
pub(crate) fn panic_message(panic: &(dyn std::any::Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied())
        .unwrap_or("panicked")
}
