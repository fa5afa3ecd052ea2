//! `phase check`: validates a file and says what would run.

mod answer;
mod describe;
mod program;
mod results;
mod study;
mod walls;

use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::options::{Ablate, Workers};
use crate::cli::time_step::{self, Tightest, tightest_limits};
use crate::cli::values;
use crate::cli::{format, job, labels, overlaps};
use answer::{Answer, ForecastAnswer};
use describe::{describe_sweep, effects, line};
use phase::cost::{self, Forecast};
use phase::dem::timestep::{Limit, StepMargin};
use phase::grid::{Axis, describe as describe_point};
use phase::run::Edits;
use phase::scene::{FileKind, Scene};
use phase::study::AnyFile;
use phase::sweep::{Job, Sweep};
use std::path::PathBuf;
use std::time::Duration;

/// Check a scene, sweep or study file and say what it would run, without running it.
///
/// A short trial of a few jobs estimates the time, memory and disk space that it will need.
///
/// The time step is compared with its limits (docs/time-step.md; --verbose lists all, with
/// formulas). A scene above a limit of stability is refused; above half of it, or above an advised
/// limit, there is a warning.
#[derive(clap::Args)]
#[command(after_help = "\
Example: what will the full diagram cost on 16 cores?
  phase check sweeps/theoretical.toml -j 16")]
pub(crate) struct Arguments {
    /// The scene, sweep or study file (TOML).
    file: PathBuf,
    #[command(flatten)]
    workers: Workers,
    #[command(flatten)]
    ablate: Ablate,
    /// Set a key of the scene, as in `phase run`; may be given several times.
    #[arg(long, value_name = "KEY=VALUE", value_parser = values::setting)]
    #[arg(conflicts_with_all = ["ablate", "seeds"])]
    set: Vec<String>,
    /// Remove a table or key from the scene, as in `phase run`; may be given several times.
    #[arg(long, value_name = "KEY", conflicts_with_all = ["ablate", "seeds"])]
    without: Vec<String>,
    /// Only validate, without trial and forecast.
    #[arg(long)]
    no_trial: bool,
}

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    let workers = arguments.workers.count();
    let (mut sweep, kind) = match arguments.load()? {
        AnyFile::Scene(scene) => (Sweep::of_scene(*scene), FileKind::Scene),
        AnyFile::Sweep(sweep) => (*sweep, FileKind::Sweep),
        AnyFile::Study(study) => return study::main(&study, arguments, workers, console),
    };
    let jobs = sweep.jobs()?;
    if kind == FileKind::Sweep {
        sweep.check_sieves(&jobs).map_err(labels::cannot_label)?;
    }
    console.result(describe_sweep(&sweep, jobs.len()));
    program::describe_programs(&sweep, &jobs, console);
    let tightest = tightest_limits(&jobs);
    for text in describe_time_step(&tightest, &sweep.axes, console.is_verbose()) {
        console.result(line("time step", text));
    }
    if let Some(text) = time_step::describe_choice(&sweep, &jobs) {
        console.result(line("time step", text));
    }
    time_step::warn_of_jobs(&tightest, &sweep.axes, console);
    overlaps::warn_of_jobs(&jobs, &sweep.axes, console);
    if kind == FileKind::Sweep {
        labels::warn_of_windows(&sweep, &jobs, console);
        results::describe_results(&sweep, &arguments.file, console)?;
    }
    let walls = walls::weakest(&jobs);
    if let Some(wall) = &walls {
        console.result(line("walls", wall.describe(&sweep.axes)));
    }
    let mut answer = Answer::new((arguments, kind), &sweep, &jobs, &tightest);
    answer.walls = walls.map(|walls| walls.answer());
    if program::runs_all(&sweep) {
        console.answer(&answer);
        return match arguments.no_trial {
            true => Ok(Exit::Done),
            false => program::forecast(&mut sweep, &arguments.file, workers, console)
                .map(|()| Exit::Done),
        };
    }
    if !arguments.no_trial {
        let forecast = try_jobs(&sweep, &jobs, workers, console)?;
        answer.forecast = Some(ForecastAnswer::new(&forecast, workers));
    }
    console.answer(&answer);
    Ok(Exit::Done)
}

