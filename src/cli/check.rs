//! `phase check`: validates a file and says what would run.

use super::console::Console;
use super::exit::{Exit, Failure};
use super::{classify, format};
use phase::classify::Sieves;
use phase::dem::timestep::{self, Limit};
use phase::scene::{Friction, Scene};
use phase::sweep::{Axis, Job, PlotSettings, Sweep, describe, forecast, work};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Check a scene or sweep file and say what it would run, without running it.
///
/// A short trial of a few jobs tells how long it will take and how much memory and disk it needs.
#[derive(clap::Args)]
#[command(after_help = "\
Example: what will the full diagram cost on 16 cores?
  phase check sweeps/theoretical.toml -j 16")]
pub(crate) struct Arguments {
    /// The scene or sweep file (TOML).
    file: PathBuf,
    /// Simulations at the same time [default: all cores].
    #[arg(short, long, value_name = "N", value_parser = super::sweep::at_least_one)]
    jobs: Option<usize>,
    /// Only validate: no trial, no forecast.
    #[arg(long)]
    no_trial: bool,
}

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    let workers = arguments.jobs.unwrap_or_else(work::default_workers);
    let is_sweep = is_sweep(&arguments.file);
    let sweep = if is_sweep {
        phase::sweep::load(&arguments.file).map_err(Failure::refused)?
    } else {
        sweep_of_one(phase::scene::load(&arguments.file).map_err(Failure::refused)?)
    };
    let jobs = sweep.jobs().map_err(Failure::refused)?;
    if is_sweep {
        classify::check_sieves(&sweep, &jobs)?;
    }
    console.result(describe_sweep(&sweep, jobs.len()))?;
    console.result(line("effects", effects(&sweep.scene).join(", ")))?;
    console.result(line("duration", describe_time(&sweep.scene)))?;
    for text in describe_time_step(&jobs, &sweep.axes, console.is_verbose()) {
        console.result(line("time step", text))?;
    }
    if !arguments.no_trial {
        print_forecast(&jobs, workers, console)?;
    }
    Ok(Exit::Done)
}

/// Whether a file is a sweep rather than a scene, which shows in its keys. What cannot be read is
/// left to the loader to complain of.
fn is_sweep(file: &Path) -> bool {
    let text = std::fs::read_to_string(file).unwrap_or_default();
    let table: toml::Table = toml::from_str(&text).unwrap_or_default();
    ["axis", "scene", "sieves", "plot", "seeds"]
        .iter()
        .any(|key| table.contains_key(*key))
}

/// The sweep of just one scene.
fn sweep_of_one(scene: Scene) -> Sweep {
    Sweep {
        title: None,
        axes: Vec::new(),
        seeds: vec![scene.seed],
        scene,
        sieves: Sieves::default(),
        plot: PlotSettings::default(),
    }
}

fn line(name: &str, text: impl std::fmt::Display) -> String {
    format!("  {name:<11} {text}")
}

fn describe_sweep(sweep: &Sweep, jobs: usize) -> String {
    let mut lines = vec![match sweep.title.as_ref().or(sweep.scene.title.as_ref()) {
        Some(title) => format!("{title}: {}", format::count(jobs, "job")),
        None => format::count(jobs, "job"),
    }];
    for axis in &sweep.axes {
        let ends = match axis.values.as_slice() {
            [first, .., last] => format!("{first} to {last}, {} values", axis.values.len()),
            values => format!("{values:?}"),
        };
        lines.push(line(&axis.name, format_args!("{ends} ({})", axis.key)));
    }
    let seeds: Vec<String> = sweep.seeds.iter().map(u64::to_string).collect();
    lines.push(line("seeds", seeds.join(", ")));
    lines.push(line("spheres", sweep.scene.spheres.count));
    lines.join("\n")
}

