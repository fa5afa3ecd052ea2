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
    match describe_point(axes, values) {
        point if point.is_empty() => format!("seed {seed}"),
        point => format!("{point}, seed {seed}"),
    }
}

/// Names a point of the grid: `radius = 0.003, omega = 6`.
pub(crate) fn describe_point(axes: &[Axis], values: &[f64]) -> String {
    let pairs = axes.iter().zip(values);
    let pairs = pairs.map(|(axis, value)| format!("{} = {}", axis.name, axis.word(*value)));
    pairs.collect::<Vec<_>>().join(", ")
}