/// Tries a few jobs, and prints what all will take.
fn try_jobs(
    sweep: &Sweep,
    jobs: &[Job],
    workers: usize,
    console: &Console,
) -> Result<Forecast, Failure> {
    // A silo ends its run when it is empty.
    let may_end = jobs.iter().any(|job| job.scene().has_flow());
    start_of_trial(console);
    let forecast = cost::forecast(jobs, workers, TRIAL_TIME)?;
    print_forecast(&forecast, jobs, workers, may_end, console);
    if let Some(settings) = &sweep.refine {
        let all = sweep.points().saturating_mul(settings.replicates as usize);
        let budget = settings.budget.min(all);
        let times = budget as f64 / jobs.len().max(1) as f64;
        console.result(line(
            "  refined",
            format_args!("at most {times:.1} times as long, with all {budget} runs"),
        ));
    }
    Ok(forecast)
}

impl Arguments {
    /// The file; of a scene with the keys that are to be set or left out.
    fn load(&self) -> Result<AnyFile, Failure> {
        if self.ablate.is_given() {
            return Ok(AnyFile::Study(self.ablate.load(&self.file, None, &[])?));
        }
        if self.set.is_empty() && self.without.is_empty() {
            return Ok(AnyFile::load(&self.file)?);
        }
        let edits = Edits {
            set: &self.set,
            remove: &self.without,
            options: &[],
        };
        let scene = Scene::load_with(&self.file, edits)?;
        Ok(AnyFile::Scene(Box::new(scene)))
    }
}

/// The time step over the limit it must not exceed, and over those it had better not; with
/// `all`, over every limit, explained.
fn describe_time_step(tightest: &[Tightest<'_>], axes: &[Axis], all: bool) -> Vec<String> {
    let is_told =
        |(index, it): &(usize, &Tightest<'_>)| all || *index == 0 || it.standing.ratio > 1.0;
    let told = tightest.iter().enumerate().filter(is_told);
    told.map(|(_, tightest)| describe_limit(tightest, axes, all))
        .collect()
}

/// A limit with its ratio, where that occurs, and with `explain` its formula.
fn describe_limit(tightest: &Tightest<'_>, axes: &[Axis], explain: bool) -> String {
    let StepMargin { limit, ratio } = tightest.standing;
    let Limit {
        name,
        seconds,
        decisive,
        explanation,
        ..
    } = limit;
    let kind = if decisive { "limit" } else { "advised limit" };
    let at = describe_point(axes, &tightest.job.values, tightest.job.seed);
    let ratio = match ratio < 0.01 {
        true => format!("{ratio:.0e}"),
        false => format!("{ratio:.2}"),
    };
    let mut text = format!("{ratio} of the {kind} {seconds:.2e} s ({name}) at {at}");
    if explain {
        text += &format!("\n{:14}{explanation}", "");
    }
    text
}

fn start_of_trial(console: &Console) {
    console.note("running the first part of a few jobs ...");
}

/// Prints time, memory and space; `may_end` if runs may end before their time.
fn print_forecast(
    forecast: &Forecast,
    jobs: &[Job],
    workers: usize,
    may_end: bool,
    console: &Console,
) {
    console.result(line(
        "forecast",
        format_args!(
            "from the first part of {}, {} per worker",
            format::count(forecast.tried, "job"),
            format::rate(forecast.rate, job::unit_of(jobs))
        ),
    ));
    let time = format::duration(forecast.seconds);
    let workers = format::count(workers.min(jobs.len()), "worker");
    let about = match may_end {
        true => "at most about",
        false => "about",
    };
    console.result(line(
        "  time",
        format_args!("{about} {time} with {workers}"),
    ));
    console.result(line(
        "  memory",
        format_args!("about {}", format::bytes(forecast.memory)),
    ));
    console.result(line(
        "  disk",
        format_args!("about {}", format::bytes(forecast.disk)),
    ));
}

/// Time for the trial, about.
const TRIAL_TIME: Duration = Duration::from_secs(4);
