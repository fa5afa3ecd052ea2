//! The cost of the runs of a study.

use super::exit::Failure;
use phase::cost::{Forecast, forecast};
use phase::study::comparison::Comparison;
use phase::sweep::Job;
use std::collections::HashSet;
use std::time::Duration;

/// The cost of the settings of a comparison, each from a short trial.
pub(super) fn of_settings(
    comparison: &Comparison,
    workers: usize,
    budget: Duration,
) -> Result<Forecast, Failure> {
    let settings = comparison.settings.len().max(1) as u32;
    let mut known = HashSet::new();
    let mut sum: Option<Forecast> = None;
    for place in 0..comparison.settings.len() {
        let jobs = comparison.jobs_of(place);
        let jobs: Vec<Job> = jobs.filter(|job| known.insert(&job.id)).cloned().collect();
        if jobs.is_empty() {
            continue;
        }
        let own = forecast(&jobs, workers, budget / settings)?;
        sum = Some(match sum {
            None => own,
            Some(sum) => {
                let (work, seconds) = (sum.work + own.work, sum.seconds + own.seconds);
                let spent = sum.work as f64 / sum.rate + own.work as f64 / own.rate;
                Forecast {
                    tried: sum.tried + own.tried,
                    work,
                    rate: work as f64 / spent,
                    seconds,
                    memory: sum.memory.max(own.memory),
                    disk: sum.disk + own.disk,
                }
            }
        });
    }
    sum.ok_or_else(|| Failure::refused("the study has no runs"))
}
