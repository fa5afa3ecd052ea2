//! What a sweep costs, from a few of its jobs.

use super::representatives::representatives;
use super::{CostError, Part, RunCost};
use crate::sweep::Job;
use std::time::Duration;

/// What a sweep, or a single scene, costs.
#[derive(Clone, Debug)]
pub struct SweepCost<'a> {
    /// The jobs that were tried.
    pub tried: Vec<Tried<'a>>,
}

/// A job that was tried, and what it stands for.
#[derive(Clone, Debug)]
pub struct Tried<'a> {
    /// The job.
    pub job: &'a Job,
    /// Number of jobs that it stands for, itself among them.
    pub jobs: usize,
    /// Their sphere-steps.
    pub sphere_steps: u64,
    /// What it costs.
    pub cost: RunCost,
}

impl Tried<'_> {
    /// Processor time of a part of all jobs that it stands for (s).
    pub fn seconds(&self, part: Part) -> f64 {
        let runs = match part {
            // Once for every job, however far it comes.
            Part::Start | Part::Record => self.jobs as f64,
            _ => self.sphere_steps as f64 / self.cost.all_sphere_steps.max(1) as f64,
        };
        self.cost.all_seconds(part) * runs
    }
}

impl<'a> SweepCost<'a> {
    /// Measures the jobs at the corners and in the middle of the grid one after the other, with so much
    /// processor time for all of them. Each stands for the jobs nearest to it.
    ///
    /// # Errors
    /// If a job cannot be run.
    pub fn measure(jobs: &'a [Job], budget: Duration) -> Result<Self, CostError> {
        let chosen = representatives(jobs);
        let budget = budget / (chosen.len() as u32).max(1);
        let tried = chosen.into_iter().map(|it| {
            let cost = RunCost::measure(&it.job.scene, budget)?;
            Ok(Tried {
                job: it.job,
                jobs: it.jobs,
                // A silo that emptied has told how much less it takes.
                sphere_steps: match jobs.len() {
                    1 => cost.all_sphere_steps,
                    _ => it.sphere_steps,
                },
                cost,
            })
        });
        Ok(Self {
            tried: tried.collect::<Result<_, CostError>>()?,
        })
    }

    /// Processor time of a part of all jobs (s).
    pub fn seconds(&self, part: Part) -> f64 {
        self.tried.iter().map(|tried| tried.seconds(part)).sum()
    }

    /// Processor time of all jobs (s).
    pub fn total(&self) -> f64 {
        Part::ALL.iter().map(|&part| self.seconds(part)).sum()
    }

    /// Sphere-steps of all jobs; where spheres come and go, the most that they may take.
    pub fn sphere_steps(&self) -> u64 {
        self.tried.iter().map(|tried| tried.sphere_steps).sum()
    }

    /// Whether any job has that part.
    pub fn has(&self, part: Part) -> bool {
        self.tried.iter().any(|it| part.is_in(&it.job.scene))
    }

    /// Processor time of a part per sphere and step (s).
    pub fn per_sphere_step(&self, part: Part) -> f64 {
        self.seconds(part) / self.sphere_steps().max(1) as f64
    }
}
