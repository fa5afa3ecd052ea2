//! A batch: jobs, who has claimed which, and what has become of them.

use super::threads::panic_message;
use super::trials::Trials;
use super::{Backend, BackendError, Claim, Event, Halt, Report, Results, Wishes};
use crate::record::RunRecord;
use crate::resume::Checkpoints;
use crate::store::{Lease, StoreError};
use crate::sweep::{Failure, Job};
use std::cmp::Reverse;
use std::collections::{BTreeMap, HashMap};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::Ordering;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// Shortest time between two looks at what other processes are making. Where files are slow, it is
/// ten times as long as a look.
const BETWEEN_LOOKS: Duration = Duration::from_millis(100);

/// Jobs that a [`Backend`] is to run, and what has become of them. One that fails does not stop the
/// others; one whose result cannot be written has failed. A full disk ends the batch.
pub struct Batch<'a> {
    /// In the order of the sweep.
    all: Vec<&'a Job>,
    /// Places in that order, by identity.
    places: HashMap<&'a str, usize>,
    /// Those to be run, the longest first, so that no worker begins one when the others are done.
    /// Those of one length are in the order of the sweep.
    jobs: Vec<&'a Job>,
    /// Those of them that decide whether others are begun.
    trials: Option<Trials>,
    results: &'a dyn Results,
    wishes: Wishes<'a>,
    tally: Mutex<Tally>,
}

/// The right to run a job, which takes its end. Dropped before, it leaves the job to others.
pub struct Permit<'b> {
    batch: &'b Batch<'b>,
    job: &'b Job,
    place: usize,
    /// Given back after the result is kept.
    _lease: Option<Lease>,
}

/// What is added up of the jobs.
#[derive(Default)]
struct Tally {
    /// By place.
    progress: Vec<JobProgress>,
    finished: usize,
    resumed: usize,
    /// Jobs that other processes have made.
    elsewhere: usize,
    /// Failures by places of their jobs.
    failures: BTreeMap<usize, Failure>,
    work: u64,
    cpu_seconds: f64,
    halted: Option<Halt>,
}

/// How far a job is.
#[derive(Clone, Default)]
struct JobProgress {
    state: JobState,
    is_resumed: bool,
    /// Work that has been told.
    told: u64,
}

#[derive(Clone, Copy, Default, PartialEq)]
enum JobState {
    /// Nobody has claimed it, or who did has given it back.
    #[default]
    Open,
    /// It is made here.
    Claimed,
    /// Another process was making it when it was claimed.
    Elsewhere,
    /// It has been handed in, or made elsewhere.
    Settled,
}

impl<'a> Batch<'a> {
    /// A batch of jobs, in the order of the sweep, whose results are kept there.
    pub fn new(
        jobs: impl IntoIterator<Item = &'a Job>,
        results: &'a dyn Results,
        wishes: Wishes<'a>,
    ) -> Self {
        let all: Vec<&Job> = jobs.into_iter().collect();
        let ids = all.iter().map(|job| job.id.as_str());
        let places = ids.enumerate().map(|(place, id)| (id, place)).collect();
        let mut jobs = all.clone();
        jobs.sort_by_cached_key(|job| Reverse(job.work()));
        let tally = Tally {
            progress: vec![JobProgress::default(); all.len()],
            ..Tally::default()
        };
        Self {
            all,
            places,
            jobs,
            trials: None,
            results,
            wishes,
            tally: Mutex::new(tally),
        }
    }

    /// The same with a few jobs first, spread over the sweep. If all of them fail alike, in a way
    /// that is not known, and no other job has ended well, no more are begun.
    pub(crate) fn trying_first(mut self, known: Vec<Failure>) -> Self {
        self.trials = Trials::among(&self.all, known);
        if let Some(trials) = &self.trials {
            self.jobs = trials.first(&self.all, &self.jobs);
        }
        self
    }

    /// The jobs, in the order in which they are best begun.
    pub fn jobs(&self) -> &[&'a Job] {
        &self.jobs
    }

    /// Whether no more jobs are to be begun: the batch is stopped or halted.
    pub fn is_over(&self) -> bool {
        self.is_stopped() || self.tally().halted.is_some()
    }

