//! What jobs will take on other machines.

use super::exit::Failure;
use phase::cost::{self, Forecast};
use phase::sweep::{Job, NextJobs};
use std::time::Duration;

/// How long jobs are tried for a forecast.
const TRIAL: Duration = Duration::from_secs(4);

/// What the jobs at these places take on one core of this machine.
pub(super) fn forecast(next: &NextJobs, places: &[usize]) -> Result<Forecast, Failure> {
    let jobs: Vec<Job> = places.iter().map(|&it| next.jobs[it].clone()).collect();
    cost::forecast(&jobs, 1, TRIAL).map_err(Failure::failed)
}
