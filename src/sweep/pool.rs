//! Runs the jobs of a sweep.

use super::backend::{Backend, Batch, Report, Results, Wishes};
use super::plan::{ForeignRecord, Plan, Standing};
use super::records::Records;
use super::{Folder, FolderError, Job, PlanError, Shard, Sweep, read_failures, work};
use crate::refusal::Refusal;
use crate::resume::DEFAULT_INTERVAL;
use std::time::Duration;

/// Where, how and by whom the jobs of a sweep are run.
pub struct Pool<'a> {
    /// Where records go. The folder must exist, and the caller have the right to write to it if
    /// other processes may (see [`Folder::enter`]).
    pub folder: &'a Folder,
    /// The sweep that the jobs belong to.
    pub sweep: &'a Sweep,
    /// Who runs the jobs.
    pub backend: &'a dyn Backend,
    /// Which of its jobs are run, if not all. Of a refined sweep one round is run.
    pub shard: Option<&'a Shard>,
    /// Number of threads that read and label records.
    pub workers: usize,
    /// Time between two checkpoints of a run.
    pub checkpoint_interval: Duration,
    /// What is wished of them.
    pub wishes: Wishes<'a>,
}

/// Why a sweep does not begin.
#[derive(Debug, thiserror::Error)]
pub enum PoolError {
    /// A record under a job's name holds another scene.
    #[error(transparent)]
    Foreign(#[from] ForeignRecord),
    /// The results folder cannot be used.
    #[error(transparent)]
    Folder(#[from] FolderError),
}

impl Refusal for PoolError {
    fn is_refusal(&self) -> bool {
        matches!(self, Self::Foreign(_))
    }
}

impl<'a> Pool<'a> {
    /// A pool with one worker for each core, default checkpoints and [wishes](Wishes::default).
    pub fn new(folder: &'a Folder, sweep: &'a Sweep, backend: &'a dyn Backend) -> Self {
        Self {
            folder,
            sweep,
            backend,
            shard: None,
            workers: work::default_workers(),
            checkpoint_interval: DEFAULT_INTERVAL,
            wishes: Wishes::default(),
        }
    }

    /// The plan of jobs of the sweep: of all of them, or of the pool's shard.
    ///
    /// # Errors
    /// Those of [`Plan::of_shard`].
    pub fn plan(&self, jobs: Vec<Job>) -> Result<Plan, PlanError> {
        Plan::of_shard(self.folder, jobs, self.shard, self.workers)
    }

    /// Runs what is pending in the plan, and stores each record as soon as it is there. A job that
    /// fails does not stop the others. What other processes have begun is waited for, and run if
    /// they end early.
    ///
    /// # Errors
    /// Before anything is run, if a record of another scene is in the way or the folder
    /// cannot be written.
    pub fn run(&self, plan: &Plan) -> Result<Report, PoolError> {
        plan.check()?;
        // Another process may be at the pairs of an ablation already.
        let extended = self.folder.extension_of(self.sweep);
        let sweep = extended.as_ref().unwrap_or(self.sweep);
        self.folder.write_sweep(sweep)?;
        let records = Records::new(self, plan, sweep);
        // Nothing has failed yet, but what was noted before may be no failure any more.
        records.note_failures(&[]).map_err(FolderError::from)?;
        let with_checkpoint = self.folder.with_checkpoint()?;
        for (job, _) in plan.done() {
            if with_checkpoint.contains(&job.id) {
                // Left by a process that was killed between record and removal. One that cannot be
                // removed does no harm: the job is done.
                let _ = records.checkpoints(job).remove();
            }
        }
        let mut batch = Batch::new(plan.pending(), &records, self.wishes);
        if sweep.scene.is_external() && plan.labelled().next().is_none() {
            // A table that cannot be read tells of no failure.
            let known = read_failures(&sweep.axes, &self.folder.failures()).unwrap_or_default();
            batch = batch.trying_first(known);
        }
        let report = batch.run_on(self.backend);
        Ok(Report {
            others: self.left_to_others(plan)?,
            ..report
        })
    }
}

impl Pool<'_> {
    /// Number of jobs of other shards that have no result yet.
    fn left_to_others(&self, plan: &Plan) -> Result<usize, FolderError> {
        let others = plan.jobs.iter();
        let others = others.filter(|it| it.1 == Standing::OfOtherShard);
        let others: Vec<&Job> = others.map(|(job, _)| job).collect();
        match others.is_empty() {
            true => Ok(0),
            false => self.folder.lacking(&others, &self.sweep.axes),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dem;
    use crate::grid::Axis;
    use crate::run::{self, Run};
    use crate::simulation::BuildError;
    use crate::store::{self, Lease};
    use crate::sweep::failures::FailureTable;
    use crate::sweep::{BackendError, Begin, Event, LocalThreads, Status};
    use crate::sweep::{Claim, Failure};
    use std::ops::ControlFlow;
    use std::sync::Mutex;
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::time::Instant;

    fn sweep() -> (Sweep, Vec<Job>) {
        let falling = Sweep::of_falling_sphere();
        let values = vec![1.0, 2.0, 3.0, 4.0];
        let axis = Axis::of_numbers("gravity.acceleration", "acceleration", values);
        let job = |&value: &f64| {
            let mut scene = falling.scene.clone();
            scene.dem.effects.gravity.as_mut().unwrap().acceleration = value;
            Job::alone(scene.identity(), vec![value], scene)
        };
        let jobs = axis.values.iter().map(job).collect();
        let sweep = Sweep {
            axes: vec![axis],
            seeds: vec![1],
            ..falling
        };
        (sweep, jobs)
    }

    fn write_record_of(job: &Job, folder: &Folder) {
        let record = run::run(&job.scene(), &mut |_| ControlFlow::Continue(()));
        store::write_record(&record.unwrap(), &folder.record(&job.id)).unwrap();
    }

    #[test]
    fn failed_and_panicking_jobs_do_not_stop_the_rest() {
        let place = tempfile::tempdir().unwrap();
        let folder = Folder::new(place.path());
        folder.create().unwrap();
        let (sweep, jobs) = sweep();
        let threads = LocalThreads::new(2);
        let pool = Pool::new(&folder, &sweep, &threads);
        let faulty: Begin<'_> = &|job| match job.values[0] {
            1.0 => panic!("one is too few"),
            3.0 => Err(BuildError::new(dem::DemBuildError::FrictionWithoutContact)),
            _ => Run::new(&job.scene()),
        };
        let plan = Plan::new(&folder, jobs.clone(), 2).unwrap();
        let faulty = Pool {
            backend: &LocalThreads::new(2).beginning(faulty),
            ..pool
        };
        let report = faulty.run(&plan).unwrap();
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
        assert_eq!(
            read_failures(&sweep.axes, &folder.failures()).unwrap(),
            report.failures
        );

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
            let mut scene = job.scene();
            scene.time.duration = duration;
            *job = Job::alone(scene.identity(), job.values.clone(), scene);
        }
        let begun = Mutex::new(Vec::new());
        let watch = |event: Event<'_>| {
            if let Event::Started(job) = event {
                begun.lock().unwrap().push(job.values[0]);
            }
        };
        let threads = LocalThreads::new(1);
        let pool = Pool {
            wishes: Wishes {
                watch: &watch,
                ..Wishes::default()
            },
            ..Pool::new(&folder, &sweep, &threads)
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
        let threads = LocalThreads::new(1);
        let pool = Pool {
            wishes: Wishes {
                stop: &stop,
                watch: &watch,
                ..Wishes::default()
            },
            ..Pool::new(&folder, &sweep, &threads)
        };
        let plan = Plan::new(&folder, jobs.clone(), 1).unwrap();
        let report = pool.run(&plan).unwrap();
        assert_eq!((report.finished, report.left), (2, 2));
        let plan = Plan::new(&folder, jobs, 1).unwrap();
        let left: Vec<_> = plan.pending().map(|job| job.values[0]).collect();
        assert_eq!(left, [3.0, 4.0]);
    }

    /// What another process has begun is waited for. It is taken over when that process ends
    /// without a record.
    #[test]
    fn a_run_of_another_process_is_waited_for() {
        for leaves_record in [true, false] {
            let place = tempfile::tempdir().unwrap();
            let folder = Folder::new(place.path());
            folder.create().unwrap();
            let (sweep, jobs) = sweep();
            let record = folder.record(&jobs[1].id);
            let lease = folder.lease(&jobs[1].id);
            let lease = Mutex::new(Lease::take(&lease).unwrap());
            let elsewhere = Mutex::new(Vec::new());
            let watch = |event: Event<'_>| match event {
                Event::Elsewhere(job) => elsewhere.lock().unwrap().push(job.values[0]),
                Event::Waiting(count) => {
                    assert_eq!(count, 1);
                    if leaves_record {
                        write_record_of(&jobs[1], &folder);
                    }
                    drop(lease.lock().unwrap().take());
                }
                _ => {}
            };
            let threads = LocalThreads::new(2);
            let pool = Pool {
                wishes: Wishes {
                    watch: &watch,
                    ..Wishes::default()
                },
                ..Pool::new(&folder, &sweep, &threads)
            };
            let report = pool
                .run(&Plan::new(&folder, jobs.clone(), 1).unwrap())
                .unwrap();
            assert_eq!(*elsewhere.lock().unwrap(), [2.0]);
            assert_eq!(
                (report.elsewhere, report.left),
                (usize::from(leaves_record), 0)
            );
            assert_eq!(report.finished, 4 - report.elsewhere);
            assert!(record.is_file() && !Lease::is_taken(&folder.lease(&jobs[1].id)));
        }
    }