/// The effects that the scene names; no other costs anything.
fn effects(scene: &Scene) -> Vec<&'static str> {
    let tank = scene.tank.as_ref();
    let law = |law: &Option<Friction>| match law {
        Some(Friction::Spin { .. }) => "friction (spin)",
        Some(Friction::Coulomb { .. }) => "friction (Coulomb)",
        Some(Friction::Mindlin { .. }) => "friction (Mindlin)",
        None => "",
    };
    [
        (scene.gravity.is_some(), "gravity"),
        (scene.contact.is_some(), "contact (Hertz)"),
        (scene.friction.is_some(), law(&scene.friction)),
        (scene.swirl.is_some(), "swirl"),
        (scene.updraught.is_some(), "updraught"),
        (scene.spin_damping.is_some(), "spin damping"),
        (tank.is_some_and(|tank| tank.radius.is_some()), "cylinder"),
        (tank.is_some_and(|tank| tank.floor.is_some()), "floor"),
    ]
    .into_iter()
    .filter_map(|(used, name)| used.then_some(name))
    .collect()
}

fn describe_time(scene: &Scene) -> String {
    let (steps, frames) = phase::run::frames(scene);
    format!(
        "{} s in {frames} frames of {steps} steps of {} s",
        scene.time.duration, scene.time.dt
    )
}

/// The time step over the limit it must not exceed, and over those it had better not; with
/// `all`, over every limit, explained.
fn describe_time_step(jobs: &[Job], axes: &[Axis], all: bool) -> Vec<String> {
    let mut tightest: Vec<Tightest<'_>> = Vec::new();
    for job in jobs {
        for limit in timestep::limits(&job.scene) {
            let next = Tightest {
                limit,
                ratio: job.scene.time.dt / limit.seconds,
                job,
            };
            match tightest
                .iter_mut()
                .find(|tightest| tightest.limit.name == limit.name)
            {
                Some(tightest) if tightest.ratio < next.ratio => *tightest = next,
                Some(_) => {}
                None => tightest.push(next),
            }
        }
    }
    tightest.sort_by(|a, b| {
        let order = b.limit.decisive.cmp(&a.limit.decisive);
        order.then(b.ratio.total_cmp(&a.ratio))
    });
    let is_told =
        |(index, tightest): &(usize, &Tightest<'_>)| all || *index == 0 || tightest.ratio > 1.0;
    let told = tightest.iter().enumerate().filter(is_told);
    told.map(|(_, tightest)| tightest.describe(axes, all))
        .collect()
}

/// A limit of the time step, and the job that comes closest to it.
struct Tightest<'a> {
    limit: Limit,
    ratio: f64,
    job: &'a Job,
}

impl Tightest<'_> {
    fn describe(&self, axes: &[Axis], explain: bool) -> String {
        let Limit {
            name,
            seconds,
            decisive,
            explanation,
        } = self.limit;
        let kind = if decisive { "limit" } else { "advised limit" };
        let at = describe(axes, &self.job.values, self.job.seed);
        let mut text = format!(
            "{:.2} of the {kind} {seconds:.2e} s ({name}) at {at}",
            self.ratio
        );
        if explain {
            text += &format!("\n{:14}{explanation}", "");
        }
        text
    }
}

fn print_forecast(jobs: &[Job], workers: usize, console: &Console) -> Result<(), Failure> {
    console.note("running the first part of a few jobs ...");
    let forecast = forecast(jobs, workers, TRIAL_TIME).map_err(Failure::failed)?;
    console.result(line(
        "forecast",
        format_args!(
            "from the first part of {}, {} per worker",
            format::count(forecast.tried, "job"),
            format::rate(forecast.rate)
        ),
    ))?;
    let time = format::duration(forecast.seconds);
    let workers = format::count(workers.min(jobs.len()), "worker");
    console.result(line("  time", format_args!("about {time} with {workers}")))?;
    console.result(line(
        "  memory",
        format_args!("about {}", format::bytes(forecast.memory)),
    ))?;
    console.result(line(
        "  disk",
        format_args!("about {}", format::bytes(forecast.disk)),
    ))
}

/// Time for the trial, about.
const TRIAL_TIME: Duration = Duration::from_secs(4);
