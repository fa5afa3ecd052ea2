//! The folder of a study, its runs with progress, its failures.

use crate::cli::console::{Console, name_first};
use crate::cli::exit::{Exit, Failure};
use crate::cli::folders::ANOTHER_FOLDER;
use crate::cli::options::Workers;
use crate::cli::progress::{Progress, Work};
use crate::cli::{folders, forecast, format, interrupt, job};
use phase::grid::describe;
use phase::record::RunRecord;
use phase::store;
use phase::study::comparison::{Comparison, KnownRuns, StudyReport, StudyRuns};
use phase::sweep::{Access, Event, Folder, FolderError, Job, LocalThreads, Wishes};
use serde::Serialize;
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Where and how the runs of a study are made.
#[derive(clap::Args)]
pub(super) struct Options {
    /// The results folder [default: results/STUDY/NAME, with the name of the study or command, and
    /// that of the file without .toml].
    #[arg(short, long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,
    #[command(flatten)]
    workers: Workers,
    /// Make every run again, whatever the table holds.
    #[arg(short, long)]
    pub(super) force: bool,
    /// Draw no figure.
    #[arg(long)]
    pub(super) no_plot: bool,
}

impl Options {
    /// Number of runs at the same time.
    pub(super) fn workers(&self) -> usize {
        self.workers.count()
    }
}

/// The folder of a study, which no other process writes to meanwhile.
pub(super) struct Place {
    pub(super) folder: Folder,
    /// Is set when the command is to end.
    pub(super) stop: &'static AtomicBool,
    _access: Access,
}

impl Place {
    /// Makes the folder for the results of a file, by default in that of the study. Refuses one in
    /// which other programs have files of the names that the study writes: tables and the like, and
    /// figures.
    pub(super) fn open(
        study: &str,
        file: &Path,
        options: &Options,
        files: impl Iterator<Item = String>,
        figures: &[String],
        console: &Console,
    ) -> Result<Self, Failure> {
        let by_default = || {
            let name = file.file_stem().unwrap_or_default();
            Path::new("results").join(study).join(name)
        };
        let root = options.out.clone().unwrap_or_else(by_default);
        let figures = figures.iter().filter(|_| !options.no_plot);
        let files = files.map(PathBuf::from);
        let names = files.chain(folders::files_of_figures(figures));
        folders::refuse_foreign(&root, names, ANOTHER_FOLDER)?;
        let stop = interrupt::stop_on_signal(console)?;
        folders::make(&root)?;
        let folder = Folder::new(&root);
        let wait = |holder: &_| folders::tell_of_waiting(&folder, holder, console);
        let access = folder.lock(&wait).map_err(|error| match error {
            FolderError::Locked { .. } => Failure::refused(error),
            _ => Failure::failed(error),
        })?;
        store::remove_leftovers(&root).map_err(Failure::failed)?;
        Ok(Self {
            folder,
            stop,
            _access: access,
        })
    }

    /// A file of the folder.
    pub(super) fn file(&self, name: &str) -> PathBuf {
        self.folder.root().join(name)
    }

