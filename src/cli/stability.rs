//! `phase stability`: where integrators are stable over two keys of a scene.

use super::console::{Console, name_first};
use super::exit::{Exit, Failure};
use super::progress::{Progress, Work};
use super::{builds, folders, format, interrupt, job, plot, sweep};
use phase::plot::stability as figure;
use phase::record::{Program, RunRecord};
use phase::scene::Integrator;
use phase::store;
use phase::study::stability::{self, Label, Report, Row, Study, Trials};
use phase::sweep::{Event, Folder, FolderError, Job, describe, work};
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

/// Try integrators over two keys of a scene, such as time step and stiffness: a phase diagram of
/// the numerics.
///
/// Every point is labelled stable, energy-gain, lost-sphere or not-a-number, and the figure has the
/// theoretical limit of the time step over it. The step may be above the limit at which scenes are
/// refused. Runs whose row is in the table already are not made again.
#[derive(clap::Args)]
#[command(after_help = "\
Example: Newton's cradle, all integrators, time step against stiffness
  phase stability sweeps/stability/cradle.toml

The results folder holds stability.csv (one row per run), stability.makers.csv (which build made
each row) and the figure as SVG and PNG.")]
pub(crate) struct Arguments {
    /// The study file (TOML).
    file: PathBuf,
    /// The results folder [default: results/NAME, the study file's name without .toml].
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Runs at the same time [default: all cores].
    #[arg(short, long, value_name = "N", value_parser = sweep::at_least_one)]
    jobs: Option<usize>,
    /// Make every run again, whatever the table holds.
    #[arg(short, long)]
    force: bool,
    /// Draw no figure.
    #[arg(long)]
    no_plot: bool,
    /// Print the result as one JSON object (docs/json.md) instead of text.
    #[arg(long)]
    pub(super) json: bool,
}

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    let study = stability::load(&arguments.file).map_err(Failure::refused)?;
    let jobs = study.jobs().map_err(Failure::refused)?;
    let root = arguments
        .out
        .clone()
        .unwrap_or_else(|| sweep::default_folder(&arguments.file));
    let stop = interrupt::stop_on_signal(console)?;
    folders::make(&root)?;
    let folder = Folder::new(&root);
    let _lock = folder.lock().map_err(|error| match error {
        FolderError::Locked(_) => Failure::refused(error),
        _ => Failure::failed(error),
    })?;
    store::remove_leftovers(&root).map_err(Failure::failed)?;
    let table = root.join("stability.csv");
    folders::refuse_to_replace(&table, "a table of stability", b"integrator,")?;
    let known = if arguments.force {
        Vec::new()
    } else {
        stability::read_stability(&study.axes, &table).map_err(Failure::refused)?
    };
    let trials = Trials {
        study: &study,
        jobs: &jobs,
        table: &table,
        workers: arguments.jobs.unwrap_or_else(work::default_workers),
        stop,
        watch: &|_| {},
    };
    let (report, seconds) = run(&trials, known, console)?;
    let tried = Tried::all(&study, &report.rows);
    print(&study, &tried, &report, seconds, console)?;
    let interrupted = stop.load(Ordering::Relaxed) && report.left > 0;
    console.file(&table);
    if !interrupted && !arguments.no_plot {
        draw(&study, &report.rows, &root, console)?;
    }
    let exit = match (interrupted, report.failures.is_empty()) {
        (true, _) => Exit::Interrupted,
        (false, true) => Exit::Done,
        (false, false) => Exit::Failed,
    };
    console.answer(&Answer {
        folder: root,
        runs: jobs.len(),
        done_before: report.known,
        run_now: report.rows.len() - report.known,
        left: report.left,
        failed: report.failures.len(),
        interrupted,
        workers: trials.workers,
        seconds,
        cpu_seconds: report.cpu_seconds,
        integrators: tried,
        files: console.files(),
    });
    Ok(exit)
}

/// What `--json` prints.
#[derive(Serialize)]
struct Answer {
    folder: PathBuf,
    runs: usize,
    done_before: usize,
    run_now: usize,
    left: usize,
    failed: usize,
    interrupted: bool,
    workers: usize,
    seconds: f64,
    cpu_seconds: f64,
    integrators: Vec<Tried>,
    files: Vec<PathBuf>,
}

/// How an integrator did.
#[derive(Serialize)]
struct Tried {
    integrator: &'static str,
    /// Number of runs by label.
    labels: BTreeMap<&'static str, usize>,
    /// Least step over its limit of a run that is not stable.
    all_stable_below: Option<f64>,
    /// Largest step over its limit of a stable run.
    none_stable_above: Option<f64>,
}

