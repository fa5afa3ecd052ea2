//! `phase check`: validates a file and says what would run.

mod study;
mod walls;

use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::options::{Ablate, Workers};
use crate::cli::time_step::{self, Tightest, tightest_limits};
use crate::cli::values;
use crate::cli::{format, job, labels, overlaps};
use phase::cost::{self, Forecast};
use phase::dem::timestep::{Limit, StepMargin};
use phase::grid::{Axis, describe};
use phase::run::Edits;
use phase::scene::{FileKind, Scene, Start, Tank};
use phase::study::AnyFile;
use phase::sweep::{Job, Sweep};
use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
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
    let (sweep, kind) = match arguments.load()? {
        AnyFile::Scene(scene) => (Sweep::of_scene(*scene), FileKind::Scene),
        AnyFile::Sweep(sweep) => (*sweep, FileKind::Sweep),
        AnyFile::Study(study) => return study::main(&study, arguments, workers, console),
    };
    let jobs = sweep.jobs()?;
    if kind == FileKind::Sweep {
        sweep.check_sieves(&jobs).map_err(labels::cannot_label)?;
    }
    console.result(describe_sweep(&sweep, jobs.len()));
    console.result(line("effects", effects(&sweep.scene).join(", ")));
    console.result(line("duration", describe_time(&sweep.scene)));
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
    }
    let walls = walls::weakest(&jobs);
    if let Some(wall) = &walls {
        console.result(line("walls", wall.describe(&sweep.axes)));
    }
    let mut forecast = None;
    if !arguments.no_trial {
        // A silo ends its run when it is empty.
        let may_end = jobs.iter().any(|job| job.scene.has_flow());
        start_of_trial(console);
        let found = cost::forecast(&jobs, workers, TRIAL_TIME)?;
        print_forecast(&found, &jobs, workers, may_end, console);
        if let Some(settings) = &sweep.refine {
            let all = sweep.points().saturating_mul(settings.replicates as usize);
            let budget = settings.budget.min(all);
            let times = budget as f64 / jobs.len().max(1) as f64;
            console.result(line(
                "  refined",
                format_args!("at most {times:.1} times as long, with all {budget} runs"),
            ));
        }
        forecast = Some(found);
    }
    let scene = &sweep.scene;
    let (steps_per_frame, frames) = (scene.time.steps_per_frame(), scene.time.frames());
    console.answer(&Answer {
        file: &arguments.file,
        kind: kind.name(),
        title: sweep.title.as_deref().or(scene.title.as_deref()),
        jobs: jobs.len(),
        axes: sweep.axes.iter().map(AxisAnswer::of).collect(),
        seeds: &sweep.seeds,
        budget: sweep.refine.as_ref().map(|it| it.budget),
        spheres: scene.spheres.count,
        effects: effects(scene),
        duration: scene.time.duration,
        frames,
        steps_per_frame,
        dt: scene.time.dt,
        safety_factor: scene.time.safety_factor,
        limits: tightest
            .iter()
            .map(|limit| LimitAnswer::new(limit, &sweep.axes))
            .collect(),
        walls: walls.map(|walls| walls.answer()),
        forecast: forecast.map(|forecast| ForecastAnswer::new(&forecast, workers)),
    });
    Ok(Exit::Done)
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

fn line(name: &str, text: impl std::fmt::Display) -> String {
    format!("  {name:<11} {text}")
}

fn describe_sweep(sweep: &Sweep, jobs: usize) -> String {
    let title = sweep.title.as_ref().or(sweep.scene.title.as_ref());
    let mut lines = describe_grid(title, &format::count(jobs, "job"), &sweep.axes);
    let seeds: Vec<String> = sweep.seeds.iter().map(u64::to_string).collect();
    let at_most = match sweep.refine {
        Some(_) => " at most",
        None => "",
    };
    lines.push(line("seeds", seeds.join(", ") + at_most));
    if let Some(settings) = &sweep.refine {
        let (round, budget) = (settings.round, settings.budget);
        let text = match budget > jobs {
            true => format!("{jobs} to start, then rounds of {round} up to {budget} in total"),
            false => format!(
                "{jobs} to start, which is the whole budget: increase `refine.budget` for rounds \
                 of {round}"
            ),
        };
        lines.push(line("refined", text));
    }
    lines.push(line("spheres", sweep.scene.spheres.count));
    lines.join("\n")
}

