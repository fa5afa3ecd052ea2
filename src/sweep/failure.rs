//! A job that failed, and how a job is named to people.

use super::{Axis, Job};

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

/// Names a point of the grid with its seed: `radius = 0.003, omega = 6, seed 1`.
pub fn describe(axes: &[Axis], values: &[f64], seed: u64) -> String {
    let mut text = String::new();
    for (axis, value) in axes.iter().zip(values) {
        text += &format!("{} = {value}, ", axis.name);
    }
    text + &format!("seed {seed}")
}
