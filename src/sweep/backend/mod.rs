//! Who runs jobs, and what becomes of them: for sweeps and for studies.

mod threads;

pub use threads::{Begin, LocalThreads};

use super::{Failure, Job};
use crate::record::RunRecord;
use crate::resume::Checkpoints;
use crate::store::{CheckpointError, Lease, StoreError};
use std::cmp::Reverse;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Who runs jobs: threads of this process, other processes, a device, a cluster.
pub trait Backend: Sync {
    /// Runs the jobs of a batch, in their order as far as it can. It [claims](Batch::claim) each,
    /// and hands it in as soon as it has ended ([`Batch::finish`] or [`Batch::fail`]). Once the
    /// batch [is over](Batch::is_over), no more are begun, and those under way may be given up.
    ///
    /// # Errors
    /// If no job can be run at all.
    fn run(&self, batch: &Batch<'_>) -> Result<(), BackendError>;
}

/// Why a backend cannot run any job.
#[derive(Debug, thiserror::Error)]
#[error("cannot start the workers: {0}")]
pub struct BackendError(#[from] pub Box<dyn std::error::Error + Send + Sync>);

/// Where the results of jobs are kept.
pub trait Results: Sync {
    /// Whether each result has a file of its own, so that one that cannot be written concerns its
    /// job alone.
    fn have_own_files(&self) -> bool;

    /// Takes the right to make a run: none if another process has it, or has made the run
    /// meanwhile.
    ///
    /// # Errors
    /// If the right cannot be taken.
    fn claim(&self, job: &Job) -> Result<Option<Claim>, StoreError>;

    /// Stores the result of a run that has ended.
    ///
    /// # Errors
    /// If it cannot be written.
    fn keep(&self, job: &Job, record: &RunRecord) -> Result<(), StoreError>;

    /// The checkpoints of a job.
    fn checkpoints(&self, job: &Job) -> Checkpoints;

    /// Notes all jobs that failed so far, in the order of the jobs.
    ///
    /// # Errors
    /// If the note cannot be written.
    fn note_failures(&self, failures: &[&Failure]) -> Result<(), StoreError>;
}

/// The right to make a run, given back when it is dropped.
#[derive(Debug)]
pub enum Claim {
    /// Against other processes.
    Lease(Lease),
    /// No other process is let in.
    Alone,
}

/// What is wished of a batch of jobs.
#[derive(Clone, Copy)]
pub struct Wishes<'a> {
    /// When set, runs under way end soon, with a checkpoint and without a result, and no more are
    /// begun.
    pub stop: &'a AtomicBool,
    /// Whether runs that are there count, and go on from their checkpoints.
    pub resume: bool,
    /// Called for every event, from any thread.
    pub watch: &'a (dyn Fn(Event<'_>) + Sync),
}