    /// What is wished of the runs.
    fn wishes<'a>(&self, watch: &'a (dyn Fn(Event<'_>) + Sync)) -> Wishes<'a> {
        Wishes {
            stop: self.stop,
            resume: true,
            watch,
        }
    }

    /// Whether runs are left because the command was told to end.
    fn is_interrupted(&self, left: usize) -> bool {
        self.stop.load(Ordering::Relaxed) && left > 0
    }
}

/// Makes the runs of a study by `run`, which gets a callback for events, and shows the progress.
/// Returns the result of `run` and its duration (s). Runs for which `is_known` is true are done
/// already.
fn with_progress<T>(
    jobs: &[Job],
    is_known: &dyn Fn(&Job) -> bool,
    name: &(dyn Fn(&Job) -> String + Sync),
    ended: &(dyn Fn(&Job, &RunRecord) -> String + Sync),
    console: &Console,
    run: impl FnOnce(&(dyn Fn(Event<'_>) + Sync)) -> T,
) -> (T, f64) {
    let done = jobs.iter().filter(|job| is_known(job));
    let (jobs_done, steps_done) =
        done.fold((0, 0), |(jobs, sum), job| (jobs + 1, sum + job.work()));
    if jobs_done > 0 {
        let runs = format::count(jobs.len(), "run");
        console.note(format_args!("{jobs_done} of {runs} are done already"));
    }
    let progress = Progress::new(
        console,
        Work {
            jobs: jobs.len(),
            jobs_done,
            steps: jobs.iter().map(Job::work).sum(),
            steps_done,
            unit: job::unit_of(jobs),
            head: String::new(),
        },
    );
    let watch = |event: Event<'_>| job::tell(event, &progress, name, ended);
    let result = run(&watch);
    (result, progress.finish())
}

/// A study that takes longer than this says so before it begins (s).
const LONG: f64 = 86_400.0;

/// Fewest sphere-steps per second of a worker: what takes less than a day with it is not tried.
const SLOWEST_RATE: f64 = 5e5;

/// Says so if what is left of a comparison will take longer than a day.
fn warn_of_days(
    comparison: &Comparison,
    is_known: &dyn Fn(&Job) -> bool,
    workers: usize,
    console: &Console,
) {
    let jobs = comparison.jobs.iter();
    let all: u64 = comparison.jobs.iter().map(Job::work).sum();
    let left: u64 = jobs.filter(|job| !is_known(job)).map(Job::work).sum();
    if (left as f64) < LONG * SLOWEST_RATE * workers as f64 {
        return;
    }
    // A setting that cannot be tried fails where it is run, and does not stop the others here.
    let Ok(forecast) = forecast::of_settings(comparison, workers, Duration::from_secs(4)) else {
        return;
    };
    let seconds = forecast.seconds * left as f64 / all.max(1) as f64;
    if seconds > LONG {
        console.warning(format_args!(
            "this will take about {} with {}; it can be stopped and goes on with the same command, \
             and fewer seeds, points or settings take less",
            format::duration(seconds),
            format::count(workers, "worker")
        ));
    }
}

/// Makes what is left of the runs of a study, and says what became of them.
pub(super) fn make(
    comparison: &Comparison,
    options: &Options,
    place: &Place,
    known: KnownRuns,
    console: &Console,
) -> Result<(StudyReport, Tally), Failure> {
    let ids: HashSet<String> = known.rows.iter().map(|row| row.id.clone()).collect();
    let settings = comparison.settings_of_runs();
    let named = |id: &str, values: &[f64], seed: u64| {
        let point = describe(comparison.axes(), values, seed);
        let setting = settings.get(id).map(|it| format!("{it}, "));
        setting.unwrap_or_default() + &point
    };
    let name = |job: &Job| named(&job.id, &job.values, job.seed);
    let ended = |job: &Job, record: &RunRecord| {
        let measured = comparison.measurement.measure(record);
        let label = measured.map_or("not measured", |it| it.label.name);
        format!("{label}: {}", name(job))
    };
    let is_known = |job: &Job| ids.contains(&job.id);
    warn_of_days(comparison, &is_known, options.workers(), console);
    let jobs = &comparison.jobs;
    let (report, seconds) = with_progress(jobs, &is_known, &name, &ended, console, |watch| {
        let runs = StudyRuns {
            comparison,
            folder: &place.folder,
            backend: &LocalThreads::new(options.workers()),
            wishes: place.wishes(watch),
        };
        runs.run(known)
    });
    let report = report.map_err(Failure::failed)?;
    let made = &report.made;
    let tally = Tally {
        folder: place.folder.root().to_owned(),
        runs: report.rows.len(),
        done_before: report.known,
        run_now: made.finished,
        left: made.left,
        failed: made.failures.len(),
        interrupted: place.is_interrupted(made.left),
        workers: options.workers(),
        seconds,
        cpu_seconds: made.cpu_seconds,
    };
    let failures = made.failures.iter().map(|failure| {
        let name = named(&failure.id, &failure.values, failure.seed);
        format!("{name}: {}", failure.reason)
    });
    tally.print(&failures.collect::<Vec<_>>(), console);
    Ok((report, tally))
}

/// What became of the runs of a study: what is printed of them, and what every `--json` has.
#[derive(Default, Serialize)]
pub(super) struct Tally {
    pub(super) folder: PathBuf,
    /// Runs in all.
    pub(super) runs: usize,
    pub(super) done_before: usize,
    pub(super) run_now: usize,
    pub(super) left: usize,
    pub(super) failed: usize,
    pub(super) interrupted: bool,
    pub(super) workers: usize,
    /// Time, and processor time (s).
    pub(super) seconds: f64,
    pub(super) cpu_seconds: f64,
}

impl Tally {
    /// Says what was made, and what failed.
    fn print(&self, failures: &[String], console: &Console) {
        console.result(format_args!(
            "{}: {} made now in {}, {} of CPU time, {} before, {} left",
            format::count(self.runs, "run"),
            self.run_now,
            format::duration(self.seconds),
            format::duration(self.cpu_seconds),
            self.done_before,
            self.left
        ));
        name_first(failures, |name| {
            console.error(format_args!("failed: {name}"));
        });
        if self.left > 0 {
            console.note("interrupted. Go on with the same command");
        }
    }

    /// How the command ends.
    pub(super) fn exit(&self) -> Exit {
        match (self.interrupted, self.failed) {
            (true, _) => Exit::Interrupted,
            (false, 0) => Exit::Done,
            (false, _) => Exit::Failed,
        }
    }
}
