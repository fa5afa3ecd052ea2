//! How far the sweep of a results folder is.

use super::{Done, Failure, Folder, FolderError, Job, Plan, Standing, read_failures};
use crate::grid::Axis;
use crate::record::Outcome;
use crate::run;
use crate::store::{self, Holder, Lease, Tenure};
use std::collections::{BTreeSet, HashSet};
use std::fs;
use std::time::Duration;

/// How far the sweep of a results folder is.
#[derive(Clone, Debug, PartialEq)]
pub struct Status {
    /// Number of jobs.
    pub jobs: usize,
    /// Jobs with a good record, or with a row of a table that counts without one.
    pub done: usize,
    /// Of these, runs that a guard ended.
    pub unstable: usize,
    /// Jobs that failed when they were last run.
    pub failures: Vec<Failure>,
    /// Jobs left whose record is damaged, or holds another scene or other output.
    pub bad: usize,
    /// Number of records that these numbers are estimated from, if not all were read.
    pub sample: Option<usize>,
    /// Jobs left to run: with those done and failed, these are all.
    pub left: usize,
    /// Of these, runs with a checkpoint that they go on from.
    pub under_way: Vec<UnderWay>,
    /// Processor time that the jobs left may take (s), if any job is done to judge by.
    pub cpu_seconds_left: Option<f64>,
    /// Mean processor time of the jobs that are done (s), if any is.
    pub cpu_seconds_per_job: Option<f64>,
    /// The processes that are at work in the folder; one on another machine may be dead.
    pub processes: Vec<Holder>,
    /// Runs that were begun and have no record yet: by whom, and whether that process is dead.
    pub claimed: Vec<Claimed>,
}

/// A run that a process has begun.
#[derive(Clone, Debug, PartialEq)]
pub struct Claimed {
    /// Identity of the run.
    pub id: String,
    /// Which process, if its lease can be read.
    pub holder: Option<Holder>,
    /// Whether that process is known to be dead: the run is made again by whoever comes next.
    pub is_stale: bool,
}

impl Claimed {
    /// All of a folder, from one look at it.
    fn all(folder: &Folder) -> Vec<Self> {
        let files = fs::read_dir(folder.records())
            .into_iter()
            .flatten()
            .flatten();
        let names = files.filter_map(|file| file.file_name().into_string().ok());
        let ids = names.filter_map(|name| Some(Lease::name_of(&name)?.to_owned()));
        let ids: BTreeSet<String> = ids.collect();
        let claimed = ids.into_iter().filter_map(|id| {
            let (holder, is_stale) = match Lease::tenure(&folder.lease(&id)) {
                Tenure::Free => return None,
                Tenure::Held(holder) => (holder, false),
                Tenure::Stale(holder) => (holder, true),
            };
            Some(Self {
                id,
                holder,
                is_stale,
            })
        });
        claimed.collect()
    }
}

/// A run that has a checkpoint and no record.
#[derive(Clone, Debug, PartialEq)]
pub struct UnderWay {
    /// Identity of the run.
    pub id: String,
    /// Value on each axis.
    pub values: Vec<f64>,
    /// Seed.
    pub seed: u64,
    /// Frames until the checkpoint.
    pub frame: u64,
    /// Frames in all, if nothing ends the run before its time.
    pub frames: u64,
}

impl UnderWay {
    /// All of a plan, from one look at the folder.
    fn all(folder: &Folder, plan: &Plan) -> Result<Vec<Self>, FolderError> {
        let with_checkpoint = folder.with_checkpoint()?;
        let jobs = plan.pending();
        let jobs = jobs.filter(|job| with_checkpoint.contains(&job.id));
        Ok(jobs.filter_map(|job| Self::of(folder, job)).collect())
    }

    /// The checkpoint of a job, if there is one from which this build can go on.
    fn of(folder: &Folder, job: &Job) -> Option<Self> {
        let checkpoints = folder.checkpoints(&job.id, Duration::ZERO);
        let scene = job.scene();
        let checkpoint = store::read_checkpoint(checkpoints.path(), &scene).ok()??;
        Some(Self {
            id: job.id.clone(),
            values: job.values.clone(),
            seed: job.seed,
            frame: run::frame_of_state(checkpoint.state()).ok()?,
            frames: scene.time.frames(),
        })
    }
}

impl Status {
    /// The status of the jobs of a sweep with these axes, as planned for `folder`. Of records that
    /// the plan did not look into, what the others show is taken as their average.
    ///
    /// # Errors
    /// If the folder or the table of failed jobs cannot be read.
    pub fn of(folder: &Folder, axes: &[Axis], plan: &Plan) -> Result<Self, FolderError> {
        let left_ids: HashSet<_> = plan.pending().map(|job| &job.id).collect();
        let mut failures = read_failures(axes, &folder.failures())?;
        failures.retain(|failure| left_ids.contains(&failure.id));
        let failed: HashSet<_> = failures.iter().map(|failure| failure.id.clone()).collect();
        let is_bad = |(job, standing): &&(Job, Standing)| {
            let is_good = matches!(
                standing,
                Standing::Done(_) | Standing::Labelled | Standing::Missing | Standing::Unread
            );
            !is_good && !failed.contains(&job.id)
        };
        let is_unstable = |done: &&Done| matches!(done.outcome, Outcome::Unstable(_));
        let bad = plan.jobs.iter().filter(is_bad).count();
        let good = plan.done().count();
        let labelled = plan.labelled().count() - good;
        let unread = plan.jobs.iter();
        let unread = unread.filter(|it| it.1 == Standing::Unread).count();
        let read = good + bad;
        // The records that were read stand for the others.
        let of_all = |number: usize| {
            let more = unread as f64 * number as f64 / read.max(1) as f64;
            number + more.round() as usize
        };
        let claimed = Claimed::all(folder);
        Ok(Self {
            jobs: plan.jobs.len(),
            done: of_all(good) + labelled,
            unstable: of_all(plan.done().map(|it| it.1).filter(is_unstable).count()),
            bad: of_all(bad),
            sample: (unread > 0).then_some(read),
            left: left_ids.len() - failures.len() + of_all(bad) - bad,
            under_way: UnderWay::all(folder, plan)?,
            cpu_seconds_left: cpu_seconds_left(plan),
            cpu_seconds_per_job: cpu_seconds_per_job(plan),
            failures,
            processes: folder.at_work()?,
            claimed,
        })
    }
}

fn cpu_seconds_per_job(plan: &Plan) -> Option<f64> {
    let seconds: Vec<f64> = plan.done().map(|(_, done)| done.cpu_seconds).collect();
    (!seconds.is_empty()).then(|| seconds.iter().sum::<f64>() / seconds.len() as f64)
}

/// Work left over the mean rate of the runs that are done.
fn cpu_seconds_left(plan: &Plan) -> Option<f64> {
    let left: u64 = plan.pending().map(Job::work).sum();
    let (mut work, mut seconds) = (0, 0.0);
    for (_, done) in plan.done() {
        work += done.work;
        seconds += done.cpu_seconds;
    }
    (work > 0).then(|| left as f64 * seconds / work as f64)
}
