//! The records of a results folder while the jobs of a sweep run.

use super::backend::{Claim, Results};
use super::failures::FailureTable;
use super::plan::Plan;
use super::{Failure, Folder, Job, Pool, Sweep};
use crate::external::RunFolder;
use crate::grid::Axis;
use crate::record::RunRecord;
use crate::resume::Checkpoints;
use crate::store::{self, Lease, StoreError};
use std::collections::HashMap;
use std::time::Duration;

/// A folder of records.
pub(super) struct Records<'a> {
    folder: &'a Folder,
    axes: &'a [Axis],
    /// Whether the sweep has jobs that are not in the plan.
    has_other_jobs: bool,
    interval: Duration,
    /// Whether records that are there do not count.
    is_afresh: bool,
    /// The jobs of the plan with their places, by identity.
    jobs: HashMap<&'a str, (usize, &'a Job)>,
}

impl<'a> Records<'a> {
    /// The records of the runs of a sweep, of which the plan may hold a part.
    pub(super) fn new(pool: &Pool<'a>, plan: &'a Plan, sweep: &'a Sweep) -> Self {
        let jobs = plan.jobs.iter().map(|(job, _)| job).enumerate();
        Self {
            folder: pool.folder,
            axes: &sweep.axes,
            has_other_jobs: sweep.refine.is_some() || sweep.study.is_some(),
            interval: pool.checkpoint_interval,
            is_afresh: !pool.wishes.resume,
            jobs: jobs.map(|it| (it.1.id.as_str(), it)).collect(),
        }
    }

    /// Whether a failure is still one: of this sweep, and no process has made its record since.
    fn is_failure(&self, failure: &Failure) -> bool {
        match self.jobs.get(failure.id.as_str()) {
            Some((_, job)) => !self.folder.is_done(job),
            // The plan of a round does not hold what failed in an earlier one, nor that of single
            // effects what failed with pairs.
            None => self.has_other_jobs && !self.folder.record(&failure.id).is_file(),
        }
    }

    fn failure_table(&self) -> FailureTable<'_> {
        FailureTable::new(self.axes, self.folder.failures())
    }
}

impl Results for Records<'_> {
    fn have_own_files(&self) -> bool {
        true
    }

    fn claim(&self, job: &Job) -> Result<Claim<Option<Lease>>, StoreError> {
        let path = self.folder.lease(&job.id);
        let lease = Lease::take(&path).map_err(|error| StoreError::writing(&path, error))?;
        Ok(match lease {
            None => Claim::Elsewhere,
            // Made since it was planned.
            Some(_) if !self.is_afresh && self.folder.is_done(job) => Claim::Made,
            lease => Claim::Granted(lease),
        })
    }

    fn is_made_elsewhere(&self, job: &Job) -> bool {
        Lease::is_taken(&self.folder.lease(&job.id))
    }

    fn keep(&self, job: &Job, record: &RunRecord) -> Result<(), StoreError> {
        let path = self.folder.record(&job.id);
        store::write_record(record, &path)?;
        RunFolder::beside(&path).tidy(&record.scene);
        Ok(())
    }

    fn checkpoints(&self, job: &Job) -> Checkpoints {
        self.folder.checkpoints(&job.id, self.interval)
    }

    fn note_failure(&self, failure: &Failure) -> Result<(), StoreError> {
        self.failure_table().append(failure)
    }

    /// What other processes have noted stays.
    fn note_failures(&self, failures: &[Failure]) -> Result<(), StoreError> {
        self.failure_table().tidy(
            failures,
            |failure| self.is_failure(failure),
            |failure| self.jobs.get(failure.id.as_str()).map(|it| it.0),
        )
    }
}
