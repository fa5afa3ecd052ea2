//! The rounds of a refined sweep, as people see them.

use crate::cli::exit::Failure;
use crate::cli::figures;
use crate::cli::runner::{Part, Runner, RunsMade, tell_of_plan};
use crate::cli::{format, refined};
use phase::refine::{Finish, Settings};
use phase::sweep::{Plan, Pool, Refinement, Report, Sweep, WatchRounds};
use std::time::{Duration, Instant};

/// Time between two notes while rounds are chosen.
const BETWEEN_NOTES: Duration = Duration::from_secs(5);

/// Runs the rounds of a sweep, and draws each if `draws`. Gives the plan of all jobs, what was run,
/// and how far refining is.
pub(super) fn refine(
    runner: &Runner<'_>,
    sweep: &Sweep,
    draws: bool,
) -> Result<(Plan, RunsMade, Refinement), Failure> {
    let mut watcher = Watcher {
        runner,
        draws,
        run: None,
        told: Instant::now(),
    };
    let done = runner.with_pool(sweep, |pool| pool.refine(&mut watcher))?;
    tell_of_end(runner, sweep, &done.refinement, done.end);
    let report = done.report;
    let done_before = done.plan.labelled().count();
    let run = RunsMade {
        done_before: done_before.saturating_sub(report.finished + report.elsewhere),
        report,
        next: done.next,
        ..watcher.run.unwrap_or_default()
    };
    Ok((done.plan, run, done.refinement))
}

/// What the progress of a round is part of.
fn part(sweep: &Sweep, refinement: &Refinement) -> Part {
    let (Some(settings), true) = (&sweep.refine, refinement.rounds() > 0) else {
        return Part::default();
    };
    let widest = match refinement.rounds() {
        1 => "coarse grid".to_owned(),
        _ => refined::describe_widest(sweep, refinement.refining()),
    };
    Part {
        head: format!("round {}, {widest}", refinement.rounds()),
        jobs: Some(settings.budget),
    }
}

fn tell_of_end(runner: &Runner<'_>, sweep: &Sweep, refinement: &Refinement, end: Option<Finish>) {
    let (Some(end), Some(settings)) = (end, &sweep.refine) else {
        return;
    };
    runner.console.result(format_args!(
        "refined with {}: {}; {}",
        format::count(refinement.runs(), "run"),
        refined::describe_end(settings, end),
        refined::describe_widest(sweep, refinement.refining())
    ));
    if let Some(gap) = refinement.gap().filter(|gap| gap.radius > 0.0) {
        runner.console.note(refined::describe_gap(sweep, &gap));
    }
}

/// Shows rounds to people.
struct Watcher<'a> {
    runner: &'a Runner<'a>,
    /// Whether each round is drawn.
    draws: bool,
    /// The runs so far, for the report.
    run: Option<RunsMade>,
    /// When progress was last reported.
    told: Instant,
}

impl WatchRounds for Watcher<'_> {
    type Error = Failure;

    fn run(
        &mut self,
        pool: &Pool<'_>,
        plan: &Plan,
        refinement: &Refinement,
    ) -> Result<Report, Failure> {
        if self.run.is_none() {
            tell_of_plan(plan, self.runner.console);
        }
        let part = part(pool.sweep, refinement);
        let mut round = self.runner.run_part(plan, pool, part)?;
        let report = std::mem::take(&mut round.report);
        round.seconds += self.run.take().map_or(0.0, |before| before.seconds);
        self.run = Some(round);
        Ok(report)
    }

    /// Reports progress while replaying rounds whose runs already exist.
    fn known(&mut self, refinement: &Refinement) {
        if self.told.elapsed() >= BETWEEN_NOTES {
            self.told = Instant::now();
            self.runner.console.note(format_args!(
                "round {} replayed: {}",
                refinement.rounds(),
                format::count(refinement.runs(), "run")
            ));
        }
    }

    /// Prints what a round has shown, and updates the figure.
    fn learnt(&mut self, pool: &Pool<'_>, refinement: &Refinement) -> Result<(), Failure> {
        if let Some(settings) = &pool.sweep.refine {
            self.runner.console.note(format_args!(
                "round {}: {} of at most {}; {}",
                refinement.rounds(),
                format::count(refinement.runs(), "run"),
                settings.budget,
                refined::describe_widest(pool.sweep, refinement.refining())
            ));
        }
        if self.draws && refinement.runs() > 0 {
            figures::draw_round(pool.folder, pool.sweep, refinement.table())?;
        }
        Ok(())
    }
}

/// Refuses what does not go with refining.
pub(super) fn check(settings: &Settings, seeds: &[u64]) -> Result<(), Failure> {
    if seeds.len() > 1 {
        return Err(Failure::refused(format_args!(
            "a refined sweep takes one --seed, the first one; each point then uses at most {} from \
             there on",
            format::count(settings.replicates as usize, "seed")
        )));
    }
    Ok(())
}
