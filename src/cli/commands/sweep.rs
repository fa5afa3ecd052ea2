//! `phase sweep`: runs the jobs of a sweep, labels them, draws the figures.

mod refining;

use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::job::NamedJob;
use crate::cli::options::Workers;
use crate::cli::programs::AllowProgram;
use crate::cli::runner::{Runner, RunsMade};
use crate::cli::values;
use crate::cli::{figures, labels};
use crate::cli::{folders, format, interrupt, overlaps, refined, time_step};
use phase::resume::DEFAULT_INTERVAL;
use phase::store::{Holder, Lease};
use phase::sweep::{
    Access, Folder, Job, NextJobs, Plan, Shard, Sweep, differing_keys, refuse_to_lose_labels,
};
use serde::Serialize;
use std::collections::HashSet;
use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::time::Duration;

/// Run the simulations of a sweep, label them, draw the phase diagram.
///
/// Jobs whose record is already in the results folder are not run again: a sweep that was stopped
/// continues where it was, and long runs from their latest checkpoint.
#[derive(clap::Args)]
#[command(after_help = "\
Example: the 9 x 9 grid on four cores, results in ./results/quick
  phase sweep sweeps/quick.toml -j 4

The results folder holds sweep.json (the sweep as run), records/ (one HDF5 file per run),
labels.csv (one row per run), points.csv (one row per point of the grid), the figures as SVG
and PNG, and, if any job failed, failed.csv. The folder of a refined sweep also holds refined.csv
(the probability of each label at each point) and borders.csv (the borders with their bands).")]
pub(crate) struct Arguments {
    /// The sweep file (TOML).
    file: PathBuf,
    /// The results folder [default: results/NAME, the sweep file's name without .toml].
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    workers: Workers,
    #[command(flatten)]
    program: AllowProgram,
    /// Run every job again, whatever the results folder holds.
    #[arg(short, long)]
    force: bool,
    /// Seeds to use instead of the file's; may be given several times.
    #[arg(short, long, value_name = "SEED", value_delimiter = ',', value_parser = values::seed)]
    seed: Vec<u64>,
    /// Run a coarse grid, then only what the labels need (docs/refine.md). The table [refine] of
    /// the file has the settings; without it at most a tenth of the grid's jobs is run.
    #[arg(long)]
    refine: bool,
    /// Run one of N parts of equal work, in any number of processes on any machines: I/N, or `auto`
    /// for the task of a Slurm array. The last one labels the runs and draws the figures. Of a
    /// refined sweep it is a part of the next round.
    #[arg(long, value_name = "I/N", value_parser = values::part)]
    #[arg(conflicts_with_all = ["job", "force", "keep_labels"])]
    shard: Option<Shard>,
    /// Run the jobs of a line that `phase jobs` printed.
    #[arg(long, value_name = "LINE", conflicts_with_all = ["force", "keep_labels"])]
    job: Option<Shard>,
    /// Time between two checkpoints of a run (s), from which it continues when the sweep is run
    /// again [default: 120].
    #[arg(long, value_name = "SECONDS", value_parser = values::seconds)]
    checkpoint_interval: Option<Duration>,
    /// Only run the simulations: no labels, no figures.
    #[arg(long)]
    no_classify: bool,
    /// Treat runs listed in labels.csv as done even without their record files (for example in
    /// published results).
    #[arg(long, conflicts_with = "force")]
    keep_labels: bool,
    /// Draw no figures.
    #[arg(long)]
    no_plot: bool,
}

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    let mut sweep = phase::sweep::load(&arguments.file)?;
    arguments
        .program
        .prepare(&mut sweep, &arguments.file, console)?;
    choose_runs(&mut sweep, arguments)?;
    let workers = arguments.workers.count();
    let jobs = sweep.jobs()?;
    if !arguments.no_classify {
        sweep.check_sieves(&jobs).map_err(labels::cannot_label)?;
    }
    let folder = folder_of(&sweep, arguments)?;
    if let Some(line) = &arguments.job {
        // Before anything is changed.
        let next = match sweep.refine {
            None => None,
            Some(_) => Some(NextJobs::new(&folder, &sweep, workers)?),
        };
        line.of(next.as_ref().map_or(&jobs, |it| &it.jobs))?;
    }
    let stop = interrupt::stop_on_signal(console)?;

    let _access = open(&folder, &sweep, &jobs, arguments, console)?;
    let runner = Runner {
        folder: &folder,
        workers,
        stop,
        checkpoint_interval: arguments.checkpoint_interval.unwrap_or(DEFAULT_INTERVAL),
        force: arguments.force,
        shard: arguments.shard.as_ref().or(arguments.job.as_ref()),
        console,
    };
    let (plan, run, refinement) = match sweep.refine {
        None => {
            let plan = runner.plan(jobs)?;
            let run = runner.run(&sweep, &plan)?;
            (plan, run, None)
        }
        Some(_) => {
            let (plan, run, refinement) = refining::refine(&runner, &sweep, !arguments.no_plot)?;
            (plan, run, Some(refinement))
        }
    };
    run.print(&plan, &sweep, console);
    let mut answer = Answer::new(&folder, &plan, &sweep, &run);
    let jobs: Vec<Job> = plan.jobs.into_iter().map(|(job, _)| job).collect();
    answer.refined =
        refinement.and_then(|it| refined::Answer::new(&sweep, Some(it.refining()), it.runs()));
    if stop.load(Ordering::Relaxed) {
        console.note(format_args!(
            "interrupted; {} left. The same command continues",
            format::count(run.report.left, "job")
        ));
        answer.interrupted = true;
        console.answer_with_files(&answer);
        return Ok(Exit::Interrupted);
    }
    if let Some(error) = &run.report.halted {
        console.answer_with_files(&answer);
        return Err(Failure::failed(error));
    }
    let mut failed = !run.report.failures.is_empty();
    if run.is_left_to_others(console) {
        console.answer_with_files(&answer);
        return Ok(if failed { Exit::Failed } else { Exit::Done });
    }
    if !arguments.no_classify
        && let Some(_lease) = lease_of_labels(&folder, console)?
    {
        let labelled = label((&folder, &sweep, &jobs), arguments, &mut answer, console);
        failed |= labelled.inspect_err(|_| console.answer_with_files(&answer))?;
    }
    console.answer_with_files(&answer);
    Ok(if failed { Exit::Failed } else { Exit::Done })
}

