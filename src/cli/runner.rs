//! Runs the jobs of sweeps and of studies and watches them. Here a backend is chosen.

use super::console::{Console, name_first};
use super::exit::Failure;
use super::progress::{Progress, Work};
use super::{builds, format, job};
use phase::external;
use phase::grid::describe;
use phase::record::{Outcome, RunRecord};
use phase::run::{Run, model_of};
use phase::sweep::{
    Event, Failure as JobFailure, Folder, Job, LocalThreads, Plan, Pool, Report, Shard, Standing,
    Sweep, Wishes,
};
use std::collections::HashMap;
use std::sync::Mutex;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

/// How and where the jobs of a sweep are run.
pub(super) struct Runner<'a> {
    pub(super) folder: &'a Folder,
    pub(super) workers: usize,
    pub(super) stop: &'a AtomicBool,
    pub(super) checkpoint_interval: Duration,
    pub(super) force: bool,
    /// Which jobs are run, if not all.
    pub(super) shard: Option<&'a Shard>,
    pub(super) console: &'a Console,
}

impl Runner<'_> {
    /// What is done of these jobs, and what is left.
    pub(super) fn plan(&self, jobs: Vec<Job>) -> Result<Plan, Failure> {
        Ok(match self.force {
            true => Plan::afresh(jobs),
            false => Plan::of_shard(self.folder, jobs, self.shard, self.workers)?,
        })
    }

    /// Runs what is left of a plan.
    pub(super) fn run(&self, sweep: &Sweep, plan: &Plan) -> Result<RunsMade, Failure> {
        tell_of_plan(plan, self.console);
        self.with_pool(sweep, |pool| self.run_part(plan, pool, Part::default()))
    }

    /// Calls `act` with the pool that runs the jobs of a sweep.
    pub(super) fn with_pool<T>(&self, sweep: &Sweep, act: impl FnOnce(&Pool<'_>) -> T) -> T {
        // Programs start in folders of their own; who runs the sweep has asked whether they may.
        let begin = |job: &Job| {
            let scene = job.scene();
            match scene.is_external() {
                true => external::begin(&scene, self.folder.run_folder(&job.id), !self.force),
                false => Run::new(&scene),
            }
        };
        act(&Pool {
            shard: self.shard,
            workers: self.workers,
            checkpoint_interval: self.checkpoint_interval,
            wishes: Wishes {
                stop: self.stop,
                resume: !self.force,
                ..Wishes::default()
            },
            ..Pool::new(
                self.folder,
                sweep,
                &LocalThreads::new(self.workers).beginning(&begin),
            )
        })
    }

    /// Runs a plan that is part of more.
    pub(super) fn run_part(
        &self,
        plan: &Plan,
        pool: &Pool<'_>,
        part: Part,
    ) -> Result<RunsMade, Failure> {
        run(plan, pool, part, self.workers, self.console)
    }
}

/// What a plan is part of.
#[derive(Default)]
pub(super) struct Part {
    /// Printed before its progress; may be empty.
    pub(super) head: String,
    /// Largest number of jobs in total, if larger than the plan's.
    pub(super) jobs: Option<usize>,
}

/// The runs made now.
#[derive(Default)]
pub(super) struct RunsMade {
    pub(super) report: Report,
    /// Jobs that had a record before, or a label that counts without one.
    pub(super) done_before: usize,
    pub(super) seconds: f64,
    pub(super) workers: usize,
    /// Runs that a guard ended, and which.
    pub(super) unstable: Vec<JobFailure>,
    /// Number of runs of the next round, which a shard of a refined sweep leaves to later tasks.
    pub(super) next: usize,
}

/// Runs what is to be run of a plan and watches it.
fn run(
    plan: &Plan,
    pool: &Pool<'_>,
    part: Part,
    workers: usize,
    console: &Console,
) -> Result<RunsMade, Failure> {
    let sweep = pool.sweep;
    let progress = Progress::new(console, work_of(plan, part, sweep));
    let name = |job: &Job| describe(&sweep.axes, &job.values, job.seed);
    let unstable = Mutex::new(HashMap::new());
    let note_unstable = |job: &Job, outcome: &Outcome| {
        if let (Outcome::Unstable(instability), Ok(mut unstable)) = (outcome, unstable.lock()) {
            let unstable_job = JobFailure::new(job, instability.to_string());
            unstable.insert(job.id.clone(), unstable_job);
        }
    };
    for (job, done) in plan.done() {
        note_unstable(job, &done.outcome);
    }
    let ended = |job: &Job, record: &RunRecord| {
        note_unstable(job, &record.outcome);
        let seconds = format::duration(record.cpu_seconds);
        format!("done: {} (job {}), {seconds} of CPU", name(job), job.id)
    };
    let watch = |event: Event<'_>| job::tell(event, &progress, &name, &ended);
    let pool = Pool {
        wishes: Wishes {
            watch: &watch,
            ..pool.wishes
        },
        ..*pool
    };
    let report = pool.run(plan);
    let seconds = progress.finish();
    let mut unstable = unstable.into_inner().unwrap_or_default();
    let unstable = plan
        .jobs
        .iter()
        .filter_map(|(job, _)| unstable.remove(&job.id))
        .collect();
    Ok(RunsMade {
        report: report?,
        done_before: plan.labelled().count(),
        seconds,
        workers,
        unstable,
        next: 0,
    })
}

