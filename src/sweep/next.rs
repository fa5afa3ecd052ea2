//! What is to be run next of a sweep, for programs that hand jobs out.

use super::shard::deal;
use super::{Folder, Job, Plan, Refinement, RefinementError, RoundsError, Shard, Step, Sweep};
use std::collections::HashSet;
use std::time::Duration;

/// The jobs of a sweep, or of the next round of a refined one.
#[derive(Clone, Debug)]
pub struct NextJobs {
    /// All of them, none twice.
    pub jobs: Vec<Job>,
    /// Places of those that are to be run, in increasing order.
    pub missing: Vec<usize>,
}

impl NextJobs {
    /// Looks with that many workers at what a folder holds of a sweep. A refined sweep that has
    /// ended has no next jobs.
    ///
    /// # Errors
    /// If a round cannot be chosen, or the folder not be read.
    pub fn new(folder: &Folder, sweep: &Sweep, workers: usize) -> Result<Self, RoundsError> {
        if sweep.refine.is_some() {
            return Self::of_round(folder, sweep, workers);
        }
        let jobs = sweep.jobs().map_err(RefinementError::from)?;
        Ok(Self::of_plan(Plan::new(folder, jobs, workers)?))
    }

    /// The jobs of a plan.
    pub fn of_plan(plan: Plan) -> Self {
        let pending: HashSet<&str> = plan.pending().map(|job| job.id.as_str()).collect();
        Self {
            missing: missing(plan.jobs.iter().map(|(job, _)| job), &pending),
            jobs: plan.jobs.into_iter().map(|(job, _)| job).collect(),
        }
    }

    fn of_round(folder: &Folder, sweep: &Sweep, workers: usize) -> Result<Self, RoundsError> {
        let mut refinement = Refinement::new(folder, sweep, false, workers)?;
        loop {
            let open = match refinement.next_step(sweep)? {
                Step::Known => continue,
                Step::Run(open) => open,
                Step::Finished(_) => Vec::new(),
            };
            let jobs = match open.is_empty() {
                true => Vec::new(),
                false => refinement.round(sweep).map_err(RefinementError::from)?,
            };
            let open: HashSet<&str> = open.iter().map(|job| job.id.as_str()).collect();
            let missing = missing(jobs.iter(), &open);
            return Ok(Self { jobs, missing });
        }
    }

    /// The jobs at these places in shards that take a worker about so long, at a rate (work per
    /// second). A job that takes longer has one of its own.
    pub fn shards(&self, places: &[usize], rate: f64, time: Duration) -> Vec<Shard> {
        let most = (rate * time.as_secs_f64()) as u64;
        let (mut shards, mut own, mut work) = (Vec::new(), Vec::new(), 0);
        for &place in places {
            let more = self.jobs[place].work();
            if !own.is_empty() && work + more > most {
                shards.push(std::mem::take(&mut own));
                work = 0;
            }
            own.push(place);
            work += more;
        }
        shards.extend((!own.is_empty()).then_some(own));
        Shard::of_places(&self.jobs, &shards)
    }

    /// The jobs at these places in so many shards of equal work, of which none is empty.
    pub fn parts(&self, places: &[usize], of: usize) -> Vec<Shard> {
        let work = places.iter().map(|&place| self.jobs[place].work());
        let dealt = deal(&work.collect::<Vec<_>>(), of);
        let mut parts = vec![Vec::new(); of.min(places.len())];
        for (&place, part) in places.iter().zip(dealt) {
            parts[part].push(place);
        }
        parts.retain(|part| !part.is_empty());
        Shard::of_places(&self.jobs, &parts)
    }
}

fn missing<'a>(jobs: impl Iterator<Item = &'a Job>, open: &HashSet<&str>) -> Vec<usize> {
    let places = jobs.enumerate();
    let open = places.filter(|(_, job)| open.contains(job.id.as_str()));
    open.map(|(place, _)| place).collect()
}
