//! `phase sweep`: runs the jobs of a sweep, labels them, draws the figures.

use super::console::{Console, name_first};
use super::exit::{Exit, Failure};
use super::job::NamedJob;
use super::progress::{Progress, Work};
use super::{builds, classify, format, interrupt, job, plot, time_step};
use phase::record::{Outcome, RunRecord};
use phase::resume::DEFAULT_INTERVAL;
use phase::run::model_of;
use phase::sweep::{
    Event, Failure as JobFailure, Folder, FolderError, Job, Plan, Pool, PoolError, Report,
    Standing, Sweep, describe, differing_keys, refuse_to_lose_labels, work,
};
use serde::Serialize;
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::Ordering;
use std::time::Duration;

/// Run the simulations of a sweep, label them, draw the phase diagram.
///
/// Jobs whose record is already in the results folder are not run again: a sweep that was stopped
/// goes on where it was, and long runs that were under way from their latest checkpoint.
#[derive(clap::Args)]
#[command(after_help = "\
Example: the 9 x 9 grid on four cores, results in ./results/quick
  phase sweep sweeps/quick.toml -j 4

The results folder holds sweep.json (the sweep as run), records/ (one HDF5 file per run),
labels.csv (one row per run), points.csv (one row per point of the grid), the figures as SVG
and PNG, and, if any job failed, failed.csv.")]
pub(crate) struct Arguments {
    /// The sweep file (TOML).
    file: PathBuf,
    /// The results folder [default: results/NAME, the sweep file's name without .toml].
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Simulations at the same time [default: all cores].
    #[arg(short, long, value_name = "N", value_parser = at_least_one)]
    jobs: Option<usize>,
    /// Run every job again, whatever the results folder holds.
    #[arg(short, long)]
    force: bool,
    /// Seeds in place of the file's; may be given several times.
    #[arg(short, long, value_name = "SEED", value_delimiter = ',', value_parser = super::seed)]
    seed: Vec<u64>,
    /// Time between two checkpoints of a run (s), from which it goes on when the sweep is run again
    /// [default: 120].
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    checkpoint_interval: Option<Duration>,
    /// Only run the simulations: no labels, no figures.
    #[arg(long)]
    no_classify: bool,
    /// Draw no figures.
    #[arg(long)]
    no_plot: bool,
    /// Print the result as one JSON object (docs/json.md) instead of text.
    #[arg(long)]
    pub(super) json: bool,
}

/// Parses a time in seconds.
pub(super) fn seconds(text: &str) -> Result<Duration, String> {
    let seconds = text.parse().ok().map(Duration::try_from_secs_f64);
    match seconds {
        Some(Ok(time)) => Ok(time),
        _ => Err("must be a time in seconds, 0 or more".to_owned()),
    }
}

