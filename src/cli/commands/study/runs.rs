//! The folder of a study, and what became of its runs.

use super::Arguments;
use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::folders::ANOTHER_FOLDER;
use crate::cli::runner::Runner;
use crate::cli::{builds, folders, forecast, format, interrupt};
use phase::resume::DEFAULT_INTERVAL;
use phase::study::StudyName;
use phase::study::comparison::{Comparison, RunTable};
use phase::sweep::{Access, Folder, Job, Plan, Standing};
use serde::Serialize;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// The folder of a study, in which only processes of the same study write meanwhile.
pub(super) struct Place {
    pub(super) folder: Folder,
    /// Is set when the command is to end.
    pub(super) stop: &'static AtomicBool,
    _access: Access,
}

impl Place {
    /// Makes the folder for the results of a study with these figures and runs; a study of a
    /// verification case has none. Refuses one in which other programs have files of the names that
    /// the study writes.
    pub(super) fn open(
        arguments: &Arguments,
        study: StudyName,
        figures: &[String],
        runs: Option<&Comparison>,
        console: &Console,
    ) -> Result<Self, Failure> {
        let name = study.name();
        let by_default = || folders::default_folder_of_study(study, &arguments.file);
        let folder = Folder::new(arguments.out.clone().unwrap_or_else(by_default));
        let root = folder.root();
        let tables = ["runs", "failed", name].map(|it| format!("{it}.csv"));
        let files = ["sweep.json".to_owned(), format!("{name}.json")];
        let files = files.into_iter().chain(tables).map(PathBuf::from);
        let figures = figures.iter().filter(|_| !arguments.no_plot);
        let names = files.chain(folders::files_of_figures(figures));
        folders::refuse_foreign(root, names, ANOTHER_FOLDER)?;
        if folder.read_sweep().is_ok_and(|it| it.study.is_none()) {
            let message = "this folder holds the results of a sweep; choose another one with --out";
            return Err(Failure::refused(message).at(root));
        }
        let stop = interrupt::stop_on_signal(console)?;
        match runs {
            Some(_) => folder.create()?,
            None => folders::make(root)?,
        }
        let wait = |holder: &_| folders::tell_of_waiting(&folder, holder, console);
        let access = match runs {
            Some(_) if arguments.force => folder.lock(&wait)?,
            None => folder.lock(&wait)?,
            Some(runs) => {
                let access = folder.enter(&runs.sweep, &wait)?;
                if arguments.out.is_none() {
                    folders::refuse_another_file(&folder, &runs.sweep, &arguments.file)?;
                }
                if access.is_alone() {
                    folder.note_source(&arguments.file)?;
                }
                folder.open(access, &runs.sweep)?
            }
        };
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

    /// Makes what is left of the runs of a study, of which `table` has rows, and writes the table
    /// of all.
    pub(super) fn make(
        &self,
        comparison: &Comparison,
        arguments: &Arguments,
        mut table: RunTable,
        console: &Console,
    ) -> Result<(RunTable, Tally), Failure> {
        let workers = arguments.workers.count();
        let runner = Runner {
            folder: &self.folder,
            workers,
            stop: self.stop,
            checkpoint_interval: DEFAULT_INTERVAL,
            force: arguments.force,
            shard: arguments.shard.as_ref().or(arguments.job.as_ref()),
            console,
        };
        let plan = table.applied_to(runner.plan(comparison.jobs.clone())?);
        let is_row_alone = |it: &&(Job, Standing)| it.1 == Standing::Labelled;
        let rows_alone = plan.jobs.iter().filter(is_row_alone).map(|_| None);
        builds::tell_of_others("row", rows_alone, console);
        warn_of_days(comparison, &plan, workers, console);
        let run = runner.run(&comparison.sweep, &plan)?;
        let is_left_to_others = run.is_left_to_others(console);
        if !is_left_to_others {
            table.add_records(comparison, &self.folder, workers)?;
            table.write(comparison, &self.folder)?;
        }
        run.tell_of_failures(&comparison.sweep, console);
        if let Some(error) = run.report.halted {
            return Err(Failure::failed(error));
        }
        let tally = Tally {
            folder: self.folder.root().to_owned(),
            runs: comparison.jobs.len(),
            done_before: run.done_before,
            run_now: run.report.finished,
            elsewhere: run.report.elsewhere,
            left: run.report.left,
            left_to_others: run.report.others,
            failed: run.report.failures.len(),
            interrupted: self.stop.load(Ordering::Relaxed) && run.report.left > 0,
            workers,
            seconds: run.seconds,
            cpu_seconds: run.report.cpu_seconds,
        };
        Ok((table, tally))
    }
}

/// A study that takes longer than this says so before it begins (s).
const LONG: f64 = 86_400.0;

/// Fewest sphere-steps per second of a worker: what takes less than a day with it is not tried.
const SLOWEST_RATE: f64 = 5e5;

/// Says so if what is left of a comparison will take longer than a day.
fn warn_of_days(comparison: &Comparison, plan: &Plan, workers: usize, console: &Console) {
    let all: u64 = comparison.jobs.iter().map(Job::work).sum();
    let left: u64 = plan.pending().map(Job::work).sum();
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

/// What became of the runs of a study: what is printed of them, and what every `--json` has.
#[derive(Default, Serialize)]
pub(super) struct Tally {
    pub(super) folder: PathBuf,
    /// Runs in all.
    pub(super) runs: usize,
    pub(super) done_before: usize,
    pub(super) run_now: usize,
    /// Runs that other processes made meanwhile.
    #[serde(skip)]
    pub(super) elsewhere: usize,
    pub(super) left: usize,
    /// Runs of other shards without a result.
    pub(super) left_to_others: usize,
    pub(super) failed: usize,
    pub(super) interrupted: bool,
    pub(super) workers: usize,
    /// Time, and processor time (s).
    pub(super) seconds: f64,
    pub(super) cpu_seconds: f64,
}

impl Tally {
    /// The tally of these runs and then of all, for which these were done before.
    pub(super) fn and(self, all: Self) -> Self {
        let done = self.run_now + self.elsewhere;
        Self {
            done_before: all.done_before.saturating_sub(done),
            run_now: self.run_now + all.run_now,
            elsewhere: self.elsewhere + all.elsewhere,
            seconds: self.seconds + all.seconds,
            cpu_seconds: self.cpu_seconds + all.cpu_seconds,
            ..all
        }
    }

    /// Says what was made.
    pub(super) fn print(&self, console: &Console) {
        let elsewhere = match self.elsewhere {
            0 => String::new(),
            runs => format!("{runs} by another process, "),
        };
        console.result(format_args!(
            "{}: {} made now in {}, {} of CPU time, {elsewhere}{} before, {} left",
            format::count(self.runs, "run"),
            self.run_now,
            format::duration(self.seconds),
            format::duration(self.cpu_seconds),
            self.done_before,
            self.left
        ));
        if self.left > 0 {
            console.note("interrupted. Go on with the same command");
        }
    }

    /// Whether all runs are there, or have failed.
    pub(super) fn is_whole(&self) -> bool {
        self.left + self.left_to_others == 0
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
