//! Runs the jobs of a sweep on all cores.

use super::{Failure, Folder, FolderError, ForeignRecord, Job, Plan, Sweep, work, write_failures};
use crate::record::RunRecord;
use crate::resume::{self, Checkpoints};
use crate::run::{Progress, Run};
use crate::simulation::BuildError;
use crate::store::{self, CheckpointError, StoreError};
use std::cmp::Reverse;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// How, where and with which callbacks the jobs of a sweep are run.
pub struct Pool<'a> {
    /// Where records go. The folder must exist, and the caller hold its lock.
    pub folder: &'a Folder,
    /// The sweep that the jobs belong to.
    pub sweep: &'a Sweep,
    /// Number of simulations at the same time.
    pub workers: usize,
    /// When set, runs under way end soon, with a checkpoint and without a record, and no more are
    /// started.
    pub stop: &'a AtomicBool,
    /// Time between two checkpoints of a run.
    pub checkpoint_interval: Duration,
    /// Whether runs go on from checkpoints that are there.
    pub resume: bool,
    /// Is told what happens.
    pub watch: &'a (dyn Fn(Event<'_>) + Sync),
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
    /// A job has ended and its record is stored.
    Finished(&'a Job, &'a RunRecord),
    /// A job has failed.
    Failed(&'a Job, &'a Failure),
}

/// What became of the jobs.
#[derive(Debug, Default)]
pub struct Report {
    /// Runs that ended and whose record is stored.
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
    /// Why no more jobs were started, if a file could not be written.
    pub halted: Option<StoreError>,
}

