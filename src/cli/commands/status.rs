//! `phase status`: the progress of the sweep in a results folder.

use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::folders::{self, Entry};
use crate::cli::job::{self, NamedJob};
use crate::cli::options::Workers;
use crate::cli::{format, refined};
use phase::grid::{Axis, describe};
use phase::refine::Finish;
use phase::store::{Holder, ProcessIdentity};
use phase::study::comparison::RunTable;
use phase::sweep::{Claimed, Folder, Plan, Refining, Status, Sweep, UnderWay, work};
use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::{SystemTime, UNIX_EPOCH};

/// Show the progress of a sweep: jobs done, failed and left, runs with a checkpoint, and the time
/// left.
#[derive(clap::Args)]
#[command(after_help = "\
Example: all sweeps in ./results
  phase status results")]
pub(crate) struct Arguments {
    /// A results folder of `phase sweep`, or a folder that holds several.
    dir: PathBuf,
    #[command(flatten)]
    workers: Workers,
}

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    let workers = arguments.workers.count();
    let found = Folder::find(&arguments.dir)?;
    let folders = folders::go_through(&arguments.dir, found, console, |folder| {
        Ok(FolderAnswer::of(folder, workers, console)?)
    })?;
    let exit = Entry::exit(&folders, |_| true);
    console.answer(&Answer { folders });
    Ok(exit)
}

/// Most records that are read: of more, these stand for all.
const MOST_RECORDS: usize = 1000;

impl FolderAnswer {
    /// Reads the progress of a folder and prints it.
    fn of(folder: &Folder, workers: usize, console: &Console) -> Result<Self, Failure> {
        let sweep = folder.read_sweep()?;
        let refining = folder.read_refining(&sweep)?;
        let jobs = sweep.jobs_so_far(refining.as_ref())?;
        let plan = Plan::sampled(folder, jobs, MOST_RECORDS, work::default_workers())?;
        let known = sweep.study.map(|_| RunTable::identities(folder));
        let known = known.unwrap_or_default();
        let plan = plan.with_labels(|job| known.contains(&job.id));
        let status = Status::of(folder, &sweep.axes, &plan)?;
        console.result(format_args!(
            "{}: {}",
            folder.root().display(),
            text(&status, &sweep.axes, workers)
        ));
        for line in describe_refined(&sweep, refining.as_ref(), &status, workers) {
            console.result(line);
        }
        Ok(Self {
            folder: folder.root().display().to_string(),
            jobs: status.jobs,
            done: status.done,
            unstable: status.unstable,
            failed: NamedJob::all(&sweep.axes, &status.failures),
            to_redo: status.bad,
            sample: status.sample,
            core_hours_spent: status
                .cpu_seconds_per_job
                .map(|it| it * status.done as f64 / 3600.0),
            core_hours_left: status.cpu_seconds_left.map(|it| it / 3600.0),
            left: status.left,
            under_way: UnderWayAnswer::all(&status.under_way, &sweep.axes),
            workers: workers.min(status.left.max(1)),
            seconds_left: seconds_left(&status, workers),
            processes: status.processes.clone(),
            running: ClaimedAnswer::all(&status.claimed),
            refined: refined::Answer::new(
                &sweep,
                refining.as_ref(),
                status.done + status.failures.len(),
            ),
        })
    }
}

/// How far a refined sweep is, and how well its borders are known.
fn describe_refined(
    sweep: &Sweep,
    refining: Option<&Refining>,
    status: &Status,
    workers: usize,
) -> Vec<String> {
    let (Some(settings), Some(refining)) = (&sweep.refine, refining) else {
        return Vec::new();
    };
    let runs = status.done + status.failures.len();
    let budget = settings.budget;
    let mut lines = vec![format!(
        "  refined    {} of at most {budget}, {}",
        format::count(runs, "run"),
        format::count(refining.widths.len(), "border")
    )];
    // A larger budget may stand in the file by now, but has not been spent.
    let end = refining
        .end
        .filter(|end| *end != Finish::Budget || runs >= budget);
    lines.extend(end.map(|end| format!("  ended      {}", refined::describe_end(settings, end))));
    let more = match end {
        Some(_) => 0,
        None => budget.saturating_sub(runs),
    };
    if let Some(seconds) = status.cpu_seconds_per_job.filter(|_| more > 0) {
        let workers = workers.min(more);
        lines.push(format!(
            "  budget     about {} with {}, if it is used up",
            format::duration(seconds * more as f64 / workers as f64),
            format::count(workers, "worker")
        ));
    }
    let borders = refined::describe_borders(sweep, refining).into_iter();
    lines.extend(borders.map(|border| format!("  border     {border}")));
    lines
}

/// The `--json` result.
#[derive(Serialize)]
struct Answer {
    folders: Vec<Entry<FolderAnswer>>,
}

/// How far the sweep of one folder is.
#[derive(Serialize)]
struct FolderAnswer {
    folder: String,
    jobs: usize,
    done: usize,
    unstable: usize,
    failed: Vec<NamedJob>,
    to_redo: usize,
    /// Number of records that were read, if not all.
    sample: Option<usize>,
    core_hours_spent: Option<f64>,
    core_hours_left: Option<f64>,
    left: usize,
    under_way: Vec<UnderWayAnswer>,
    workers: usize,
    seconds_left: Option<f64>,
    processes: Vec<Holder>,
    /// Runs that a process has begun.
    running: Vec<ClaimedAnswer>,
    /// How well borders are known; none if the whole grid is run.
    refined: Option<refined::Answer>,
}