/// Takes the results folder for a sweep, and says what its jobs may suffer from. Refuses a folder
/// that is another's.
fn open(
    folder: &Folder,
    sweep: &Sweep,
    jobs: &[Job],
    arguments: &Arguments,
    console: &Console,
) -> Result<Access, Failure> {
    folder.create()?;
    let access = enter(folder, sweep, arguments, console)?;
    if arguments.out.is_none() {
        folders::refuse_another_file(folder, sweep, &arguments.file)?;
    }
    if !arguments.no_classify {
        let again = jobs_made_again(folder, sweep);
        let kept = jobs.iter().chain(&again).map(|job| job.id.as_str());
        refuse_to_lose_labels(folder, kept)?;
    }
    tell_of_other_sweep(folder, sweep, console);
    time_step::tell_of_jobs(jobs, &sweep.axes, console);
    overlaps::warn_of_jobs(jobs, &sweep.axes, console);
    if !arguments.no_classify {
        labels::warn_of_windows(sweep, jobs, console);
    }
    if access.is_alone() {
        folder.note_source(&arguments.file)?;
    }
    Ok(match arguments.force {
        true => access,
        false => folder.open(access, sweep)?,
    })
}

/// Labels the runs and draws the figures; returns whether anything of it failed.
fn label(
    (folder, sweep, jobs): (&Folder, &Sweep, &[Job]),
    arguments: &Arguments,
    answer: &mut Answer,
    console: &Console,
) -> Result<bool, Failure> {
    let workers = arguments.workers.count();
    let labelled = labels::label_folder(folder, sweep, jobs, workers, console)?;
    if !arguments.no_plot {
        let problems = figures::draw_default_figures(folder, sweep, &labelled.table, console);
        answer.problems = problems;
    }
    let root = format::shell_word(&folder.root().display().to_string());
    console.result(format_args!("look at it in a browser: phase report {root}"));
    tell_of_earlier_borders(folder, sweep, console);
    answer.labels = Some(labels::Summary::new(folder, &labelled));
    Ok(!labelled.problems.is_empty() || !answer.problems.is_empty())
}

