//! Who runs jobs, and what becomes of them: for sweeps and for studies.

mod batch;
mod report;
#[cfg(test)]
mod tests;
mod threads;
mod trials;

pub use batch::{Batch, Permit};
pub use report::{Halt, Report};
pub use threads::{Begin, LocalThreads};

use super::{Failure, Job};
use crate::record::RunRecord;
use crate::resume::Checkpoints;
use crate::store::{CheckpointError, Lease, StoreError};
use std::error::Error;
use std::sync::atomic::AtomicBool;

/// Who runs jobs: threads of this process, other processes, a device, a cluster.
///
/// `examples/processes.rs` is one that runs each job in a process of its own.
pub trait Backend: Sync {
    /// Runs the [jobs](Batch::jobs) of a batch, in their order as far as it can, one by one or many
    /// in one call.
    ///
    /// - It [claims](Batch::claim) each job. The permit that it gets is kept while the job runs,
    ///   and takes its end: a record ([`Permit::finish`]) or why there is none ([`Permit::fail`]).
    ///   A permit that is dropped before leaves the job to whoever claims it next.
    /// - Once [`Batch::is_over`] is true no more jobs are begun; `claim` grants none. Jobs under
    ///   way may go on to their end, and still count.
    /// - Once [`Batch::is_stopped`] is true, which implies the former, jobs under way are given up
    ///   within a second: they leave a [checkpoint](Batch::checkpoints) if they can, and their
    ///   permits are dropped. It is up to the backend to look, ten times a second or so.
    /// - It may be called again with the jobs that another process had begun and did not end.
    ///
    /// Another program gets a job as text: `toml::to_string(&job.scene())` is a scene file, which
    /// `phase run` takes, unless a study of stability chose a step above its limit. Child processes
    /// get the Ctrl-C of a terminal, too; one that the backend alone may end needs a process group
    /// of its own (`CommandExt::process_group(0)`).
    ///
    /// A panic ends the batch like an error, with its message in the report; one that should fail
    /// just its job is caught by the backend.
    ///
    /// # Errors
    /// Why no more jobs can be run. What was handed in before is kept and reported. A thread that
    /// finds out while others are at work calls [`Batch::halt`].
    fn run(&self, batch: &Batch<'_>) -> Result<(), BackendError>;
}

/// Why a backend cannot go on.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct BackendError(Box<dyn Error + Send + Sync>);

impl BackendError {
    /// An error for this reason: a message or another error.
    pub fn new(reason: impl Into<Box<dyn Error + Send + Sync>>) -> Self {
        Self(reason.into())
    }
}

/// Where the results of jobs are kept.
pub trait Results: Sync {
    /// Whether each result has a file of its own, so that one that cannot be written concerns its
    /// job alone.
    fn have_own_files(&self) -> bool;

    /// Takes the right to make a run. Without a lease no other process is let in.
    ///
    /// # Errors
    /// If the right cannot be taken.
    fn claim(&self, _: &Job) -> Result<Claim<Option<Lease>>, StoreError> {
        Ok(Claim::Granted(None))
    }

    /// Whether another process is making a run.
    fn is_made_elsewhere(&self, _: &Job) -> bool {
        false
    }

    /// Stores the result of a run that has ended.
    ///
    /// # Errors
    /// If it cannot be written.
    fn keep(&self, job: &Job, record: &RunRecord) -> Result<(), StoreError>;

    /// The checkpoints of a job.
    fn checkpoints(&self, job: &Job) -> Checkpoints;

    /// Notes a failure at once, so that it is not forgotten if the process is killed.
    ///
    /// # Errors
    /// If the note cannot be written.
    fn note_failure(&self, _: &Failure) -> Result<(), StoreError> {
        Ok(())
    }

    /// Notes all failures of a batch that has ended, in the order of the jobs.
    ///
    /// # Errors
    /// If the note cannot be written.
    fn note_failures(&self, _: &[Failure]) -> Result<(), StoreError> {
        Ok(())
    }
}

/// The answer to a wish to make a run.
#[derive(Debug)]
pub enum Claim<R> {
    /// The right to make it, given back when it is dropped.
    Granted(R),
    /// Another process is making it. The batch comes back to it at the end.
    Elsewhere,
    /// Another process has made it since the batch was planned.
    Made,
    /// It is not to be run: it has been claimed or handed in before, it is no job of the batch, the
    /// batch is over, or the right cannot be taken, which fails the job.
    Refused,
}

/// What is wished of a batch of jobs.
#[derive(Clone, Copy)]
pub struct Wishes<'a> {
    /// When set, no more runs are begun, and those under way end soon: without a result, but with a
    /// checkpoint, if the backend can leave one.
    pub stop: &'a AtomicBool,
    /// Whether runs that are there count, and go on from their checkpoints.
    pub resume: bool,
    /// Called for every event, from any thread.
    pub watch: &'a (dyn Fn(Event<'_>) + Sync),
}

/// All jobs to their ends, as far as they are not done, without a word.
impl Default for Wishes<'_> {
    fn default() -> Self {
        static NEVER: AtomicBool = AtomicBool::new(false);
        Self {
            stop: &NEVER,
            resume: true,
            watch: &|_| {},
        }
    }
}

/// Something that happened to a job. Events of different jobs come from different threads.
#[derive(Clone, Copy, Debug)]
pub enum Event<'a> {
    /// A job has begun.
    Started(&'a Job),
    /// Another process is making a job.
    Elsewhere(&'a Job),
    /// Another process has made a job since the batch was planned.
    Made(&'a Job),
    /// Only jobs are left that other processes are making, so many: the batch waits for them, and
    /// takes over those whose process ends early.
    Waiting(usize),
    /// A job goes on from its checkpoint, where it had done this much work.
    Resumed(&'a Job, u64),
    /// A job cannot go on from its checkpoint, and starts from the beginning.
    CheckpointRefused(&'a Job, &'a CheckpointError),
    /// A checkpoint of a job could not be written; an older one is still there.
    NoCheckpoint(&'a Job, &'a StoreError),
    /// A job did this much work since the last such event. A backend need not tell any.
    Advanced(&'a Job, u64),
    /// A job has ended, its result is kept, and this much of its work had not been told or was not
    /// needed.
    Finished(&'a Job, &'a RunRecord, u64),
    /// A job has failed.
    Failed(&'a Job, &'a Failure),
}