    /// Symptom: a process that began forgot what had failed in others, and one that ended noted a
    /// failure whose record another one had made since.
    #[test]
    fn failures_stand_until_their_record_is_made() {
        let place = tempfile::tempdir().unwrap();
        let folder = Folder::new(place.path());
        folder.create().unwrap();
        let (sweep, jobs) = sweep();
        let table = FailureTable::new(&sweep.axes, folder.failures());
        table
            .append(&Failure::new(&jobs[1], "of another process"))
            .unwrap();
        let mut stranger = jobs[0].clone();
        stranger.id = "0123456789abcdef".to_owned();
        table
            .append(&Failure::new(&stranger, "of an earlier sweep"))
            .unwrap();

        // Stopped at once, it has made nothing again.
        let stop = AtomicBool::new(true);
        let threads = LocalThreads::new(1);
        let stopped = Pool {
            wishes: Wishes {
                stop: &stop,
                ..Wishes::default()
            },
            ..Pool::new(&folder, &sweep, &threads)
        };
        let plan = Plan::new(&folder, jobs.clone(), 1).unwrap();
        assert_eq!(stopped.run(&plan).unwrap().left, 4);
        let noted = || read_failures(&sweep.axes, &folder.failures()).unwrap();
        assert_eq!(noted(), [Failure::new(&jobs[1], "of another process")]);
        let status = Status::of(&folder, &sweep.axes, &plan).unwrap();
        assert_eq!((status.failures.len(), status.left), (1, 3));

        // Two jobs fail here; the record of one is made by another process before the end.
        let watch = |event: Event<'_>| {
            if let Event::Failed(job, _) = event
                && job.id == jobs[2].id
            {
                write_record_of(job, &folder);
            }
        };
        let faulty: Begin<'_> = &|job| match job.values[0] {
            2.0 | 3.0 => Err(BuildError::new(dem::DemBuildError::FrictionWithoutContact)),
            _ => Run::new(&job.scene()),
        };
        let threads = LocalThreads::new(1).beginning(faulty);
        let pool = Pool {
            wishes: Wishes {
                watch: &watch,
                ..Wishes::default()
            },
            ..Pool::new(&folder, &sweep, &threads)
        };
        let report = pool.run(&plan).unwrap();
        assert_eq!((report.finished, report.failures.len()), (2, 2));
        assert_eq!(noted(), report.failures[..1]);
        let plan = Plan::new(&folder, jobs.clone(), 1).unwrap();
        let status = Status::of(&folder, &sweep.axes, &plan).unwrap();
        assert_eq!((status.done, status.failures.len(), status.left), (3, 1, 0));
    }

    /// Each job fails.
    struct Failing;

    impl Backend for Failing {
        fn run(&self, batch: &Batch<'_>) -> Result<(), BackendError> {
            for job in batch.jobs() {
                if let Claim::Granted(permit) = batch.claim(job) {
                    permit.fail("none");
                }
            }
            Ok(())
        }
    }

    /// Symptom: places were searched and failures written anew for each job. The time for a job
    /// must not grow with their number.
    #[test]
    #[ignore = "takes a minute, and times it"]
    fn the_time_for_a_job_does_not_grow_with_their_number() {
        let seconds = |count: u64| {
            let place = tempfile::tempdir().unwrap();
            let folder = Folder::new(place.path());
            folder.create().unwrap();
            let sweep = Sweep {
                seeds: (1..=count).collect(),
                ..Sweep::of_falling_sphere()
            };
            let jobs = sweep.jobs().unwrap();
            let begin = Instant::now();
            for _ in 0..2 {
                let plan = Plan::new(&folder, jobs.clone(), 1).unwrap();
                let report = Pool::new(&folder, &sweep, &Failing).run(&plan).unwrap();
                assert_eq!(report.failures.len() as u64, count);
                let status = Status::of(&folder, &sweep.axes, &plan).unwrap();
                assert_eq!((status.failures.len() as u64, status.left), (count, 0));
            }
            begin.elapsed().as_secs_f64() / count as f64
        };
        let (few, many) = (seconds(2_000), seconds(40_000));
        assert!(many < 3.0 * few, "{few} s a job of few, {many} s of many");
    }
}