    /// Whether runs under way are to end now, without a result (see [`Wishes::stop`]).
    pub fn is_stopped(&self) -> bool {
        self.wishes.stop.load(Ordering::Relaxed)
    }

    /// Ends the batch early: no more jobs are begun, and the [report](Report::halted) says why. For
    /// what concerns all jobs, such as a cluster that does not answer.
    pub fn halt(&self, reason: impl Into<Halt>) {
        self.tally().halted.get_or_insert(reason.into());
    }

    /// Whether runs go on from checkpoints that are there.
    pub fn resumes(&self) -> bool {
        self.wishes.resume
    }

    /// Where a job leaves checkpoints, and how often.
    pub fn checkpoints(&self, job: &Job) -> Checkpoints {
        self.results.checkpoints(job)
    }

    /// Takes the right to run a job.
    pub fn claim<'b>(&'b self, job: &'b Job) -> Claim<Permit<'b>> {
        let Some(place) = self.places.get(job.id.as_str()).copied() else {
            return Claim::Refused;
        };
        let permit = |lease: Option<Lease>| Permit {
            batch: self,
            job,
            place,
            _lease: lease,
        };
        // Marked before the lease is taken: a lease keeps out threads of this process, too.
        if self.is_over() || !self.mark(place, JobState::Open, JobState::Claimed) {
            return Claim::Refused;
        }
        match self.results.claim(job) {
            Ok(Claim::Granted(lease)) => return Claim::Granted(permit(lease)),
            Ok(Claim::Elsewhere) => {
                self.mark(place, JobState::Claimed, JobState::Elsewhere);
                self.tell(Event::Elsewhere(job));
                return Claim::Elsewhere;
            }
            Ok(Claim::Made) => {
                self.mark(place, JobState::Claimed, JobState::Settled);
                self.tally().elsewhere += 1;
                self.tell(Event::Made(job));
                return Claim::Made;
            }
            Ok(Claim::Refused) => drop(permit(None)),
            Err(error) => permit(None).fail_to_store(error),
        }
        Claim::Refused
    }

    /// Tells of something that happened to a job, but for its end.
    pub fn tell(&self, event: Event<'_>) {
        if let Event::Resumed(job, work) | Event::Advanced(job, work) = event
            && let Some(place) = self.places.get(job.id.as_str())
        {
            let mut tally = self.tally();
            let progress = &mut tally.progress[*place];
            progress.told += work;
            progress.is_resumed |= matches!(event, Event::Resumed(..));
        }
        (self.wishes.watch)(event);
    }

    /// Whether a job was in one state; it is in the other now.
    fn mark(&self, place: usize, from: JobState, to: JobState) -> bool {
        let state = &mut self.tally().progress[place].state;
        let was = *state == from;
        if was {
            *state = to;
        }
        was
    }

    /// Has a backend run the jobs, and says what became of them. Jobs that other processes are
    /// making are waited for, and run if their processes end early.
    pub fn run_on(mut self, backend: &dyn Backend) -> Report {
        while !self.jobs.is_empty() {
            let ran = catch_unwind(AssertUnwindSafe(|| backend.run(&self)));
            let ran = ran.unwrap_or_else(|panic| {
                let message = panic_message(&*panic);
                Err(BackendError::new(format!(
                    "a bug in the backend: {message}"
                )))
            });
            if let Err(error) = ran {
                self.halt(error);
            }
            self.jobs = self.left_by_others();
        }
        self.report()
    }