/// Title and number of what is run, and the axes.
fn describe_grid(title: Option<&String>, runs: &str, axes: &[Axis]) -> Vec<String> {
    let mut lines = vec![match title {
        Some(title) => format!("{title}: {runs}"),
        None => runs.to_owned(),
    }];
    for axis in axes {
        if axis.is_of_variants() {
            lines.push(line(&axis.name, axis.words().join(", ")));
            continue;
        }
        let ends = match axis.values.as_slice() {
            [first, .., last] => format!("{first} to {last}, {} values", axis.values.len()),
            values => format!("{values:?}"),
        };
        lines.push(line(&axis.name, format_args!("{ends} ({})", axis.key)));
    }
    lines
}

/// The effects that the scene names; no other costs anything.
fn effects(scene: &Scene) -> Vec<String> {
    let tank = scene.tank.as_ref();
    let contact = scene.dem.contact.iter();
    let friction = scene.dem.friction.iter();
    let laws = contact
        .map(|contact| format!("contact ({})", contact.law()))
        .chain(friction.map(|friction| format!("friction ({})", friction.law())));
    let others = [
        (scene.dem.rolling.is_some(), "rolling resistance"),
        (scene.dem.effects.added_mass.is_some(), "added mass"),
        (tank.is_some_and(|tank| tank.radius.is_some()), "cylinder"),
        (tank.is_some_and(Tank::has_sides), "sides"),
        (tank.is_some_and(|tank| tank.floor.is_some()), "floor"),
        (scene.dem.geometry.is_some(), "fixed spheres"),
        (matches!(scene.start, Start::Feed { .. }), "feed"),
        (scene.spot.is_some(), "spots"),
        (scene.dem.door.is_some(), "door"),
        (scene.dem.outlet.is_some(), "outlet"),
    ];
    let others = others.iter().filter(|(used, _)| *used);
    let effects = scene.dem.effects.names().map(str::to_owned);
    let others = others.map(|(_, name)| (*name).to_owned());
    effects.chain(laws).chain(others).collect()
}

fn describe_time(scene: &Scene) -> String {
    let (steps, frames) = (scene.time.steps_per_frame(), scene.time.frames());
    let (duration, unit) = (scene.time.duration, scene.units().of_time());
    if scene.spot.is_some() {
        return format!("{duration} {unit} in {frames} frames");
    }
    let dt = scene.time.dt;
    format!("{duration} {unit} in {frames} frames of {steps} steps of {dt} {unit}")
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
    let at = describe(axes, &tightest.job.values, tightest.job.seed);
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

/// An axis of numbers or of variants, which are named.
#[derive(Serialize)]
struct AxisAnswer<'a> {
    key: &'a str,
    name: &'a str,
    values: Vec<Value>,
}

impl<'a> AxisAnswer<'a> {
    fn of(axis: &'a Axis) -> Self {
        let value = |value: &f64| match axis.variant(*value) {
            Some(variant) => variant.name.as_str().into(),
            None => (*value).into(),
        };
        Self {
            key: &axis.key,
            name: &axis.name,
            values: axis.values.iter().map(value).collect(),
        }
    }
}

/// What `--json` prints.
#[derive(Serialize)]
struct Answer<'a> {
    file: &'a Path,
    kind: &'static str,
    title: Option<&'a str>,
    jobs: usize,
    axes: Vec<AxisAnswer<'a>>,
    seeds: &'a [u64],
    /// Most runs of a refined sweep; `None` if the whole grid is run.
    budget: Option<usize>,
    spheres: usize,
    effects: Vec<String>,
    duration: f64,
    frames: u64,
    steps_per_frame: u64,
    dt: f64,
    /// The safety factor of `dt = "auto"`; `None` if the step was given.
    safety_factor: Option<f64>,
    limits: Vec<LimitAnswer>,
    /// Whether walls of discs hold; `None` without such walls.
    walls: Option<walls::Answer>,
    forecast: Option<ForecastAnswer>,
}

/// A limit of the time step, and the job that comes closest to it.
#[derive(Serialize)]
struct LimitAnswer {
    name: &'static str,
    seconds: f64,
    decisive: bool,
    ratio: f64,
    point: BTreeMap<String, Value>,
    seed: u64,
}

impl LimitAnswer {
    fn new(tightest: &Tightest<'_>, axes: &[Axis]) -> Self {
        let StepMargin { limit, ratio } = tightest.standing;
        Self {
            name: limit.name,
            seconds: limit.seconds,
            decisive: limit.decisive,
            ratio,
            point: job::point(axes, &tightest.job.values),
            seed: tightest.job.seed,
        }
    }
}

/// What the sweep will cost.
#[derive(Serialize)]
struct ForecastAnswer {
    workers: usize,
    #[serde(flatten)]
    forecast: Forecast,
}

impl ForecastAnswer {
    fn new(forecast: &Forecast, workers: usize) -> Self {
        Self {
            workers,
            forecast: *forecast,
        }
    }
}

/// Time for the trial, about.
const TRIAL_TIME: Duration = Duration::from_secs(4);
