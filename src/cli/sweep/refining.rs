//! The rounds of a refined sweep: a coarse grid, then runs where the label is least certain.

use super::rounds::{Part, Rounds, Run};
use crate::cli::exit::Failure;
use crate::cli::{format, plot, refined};
use phase::refine::Finish;
use phase::sweep::{
    Folder, Job, Plan, Refinement, RefinementError, Refining, Standing, Step, Sweep,
};
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

/// Time between two notes while rounds are chosen.
const BETWEEN_NOTES: Duration = Duration::from_secs(5);

impl Rounds<'_> {
    /// Runs the rounds, and puts the runs into the sweep. Gives the plan of all its jobs, what was
    /// run, and the number of runs that have been learnt from.
    pub(super) fn refine(&self, sweep: &mut Sweep) -> Result<(Plan, Run, usize), Failure> {
        let Rounds {
            folder,
            workers,
            console,
            ..
        } = *self;
        let mut refinement =
            Refinement::new(folder, sweep, self.force, workers).map_err(refused_or_failed)?;
        let mut run: Option<Run> = None;
        let mut told = Instant::now();
        let end = loop {
            let jobs = match refinement.next_step(sweep).map_err(refused_or_failed)? {
                Step::Finished(end) => break Some(end),
                Step::Known if self.stop.load(Ordering::Relaxed) => break None,
                Step::Known => {
                    self.tell_of_known(&refinement, &mut told);
                    continue;
                }
                Step::Run(jobs) => jobs,
            };
            let plan = self.plan_of_round(sweep, &jobs)?;
            if run.is_none() {
                super::rounds::tell_of_plan(&plan, console);
            }
            let round = self.run_part(&plan, sweep, self.part(sweep, &refinement))?;
            let mut all = match run {
                Some(run) => run.and(round),
                None => round,
            };
            all.note_failures(sweep, folder);
            let is_whole = all.report.left == 0 && all.report.halted.is_none();
            run = Some(all);
            if !is_whole {
                break None;
            }
            refinement
                .learn(folder, sweep, &jobs, workers)
                .map_err(refused_or_failed)?;
            self.show(folder, sweep, &mut refinement)?;
        };
        if end.is_none()
            && run.is_none()
            && let Some(stored) = folder.read_sweep().ok().and_then(|it| it.refine)
        {
            // Stopped before anything was run: the folder stays as it was.
            sweep.refine = Some(stored);
        }
        let plan = Plan::new(folder, all_jobs(sweep)?, workers).map_err(Failure::failed)?;
        let run = match run {
            Some(run) => run,
            None => self.run_part(&plan, sweep, Part::default())?,
        };
        if end.is_some() {
            folder.write_sweep(sweep).map_err(Failure::failed)?;
        }
        self.tell_of_end(sweep, &refinement, end);
        let done_before = plan.labelled().count().saturating_sub(run.report.finished);
        let run = Run { done_before, ..run };
        Ok((plan, run, refinement.runs()))
    }

    /// Says now and then how far the choosing of rounds is whose runs are there already.
    fn tell_of_known(&self, refinement: &Refinement, told: &mut Instant) {
        if told.elapsed() >= BETWEEN_NOTES {
            *told = Instant::now();
            self.console.note(format_args!(
                "round {} chosen again: {}",
                refinement.rounds(),
                format::count(refinement.runs(), "run")
            ));
        }
    }

    /// The plan of all jobs that have not failed, of which only those of the round are to be run.
    fn plan_of_round(&self, sweep: &Sweep, round: &[Job]) -> Result<Plan, Failure> {
        let mut jobs = all_jobs(sweep)?;
        let refining = sweep.refine.as_ref();
        let has_failed = |job: &Job| {
            let mut failed = refining.into_iter().flat_map(|it| &it.failed);
            failed.any(|run| run.values == job.values && run.seed == job.seed)
        };
        jobs.retain(|job| !has_failed(job));
        let mut plan = Plan::new(self.folder, jobs, self.workers).map_err(Failure::failed)?;
        if self.force {
            let of_round = |job: &Job| round.iter().any(|other| other.id == job.id);
            let again = plan.jobs.iter_mut().filter(|(job, _)| of_round(job));
            again.for_each(|(_, standing)| *standing = Standing::Missing);
        }
        Ok(plan)
    }

    /// What the progress of a round is part of.
    fn part(&self, sweep: &Sweep, refinement: &Refinement) -> Part {
        let Some(refining) = &sweep.refine else {
            return Part::default();
        };
        let widest = match refinement.rounds() {
            0 | 1 => "coarse grid".to_owned(),
            _ => refined::describe_widest(sweep, refining),
        };
        Part {
            head: format!("round {}, {widest}", refinement.rounds()),
            jobs: Some(refining.settings.budget),
        }
    }

    /// Says what a round has told, and writes tables and figure anew.
    fn show(
        &self,
        folder: &Folder,
        sweep: &Sweep,
        refinement: &mut Refinement,
    ) -> Result<(), Failure> {
        if let Some(refining) = &sweep.refine {
            self.console.note(format_args!(
                "round {}: {} of at most {}; {}",
                refinement.rounds(),
                format::count(refinement.runs(), "run"),
                refining.settings.budget,
                refined::describe_widest(sweep, refining)
            ));
        }
        if let Some(learnt) = refinement.learnt().map_err(refused_or_failed)? {
            let family = refinement.table().family;
            learnt
                .write(folder, sweep, family)
                .map_err(Failure::failed)?;
            if self.draws {
                plot::draw_round(folder, sweep, refinement.table())?;
            }
        }
        Ok(())
    }

    fn tell_of_end(&self, sweep: &Sweep, refinement: &Refinement, end: Option<Finish>) {
        let (Some(end), Some(refining)) = (end, &sweep.refine) else {
            return;
        };
        self.console.result(format_args!(
            "refined with {}: {}; {}",
            format::count(refinement.runs(), "run"),
            refined::describe_end(refining, end),
            refined::describe_widest(sweep, refining)
        ));
        if let Some(gap) = refinement.gap().filter(|gap| gap.radius > 0.0) {
            self.console.note(refined::describe_gap(sweep, &gap));
        }
    }
}

fn all_jobs(sweep: &Sweep) -> Result<Vec<Job>, Failure> {
    sweep.jobs().map_err(Failure::refused)
}

fn refused_or_failed(error: RefinementError) -> Failure {
    match error {
        RefinementError::Threads(_) => Failure::failed(error),
        _ => Failure::refused(error),
    }
}

/// Refuses what does not go with refining.
pub(super) fn check(refining: &Refining, seeds: &[u64]) -> Result<(), Failure> {
    if seeds.len() > 1 {
        return Err(Failure::refused(format_args!(
            "a refined sweep takes one --seed, the first; each point has at most {} from there on",
            format::count(refining.settings.replicates as usize, "seed")
        )));
    }
    Ok(())
}