/// Why a sweep does not begin.
#[derive(Debug, thiserror::Error)]
pub enum PoolError {
    /// A record under a job's name holds another scene.
    #[error(transparent)]
    Foreign(#[from] ForeignRecord),
    /// The system gives no threads.
    #[error("cannot start the workers: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// The results folder cannot be used.
    #[error(transparent)]
    Folder(#[from] FolderError),
}

/// Makes the run of a job, at its start.
pub type Begin<'a> = &'a (dyn Fn(&Job) -> Result<Run, BuildError> + Sync);

impl Pool<'_> {
    /// Runs what is pending in the plan, and stores each record as soon as it is there.
    ///
    /// A job that fails does not stop the others. A file that cannot be written ends the sweep:
    /// runs under way may end, and no more are started.
    ///
    /// # Errors
    /// Before anything is run, if a record of another scene is in the way or the folder
    /// cannot be written.
    pub fn run(&self, plan: &Plan) -> Result<Report, PoolError> {
        self.run_with(plan, &|job| Run::new(&job.scene))
    }

    /// The same with runs that `begin` makes. Those with a good checkpoint go on from it.
    ///
    /// # Errors
    /// Those of [`run`](Self::run).
    pub fn run_with(&self, plan: &Plan, begin: Begin<'_>) -> Result<Report, PoolError> {
        plan.check()?;
        self.folder.remove_leftovers()?;
        self.folder.write_sweep(self.sweep)?;
        self.folder.forget_failures()?;
        for (job, _) in plan.done() {
            // Left by a process that was killed between record and removal.
            self.checkpoints(job).remove().map_err(FolderError::from)?;
        }

        let mut pending: Vec<(usize, &Job)> = plan.pending().enumerate().collect();
        // The longest first, so that no worker begins one when the others are done. Those of one
        // length stay in the sweep's order.
        pending.sort_by_key(|(_, job)| Reverse(job.work()));
        let tally = Mutex::new(Tally::default());
        work::each(self.workers, &pending, |&(position, job)| {
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
        })
    }

    /// Runs one job and stores its record.
    fn job(&self, job: &Job, begin: Begin<'_>) -> Ending {
        (self.watch)(Event::Started(job));
        let fail = |reason: String| {
            let failure = Failure::new(job, reason);
            (self.watch)(Event::Failed(job, &failure));
            Ending::Failed(failure)
        };
        let run = || begin(job).map(|run| self.drive(job, self.resumed(job, run)));
        let (record, resumed) = match catch_unwind(AssertUnwindSafe(run)) {
            Ok(Ok((resume::Ending::Finished(record), resumed))) => (record, resumed),
            Ok(Ok((resume::Ending::Lost(error), _))) => {
                (self.watch)(Event::NoCheckpoint(job, &error));
                return Ending::Interrupted;
            }
            Ok(Ok(_)) => return Ending::Interrupted,
            Ok(Err(error)) => return fail(error.to_string()),
            Err(panic) => return fail(format!("a bug in phase: {}", panic_message(&*panic))),
        };
        match store::write_record(&record, &self.folder.record(&job.id)) {
            Ok(()) => {
                // What cannot be removed now is when the sweep is run again.
                let _ = self.checkpoints(job).remove();
                (self.watch)(Event::Finished(job, &record));
                Ending::Finished(record, resumed)
            }
            // What does not fit into a record concerns this job alone, unlike a full disk.
            Err(error @ StoreError::Content { .. }) => fail(error.to_string()),
            Err(error) => Ending::NotStored(error),
        }
    }

    fn checkpoints(&self, job: &Job) -> Checkpoints {
        self.folder.checkpoints(&job.id, self.checkpoint_interval)
    }

    /// The run of a job: at its checkpoint, if there is a good one and it may be used.
    fn resumed(&self, job: &Job, mut run: Run) -> Run {
        if self.resume {
            match self.checkpoints(job).restore(&mut run) {
                Ok(true) => (self.watch)(Event::Resumed(job, job.work_at(&run.progress()))),
                Ok(false) => {}
                Err(error) => (self.watch)(Event::CheckpointRefused(job, &error)),
            }
        }
        run
    }

    /// Advances a run to its end and tells of it; and whether it went on from a checkpoint.
    fn drive(&self, job: &Job, run: Run) -> (resume::Ending, bool) {
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
        let ending = self.checkpoints(job).run(run, &mut control, &mut warn);
        (ending, first > 0)
    }

    /// Notes a failure, in the file too, so that nothing is forgotten if the sweep is killed.
    fn fail(&self, tally: &mut Tally, position: usize, failure: Failure) {
        tally.failures.insert(position, failure);
        let failures: Vec<_> = tally.failures.values().cloned().collect();
        let path = self.folder.failures();
        if let Err(error) = write_failures(&self.sweep.axes, &failures, &path) {
            tally.halted = Some(error);
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
    /// By position among the pending jobs.
    failures: std::collections::BTreeMap<usize, Failure>,
    work: u64,
    cpu_seconds: f64,
    halted: Option<StoreError>,
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
    use crate::classify::Sieves;
    use crate::dem;
    use crate::scene::Scene;
    use crate::sweep::{Axis, PlotSettings, read_failures};

    const SCENE: &str = r#"
        spheres = { count = 1, radius = 0.004, density = 1000.0 }
        start = { kind = "list", spheres = [{ position = [0.0, 0.0, 1.0] }] }
        gravity = { acceleration = 9.8 }
        time = { dt = 1e-3, duration = 0.01, frame_interval = 1e-3 }
    "#;

    fn sweep() -> (Sweep, Vec<Job>) {
        let scene: Scene = toml::from_str(SCENE).unwrap();
        let axis = Axis {
            key: "gravity.acceleration".to_owned(),
            name: "acceleration".to_owned(),
            values: vec![1.0, 2.0, 3.0, 4.0],
        };
        let job = |&value: &f64| {
            let mut scene = scene.clone();
            scene.gravity.as_mut().unwrap().acceleration = value;
            Job {
                id: scene.identity(),
                values: vec![value],
                seed: 1,
                scene,
            }
        };
        let jobs = axis.values.iter().map(job).collect();
        let (sieves, plot) = (Sieves::default(), PlotSettings::default());
        (
            Sweep {
                title: None,
                scene,
                axes: vec![axis],
                seeds: vec![1],
                sieves,
                plot,
            },
            jobs,
        )
    }

    #[test]
    fn failed_and_panicking_jobs_do_not_stop_the_rest() {
        let place = tempfile::tempdir().unwrap();
        let folder = Folder::new(place.path());
        folder.create().unwrap();
        let (sweep, jobs) = sweep();
        let pool = Pool {
            folder: &folder,
            sweep: &sweep,
            workers: 2,
            stop: &AtomicBool::new(false),
            checkpoint_interval: resume::DEFAULT_INTERVAL,
            resume: true,
            watch: &|_| {},
        };
        let faulty: Begin<'_> = &|job| match job.values[0] {
            1.0 => panic!("one is too few"),
            3.0 => Err(BuildError::new(dem::BuildError::FrictionWithoutContact)),
            _ => Run::new(&job.scene),
        };
        let plan = Plan::new(&folder, jobs.clone(), 2).unwrap();
        let report = pool.run_with(&plan, faulty).unwrap();
        assert_eq!((report.finished, report.left), (2, 0));
        let failed: Vec<_> = report
            .failures
            .iter()
            .map(|failure| failure.values[0])
            .collect();
        assert_eq!(failed, [1.0, 3.0]);
        assert_eq!(report.failures[0].reason, "a bug in phase: one is too few");
        assert!(
            report.failures[1]
                .reason
                .contains("the scene has no contact law")
        );
        assert_eq!(read_failures(&folder.failures()).unwrap(), report.failures);

        // The failed ones, and only these, are run again, and then no failure is left.
        let plan = Plan::new(&folder, jobs, 2).unwrap();
        let again: Vec<_> = plan.pending().map(|job| job.values[0]).collect();
        assert_eq!(again, [1.0, 3.0]);
        let report = pool.run(&plan).unwrap();
        assert_eq!((report.finished, report.failures.len()), (2, 0));
        assert!(!folder.failures().exists());
    }

    #[test]
    fn the_longest_jobs_come_first() {
        let place = tempfile::tempdir().unwrap();
        let folder = Folder::new(place.path());
        folder.create().unwrap();
        let (sweep, mut jobs) = sweep();
        for (job, duration) in jobs.iter_mut().zip([0.01, 0.03, 0.01, 0.02]) {
            job.scene.time.duration = duration;
            job.id = job.scene.identity();
        }
        let begun = Mutex::new(Vec::new());
        let pool = Pool {
            folder: &folder,
            sweep: &sweep,
            workers: 1,
            stop: &AtomicBool::new(false),
            checkpoint_interval: resume::DEFAULT_INTERVAL,
            resume: true,
            watch: &|event| {
                if let Event::Started(job) = event {
                    begun.lock().unwrap().push(job.values[0]);
                }
            },
        };
        let plan = Plan::new(&folder, jobs, 1).unwrap();
        let report = pool.run(&plan).unwrap();
        assert_eq!(report.finished, 4);
        assert_eq!(*begun.lock().unwrap(), [2.0, 4.0, 1.0, 3.0]);
    }

    #[test]
    fn a_stop_leaves_no_record_of_the_run_under_way() {
        let place = tempfile::tempdir().unwrap();
        let folder = Folder::new(place.path());
        folder.create().unwrap();
        let (sweep, jobs) = sweep();
        let stop = AtomicBool::new(false);
        let watch = |event: Event<'_>| {
            if matches!(event, Event::Advanced(job, _) if job.values[0] == 3.0) {
                stop.store(true, Ordering::Relaxed);
            }
        };
        let pool = Pool {
            folder: &folder,
            sweep: &sweep,
            workers: 1,
            stop: &stop,
            checkpoint_interval: resume::DEFAULT_INTERVAL,
            resume: true,
            watch: &watch,
        };
        let plan = Plan::new(&folder, jobs.clone(), 1).unwrap();
        let report = pool.run(&plan).unwrap();
        assert_eq!((report.finished, report.left), (2, 2));
        let plan = Plan::new(&folder, jobs, 1).unwrap();
        let left: Vec<_> = plan.pending().map(|job| job.values[0]).collect();
        assert_eq!(left, [3.0, 4.0]);
    }
}
