//! What a sweep costs, from a few of its jobs.

use super::representatives::representatives;
use super::{CostError, PartCost, RunCost};
use crate::sweep::Job;
use std::time::Duration;

/// What a sweep, or a single scene, costs.
#[derive(Clone, Debug)]
pub struct SweepCost<'a> {
    /// The jobs that were tried.
    pub tried: Vec<TriedJob<'a>>,
}

/// A job that was tried, and what it stands for.
#[derive(Clone, Debug)]
pub struct TriedJob<'a> {
    /// The job.
    pub job: &'a Job,
    /// Number of jobs that it stands for, itself among them.
    pub jobs: usize,
    /// Their work.
    pub work: u64,
    /// What it costs.
    pub cost: RunCost,
}

impl TriedJob<'_> {
    /// Processor time of a part of all jobs that it stands for (s).
    fn seconds(&self, part: &PartCost) -> f64 {
        let runs = match part.is_once {
            true => self.jobs as f64,
            false => self.work as f64 / self.cost.all_work.max(1) as f64,
        };
        self.cost.all_seconds(part) * runs
    }
}

impl<'a> SweepCost<'a> {
    /// Measures the jobs at the corners and in the middle of the grid one after the other, with so
    /// much processor time for all of them. Each stands for the jobs nearest to it.
    ///
    /// # Errors
    /// If a job cannot be run.
    pub fn measure(jobs: &'a [Job], budget: Duration) -> Result<Self, CostError> {
        let chosen = representatives(jobs);
        let budget = budget / (chosen.len() as u32).max(1);
        let tried = chosen.into_iter().map(|it| {
            let cost = RunCost::measure(&it.job.scene(), budget)?;
            Ok(TriedJob {
                job: it.job,
                jobs: it.jobs,
                // A silo that emptied has told how much less it takes.
                work: match jobs.len() {
                    1 => cost.all_work,
                    _ => it.work,
                },
                cost,
            })
        });
        Ok(Self {
            tried: tried.collect::<Result<_, CostError>>()?,
        })
    }

    /// What each part of all jobs costs.
    pub fn parts(&self) -> Vec<PartCost> {
        let first = self.tried.first().map_or(&[][..], |it| &it.cost.parts);
        let of_all = |(index, part): (usize, &PartCost)| {
            let all = self.tried.iter().map(|it| (it, &it.cost.parts[index]));
            PartCost {
                is_present: all.clone().any(|(_, part)| part.is_present),
                seconds: all.map(|(tried, part)| tried.seconds(part)).sum(),
                ..*part
            }
        };
        first.iter().enumerate().map(of_all).collect()
    }

    /// Processor time of all jobs (s).
    pub fn total(&self) -> f64 {
        self.parts().iter().map(|part| part.seconds).sum()
    }

    /// Work of all jobs; where spheres come and go, the most that it may be.
    pub fn work(&self) -> u64 {
        self.tried.iter().map(|tried| tried.work).sum()
    }
}