/// The results folder. Refuses one where a file of another program is in the way.
fn folder_of(sweep: &Sweep, arguments: &Arguments) -> Result<Folder, Failure> {
    let root = arguments.out.clone();
    let mut folder = Folder::new(root.unwrap_or_else(|| folders::default_folder(&arguments.file)));
    if arguments.keep_labels {
        check_kept_labels(&folder, sweep)?;
        folder = folder.keeping_labels();
    }
    refuse_foreign(&folder, sweep, arguments)?;
    Ok(folder)
}

/// Says which files of the folder belong to an earlier sweep.
fn tell_of_earlier_borders(folder: &Folder, sweep: &Sweep, console: &Console) {
    if sweep.refine.is_none() && folder.borders().exists() {
        console.note(format_args!(
            "{} and the figure `refined` belong to an earlier, refined sweep in this folder",
            folder.borders().display()
        ));
    }
}

/// Takes the right to run a sweep into a folder: together with other processes that run the same
/// one, unless everything is run again.
fn enter(
    folder: &Folder,
    sweep: &Sweep,
    arguments: &Arguments,
    console: &Console,
) -> Result<Access, Failure> {
    let wait = |holder: &Holder| folders::tell_of_waiting(folder, holder, console);
    let access = match arguments.force {
        true => folder.lock(&wait),
        false => folder.enter(sweep, &wait),
    };
    Ok(access?)
}

/// Takes the right to label the runs of a folder. None if another process labels them.
fn lease_of_labels(folder: &Folder, console: &Console) -> Result<Option<Lease>, Failure> {
    let wait = |holder: &Holder| folders::tell_of_waiting(folder, holder, console);
    let lease = folder.lease_of_labels(&wait)?;
    if lease.is_none() {
        console.note("another process labels the runs and draws the figures");
    }
    Ok(lease)
}

/// Refuses to keep labels that cannot be read, or that other thresholds gave.
fn check_kept_labels(folder: &Folder, sweep: &Sweep) -> Result<(), Failure> {
    if !folder.labels().exists() {
        return Ok(());
    }
    folder.read_labels().map_err(|error| {
        Failure::refused(format_args!(
            "{error}\n--keep-labels needs a readable labels.csv; repair the file or drop \
             --keep-labels"
        ))
    })?;
    let stored = folder.read_sweep()?;
    match stored.sieves == sweep.sieves {
        true => Ok(()),
        false => Err(Failure::refused(format_args!(
            "these labels were made with other thresholds ([sieves]); drop --keep-labels, or use \
             the thresholds of {}",
            folder.sweep().display()
        ))
        .at(folder.labels())),
    }
}

/// Refuses a folder in which files of another program are in the way, or of a study. One with the
/// sweep.json of a sweep is a results folder, whatever it holds.
fn refuse_foreign(folder: &Folder, sweep: &Sweep, arguments: &Arguments) -> Result<(), Failure> {
    let root = folder.root();
    if folder.read_sweep().is_ok_and(|it| it.study.is_some()) {
        let message = "this folder holds the results of a study; choose another one with --out";
        return Err(Failure::refused(message).at(root));
    }
    if folder.sweep().exists() {
        return folders::refuse_foreign(root, ["sweep.json"], folders::ANOTHER_FOLDER);
    }
    let mut names = vec![PathBuf::from("failed.csv")];
    if !arguments.no_classify {
        names.extend(["labels.csv", "points.csv"].map(PathBuf::from));
        let refined = sweep
            .refine
            .iter()
            .flat_map(|_| ["refined.csv", "borders.csv"]);
        names.extend(refined.map(PathBuf::from));
        if !arguments.no_plot && !sweep.axes.is_empty() {
            let figures = figures::figures_of_sweep(sweep, sweep.family());
            names.extend(folders::files_of_figures(figures));
        }
    }
    folders::refuse_foreign(root, names, folders::ANOTHER_FOLDER)
}