    /// Waits for jobs that other processes are making. Gives those that no process is making any
    /// more, made or not, and none if there are none or the batch is over.
    fn left_by_others(&self) -> Vec<&'a Job> {
        let is_elsewhere = |job: &&Job| {
            let place = self.places[job.id.as_str()];
            self.tally().progress[place].state == JobState::Elsewhere
        };
        let elsewhere: Vec<&Job> = self.all.iter().copied().filter(is_elsewhere).collect();
        if !elsewhere.is_empty() && !self.is_over() {
            self.tell(Event::Waiting(elsewhere.len()));
        }
        while !elsewhere.is_empty() && !self.is_over() {
            let begun = Instant::now();
            let free = elsewhere.iter().copied();
            let free = free.filter(|job| !self.results.is_made_elsewhere(job));
            let free: Vec<&Job> = free.collect();
            if !free.is_empty() {
                for job in &free {
                    self.mark(
                        self.places[job.id.as_str()],
                        JobState::Elsewhere,
                        JobState::Open,
                    );
                }
                return free;
            }
            // Looks at many leases on a slow disk take a tenth of the time.
            let next = begun + BETWEEN_LOOKS.max(11 * begun.elapsed());
            while !self.is_over() && Instant::now() < next {
                thread::sleep(BETWEEN_LOOKS);
            }
        }
        Vec::new()
    }

    fn report(self) -> Report {
        let mut tally = self
            .tally
            .into_inner()
            .unwrap_or_else(PoisonError::into_inner);
        let failures: Vec<Failure> = std::mem::take(&mut tally.failures).into_values().collect();
        let unnoted = match self.results.note_failures(&failures).err() {
            Some(error) if error.concerns_all_files() => {
                tally.halted.get_or_insert(error.into());
                None
            }
            other => other,
        };
        Report {
            finished: tally.finished,
            resumed: tally.resumed,
            elsewhere: tally.elsewhere,
            left: self.all.len() - tally.finished - failures.len() - tally.elsewhere,
            failures,
            others: 0,
            work: tally.work,
            cpu_seconds: tally.cpu_seconds,
            halted: tally.halted,
            unnoted,
        }
    }

    /// Whether no other result could be stored either.
    fn concerns_all_jobs(&self, error: &StoreError) -> bool {
        let is_of_content = matches!(error, StoreError::Content { .. });
        error.concerns_all_files() || !(self.results.have_own_files() || is_of_content)
    }

    /// Locks the tally; a panic elsewhere leaves only whole entries in it.
    fn tally(&self) -> MutexGuard<'_, Tally> {
        self.tally.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<'b> Permit<'b> {
    /// The job.
    pub fn job(&self) -> &'b Job {
        self.job
    }

    /// Hands in the record of the job. One of another run is refused, and the job has failed.
    pub fn finish(self, record: &RunRecord) {
        let found = record.scene.identity();
        // A study that times steps gives one scene several jobs, each with an id of its own.
        if found != self.job.scene().identity() {
            let id = &self.job.id;
            return self.fail(format!(
                "a bug in the backend: for job {id} it handed in the record of run {found}"
            ));
        }
        if let Err(error) = self.batch.results.keep(self.job, record) {
            return self.fail_to_store(error);
        }
        // If it cannot be removed now, the next run of the sweep removes it.
        let _ = self.batch.checkpoints(self.job).remove();
        let progress = {
            let mut tally = self.batch.tally();
            let progress = &mut tally.progress[self.place];
            progress.state = JobState::Settled;
            let progress = progress.clone();
            tally.finished += 1;
            tally.resumed += usize::from(progress.is_resumed);
            tally.work += record.work;
            tally.cpu_seconds += record.cpu_seconds;
            progress
        };
        let left = self.job.work().saturating_sub(progress.told);
        self.batch.tell(Event::Finished(self.job, record, left));
    }

    /// Hands in that the job has failed, and why.
    pub fn fail(self, reason: impl Into<String>) {
        let failure = Failure::new(self.job, reason);
        self.batch.tell(Event::Failed(self.job, &failure));
        // At the end all are noted once more.
        if let Err(error) = self.batch.results.note_failure(&failure)
            && error.concerns_all_files()
        {
            self.batch.halt(error);
        }
        let mut tally = self.batch.tally();
        tally.progress[self.place].state = JobState::Settled;
        tally.failures.insert(self.place, failure);
        let trials = self.batch.trials.as_ref();
        if tally.finished + tally.elsewhere == 0
            && let Some(jobs) = trials.and_then(|it| it.all_failed(&tally.failures))
        {
            tally.halted.get_or_insert(Halt::Alike { jobs });
        }
    }

    /// The result or the right to make it cannot be stored: the job has failed, unless that
    /// concerns all jobs.
    fn fail_to_store(self, error: StoreError) {
        match self.batch.concerns_all_jobs(&error) {
            true => self.batch.halt(error),
            false => self.fail(error.to_string()),
        }
    }
}

impl Drop for Permit<'_> {
    fn drop(&mut self) {
        let progress = &mut self.batch.tally().progress[self.place];
        if progress.state == JobState::Claimed {
            *progress = JobProgress::default();
        }
    }
}
