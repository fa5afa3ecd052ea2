//! A job that failed, and how a job is named to people.

use super::Job;

/// A job that failed.
#[derive(Clone, Debug, PartialEq)]
pub struct Failure {
    /// Identity of the run.
    pub id: String,
    /// Value on each axis, in the sweep's order.
    pub values: Vec<f64>,
    /// Seed.
    pub seed: u64,
    /// Why.
    pub reason: String,
}

impl Failure {
    /// The failure of that job.
    pub fn new(job: &Job, reason: impl Into<String>) -> Self {
        Self {
            id: job.id.clone(),
            values: job.values.clone(),
            seed: job.seed,
            reason: reason.into(),
        }
    }

    /// What the failure has in common with those of other jobs: the reason without the identity,
    /// which names its files.
    pub fn kind(&self) -> String {
        self.reason.replace(&self.id, "")
    }

    /// Whether another job failed for the same reason.
    pub fn is_like(&self, other: &Self) -> bool {
        self.kind() == other.kind()
    }
}