/// Something that happened to a job. Events of different jobs come from different threads.
#[derive(Clone, Copy, Debug)]
pub enum Event<'a> {
    /// A job has begun.
    Started(&'a Job),
    /// Another process makes a job, or has made it meanwhile.
    Elsewhere(&'a Job),
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
    /// Jobs that another process is making, or has made meanwhile.
    pub elsewhere: usize,
    /// Jobs left to do: not finished, not failed, not elsewhere.
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

impl Report {
    /// What became of these jobs and the jobs of a later batch. What is left, and why no more jobs
    /// were started, is what the later one says.
    #[must_use]
    pub fn and(self, later: Self) -> Self {
        let mut failures = self.failures;
        failures.extend(later.failures);
        Self {
            finished: self.finished + later.finished,
            resumed: self.resumed + later.resumed,
            work: self.work + later.work,
            cpu_seconds: self.cpu_seconds + later.cpu_seconds,
            failures,
            ..later
        }
    }
}

/// Time between two notes of failures.
const BETWEEN_NOTES: Duration = Duration::from_secs(1);

/// Jobs that a [`Backend`] is to run, and what has become of them. One that fails does not stop the
/// others; one whose result cannot be written has failed. A full disk ends the batch.
pub struct Batch<'a> {
    /// The longest first, so that no worker begins one when the others are done. Those of one
    /// length are in the order of the sweep.
    jobs: Vec<&'a Job>,
    /// Places in the order of the sweep, by identity.
    places: HashMap<&'a str, usize>,
    results: &'a dyn Results,
    wishes: Wishes<'a>,
    tally: Mutex<Tally>,
}

/// What is added up of the jobs that have ended.
#[derive(Default)]
struct Tally {
    /// Jobs that were handed in, or are made elsewhere, by identity.
    settled: HashSet<String>,
    finished: usize,
    resumed: usize,
    elsewhere: usize,
    /// Failures by places of their jobs.
    failures: BTreeMap<usize, Failure>,
    /// When the failures were noted last.
    noted: Option<Instant>,
    work: u64,
    cpu_seconds: f64,
    halted: Option<StoreError>,
    unnoted: Option<StoreError>,
}

impl<'a> Batch<'a> {
    /// A batch of jobs, in the order of the sweep, whose results are kept there.
    pub fn new(
        jobs: impl IntoIterator<Item = &'a Job>,
        results: &'a dyn Results,
        wishes: Wishes<'a>,
    ) -> Self {
        let mut jobs: Vec<&Job> = jobs.into_iter().collect();
        let ids = jobs.iter().map(|job| job.id.as_str());
        let places = ids.enumerate().map(|(place, id)| (id, place)).collect();
        jobs.sort_by_key(|job| Reverse(job.work()));
        Self {
            jobs,
            places,
            results,
            wishes,
            tally: Mutex::default(),
        }
    }

    /// The jobs, in the order in which they are best begun.
    pub fn jobs(&self) -> &[&'a Job] {
        &self.jobs
    }

    /// Whether no more jobs are to be begun.
    pub fn is_over(&self) -> bool {
        self.is_stopped() || self.tally().halted.is_some()
    }

    /// Whether runs under way are to end.
    pub fn is_stopped(&self) -> bool {
        self.wishes.stop.load(Ordering::Relaxed)
    }

    /// Whether runs go on from checkpoints that are there.
    pub fn resumes(&self) -> bool {
        self.wishes.resume
    }

    /// The checkpoints of a job.
    pub fn checkpoints(&self, job: &Job) -> Checkpoints {
        self.results.checkpoints(job)
    }

    /// Takes the right to run a job, to be kept until it is handed in. None if it is not to be run:
    /// another process has it, or the right cannot be taken, which fails the job.
    pub fn claim(&self, job: &Job) -> Option<Claim> {
        match self.results.claim(job) {
            Ok(Some(claim)) => Some(claim),
            Ok(None) => {
                if self.settle(job) {
                    self.tally().elsewhere += 1;
                    self.tell(Event::Elsewhere(job));
                }
                None
            }
            Err(error) if self.concerns_all_jobs(&error) => {
                self.tally().halted = Some(error);
                None
            }
            Err(error) => {
                self.fail(job, error.to_string());
                None
            }
        }
    }

    /// Tells of something that happened to a job, but for its end.
    pub fn tell(&self, event: Event<'_>) {
        (self.wishes.watch)(event);
    }

    /// Hands in the record of a job that has ended. `is_resumed` says whether it went on from a
    /// checkpoint, and `left` how much of its work has not been [told](Event::Advanced). Each job
    /// is handed in once: nothing that follows counts.
    pub fn finish(&self, job: &Job, record: &RunRecord, is_resumed: bool, left: u64) {
        if !self.settle(job) {
            return;
        }
        match self.results.keep(job, record) {
            Ok(()) => {
                // If it cannot be removed now, the next run of the sweep removes it.
                let _ = self.checkpoints(job).remove();
                self.tell(Event::Finished(job, record, left));
                let mut tally = self.tally();
                tally.finished += 1;
                tally.resumed += usize::from(is_resumed);
                tally.work += record.work;
                tally.cpu_seconds += record.cpu_seconds;
            }
            Err(error) if self.concerns_all_jobs(&error) => self.tally().halted = Some(error),
            Err(error) => self.note_failure(job, error.to_string()),
        }
    }

    /// Hands in a job that has failed, and why. Each job is handed in once: nothing that follows
    /// counts.
    pub fn fail(&self, job: &Job, reason: impl Into<String>) {
        if self.settle(job) {
            self.note_failure(job, reason.into());
        }
    }

    /// Whether a job has not been settled before; it is by now.
    fn settle(&self, job: &Job) -> bool {
        self.tally().settled.insert(job.id.clone())
    }

    fn note_failure(&self, job: &Job, reason: String) {
        let failure = Failure::new(job, reason);
        self.tell(Event::Failed(job, &failure));
        let place = self.places.get(job.id.as_str());
        let mut tally = self.tally();
        tally.failures.insert(place.copied().unwrap_or(0), failure);
        // So that nothing is forgotten if the process is killed, and not too often.
        if tally.noted.is_none_or(|it| it.elapsed() >= BETWEEN_NOTES) {
            self.note_failures(&mut tally);
        }
    }

    /// Has a backend run the jobs, and says what became of them.
    ///
    /// # Errors
    /// Those of the backend.
    pub fn run_on(self, backend: &dyn Backend) -> Result<Report, BackendError> {
        backend.run(&self)?;
        let mut tally = self.tally();
        if !tally.failures.is_empty() {
            self.note_failures(&mut tally);
        }
        let tally = std::mem::take(&mut *tally);
        let failures: Vec<_> = tally.failures.into_values().collect();
        Ok(Report {
            finished: tally.finished,
            resumed: tally.resumed,
            elsewhere: tally.elsewhere,
            left: self.jobs.len() - tally.finished - failures.len() - tally.elsewhere,
            failures,
            work: tally.work,
            cpu_seconds: tally.cpu_seconds,
            halted: tally.halted,
            unnoted: tally.unnoted,
        })
    }

    /// Whether no other result could be stored either.
    fn concerns_all_jobs(&self, error: &StoreError) -> bool {
        let is_of_content = matches!(error, StoreError::Content { .. });
        error.concerns_all_files() || !(self.results.have_own_files() || is_of_content)
    }

    fn note_failures(&self, tally: &mut Tally) {
        let failures: Vec<&Failure> = tally.failures.values().collect();
        let noted = self.results.note_failures(&failures);
        tally.noted = Some(Instant::now());
        tally.unnoted = None;
        match noted.err() {
            Some(error) if error.concerns_all_files() => tally.halted = Some(error),
            other => tally.unnoted = other,
        }
    }

    /// Locks the tally; a panic elsewhere leaves only whole entries in it.
    fn tally(&self) -> MutexGuard<'_, Tally> {
        self.tally.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run;
    use crate::sweep::Sweep;
    use std::io::{Error, ErrorKind};
    use std::ops::ControlFlow;
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

        fn claim(&self, _: &Job) -> Result<Option<Claim>, StoreError> {
            Ok(Some(Claim::Alone))
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

        fn note_failures(&self, _: &[&Failure]) -> Result<(), StoreError> {
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
        let results = Faulty {
            folder: place.path().to_owned(),
            kind,
            have_own_files,
        };
        let wishes = Wishes {
            stop: &AtomicBool::new(false),
            resume: true,
            watch: &|_| {},
        };
        let batch = Batch::new(&jobs, &results, wishes);
        batch.run_on(&LocalThreads::new(1)).unwrap()
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

    /// A backend that hands every job in as failed, and then its record.
    struct Twice;

    impl Backend for Twice {
        fn run(&self, batch: &Batch<'_>) -> Result<(), BackendError> {
            for job in batch.jobs() {
                let record = run::run(&job.scene, &mut |_| ControlFlow::Continue(()));
                batch.fail(job, "first");
                batch.finish(job, &record.unwrap(), false, 0);
            }
            Ok(())
        }
    }

    /// Symptom: a job that failed and was handed in again made the number of those left overflow.
    #[test]
    fn a_job_is_handed_in_once() {
        let place = tempfile::tempdir().unwrap();
        let sweep = Sweep::of_falling_sphere();
        let jobs = sweep.jobs().unwrap();
        let results = Faulty {
            folder: place.path().to_owned(),
            kind: ErrorKind::Other,
            have_own_files: true,
        };
        let wishes = Wishes {
            stop: &AtomicBool::new(false),
            resume: true,
            watch: &|_| {},
        };
        let report = Batch::new(&jobs, &results, wishes).run_on(&Twice).unwrap();
        assert_eq!((report.failures.len(), report.left), (jobs.len(), 0));
        assert_eq!(report.finished, 0);
        assert!(report.failures.iter().all(|it| it.reason == "first"));
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
