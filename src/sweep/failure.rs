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
}