/// A run that a process has begun.
#[derive(Serialize)]
struct ClaimedAnswer {
    id: String,
    #[serde(flatten)]
    holder: Option<Holder>,
    /// Whether that process is known to be dead.
    stale: bool,
}

impl ClaimedAnswer {
    fn all(claimed: &[Claimed]) -> Vec<Self> {
        let answer = |run: &Claimed| Self {
            id: run.id.clone(),
            holder: run.holder.clone(),
            stale: run.is_stale,
        };
        claimed.iter().map(answer).collect()
    }
}

/// A run that will continue from its checkpoint.
#[derive(Serialize)]
struct UnderWayAnswer {
    id: String,
    point: BTreeMap<String, Value>,
    seed: u64,
    frame: u64,
    frames: u64,
}

impl UnderWayAnswer {
    fn all(runs: &[UnderWay], axes: &[Axis]) -> Vec<Self> {
        let answer = |run: &UnderWay| Self {
            id: run.id.clone(),
            point: job::point(axes, &run.values),
            seed: run.seed,
            frame: run.frame,
            frames: run.frames,
        };
        runs.iter().map(answer).collect()
    }
}

/// Time for the remaining jobs with this number of workers (s); `None` before any job is done.
fn seconds_left(status: &Status, workers: usize) -> Option<f64> {
    // More workers than jobs are of no use.
    let workers = workers.min(status.left.max(1));
    status
        .cpu_seconds_left
        .map(|seconds| seconds / workers as f64)
}

fn text(status: &Status, axes: &[Axis], workers: usize) -> String {
    let Status {
        jobs,
        done,
        unstable,
        failures,
        bad,
        sample,
        left,
        under_way,
        processes,
        claimed,
        ..
    } = status;
    let mut text = format!(
        "{}, {done} done, {} failed, {left} left",
        format::count(*jobs, "job"),
        failures.len()
    );
    if let Some(sample) = sample {
        text += &format!(
            "\n  judged by  {}, not by all",
            format::count(*sample, "record")
        );
    }
    if *unstable > 0 {
        text += &format!("\n  unstable   {unstable} of the done jobs");
    }
    if *bad > 0 {
        text += &format!(
            "\n  to redo    {}, damaged or made with other settings",
            format::count(*bad, "record")
        );
    }
    if *left > 0 {
        let time = match seconds_left(status, workers) {
            Some(seconds) => format!(
                "about {} with {}",
                format::duration(seconds),
                format::count(workers.min(*left), "worker")
            ),
            None => "unknown until a job is done; `phase check` forecasts it".to_owned(),
        };
        text += &format!("\n  time left  {time}");
    }
    if let (Some(job), Some(left)) = (status.cpu_seconds_per_job, status.cpu_seconds_left) {
        text += &format!(
            "\n  spent      {}, {} left",
            format::core_hours(job * *done as f64),
            format::core_hours(left)
        );
    }
    text += &describe_running(processes, claimed);
    for run in under_way {
        text += &format!(
            "\n  under way  {} (job {}): checkpoint at frame {} of {}, {}",
            describe(axes, &run.values, run.seed),
            run.id,
            run.frame,
            run.frames,
            format::percent(run.frame as usize, run.frames as usize)
        );
    }
    for failure in failures {
        let name = describe(axes, &failure.values, failure.seed);
        text += &format!(
            "\n  failed     {name} (job {}): {}",
            failure.id, failure.reason
        );
    }
    text
}

/// Who is at work, with how many runs, and what dead processes have left.
fn describe_running(processes: &[Holder], claimed: &[Claimed]) -> String {
    let held = claimed.iter().filter(|run| !run.is_stale);
    let held: Vec<Option<&ProcessIdentity>> = held
        .map(|run| run.holder.as_ref().map(|it| &it.process))
        .collect();
    let mut text = match processes.len() {
        0 if held.is_empty() => "\n  running    no".to_owned(),
        number => format!(
            "\n  running    {}, {}",
            format::count(held.len(), "run"),
            format::count(number, "process")
        ),
    };
    for holder in processes {
        let own = held.iter().filter(|it| **it == Some(&holder.process));
        text += &format!(
            "\n  process    {holder}: {}, at work for {}",
            format::count(own.count(), "run"),
            format::duration(age(holder))
        );
    }
    for run in claimed.iter().filter(|run| run.is_stale) {
        let of = run.holder.as_ref().map(|it| format!(" of {it}"));
        text += &format!(
            "\n  stale      run {}{}, which is dead: the same sweep makes it again",
            run.id,
            of.unwrap_or_default()
        );
    }
    text
}

/// Time since a lease was taken (s), by this machine's clock.
fn age(holder: &Holder) -> f64 {
    let now = SystemTime::now().duration_since(UNIX_EPOCH);
    now.map_or(0.0, |it| it.as_secs().saturating_sub(holder.since) as f64)
}
