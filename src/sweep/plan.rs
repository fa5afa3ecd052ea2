//! What a results folder already holds of a sweep, and what is left to do.

use super::shard::ForeignShard;
use super::{Folder, FolderError, Job, Shard, differing_keys, work};
use crate::record::{Outcome, Program, RunRecord};
use crate::refusal::Refusal;
use crate::scene::{LIST_KEY, Output, Scene};
use crate::store::{self, StoreError};
use std::collections::HashSet;
use std::path::{Path, PathBuf};

/// The jobs of a sweep, each with what the results folder holds of it.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The jobs, in the sweep's order, none twice, each with its standing.
    pub jobs: Vec<(Job, Standing)>,
}

/// What a results folder holds of a job.
#[derive(Clone, Debug, PartialEq)]
pub enum Standing {
    /// No record.
    Missing,
    /// A good record of this very scene. It may hold further columns that are not asked for.
    Done(Done),
    /// A label that counts without a record.
    Labelled,
    /// A good record of the same motion, but something is wanted that it does not hold.
    OtherOutput,
    /// A record that cannot be read; says why.
    Damaged(String),
    /// A record under this job's name that holds another scene.
    Foreign(ForeignRecord),
    /// The job belongs to another shard: its record was not looked for.
    OfOtherShard,
    /// A record that was not looked into, because enough others were.
    Unread,
}

/// Why there is no plan.
#[derive(Debug, thiserror::Error)]
pub enum PlanError {
    /// The folder of records cannot be read.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// The shard is not one of these jobs.
    #[error(transparent)]
    Shard(#[from] ForeignShard),
    /// The system gives no threads.
    #[error("cannot start the workers: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

impl Refusal for PlanError {
    fn is_refusal(&self) -> bool {
        matches!(self, Self::Shard(_))
    }
}

/// A record under a job's name that holds another scene.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "{}: this record has other parameters than the job of that name; they differ in {}. Move it \
     away, choose another folder with --out, or run everything again with --force",
    path.display(),
    keys.join(", ")
)]
pub struct ForeignRecord {
    /// The record.
    pub path: PathBuf,
    /// Keys in which the scenes differ.
    pub keys: Vec<String>,
}

/// A run whose record is there.
#[derive(Clone, Debug, PartialEq)]
pub struct Done {
    /// How it ended.
    pub outcome: Outcome,
    /// Its work, in the unit of its model.
    pub work: u64,
    /// Processor time it took (s).
    pub cpu_seconds: f64,
    /// The build that made it.
    pub program: Program,
}

impl Plan {
    /// Looks at the record of every job, with that many workers.
    ///
    /// # Errors
    /// If the folder of records cannot be read, or the system gives no threads.
    pub fn new(folder: &Folder, jobs: Vec<Job>, workers: usize) -> Result<Self, PlanError> {
        Self::of_shard(folder, jobs, None, workers)
    }

    /// The plan of a shard of the jobs, or of all: only its records are looked at.
    ///
    /// # Errors
    /// Those of [`new`](Self::new), or if the shard is not one of these jobs.
    pub fn of_shard(
        folder: &Folder,
        jobs: Vec<Job>,
        shard: Option<&Shard>,
        workers: usize,
    ) -> Result<Self, PlanError> {
        let jobs = each_once(jobs);
        let own = shard.map(|shard| shard.of(&jobs)).transpose()?;
        let kept = folder.kept_labels();
        let there = folder.recorded()?;
        let standings = work::map(workers, &jobs, |job| {
            let id = job.id.as_str();
            match own.as_ref().is_none_or(|own| own.contains(id)) {
                false => Standing::OfOtherShard,
                true if there.contains(id) => standing(job, &folder.record(id)),
                true if kept.contains_key(id) => Standing::Labelled,
                true => Standing::Missing,
            }
        })?;
        drop(own);
        Ok(Self {
            jobs: jobs.into_iter().zip(standings).collect(),
        })
    }

    /// Looks at `most` records at most, spread evenly over the jobs that have one: it takes about
    /// as long for any number of jobs.
    ///
    /// # Errors
    /// Those of [`new`](Self::new).
    pub fn sampled(
        folder: &Folder,
        jobs: Vec<Job>,
        most: usize,
        workers: usize,
    ) -> Result<Self, PlanError> {
        let jobs = each_once(jobs);
        let there = folder.recorded()?;
        let places = (0..jobs.len()).filter(|&place| there.contains(&jobs[place].id));
        let places: Vec<usize> = places.collect();
        let mut jobs: Vec<(Job, Standing)> = jobs
            .into_iter()
            .map(|job| (job, Standing::Missing))
            .collect();
        for &place in &places {
            jobs[place].1 = Standing::Unread;
        }
        let chosen = places
            .iter()
            .step_by(places.len().div_ceil(most.max(1)).max(1));
        let chosen: Vec<usize> = chosen.copied().collect();
        let standings = work::map(workers, &chosen, |&place| {
            let job = &jobs[place].0;
            standing(job, &folder.record(&job.id))
        })?;
        for (place, standing) in chosen.into_iter().zip(standings) {
            jobs[place].1 = standing;
        }
        Ok(Self { jobs })
    }

    /// The plan of running everything again, whatever the folder holds.
    pub fn afresh(jobs: Vec<Job>) -> Self {
        let jobs = each_once(jobs).into_iter();
        Self {
            jobs: jobs.map(|job| (job, Standing::Missing)).collect(),
        }
    }

    /// Number of jobs of the plan's shard.
    pub fn own(&self) -> usize {
        let is_own = |it: &&(Job, Standing)| it.1 != Standing::OfOtherShard;
        self.jobs.iter().filter(is_own).count()
    }

