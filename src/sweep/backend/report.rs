//! What became of the jobs of a batch.

use super::BackendError;
use crate::store::StoreError;
use crate::sweep::Failure;

/// What became of the jobs.
#[derive(Debug, Default)]
pub struct Report {
    /// Runs that ended and whose result is kept.
    pub finished: usize,
    /// How many of these went on from a checkpoint.
    pub resumed: usize,
    /// Jobs that failed, in the sweep's order.
    pub failures: Vec<Failure>,
    /// Jobs that another process has made meanwhile.
    pub elsewhere: usize,
    /// Jobs left to do: not finished, not failed, not made elsewhere.
    pub left: usize,
    /// Jobs of other shards that have no result yet.
    pub others: usize,
    /// Work of the finished runs, in the unit of their model.
    pub work: u64,
    /// Processor time of the finished runs (s).
    pub cpu_seconds: f64,
    /// Why no more jobs were begun, if it was not wished.
    pub halted: Option<Halt>,
    /// Why the failures could not be noted, if they could not.
    pub unnoted: Option<StoreError>,
}

/// Why no more jobs are begun.
#[derive(Debug, thiserror::Error)]
pub enum Halt {
    /// The disk is full, or the one file of all results cannot be written.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The backend cannot go on.
    #[error(transparent)]
    Backend(#[from] BackendError),
    /// The first jobs of a program all failed alike, so others would too.
    #[error(
        "the first {jobs} jobs, spread over the sweep, all failed alike, and no more were begun. \
         Mend the program and give the same command again; if nothing is to be mended, it makes \
         the other runs anyway"
    )]
    Alike {
        /// How many these are.
        jobs: usize,
    },
}

impl Report {
    /// What became of these jobs and the jobs of a later batch. What is left, and why no more jobs
    /// were begun, is what the later one says.
    #[must_use]
    pub fn and(self, later: Self) -> Self {
        let mut failures = self.failures;
        failures.extend(later.failures);
        Self {
            finished: self.finished + later.finished,
            resumed: self.resumed + later.resumed,
            elsewhere: self.elsewhere + later.elsewhere,
            work: self.work + later.work,
            cpu_seconds: self.cpu_seconds + later.cpu_seconds,
            failures,
            ..later
        }
    }
}