/// The work of a plan, or of the whole that it is part of.
fn work_of(plan: &Plan, part: Part, sweep: &Sweep) -> Work {
    let steps = Job::work;
    let done: u64 = plan.labelled().map(steps).sum();
    let planned = done + plan.pending().map(steps).sum::<u64>();
    let jobs = part.jobs.unwrap_or(plan.own());
    // Jobs that are not planned yet take as much work as the others do on average.
    let scale = jobs as f64 / plan.own().max(1) as f64;
    Work {
        jobs,
        jobs_done: plan.labelled().count(),
        steps: (planned as f64 * scale) as u64,
        steps_done: done,
        unit: model_of(&sweep.scene).work_unit(),
        head: part.head,
    }
}

impl RunsMade {
    /// Says what is left to other shards, if anything is.
    pub(super) fn is_left_to_others(&self, console: &Console) -> bool {
        if self.report.others > 0 {
            console.result(format_args!(
                "{} left to other shards, of which the last one writes tables and figures",
                format::count(self.report.others, "job")
            ));
        }
        if self.next > 0 {
            console.result(format_args!(
                "the next round has {}: run the shards again",
                format::count(self.next, "job")
            ));
        }
        self.report.others + self.next > 0
    }

    /// Prints what was done and names what went wrong.
    pub(super) fn print(&self, plan: &Plan, sweep: &Sweep, console: &Console) {
        console.result(self.summary(plan, sweep));
        name_first(&names(&self.unstable, sweep), |name| {
            console.note(format_args!("unstable: {name}"));
        });
        self.tell_of_failures(sweep, console);
    }

    /// Names the jobs that failed; of those that failed alike the first.
    pub(super) fn tell_of_failures(&self, sweep: &Sweep, console: &Console) {
        name_first(&names_of_kinds(&self.report.failures, sweep), |name| {
            console.error(format_args!("failed: {name}"));
        });
        if let Some(error) = &self.report.unnoted {
            console.error(format_args!(
                "the table of failed jobs could not be written: {error}"
            ));
        }
    }

    /// How much was done, how fast, and what is left.
    fn summary(&self, plan: &Plan, sweep: &Sweep) -> String {
        let Report {
            finished,
            resumed,
            failures,
            left,
            work,
            cpu_seconds,
            ..
        } = &self.report;
        let mut text = format!(
            "{}: {finished} run now in {} with {}",
            format::count(plan.own(), "job"),
            format::duration(self.seconds),
            format::count(self.workers, "worker"),
        );
        for (number, what) in [
            (*resumed, "of them resumed from a checkpoint"),
            (self.done_before, "done before"),
            (self.report.elsewhere, "run by another process"),
            (self.unstable.len(), "unstable"),
            (failures.len(), "failed"),
            (*left, "left"),
        ] {
            if number > 0 {
                text += &format!(", {number} {what}");
            }
        }
        if *finished > 0 && sweep.scene.is_external() {
            let time = format::duration(*cpu_seconds);
            text += &format!("\ntheir programs took {time}");
        } else if *finished > 0 {
            let unit = model_of(&sweep.scene).work_unit();
            text += &format!(
                "\n{} in {} of CPU time: {} per CPU second",
                format::work(*work as f64, unit),
                format::duration(*cpu_seconds),
                format::work(*work as f64 / cpu_seconds.max(1e-9), unit),
            );
        }
        text
    }
}

/// Names jobs, each with what went wrong.
fn names(jobs: &[JobFailure], sweep: &Sweep) -> Vec<String> {
    let named = |job: &JobFailure| format!("{}: {}", name_of(job, sweep), job.reason);
    jobs.iter().map(named).collect()
}

/// Says what went wrong with jobs, once for those with which the same did.
fn names_of_kinds(jobs: &[JobFailure], sweep: &Sweep) -> Vec<String> {
    let mut places = HashMap::new();
    let mut kinds: Vec<(&JobFailure, usize)> = Vec::new();
    for job in jobs {
        let place = *places.entry(job.kind()).or_insert(kinds.len());
        match kinds.get_mut(place) {
            Some((_, count)) => *count += 1,
            None => kinds.push((job, 1)),
        }
    }
    let named = |(first, count): &(&JobFailure, usize)| match count {
        1 => format!("{}: {}", name_of(first, sweep), first.reason),
        count => format!(
            "{count} jobs: {}; the first: {}",
            first.reason,
            name_of(first, sweep)
        ),
    };
    kinds.iter().map(named).collect()
}

fn name_of(job: &JobFailure, sweep: &Sweep) -> String {
    let name = describe(&sweep.axes, &job.values, job.seed);
    format!("{name} (job {})", job.id)
}

/// Says what is done already, and what is run again and why.
pub(super) fn tell_of_plan(plan: &Plan, console: &Console) {
    let done = plan.labelled().count();
    if done > 0 {
        console.note(format_args!(
            "{done} of {} are done already",
            format::count(plan.own(), "job")
        ));
    }
    let makers = plan.done().map(|(_, done)| Some(&done.program));
    builds::tell_of_others("record", makers, console);
    for (job, standing) in &plan.jobs {
        match standing {
            Standing::Damaged(reason) => console.note(format_args!(
                "running job {} again: its record cannot be used: {reason}",
                job.id
            )),
            Standing::OtherOutput => console.detail(format_args!(
                "running job {} again: its record was made with other output settings",
                job.id
            )),
            Standing::Missing
            | Standing::Done(_)
            | Standing::Labelled
            | Standing::Foreign(_)
            | Standing::OfOtherShard
            | Standing::Unread => {}
        }
    }
}