    /// Leaves what is pending to other shards, but for jobs with these identities.
    pub(super) fn leave_to_others(&mut self, own: &HashSet<&str>) {
        for (job, standing) in &mut self.jobs {
            let is_pending = !matches!(standing, Standing::Done(_) | Standing::Labelled);
            if is_pending && !own.contains(job.id.as_str()) {
                *standing = Standing::OfOtherShard;
            }
        }
    }

    /// The same plan with jobs that have a label, so that they need no good record.
    #[must_use]
    pub fn with_labels(mut self, is_labelled: impl Fn(&Job) -> bool) -> Self {
        for (job, standing) in &mut self.jobs {
            if !matches!(standing, Standing::Done(_)) && is_labelled(job) {
                *standing = Standing::Labelled;
            }
        }
        self
    }

    /// Refuses to write where records of other scenes are in the way.
    ///
    /// # Errors
    /// The first such record.
    pub fn check(&self) -> Result<(), ForeignRecord> {
        for (_, standing) in &self.jobs {
            if let Standing::Foreign(record) = standing {
                return Err(record.clone());
            }
        }
        Ok(())
    }

    /// The jobs that are done.
    pub fn done(&self) -> impl Iterator<Item = (&Job, &Done)> {
        self.jobs
            .iter()
            .filter_map(|(job, standing)| match standing {
                Standing::Done(done) => Some((job, done)),
                _ => None,
            })
    }

    /// The jobs that have a label, from their records or kept without.
    pub fn labelled(&self) -> impl Iterator<Item = &Job> {
        let has_label =
            |standing: &Standing| matches!(standing, Standing::Done(_) | Standing::Labelled);
        let jobs = self.jobs.iter();
        jobs.filter(move |(_, standing)| has_label(standing))
            .map(|(job, _)| job)
    }

    /// The jobs that are to be run.
    pub fn pending(&self) -> impl Iterator<Item = &Job> {
        let pending = |standing: &Standing| {
            !matches!(
                standing,
                Standing::Done(_) | Standing::Labelled | Standing::OfOtherShard | Standing::Unread
            )
        };
        self.jobs
            .iter()
            .filter(move |(_, standing)| pending(standing))
            .map(|(job, _)| job)
    }
}

/// The jobs, none twice.
fn each_once(mut jobs: Vec<Job>) -> Vec<Job> {
    let mut seen = HashSet::new();
    jobs.retain(|job| seen.insert(job.id.clone()));
    jobs
}

impl Folder {
    /// Reads the record of a job; none if it has no good one.
    ///
    /// # Errors
    /// Those of [`store::read_record`].
    pub fn read_record_of(&self, job: &Job) -> Result<Option<RunRecord>, StoreError> {
        let path = self.record(&job.id);
        match standing(job, &path) {
            Standing::Done(_) => store::read_record(&path).map(Some),
            _ => Ok(None),
        }
    }
}

pub(super) fn standing(job: &Job, path: &Path) -> Standing {
    if !path.exists() {
        return Standing::Missing;
    }
    let record = match store::read_record_header(path) {
        Ok(record) => record,
        Err(StoreError::Damaged { reason, .. } | StoreError::NotARecord { reason, .. }) => {
            return Standing::Damaged(reason);
        }
        Err(error) => return Standing::Damaged(error.to_string()),
    };
    let scene = job.scene();
    let keys = differing_keys_of_motion(&record.scene, &scene);
    if !keys.is_empty() {
        Standing::Foreign(ForeignRecord {
            path: path.to_owned(),
            keys,
        })
    } else if !record.scene.has_output_of(&scene) {
        Standing::OtherOutput
    } else {
        Standing::Done(Done {
            outcome: record.outcome,
            work: record.work,
            cpu_seconds: record.cpu_seconds,
            program: record.program,
        })
    }
}

/// Keys in which two scenes differ that change the motion.
fn differing_keys_of_motion(a: &Scene, b: &Scene) -> Vec<String> {
    let motion = |scene: &Scene| {
        let mut motion = Scene {
            output: Output::default(),
            ..scene.without_list().without_names()
        };
        motion.forget_names_of_walls();
        motion
    };
    let mut keys = differing_keys(&motion(a), &motion(b));
    // Lists are compared directly: trees of values would take kilobytes for each sphere.
    if matches!((a.apart_from_list(), b.apart_from_list()), (Some((_, a)), Some((_, b))) if a != b)
    {
        keys.push(LIST_KEY.to_owned());
    }
    keys
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Start;
    use std::path::Path;

    #[test]
    fn keys_of_motion_include_the_spheres_of_a_list() {
        let text = r#"
            spheres = { count = 2, radius = 0.004, density = 1e3 }
            start.kind = "list"
            start.spheres = [{ position = [0, 0, 0] }, { position = [1, 0, 0] }]
            gravity = { acceleration = 9.8 }
            time = { dt = 1e-4, duration = 1.0, frame_interval = 1e-3 }
        "#;
        let scene = crate::scene::Scene::from_toml(text, Path::new("scene.toml")).unwrap();
        let mut other = scene.clone();
        other.title = Some("another".to_owned());
        other.output.trajectory = true;
        assert!(differing_keys_of_motion(&scene, &other).is_empty());
        other.start.list_mut().unwrap()[1].spin[2] = 1e-9;
        assert_eq!(differing_keys_of_motion(&scene, &other), ["start.spheres"]);
        other.seed = 7;
        assert_eq!(
            differing_keys_of_motion(&scene, &other),
            ["seed", "start.spheres"]
        );
        other.start = Start::File {
            path: "start.csv".into(),
        };
        assert_eq!(
            differing_keys_of_motion(&scene, &other),
            ["seed", "start.kind", "start.path", "start.spheres"]
        );
    }
}
