//! What a results folder already holds of a sweep, and what is left to do.

use super::{Folder, Job, differing_keys, work};
use crate::record::{Outcome, Program, RunRecord};
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
    /// A good record of this very scene.
    Done(Done),
    /// A label that counts without a record.
    Labelled,
    /// A good record of the same motion, but other things were stored.
    OtherOutput,
    /// A record that cannot be read; says why.
    Damaged(String),
    /// A record under this job's name that holds another scene.
    Foreign(ForeignRecord),
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
    /// If the system gives no threads.
    pub fn new(
        folder: &Folder,
        mut jobs: Vec<Job>,
        workers: usize,
    ) -> Result<Self, rayon::ThreadPoolBuildError> {
        let mut seen = HashSet::new();
        jobs.retain(|job| seen.insert(job.id.clone()));
        let kept = folder.kept_labels();
        let standings = work::map(workers, &jobs, |job| {
            match standing(job, &folder.record(&job.id)) {
                Standing::Missing if kept.contains_key(&job.id) => Standing::Labelled,
                standing => standing,
            }
        })?;
        Ok(Self {
            jobs: jobs.into_iter().zip(standings).collect(),
        })
    }

    /// The plan of running everything again, whatever the folder holds.
    pub fn afresh(jobs: Vec<Job>) -> Self {
        let mut seen = HashSet::new();
        let jobs = jobs.into_iter().filter(|job| seen.insert(job.id.clone()));
        Self {
            jobs: jobs.map(|job| (job, Standing::Missing)).collect(),
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
        let pending =
            |standing: &Standing| !matches!(standing, Standing::Done(_) | Standing::Labelled);
        self.jobs
            .iter()
            .filter(move |(_, standing)| pending(standing))
            .map(|(job, _)| job)
    }
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
    let keys = differing_keys_of_motion(&record.scene, &job.scene);
    if !keys.is_empty() {
        Standing::Foreign(ForeignRecord {
            path: path.to_owned(),
            keys,
        })
    } else if record.scene.output != job.scene.output {
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
    let motion = |scene: &Scene| Scene {
        output: Output::default(),
        ..scene.without_list().without_names()
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
