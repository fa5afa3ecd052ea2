//! Runs the jobs of a sweep.

use super::backend::{Backend, BackendError, Batch, Claim, Report, Results, Wishes};
use super::plan::{ForeignRecord, Plan, Standing, standing};
use super::{Failure, Folder, FolderError, Job, Sweep, read_failures, write_failures};
use crate::record::RunRecord;
use crate::resume::Checkpoints;
use crate::store::{self, Lease, StoreError};
use std::collections::HashSet;
use std::time::Duration;

/// Where, how and by whom the jobs of a sweep are run.
pub struct Pool<'a> {
    /// Where records go. The folder must exist, and the caller hold its lock.
    pub folder: &'a Folder,
    /// The sweep that the jobs belong to.
    pub sweep: &'a Sweep,
    /// Who runs the jobs.
    pub backend: &'a dyn Backend,
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
    /// No job can be run.
    #[error(transparent)]
    Backend(#[from] BackendError),
    /// The results folder cannot be used.
    #[error(transparent)]
    Folder(#[from] FolderError),
}

impl Pool<'_> {
    /// Runs what is pending in the plan, and stores each record as soon as it is there. A job that
    /// fails does not stop the others.
    ///
    /// # Errors
    /// Before anything is run, if a record of another scene is in the way or the folder
    /// cannot be written.
    pub fn run(&self, plan: &Plan) -> Result<Report, PoolError> {
        plan.check()?;
        self.folder.write_sweep(self.sweep)?;
        self.folder.forget_failures()?;
        let records = Records {
            folder: self.folder,
            sweep: self.sweep,
            interval: self.checkpoint_interval,
            is_afresh: !self.wishes.resume,
        };
        for (job, _) in plan.done() {
            // Left by a process that was killed between record and removal. One that cannot be
            // removed does no harm: the job is done.
            let _ = records.checkpoints(job).remove();
        }
        let batch = Batch::new(plan.pending(), &records, self.wishes);
        Ok(batch.run_on(self.backend)?)
    }
}

/// A folder of records.
struct Records<'a> {
    folder: &'a Folder,
    sweep: &'a Sweep,
    interval: Duration,
    /// Whether records that are there do not count.
    is_afresh: bool,
}

impl Results for Records<'_> {
    fn have_own_files(&self) -> bool {
        true
    }

    fn claim(&self, job: &Job) -> Result<Option<Claim>, StoreError> {
        let path = self.folder.record(&job.id);
        let lease = Lease::take(&path).map_err(|error| StoreError::writing(&path, error))?;
        let is_done = || matches!(standing(job, &path), Standing::Done(_));
        match lease {
            // Made since it was planned.
            Some(_) if !self.is_afresh && is_done() => Ok(None),
            lease => Ok(lease.map(Claim::Lease)),
        }
    }

    fn keep(&self, job: &Job, record: &RunRecord) -> Result<(), StoreError> {
        store::write_record(record, &self.folder.record(&job.id))
    }

    fn checkpoints(&self, job: &Job) -> Checkpoints {
        self.folder.checkpoints(&job.id, self.interval)
    }

    /// Those stay that another process has noted meanwhile.
    fn note_failures(&self, failures: &[&Failure]) -> Result<(), StoreError> {
        let path = self.folder.failures();
        let ours: HashSet<&str> = failures.iter().map(|it| it.id.as_str()).collect();
        let noted = read_failures(&self.sweep.axes, &path).unwrap_or_default();
        let others = noted.iter().filter(|other| {
            !ours.contains(other.id.as_str()) && !self.folder.record(&other.id).is_file()
        });
        let all = failures.iter().copied().chain(others);
        write_failures(&self.sweep.axes, all, &path)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dem;
    use crate::grid::Axis;
    use crate::resume;
    use crate::run::Run;
    use crate::simulation::BuildError;
    use crate::sweep::read_failures;
    use crate::sweep::{Begin, Event, LocalThreads};
    use std::sync::Mutex;
    use std::sync::atomic::{AtomicBool, Ordering};

    fn sweep() -> (Sweep, Vec<Job>) {
        let falling = Sweep::of_falling_sphere();
        let values = vec![1.0, 2.0, 3.0, 4.0];
        let axis = Axis::of_numbers("gravity.acceleration", "acceleration", values);
        let job = |&value: &f64| {
            let mut scene = falling.scene.clone();
            scene.dem.effects.gravity.as_mut().unwrap().acceleration = value;
            Job {
                id: scene.identity(),
                values: vec![value],
                seed: 1,
                scene,
            }
        };
        let jobs = axis.values.iter().map(job).collect();
        let sweep = Sweep {
            axes: vec![axis],
            seeds: vec![1],
            ..falling
        };
        (sweep, jobs)
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
            backend: &LocalThreads::new(2),
            workers: 2,
            checkpoint_interval: resume::DEFAULT_INTERVAL,
            wishes: Wishes {
                stop: &AtomicBool::new(false),
                resume: true,
                watch: &|_| {},
            },
        };
        let faulty: Begin<'_> = &|job| match job.values[0] {
            1.0 => panic!("one is too few"),
            3.0 => Err(BuildError::new(dem::DemBuildError::FrictionWithoutContact)),
            _ => Run::new(&job.scene),
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
            job.scene.time.duration = duration;
            job.id = job.scene.identity();
        }
        let begun = Mutex::new(Vec::new());
        let pool = Pool {
            folder: &folder,
            sweep: &sweep,
            backend: &LocalThreads::new(1),
            workers: 1,
            checkpoint_interval: resume::DEFAULT_INTERVAL,
            wishes: Wishes {
                stop: &AtomicBool::new(false),
                resume: true,
                watch: &|event| {
                    if let Event::Started(job) = event {
                        begun.lock().unwrap().push(job.values[0]);
                    }
                },
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
            backend: &LocalThreads::new(1),
            workers: 1,
            checkpoint_interval: resume::DEFAULT_INTERVAL,
            wishes: Wishes {
                stop: &stop,
                resume: true,
                watch: &watch,
            },
        };
        let plan = Plan::new(&folder, jobs.clone(), 1).unwrap();
        let report = pool.run(&plan).unwrap();
        assert_eq!((report.finished, report.left), (2, 2));
        let plan = Plan::new(&folder, jobs, 1).unwrap();
        let left: Vec<_> = plan.pending().map(|job| job.values[0]).collect();
        assert_eq!(left, [3.0, 4.0]);
    }
}
