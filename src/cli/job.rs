//! A job of a sweep, as `--json` names it.

use phase::sweep::{Axis, Failure};
use serde::Serialize;
use std::collections::BTreeMap;

/// A job of a sweep and what is to be said of it.
#[derive(Serialize)]
pub(super) struct NamedJob {
    id: String,
    /// Values by the names of the axes.
    point: BTreeMap<String, f64>,
    seed: u64,
    reason: String,
}

impl NamedJob {
    /// The jobs of a sweep with these axes.
    pub(super) fn all(axes: &[Axis], jobs: &[Failure]) -> Vec<Self> {
        let named = |job: &Failure| Self {
            id: job.id.clone(),
            point: point(axes, &job.values),
            seed: job.seed,
            reason: job.reason.clone(),
        };
        jobs.iter().map(named).collect()
    }
}

/// Values by the names of their axes.
pub(super) fn point(axes: &[Axis], values: &[f64]) -> BTreeMap<String, f64> {
    let names = axes.iter().map(|axis| axis.name.clone());
    names.zip(values.iter().copied()).collect()
}
