//! Runs a refined sweep: round after round, until none is left.

use super::{Refinement, RefinementError, Refining, Step};
use crate::refine::Finish;
use crate::refusal::Refusal;
use crate::store::StoreError;
use crate::sweep::{FolderError, Job, Plan, PlanError, Pool, PoolError, Report, Standing};
use std::collections::HashSet;
use std::sync::atomic::Ordering;

/// Who watches a sweep while it is refined. All methods may be left as they are: then rounds are
/// run without a word.
pub trait WatchRounds {
    /// Why the watcher gives up.
    type Error: From<RoundsError>;

    /// Runs a round: of the plan of all jobs so far what is pending.
    ///
    /// # Errors
    /// If the round cannot be run.
    fn run(
        &mut self,
        pool: &Pool<'_>,
        plan: &Plan,
        _refinement: &Refinement,
    ) -> Result<Report, Self::Error> {
        Ok(pool.run(plan).map_err(RoundsError::from)?)
    }

    /// All runs of a round were there already.
    fn known(&mut self, _refinement: &Refinement) {}

    /// A round has been learnt, and the tables of the folder are written.
    ///
    /// # Errors
    /// If the watcher gives up.
    fn learnt(&mut self, _pool: &Pool<'_>, _refinement: &Refinement) -> Result<(), Self::Error> {
        Ok(())
    }
}

/// Nobody watches.
impl WatchRounds for () {
    type Error = RoundsError;
}

/// Why the rounds of a sweep end early.
#[derive(Debug, thiserror::Error)]
pub enum RoundsError {
    /// The sweep cannot be refined.
    #[error(transparent)]
    Refinement(#[from] RefinementError),
    /// A round cannot be planned.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// A round cannot be run.
    #[error(transparent)]
    Pool(#[from] PoolError),
    /// The results folder cannot be used.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// A table cannot be written.
    #[error(transparent)]
    Store(#[from] StoreError),
}

impl Refusal for RoundsError {
    fn is_refusal(&self) -> bool {
        match self {
            Self::Refinement(error) => error.is_refusal(),
            Self::Plan(error) => error.is_refusal(),
            Self::Pool(error) => error.is_refusal(),
            Self::Folder(_) | Self::Store(_) => false,
        }
    }
}

/// A sweep that has been refined, or as far as it came.
pub struct Refined {
    /// All jobs so far, with what the folder holds of them.
    pub plan: Plan,
    /// What became of the jobs that were run now.
    pub report: Report,
    /// How far refining is.
    pub refinement: Refinement,
    /// Why no more runs are made; none if it was stopped, or is left to other shards.
    pub end: Option<Finish>,
    /// Number of runs of the next round, which a pool with a shard leaves to a later call.
    pub next: usize,
}

impl Pool<'_> {
    /// Refines the sweep: chooses, runs and learns rounds until none is left. It goes on where it
    /// was stopped, and makes the same runs for any number of workers.
    ///
    /// # Errors
    /// Why a round cannot be chosen or run, and those of the watcher.
    pub fn refine<W: WatchRounds>(&self, watcher: &mut W) -> Result<Refined, W::Error> {
        let (folder, sweep) = (self.folder, self.sweep);
        let is_afresh = !self.wishes.resume;
        let refinement = Refinement::new(folder, sweep, is_afresh, self.workers);
        let mut refinement = refinement.map_err(RoundsError::from)?;
        let mut report: Option<Report> = None;
        let mut next = 0;
        let end = loop {
            let jobs = match refinement.next_step(sweep).map_err(RoundsError::from)? {
                Step::Finished(end) => break Some(end),
                Step::Known if self.wishes.stop.load(Ordering::Relaxed) => break None,
                Step::Known => {
                    watcher.known(&refinement);
                    continue;
                }
                Step::Run(jobs) if self.shard.is_some() && report.is_some() => {
                    next = jobs.len();
                    break None;
                }
                Step::Run(jobs) => jobs,
            };
            self.keep_progress(&refinement)?;
            let plan = self.plan_of_round(&refinement, &jobs)?;
            let round = watcher.run(self, &plan, &refinement)?;
            let is_whole = round.left + round.others == 0 && round.halted.is_none();
            report = Some(match report {
                Some(before) => before.and(round),
                None => round,
            });
            if !is_whole {
                break None;
            }
            self.learn(&mut refinement, &jobs)?;
            watcher.learnt(self, &refinement)?;
        };
        if end.is_some() || next > 0 {
            self.keep_progress(&refinement)?;
        }
        let refining = match end {
            Some(_) => Some(refinement.refining().clone()),
            None if next > 0 => Some(refinement.refining().clone()),
            // Stopped before anything was run, the folder stays as it was.
            None => folder.read_refining(sweep).map_err(RoundsError::from)?,
        };
        let plan = self.plan_of(refining.as_ref())?;
        let report = match report {
            Some(report) => report,
            None => watcher.run(self, &plan, &refinement)?,
        };
        Ok(Refined {
            plan,
            report,
            refinement,
            end,
            next,
        })
    }

    fn keep_progress(&self, refinement: &Refinement) -> Result<(), RoundsError> {
        Ok(self.folder.write_refining(refinement.refining())?)
    }

    fn plan_of(&self, refining: Option<&Refining>) -> Result<Plan, RoundsError> {
        let jobs = self.sweep.jobs_so_far(refining);
        let jobs = jobs.map_err(RefinementError::from)?;
        Ok(Plan::new(self.folder, jobs, self.workers)?)
    }

    /// The plan of all jobs that have not failed, of which only those of the round are pending, and
    /// of the pool's shard, if it has one.
    fn plan_of_round(&self, refinement: &Refinement, open: &[Job]) -> Result<Plan, RoundsError> {
        let refining = refinement.refining();
        let mut plan = self.plan_of(Some(refining))?;
        let point = |values: &[f64], seed| -> (Vec<u64>, u64) {
            (values.iter().map(|value| value.to_bits()).collect(), seed)
        };
        let failed = refining.failed.iter();
        let failed: HashSet<_> = failed.map(|run| point(&run.values, run.seed)).collect();
        plan.jobs
            .retain(|(job, _)| !failed.contains(&point(&job.values, job.seed)));
        if !self.wishes.resume {
            let open: HashSet<&str> = open.iter().map(|job| job.id.as_str()).collect();
            let again = plan.jobs.iter_mut();
            again
                .filter(|(job, _)| open.contains(job.id.as_str()))
                .for_each(|(_, standing)| *standing = Standing::Missing);
        }
        if let Some(shard) = self.shard {
            let round = refinement
                .round(self.sweep)
                .map_err(RefinementError::from)?;
            plan.leave_to_others(&shard.of(&round).map_err(PlanError::from)?);
        }
        Ok(plan)
    }

    /// Learns a round, and writes what is known by now.
    fn learn(&self, refinement: &mut Refinement, jobs: &[Job]) -> Result<(), RoundsError> {
        refinement.learn(self.folder, self.sweep, jobs, self.workers)?;
        self.keep_progress(refinement)?;
        if let Some(learnt) = refinement.learnt()? {
            learnt.write(self.folder, self.sweep, refinement.table().family)?;
        }
        Ok(())
    }
}
