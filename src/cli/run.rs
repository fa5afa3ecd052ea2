//! `phase run`: runs one scene.

use super::console::Console;
use super::exit::{Exit, Failure};
use super::progress::{Progress, Work};
use super::{folders, format, interrupt};
use phase::record::{Outcome, RunRecord};
use phase::run::RunError;
use phase::store;
use phase::sweep::work;
use serde::Serialize;
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

/// Run one scene and store its record.
#[derive(clap::Args)]
#[command(after_help = "\
Example: one scene with another seed
  phase run sweeps/scenes/theoretical.toml --seed 7 --out tank-7.h5")]
pub(crate) struct Arguments {
    /// The scene file (TOML).
    scene: PathBuf,
    /// The record to write, an HDF5 file; one of that name is replaced [default:
    /// results/NAME.h5, the scene file's name without .toml].
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Seed in place of the scene's.
    #[arg(short, long)]
    seed: Option<u64>,
    /// Print the result as one JSON object (docs/json.md) instead of text.
    #[arg(long)]
    pub(super) json: bool,
}

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    let mut scene = phase::scene::load(&arguments.scene).map_err(Failure::refused)?;
    scene.seed = arguments.seed.unwrap_or(scene.seed);
    let stop = interrupt::stop_on_signal(console)?;
    let path = arguments
        .out
        .clone()
        .unwrap_or_else(|| default_record(&arguments.scene));
    folders::make_for(&path)?;

    let steps = work::sphere_steps(&scene);
    let progress = Progress::new(
        console,
        Work {
            jobs: 1,
            jobs_done: 0,
            steps,
            steps_done: 0,
        },
    );
    let steps_per_frame = steps / phase::run::frames(&scene).1.max(1);
    let result = phase::run::run(&scene, &mut |_| {
        progress.advance(steps_per_frame);
        if stop.load(Ordering::Relaxed) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    });
    let seconds = progress.finish();
    let record = match result {
        Ok(record) => record,
        Err(RunError::Interrupted) => {
            console.note("interrupted; nothing was stored");
            return Ok(Exit::Interrupted);
        }
        Err(error) => return Err(Failure::failed(error)),
    };
    store::write_record(&record, &path).map_err(Failure::failed)?;
    console.result(summary(&record, seconds))?;
    console.file(&path)?;
    console.answer(&Answer::new(&record, seconds, &path))?;
    Ok(Exit::Done)
}

/// `results/<stem of the scene file>.h5`.
fn default_record(file: &Path) -> PathBuf {
    Path::new("results")
        .join(file.file_stem().unwrap_or("scene".as_ref()))
        .with_added_extension("h5")
}

/// What `--json` prints.
#[derive(Serialize)]
struct Answer<'a> {
    record: &'a Path,
    seed: u64,
    outcome: &'static str,
    /// What ended an unstable run.
    instability: Option<Broken>,
    seconds: f64,
    cpu_seconds: f64,
    sphere_steps: u64,
    frames: usize,
    /// Time (s) and every scalar observable of the last frame, in the units of the record.
    last_frame: BTreeMap<&'static str, f64>,
}

/// The guard that ended a run.
#[derive(Serialize)]
struct Broken {
    guard: &'static str,
    step: u64,
    time: f64,
    sphere: usize,
    detail: String,
}

impl<'a> Answer<'a> {
    fn new(record: &RunRecord, seconds: f64, path: &'a Path) -> Self {
        let observations = &record.observations;
        let mut last_frame = BTreeMap::new();
        last_frame.extend(observations.time.last().map(|time| ("time", *time)));
        for series in observations.scalars() {
            let last = series.values.last();
            last_frame.extend(last.map(|value| (series.name, f64::from(*value))));
        }
        let (outcome, instability) = match &record.outcome {
            Outcome::Completed => ("completed", None),
            Outcome::Unstable(instability) => ("unstable", Some(instability)),
        };
        Self {
            record: path,
            seed: record.scene.seed,
            outcome,
            instability: instability.map(|instability| Broken {
                guard: instability.guard.name(),
                step: instability.step,
                time: instability.time,
                sphere: instability.sphere,
                detail: instability.detail.clone(),
            }),
            seconds,
            cpu_seconds: record.cpu_seconds,
            sphere_steps: work::sphere_steps_run(&record.scene, &record.outcome),
            frames: observations.frames(),
            last_frame,
        }
    }
}

/// How the run ended, and the state of its last frame.
fn summary(record: &RunRecord, seconds: f64) -> String {
    let observations = &record.observations;
    let steps = work::sphere_steps_run(&record.scene, &record.outcome) as f64;
    let mut text = match &record.outcome {
        Outcome::Completed => "completed".to_owned(),
        Outcome::Unstable(instability) => format!("unstable: {instability}"),
    };
    text += &format!(
        "\n  {:<14} {} ({})",
        "took",
        format::duration(seconds),
        format::rate(steps / record.cpu_seconds.max(1e-9))
    );
    text += &format!("\n  {:<14} {}", "frames", observations.frames());
    if let Some(time) = observations.time.last() {
        text += &format!("\nlast frame, at {time} s");
    }
    for series in observations.scalars() {
        if let Some(value) = series.values.last() {
            let value = format!("{value:.4e}");
            text += &format!(
                "\n  {:<14} {value:>11} {:<6} {}",
                series.name, series.unit, series.description
            );
        }
    }
    text
}