/// Parses a number of workers.
pub(super) fn at_least_one(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(number) if number > 0 => Ok(number),
        _ => Err("must be a whole number from 1".to_owned()),
    }
}

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    let mut sweep = phase::sweep::load(&arguments.file).map_err(Failure::refused)?;
    if !arguments.seed.is_empty() {
        sweep.seeds = distinct(&arguments.seed)?;
    }
    let workers = arguments.jobs.unwrap_or_else(work::default_workers);
    let jobs = sweep.jobs().map_err(Failure::refused)?;
    if !arguments.no_classify {
        sweep.check_sieves(&jobs).map_err(classify::cannot_label)?;
    }
    let folder = Folder::new(
        arguments
            .out
            .clone()
            .unwrap_or_else(|| default_folder(&arguments.file)),
    );
    let stop = interrupt::stop_on_signal(console)?;

    folder.create().map_err(Failure::failed)?;
    let _lock = folder.lock().map_err(|error| match error {
        FolderError::Locked(_) => Failure::refused(error),
        _ => Failure::failed(error),
    })?;
    if !arguments.force && !arguments.no_classify {
        let kept = jobs.iter().map(|job| job.id.as_str());
        refuse_to_lose_labels(&folder, kept).map_err(classify::cannot_write)?;
    }
    tell_of_other_sweep(&folder, &sweep, console);
    let plan = if arguments.force {
        Plan::afresh(jobs.clone())
    } else {
        Plan::new(&folder, jobs.clone(), workers).map_err(Failure::failed)?
    };
    tell_of_plan(&plan, console);
    time_step::tell_of_jobs(&jobs, &sweep.axes, console);
    if !arguments.no_classify {
        warn_of_windows(&sweep, &jobs, console);
    }
    let pool = Pool {
        folder: &folder,
        sweep: &sweep,
        workers,
        stop,
        checkpoint_interval: arguments.checkpoint_interval.unwrap_or(DEFAULT_INTERVAL),
        resume: !arguments.force,
        watch: &|_| {},
    };
    let run = run(&plan, pool, console)?;
    run.print(&plan, &sweep, console)?;
    let mut answer = Answer::new(&folder, &plan, &sweep, &run);

    if stop.load(Ordering::Relaxed) {
        console.note(format_args!(
            "interrupted; {} left. Go on with the same command",
            format::count(run.report.left, "job")
        ));
        answer.interrupted = true;
        console.answer(&answer);
        return Ok(Exit::Interrupted);
    }
    if let Some(error) = &run.report.halted {
        return Err(Failure::failed(error));
    }
    let mut failed = !run.report.failures.is_empty();
    if !arguments.no_classify {
        let labelled = classify::label_folder(&folder, &sweep, &jobs, workers, console)?;
        failed |= !labelled.problems.is_empty();
        if !arguments.no_plot {
            let place = folder.root();
            plot::draw_default_figures(&folder, place, &sweep, &labelled.table, console)?;
        }
        answer.labels = Some(classify::Summary::new(&folder, &labelled));
    }
    answer.files = console.files();
    console.answer(&answer);
    Ok(if failed { Exit::Failed } else { Exit::Done })
}

/// Warns of sieves that find nothing in any run, as these are too short.
pub(super) fn warn_of_windows(sweep: &Sweep, jobs: &[Job], console: &Console) {
    for (name, window, duration) in sweep.sieves_without_room(jobs) {
        console.warning(format_args!(
            "the window of the sieve {name}, {window} s, is longer than the runs, {duration} s: it \
             finds nothing in any of them; lengthen time.duration, or shorten `window` in \
             [sieves.{name}]"
        ));
    }
}

/// Seeds, each of which is there once.
fn distinct(seeds: &[u64]) -> Result<Vec<u64>, Failure> {
    let mut seen = HashSet::new();
    match seeds.iter().find(|seed| !seen.insert(**seed)) {
        None => Ok(seeds.to_vec()),
        Some(seed) => Err(Failure::refused(format_args!(
            "--seed {seed} is there twice, and would count its runs twice; give it once"
        ))),
    }
}

/// `results/<stem of the sweep file>`.
pub(super) fn default_folder(file: &Path) -> PathBuf {
    Path::new("results").join(file.file_stem().unwrap_or("sweep".as_ref()))
}

/// Says in what an earlier sweep of the same folder differed.
fn tell_of_other_sweep(folder: &Folder, sweep: &Sweep, console: &Console) {
    let Ok(earlier) = folder.read_sweep() else {
        return;
    };
    let keys = differing_keys(&earlier, sweep);
    if !keys.is_empty() {
        console.note(format_args!(
            "the sweep has changed since it was last run into {} ({}); records it still needs are \
             kept, others stay in the folder unused",
            folder.root().display(),
            keys.join(", ")
        ));
    }
}

/// Says what is done already, and what is run again and why.
fn tell_of_plan(plan: &Plan, console: &Console) {
    let done = plan.done().count();
    if done > 0 {
        console.note(format_args!(
            "{done} of {} are done already",
            format::count(plan.jobs.len(), "job")
        ));
    }
    let makers = plan.done().map(|(_, done)| Some(&done.program));
    builds::tell_of_others("record", makers, console);
    for (job, standing) in &plan.jobs {
        match standing {
            Standing::Damaged(reason) => console.note(format_args!(
                "run again: the record of job {} cannot be used: {reason}",
                job.id
            )),
            Standing::OtherOutput => console.detail(format_args!(
                "run again: the record of job {} was made with other output settings",
                job.id
            )),
            Standing::Missing | Standing::Done(_) | Standing::Foreign(_) => {}
        }
    }
}

