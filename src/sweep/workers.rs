//! Workers that run jobs until all are done: for sweeps and for studies.

use super::{Failure, Job, work};
use crate::record::RunRecord;
use crate::resume::{self, Checkpoints};
use crate::run::{Progress, Run};
use crate::simulation::BuildError;
use crate::store::{CheckpointError, StoreError};
use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Where the results of jobs are kept.
pub(crate) trait Results: Sync {
    /// Whether each result has a file of its own, so that one that cannot be written concerns its
    /// job alone.
    fn have_own_files(&self) -> bool;

    /// Stores the result of a run that has ended.
    fn keep(&self, job: &Job, record: &RunRecord) -> Result<(), StoreError>;

    /// The checkpoints of a job.
    fn checkpoints(&self, job: &Job) -> Checkpoints;

    /// Notes all jobs that failed so far, in the order of the jobs.
    fn note_failures(&self, failures: &[Failure]) -> Result<(), StoreError>;
}

/// How jobs are run: number of workers, place of results, callbacks.
pub(crate) struct Workers<'a> {
    /// Where results go.
    pub(crate) results: &'a dyn Results,
    /// Number of simulations at the same time.
    pub(crate) count: usize,
    /// When set, runs under way end soon, with a checkpoint and without a result, and no more are
    /// started.
    pub(crate) stop: &'a AtomicBool,
    /// Whether runs go on from checkpoints that are there.
    pub(crate) resume: bool,
    /// Called for every event.
    pub(crate) watch: &'a (dyn Fn(Event<'_>) + Sync),
}