impl Tried {
    fn all(study: &Study, rows: &[Row]) -> Vec<Self> {
        let of = |&integrator: &Integrator| {
            let own = rows.iter().filter(|row| row.integrator == integrator);
            Self::of(integrator, own.collect())
        };
        study.integrators.iter().map(of).collect()
    }

    fn of(integrator: Integrator, rows: Vec<&Row>) -> Self {
        let mut labels = BTreeMap::new();
        for row in &rows {
            *labels.entry(row.label.name()).or_default() += 1;
        }
        let ratios = |stable: bool| {
            let chosen = rows
                .iter()
                .filter(move |row| (row.label == Label::Stable) == stable);
            chosen.filter_map(|row| row.limit.as_ref().map(|limit| limit.0))
        };
        Self {
            integrator: integrator.name(),
            labels,
            all_stable_below: ratios(false).reduce(f64::min),
            none_stable_above: ratios(true).reduce(f64::max),
        }
    }

    fn line(&self) -> String {
        let counts = Label::ALL.into_iter().filter_map(|label| {
            let count = self.labels.get(label.name())?;
            Some(format!("{count} {}", label.name()))
        });
        let mut text = format!(
            "{:<20} {}",
            self.integrator,
            counts.collect::<Vec<_>>().join(", ")
        );
        match (self.all_stable_below, self.none_stable_above) {
            (Some(below), Some(above)) => {
                text += &format!(
                    "; the first that is not stable is at {below:.3} of the limit, the last that \
                     is at {above:.3}"
                );
            }
            (None, Some(above)) => text += &format!(", up to {above:.3} of the limit"),
            _ => {}
        }
        text
    }
}

/// Runs what is left of a study; and how long that took (s).
fn run(trials: &Trials<'_>, known: Vec<Row>, console: &Console) -> Result<(Report, f64), Failure> {
    let is_known = |job: &&Job| known.iter().any(|row| row.id == job.id);
    let done = trials.jobs.iter().filter(is_known);
    let (jobs_done, steps_done) =
        done.fold((0, 0), |(jobs, sum), job| (jobs + 1, sum + job.work()));
    if jobs_done > 0 {
        let runs = format::count(trials.jobs.len(), "run");
        console.note(format_args!("{jobs_done} of {runs} are done already"));
        let makers = stability::read_makers(trials.table).map_err(Failure::refused)?;
        let done = trials.jobs.iter().filter(is_known);
        builds::tell_of_others("row", done.map(|job| makers.get(&job.id)), console);
    }
    let progress = Progress::new(
        console,
        Work {
            jobs: trials.jobs.len(),
            jobs_done,
            steps: trials.jobs.iter().map(Job::work).sum(),
            steps_done,
        },
    );
    let name = |job: &Job| {
        let point = describe(&trials.study.axes, &job.values, job.seed);
        format!("{}, {point}", job.scene.time.integrator.name())
    };
    let ended = |job: &Job, record: &RunRecord| {
        let row = trials.study.row(job, record);
        format!("{}: {}", row.label.name(), name(job))
    };
    let watch = |event: Event<'_>| job::tell(event, &progress, &name, &ended);
    let trials = Trials {
        watch: &watch,
        ..*trials
    };
    let report = trials.run(known);
    let seconds = progress.finish();
    Ok((report.map_err(Failure::failed)?, seconds))
}

fn print(
    study: &Study,
    tried: &[Tried],
    report: &Report,
    seconds: f64,
    console: &Console,
) -> Result<(), Failure> {
    console.result(format_args!(
        "{}: {} made now in {}, {} of CPU time, {} before, {} left",
        format::count(report.rows.len() + report.left, "run"),
        report.rows.len() - report.known,
        format::duration(seconds),
        format::duration(report.cpu_seconds),
        report.known,
        report.left
    ));
    for tried in tried {
        console.result(tried.line());
    }
    let failures = report.failures.iter().map(|failure| {
        let point = describe(&study.axes, &failure.values, failure.seed);
        format!("{point}: {}", failure.reason)
    });
    name_first(&failures.collect::<Vec<_>>(), |name| {
        console.error(format_args!("failed: {name}"));
    });
    if report.left > 0 {
        console.note("interrupted. Go on with the same command");
    }
    Ok(())
}

fn draw(study: &Study, rows: &[Row], root: &Path, console: &Console) -> Result<(), Failure> {
    let figure = figure::draw(study, rows, &Program::current()).map_err(Failure::failed)?;
    plot::write(
        &figure,
        |end| root.join(format!("stability.{end}")),
        console,
    )
}