/// What was run now.
struct Run {
    report: Report,
    seconds: f64,
    workers: usize,
    /// Runs that a guard ended, and which.
    unstable: Vec<JobFailure>,
}

/// What `--json` prints.
#[derive(Serialize)]
struct Answer {
    folder: PathBuf,
    jobs: usize,
    done_before: usize,
    run_now: usize,
    resumed: usize,
    left: usize,
    unstable: Vec<NamedJob>,
    failed: Vec<NamedJob>,
    interrupted: bool,
    workers: usize,
    seconds: f64,
    cpu_seconds: f64,
    sphere_steps: u64,
    labels: Option<classify::Summary>,
    /// The files written, but for the records.
    files: Vec<PathBuf>,
}

impl Answer {
    fn new(folder: &Folder, plan: &Plan, sweep: &Sweep, run: &Run) -> Self {
        Self {
            folder: folder.root().to_owned(),
            jobs: plan.jobs.len(),
            done_before: plan.done().count(),
            run_now: run.report.finished,
            resumed: run.report.resumed,
            left: run.report.left,
            unstable: NamedJob::all(&sweep.axes, &run.unstable),
            failed: NamedJob::all(&sweep.axes, &run.report.failures),
            interrupted: false,
            workers: run.workers,
            seconds: run.seconds,
            cpu_seconds: run.report.cpu_seconds,
            sphere_steps: run.report.work,
            labels: None,
            files: Vec::new(),
        }
    }
}

/// Runs what is to be run of a plan and watches it.
fn run(plan: &Plan, pool: Pool<'_>, console: &Console) -> Result<Run, Failure> {
    let (sweep, workers) = (pool.sweep, pool.workers);
    let steps = Job::work;
    let progress = Progress::new(
        console,
        Work {
            jobs: plan.jobs.len(),
            jobs_done: plan.done().count(),
            steps: plan.jobs.iter().map(|(job, _)| steps(job)).sum(),
            steps_done: plan.done().map(|(job, _)| steps(job)).sum(),
            unit: model_of(&sweep.scene).work_unit(),
        },
    );
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
        watch: &watch,
        ..pool
    };
    let report = pool.run(plan).map_err(|error| match error {
        PoolError::Foreign(_) => Failure::refused(error),
        _ => Failure::failed(error),
    });
    let seconds = progress.finish();
    let mut unstable = unstable.into_inner().unwrap_or_default();
    let unstable = plan
        .jobs
        .iter()
        .filter_map(|(job, _)| unstable.remove(&job.id))
        .collect();
    Ok(Run {
        report: report?,
        seconds,
        workers,
        unstable,
    })
}

impl Run {
    /// Prints what was done and names what went wrong.
    fn print(&self, plan: &Plan, sweep: &Sweep, console: &Console) -> Result<(), Failure> {
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
            format::count(plan.jobs.len(), "job"),
            format::duration(self.seconds),
            format::count(self.workers, "worker"),
        );
        for (number, what) in [
            (*resumed, "of them from a checkpoint"),
            (plan.done().count(), "done before"),
            (self.unstable.len(), "unstable"),
            (failures.len(), "failed"),
            (*left, "left"),
        ] {
            if number > 0 {
                text += &format!(", {number} {what}");
            }
        }
        if *finished > 0 {
            let unit = model_of(&sweep.scene).work_unit();
            text += &format!(
                "\n{} in {} of CPU time: {} per CPU second",
                format::work(*work as f64, unit),
                format::duration(*cpu_seconds),
                format::work(*work as f64 / cpu_seconds.max(1e-9), unit),
            );
        }
        console.result(text);
        let names = |jobs: &[JobFailure]| -> Vec<String> {
            let named = |job: &JobFailure| {
                let name = describe(&sweep.axes, &job.values, job.seed);
                format!("{name} (job {}): {}", job.id, job.reason)
            };
            jobs.iter().map(named).collect()
        };
        name_first(&names(&self.unstable), |name| {
            console.note(format_args!("unstable: {name}"));
        });
        name_first(&names(failures), |name| {
            console.error(format_args!("failed: {name}"));
        });
        Ok(())
    }
}