/// The jobs of the sweep that the folder keeps, if this one makes the same, and those that a
/// refined sweep takes as given. The jobs of rounds follow from the labels, so that the thresholds
/// count too.
fn jobs_made_again(folder: &Folder, sweep: &Sweep) -> Vec<Job> {
    let given = sweep.jobs_given_by(folder).unwrap_or_default();
    let stored = folder.read_sweep().ok();
    let stored = stored.filter(|stored| {
        stored.sieves == sweep.sieves && stored.keys_of_other_runs(sweep).is_empty()
    });
    let jobs = stored.and_then(|stored| {
        let refining = folder.read_refining(&stored).ok()?;
        stored.jobs_so_far(refining.as_ref()).ok()
    });
    given.into_iter().chain(jobs.unwrap_or_default()).collect()
}

/// Takes the seeds of the command line, and refines the sweep if requested.
fn choose_runs(sweep: &mut Sweep, arguments: &Arguments) -> Result<(), Failure> {
    if !arguments.seed.is_empty() {
        let seeds = distinct(&arguments.seed)?;
        if let Some(settings) = &sweep.refine {
            refining::check(settings, &seeds)?;
            sweep.refine_from_seed(seeds[0]).map_err(Failure::refused)?;
        } else {
            sweep.seeds = seeds;
        }
    }
    if arguments.refine && sweep.refine.is_none() {
        sweep.refine_by_default().map_err(Failure::refused)?;
    }
    if arguments.no_classify && sweep.refine.is_some() {
        return Err(Failure::refused(
            "refining needs labels; drop --no-classify",
        ));
    }
    Ok(())
}

/// Seeds without duplicates.
fn distinct(seeds: &[u64]) -> Result<Vec<u64>, Failure> {
    let mut seen = HashSet::new();
    match seeds.iter().find(|seed| !seen.insert(**seed)) {
        None => Ok(seeds.to_vec()),
        Some(seed) => Err(Failure::refused(format_args!(
            "duplicate --seed {seed}: its runs would count twice; give it once"
        ))),
    }
}

/// Says how an earlier sweep of the same folder differed.
fn tell_of_other_sweep(folder: &Folder, sweep: &Sweep, console: &Console) {
    let Ok(earlier) = folder.read_sweep() else {
        return;
    };
    let keys = differing_keys(&earlier, sweep);
    if !keys.is_empty() {
        console.note(format_args!(
            "the sweep has changed since it was last run into {} ({}); its records are reused \
             where they still apply, others stay in the folder unused",
            folder.root().display(),
            keys.join(", ")
        ));
    }
}

/// The `--json` result.
#[derive(Serialize)]
struct Answer {
    folder: PathBuf,
    jobs: usize,
    done_before: usize,
    run_now: usize,
    resumed: usize,
    left: usize,
    /// Jobs of other shards without a result, and runs of the next round of a refined sweep.
    left_to_others: usize,
    next_round: usize,
    unstable: Vec<NamedJob>,
    failed: Vec<NamedJob>,
    interrupted: bool,
    workers: usize,
    seconds: f64,
    cpu_seconds: f64,
    sphere_steps: u64,
    labels: Option<labels::Summary>,
    /// How well borders are known; none if the whole grid is run.
    refined: Option<refined::Answer>,
    /// Figures that could not be drawn, and why.
    problems: Vec<String>,
}

impl Answer {
    fn new(folder: &Folder, plan: &Plan, sweep: &Sweep, run: &RunsMade) -> Self {
        Self {
            folder: folder.root().to_owned(),
            jobs: plan.own(),
            done_before: run.done_before,
            run_now: run.report.finished,
            resumed: run.report.resumed,
            left: run.report.left,
            left_to_others: run.report.others,
            next_round: run.next,
            unstable: NamedJob::all(&sweep.axes, &run.unstable),
            failed: NamedJob::all(&sweep.axes, &run.report.failures),
            interrupted: false,
            workers: run.workers,
            seconds: run.seconds,
            cpu_seconds: run.report.cpu_seconds,
            sphere_steps: run.report.work,
            labels: None,
            refined: None,
            problems: Vec::new(),
        }
    }
}