/// Something that happened to a job. Events of different jobs come from different threads.
#[derive(Clone, Copy, Debug)]
pub enum Event<'a> {
    /// A job has begun.
    Started(&'a Job),
    /// A job goes on from its checkpoint, where it had done this much work.
    Resumed(&'a Job, u64),
    /// A job cannot go on from its checkpoint, and starts from the beginning.
    CheckpointRefused(&'a Job, &'a CheckpointError),
    /// A checkpoint of a job could not be written; an older one is still there.
    NoCheckpoint(&'a Job, &'a StoreError),
    /// A job did this much work since the last such event.
    Advanced(&'a Job, u64),
    /// A job has ended, its result is kept, and this much of its work was not needed.
    Finished(&'a Job, &'a RunRecord, u64),
    /// A job has failed.
    Failed(&'a Job, &'a Failure),
}

/// What became of the jobs.
#[derive(Debug, Default)]
pub struct Report {
    /// Runs that ended and whose result is kept.
    pub finished: usize,
    /// How many of these went on from a checkpoint.
    pub resumed: usize,
    /// Jobs that failed, in the sweep's order.
    pub failures: Vec<Failure>,
    /// Jobs left to do, neither finished nor failed.
    pub left: usize,
    /// Work of the finished runs, in the unit of their model.
    pub work: u64,
    /// Processor time of the finished runs (s).
    pub cpu_seconds: f64,
    /// Why no more jobs were started: the disk is full, or the one file of all results cannot be
    /// written.
    pub halted: Option<StoreError>,
    /// Why the failures could not be noted, if they could not.
    pub unnoted: Option<StoreError>,
}

/// Makes the run of a job, at its start.
pub type Begin<'a> = &'a (dyn Fn(&Job) -> Result<Run, BuildError> + Sync);

impl Workers<'_> {
    /// Runs jobs, each as `begin` makes it or from its checkpoint, and keeps each result as soon as
    /// it is there.
    ///
    /// A job that fails does not stop the others; one whose result cannot be written has failed. A
    /// full disk ends the work: runs under way may end, and no more are started.
    ///
    /// # Errors
    /// If the system gives no threads.
    pub(crate) fn run(
        &self,
        jobs: &[&Job],
        begin: Begin<'_>,
    ) -> Result<Report, rayon::ThreadPoolBuildError> {
        let mut pending: Vec<(usize, &Job)> = jobs.iter().copied().enumerate().collect();
        // The longest first, so that no worker begins one when the others are done. Those of one
        // length stay in the sweep's order.
        pending.sort_by_key(|(_, job)| Reverse(job.work()));
        let tally = Mutex::new(Tally::default());
        work::each(self.count, &pending, |&(position, job)| {
            if self.stop.load(Ordering::Relaxed) || lock(&tally).halted.is_some() {
                return;
            }
            match self.job(job, begin) {
                Ending::Finished(record, resumed) => lock(&tally).add(&record, resumed),
                Ending::Failed(failure) => self.fail(&mut lock(&tally), position, failure),
                Ending::NotStored(error) => lock(&tally).halted = Some(error),
                Ending::Interrupted => {}
            }
        })?;
        let tally = tally.into_inner().unwrap_or_else(PoisonError::into_inner);
        let failures: Vec<_> = tally.failures.into_values().collect();
        Ok(Report {
            finished: tally.finished,
            resumed: tally.resumed,
            left: pending.len() - tally.finished - failures.len(),
            failures,
            work: tally.work,
            cpu_seconds: tally.cpu_seconds,
            halted: tally.halted,
            unnoted: tally.unnoted,
        })
    }

    /// Runs one job and keeps its result.
    fn job(&self, job: &Job, begin: Begin<'_>) -> Ending {
        (self.watch)(Event::Started(job));
        let fail = |reason: String| {
            let failure = Failure::new(job, reason);
            (self.watch)(Event::Failed(job, &failure));
            Ending::Failed(failure)
        };
        let run = || begin(job).map(|run| self.drive(job, self.resumed(job, run)));
        let (record, resumed, left) = match catch_unwind(AssertUnwindSafe(run)) {
            Ok(Ok((resume::Ending::Finished(record), resumed, left))) => (record, resumed, left),
            Ok(Ok((resume::Ending::Lost(error), ..))) => {
                (self.watch)(Event::NoCheckpoint(job, &error));
                return Ending::Interrupted;
            }
            Ok(Ok(_)) => return Ending::Interrupted,
            Ok(Err(error)) => return fail(error.to_string()),
            Err(panic) => return fail(format!("a bug in phase: {}", panic_message(&*panic))),
        };
        match self.results.keep(job, &record) {
            Ok(()) => {
                // If it cannot be removed now, the next run of the sweep removes it.
                let _ = self.results.checkpoints(job).remove();
                (self.watch)(Event::Finished(job, &record, left));
                Ending::Finished(record, resumed)
            }
            Err(error) if self.concerns_all_jobs(&error) => Ending::NotStored(error),
            Err(error) => fail(error.to_string()),
        }
    }

    /// Whether no other result could be stored either.
    fn concerns_all_jobs(&self, error: &StoreError) -> bool {
        let is_of_content = matches!(error, StoreError::Content { .. });
        error.concerns_all_files() || !(self.results.have_own_files() || is_of_content)
    }

    /// The run of a job: at its checkpoint, if there is a good one and it may be used.
    fn resumed(&self, job: &Job, mut run: Run) -> Run {
        if self.resume {
            match self.results.checkpoints(job).restore(&mut run) {
                Ok(true) => (self.watch)(Event::Resumed(job, job.work_at(&run.progress()))),
                Ok(false) => {}
                Err(error) => (self.watch)(Event::CheckpointRefused(job, &error)),
            }
        }
        run
    }

    /// Advances a run to its end and reports its progress. Returns its ending, whether it went on
    /// from a checkpoint, and the work that was not reported.
    fn drive(&self, job: &Job, run: Run) -> (resume::Ending, bool, u64) {
        let first = run.progress().frame;
        let (mut frame, mut work) = (first, job.work_at(&run.progress()));
        let mut control = |progress: Progress| {
            // A frame may take less than a millisecond: too often for people, and for locks.
            let frames = progress.frames;
            if progress.frame == frames || (progress.frame - frame) * 100 >= frames {
                let now = job.work_at(&progress);
                (self.watch)(Event::Advanced(job, now.saturating_sub(work)));
                (frame, work) = (progress.frame, now);
            }
            if self.stop.load(Ordering::Relaxed) {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        let mut warn = |error: StoreError| (self.watch)(Event::NoCheckpoint(job, &error));
        let ending = self
            .results
            .checkpoints(job)
            .run(run, &mut control, &mut warn);
        (ending, first > 0, job.work().saturating_sub(work))
    }

    /// Notes a failure, in the file too, so that nothing is forgotten if the sweep is killed.
    fn fail(&self, tally: &mut Tally, position: usize, failure: Failure) {
        tally.failures.insert(position, failure);
        let failures: Vec<_> = tally.failures.values().cloned().collect();
        tally.unnoted = self.results.note_failures(&failures).err();
        if tally
            .unnoted
            .as_ref()
            .is_some_and(StoreError::concerns_all_files)
        {
            tally.halted = tally.unnoted.take();
        }
    }
}

/// How one job ended.
enum Ending {
    /// With its record, and whether it went on from a checkpoint.
    Finished(Box<RunRecord>, bool),
    Failed(Failure),
    NotStored(StoreError),
    Interrupted,
}

/// What the workers add up together.
#[derive(Default)]
struct Tally {
    finished: usize,
    resumed: usize,
    /// Failures by position of their jobs among the pending ones.
    failures: BTreeMap<usize, Failure>,
    work: u64,
    cpu_seconds: f64,
    halted: Option<StoreError>,
    unnoted: Option<StoreError>,
}

impl Tally {
    fn add(&mut self, record: &RunRecord, resumed: bool) {
        self.finished += 1;
        self.resumed += usize::from(resumed);
        self.work += record.work;
        self.cpu_seconds += record.cpu_seconds;
    }
}

/// Locks the tally; a panic elsewhere leaves only whole entries in it.
fn lock(tally: &Mutex<Tally>) -> MutexGuard<'_, Tally> {
    tally.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What a panic said.
pub(crate) fn panic_message(panic: &(dyn std::any::Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied())
        .unwrap_or("panicked")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::Sweep;
    use std::io::{Error, ErrorKind};
    use std::path::{Path, PathBuf};
    use std::time::Duration;

    /// Results of which seed 2 cannot be written, for this reason.
    struct Faulty {
        folder: PathBuf,
        kind: ErrorKind,
        have_own_files: bool,
    }

    impl Results for Faulty {
        fn have_own_files(&self) -> bool {
            self.have_own_files
        }

        fn keep(&self, job: &Job, _: &RunRecord) -> Result<(), StoreError> {
            let path = self.folder.join(&job.id);
            match (job.seed, self.kind) {
                (2, ErrorKind::StorageFull | ErrorKind::FileTooLarge) => {
                    let source = Error::from(self.kind);
                    Err(StoreError::DiskFull { path, source })
                }
                (2, kind) => Err(StoreError::Write {
                    path,
                    source: kind.into(),
                }),
                _ => Ok(()),
            }
        }

        fn checkpoints(&self, job: &Job) -> Checkpoints {
            Checkpoints::beside(&self.folder.join(&job.id), Duration::from_mins(1))
        }

        fn note_failures(&self, _: &[Failure]) -> Result<(), StoreError> {
            match self.kind {
                ErrorKind::IsADirectory => Err(StoreError::Write {
                    path: Path::new("failed.csv").to_owned(),
                    source: ErrorKind::IsADirectory.into(),
                }),
                _ => Ok(()),
            }
        }
    }

    /// What became of four jobs with seeds 1 to 4, one after the other.
    fn report(kind: ErrorKind, have_own_files: bool) -> Report {
        let place = tempfile::tempdir().unwrap();
        let sweep = Sweep {
            seeds: vec![1, 2, 3, 4],
            ..Sweep::of_falling_sphere()
        };
        let jobs = sweep.jobs().unwrap();
        let workers = Workers {
            results: &Faulty {
                folder: place.path().to_owned(),
                kind,
                have_own_files,
            },
            count: 1,
            stop: &AtomicBool::new(false),
            resume: true,
            watch: &|_| {},
        };
        let jobs: Vec<&Job> = jobs.iter().collect();
        workers.run(&jobs, &|job| Run::new(&job.scene)).unwrap()
    }

    #[test]
    fn a_result_that_cannot_be_written_fails_its_job() {
        for kind in [
            ErrorKind::PermissionDenied,
            ErrorKind::InvalidFilename,
            ErrorKind::FileTooLarge,
            ErrorKind::IsADirectory,
        ] {
            let report = report(kind, true);
            assert_eq!((report.finished, report.left), (3, 0), "{kind}");
            assert_eq!(report.failures.len(), 1);
            assert_eq!(report.failures[0].seed, 2);
            assert!(report.halted.is_none());
            // That the failure could not be noted stops nothing.
            assert_eq!(report.unnoted.is_some(), kind == ErrorKind::IsADirectory);
        }
    }

    #[test]
    fn a_full_disk_or_one_table_of_all_ends_the_work() {
        for (kind, have_own_files) in [
            (ErrorKind::StorageFull, true),
            (ErrorKind::PermissionDenied, false),
        ] {
            let report = report(kind, have_own_files);
            assert_eq!((report.finished, report.left), (1, 3), "{kind}");
            assert!(report.halted.is_some() && report.failures.is_empty());
        }
    }
}
