//! `phase run`: runs one scene, or one job of a sweep again.

mod again;
mod interruptible;

use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::values;
use crate::cli::{folders, format, overlaps, time_step};
use again::Original;
use interruptible::Ran;
use phase::dem::timestep::StepMargin;
use phase::document::Problem;
use phase::record::{Milestone, MilestoneKind, Outcome, RunRecord};
use phase::resume::{Checkpoints, DEFAULT_INTERVAL};
use phase::run::{Edits, frame_of_state, model_of};
use phase::scene::{Scene, Start};
use phase::simulation::Instability;
use phase::store::{self, Lease, StoreError};
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Run one scene, or one job of a sweep again, and store its record.
///
/// More output never changes the motion: a job that is run again must give the same bits as in the
/// sweep, and the command says whether it did.
#[derive(clap::Args)]
#[command(after_help = "\
Example: one scene with another seed
  phase run sweeps/scenes/theoretical.toml --seed 7 --out tank-7.h5

Example: the same with other keys
  phase run sweeps/scenes/theoretical.toml --set swirl.omega=12 --without updraught --out slow.h5

Example: one job of a sweep, this time with all spheres at every frame
  phase run --from results/quick --point radius=0.003,omega=6 --trajectory --out spout.h5

Example: continue an interrupted run
  phase run sweeps/scenes/silo.toml --resume

A long run writes a checkpoint, NAME.checkpoint next to NAME.h5, every two minutes and when it is
interrupted. A continued run has the same bits as an uninterrupted one. Only the same build of
phase, with the same scene and output, reads a checkpoint.")]
pub(crate) struct Arguments {
    /// The scene file (TOML).
    #[arg(required_unless_present = "from")]
    scene: Option<PathBuf>,
    /// Run a job of the sweep in this results folder again, instead of a scene file.
    #[arg(long, value_name = "DIR", conflicts_with = "scene")]
    from: Option<PathBuf>,
    /// Which job: a value for every axis of the sweep and optionally `seed=N` [default: the first
    /// seed].
    #[arg(long, value_name = "NAME=VALUE,...", requires = "from")]
    point: Option<String>,
    /// The record to write (HDF5), replacing an earlier one [default: results/NAME.h5 for a scene
    /// file NAME.toml, DIR/runs/POINT.h5 for a job].
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Seed to use instead of the scene's.
    #[arg(short, long, conflicts_with = "from", value_parser = values::seed)]
    seed: Option<u64>,
    /// Set a key of the scene, such as `spot.walk.bias=3`; may be given several times.
    #[arg(long, value_name = "KEY=VALUE", conflicts_with = "from", value_parser = values::setting)]
    set: Vec<String>,
    /// Remove a table or key from the scene, such as `spot.weighting`; may be given several times.
    #[arg(long, value_name = "KEY", conflicts_with = "from")]
    without: Vec<String>,
    /// Store position, velocity and spin of every sphere at every frame.
    #[arg(short, long)]
    trajectory: bool,
    /// Compute the energy balance: dissipation by damping and friction, work of the air, and the
    /// residual (the integrator's error). Slower; never changes the motion.
    #[arg(short, long)]
    ledger: bool,
    /// Time between snapshots of all spheres (s); 0 for the last state only.
    #[arg(long, value_name = "SECONDS")]
    snapshot_interval: Option<f64>,
    /// Continue from the checkpoint of an interrupted run of this record, if there is one.
    #[arg(short, long)]
    resume: bool,
    /// Time between two checkpoints (s); 0 for a checkpoint at every frame [default: 120].
    #[arg(long, value_name = "SECONDS", value_parser = values::seconds)]
    checkpoint_interval: Option<Duration>,
    /// Threads for the simulation; runs of fewer than 4096 spheres use one. The bits do not
    /// depend on it.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = values::threads)]
    threads: usize,
}

impl Arguments {
    /// The options given that set a key of the scene of their own, with that key.
    fn own_keys(&self) -> Vec<(&'static str, &'static str)> {
        let options = [
            (self.seed.is_some(), "--seed", "seed"),
            (self.trajectory, "--trajectory", "output.trajectory"),
            (self.ledger, "--ledger", "output.ledger"),
            (
                self.snapshot_interval.is_some(),
                "--snapshot-interval",
                "output.snapshot_interval",
            ),
        ];
        let given = options.into_iter().filter(|(is_given, ..)| *is_given);
        given.map(|(_, option, key)| (option, key)).collect()
    }
}

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    // The parser asks for --from beside --point only where no scene file is given.
    if arguments.point.is_some() && arguments.from.is_none() {
        return Err(Failure::refused(
            "--point selects a job of a sweep: give the sweep's results folder with --from instead \
             of a scene file",
        ));
    }
    let (mut scene, default_path, original) = match (&arguments.scene, &arguments.from) {
        (Some(file), _) => {
            let edits = Edits {
                set: &arguments.set,
                remove: &arguments.without,
                options: &arguments.own_keys(),
            };
            let scene = Scene::load_with(file, edits);
            let mut scene = scene?;
            scene.seed = arguments.seed.unwrap_or(scene.seed);
            (scene, default_record(file), None)
        }
        (None, Some(folder)) => {
            let point = arguments.point.as_deref().unwrap_or_default();
            let original = Original::find(folder, point, console)?;
            let path = original.default_path();
            (original.job.scene.clone(), path, Some(original))
        }
        // The parser of the command line asks for one of them.
        (None, None) => return Err(Failure::refused("give a scene file, or --from and --point")),
    };
    ask_for_more(&mut scene, arguments)?;
    let path = arguments.out.clone().unwrap_or(default_path);
    if let Some(original) = &original {
        original.refuse_to_replace(&path)?;
    }
    folders::refuse_to_replace(&path, "a record", store::HDF5_SIGNATURE)?;
    if let Err(StoreError::NotARecord { .. }) = store::read_record_header(&path) {
        folders::refuse_foreign(Path::new(""), [&path], "choose another name with --out")?;
    }
    let table = scene.has_flow().then(|| beside(&path));
    if let Some(table) = &table {
        // The first columns of what is observed; spots have no energies.
        let columns: [&[u8]; 2] = [b"time,height_mean,", b"time,kinetic,"];
        folders::refuse_to_replace_any(table, "a table of observables", &columns)?;
    }
    folders::make_for(&path)?;
    let _lock = lock(&path)?;
    time_step::tell_of_scene(&scene, console);
    overlaps::warn_of_scene(&scene, console);
    let interval = arguments.checkpoint_interval.unwrap_or(DEFAULT_INTERVAL);
    let checkpoints = Checkpoints::beside(&path, interval);
    let signature = store::CHECKPOINT_SIGNATURE;
    folders::refuse_to_replace(checkpoints.path(), "a checkpoint", signature)?;
    let ran = interruptible::run(
        &scene,
        arguments.threads,
        &checkpoints,
        arguments.resume,
        console,
    )?;
    let Some(Ran {
        mut record,
        seconds,
        resumed_from,
    }) = ran
    else {
        return Ok(Exit::Interrupted);
    };
    write(&mut record, &path, &checkpoints, original.is_some())?;
    console.result(summary(&record, seconds));
    console.file(&path);
    if let Some(table) = &table {
        store::write_observations(&record, table)?;
        console.file(table);
    }
    checkpoints.remove()?;
    let same_bits = match &original {
        Some(original) => original.compare(&record, console)?,
        None => None,
    };
    console.answer(&Answer {
        resumed_from,
        same_bits,
        ..Answer::new(&record, seconds, &path)
    });
    Ok(Exit::Done)
}

/// Takes the right to write a record and what goes beside it.
fn lock(record: &Path) -> Result<Lease, Failure> {
    let file = record.display();
    let lease = Lease::take_beside(record, Duration::ZERO).map_err(|error| {
        Failure::failed(format_args!("{file}: {error}{}", store::advice(&error)))
    })?;
    lease.ok_or_else(|| {
        Failure::refused(format_args!(
            "{file}: another `phase run` is writing this record; wait until it ends, or choose \
             another name with --out"
        ))
    })
}

/// Writes the record, and makes its folder again if somebody removed it. If this fails, only the
/// latest checkpoint of the run remains. The record loses its states if it need not keep them.
fn write(
    record: &mut RunRecord,
    path: &Path,
    checkpoints: &Checkpoints,
    keep_states: bool,
) -> Result<(), Failure> {
    folders::make_for(path)?;
    let written = match keep_states {
        true => store::write_record(record, path),
        false => store::write_record_and_drop_states(record, path),
    };
    written.map_err(|error| {
        let left = match store::read_checkpoint(checkpoints.path(), &record.scene) {
            Ok(Some(checkpoint)) => format!(
                "the checkpoint of frame {} of {} is kept: the same command with --resume \
                 continues from there ({})",
                frame_of_state(checkpoint.state()).unwrap_or_default(),
                record.scene.time.frames(),
                checkpoints.path().display()
            ),
            _ => "there is no checkpoint yet, so the run must start again".to_owned(),
        };
        Failure::failed(format_args!("{error}; {left}"))
    })
}

/// The table of observables beside a record.
fn beside(record: &Path) -> PathBuf {
    let mut name = record.file_stem().unwrap_or_default().to_owned();
    name.push("-observations.csv");
    record.with_file_name(name)
}

/// Puts what the command line says of the output into the scene.
fn ask_for_more(scene: &mut Scene, arguments: &Arguments) -> Result<(), Failure> {
    scene.output.trajectory |= arguments.trajectory;
    scene.output.ledger |= arguments.ledger;
    if let Some(interval) = arguments.snapshot_interval {
        if !(interval.is_finite() && interval >= 0.0) {
            return Err(Failure::refused(format_args!(
                "--snapshot-interval {interval}: must be a time in seconds, 0 or more"
            )));
        }
        scene.output.snapshot_interval = interval;
    }
    match scene.problems().as_slice() {
        [] => Ok(()),
        problems => {
            let problems: Vec<String> = problems.iter().map(Problem::to_string).collect();
            Err(Failure::refused(problems.join("; ")))
        }
    }
}

/// `results/<stem of the scene file>.h5`.
fn default_record(file: &Path) -> PathBuf {
    Path::new("results")
        .join(file.file_stem().unwrap_or("scene".as_ref()))
        .with_added_extension("h5")
}

/// The `--json` result.
#[derive(Serialize)]
struct Answer<'a> {
    record: &'a Path,
    seed: u64,
    outcome: &'static str,
    /// How an unstable run ended.
    instability: Option<&'a Instability>,
    seconds: f64,
    cpu_seconds: f64,
    sphere_steps: u64,
    frames: usize,
    /// Time step (s), over the limit above which it is refused, and the name of that limit.
    dt: f64,
    dt_over_limit: Option<f64>,
    limit: Option<&'static str>,
    /// What happened once, and when (s), where spheres come or go.
    milestones: Vec<Milestone>,
    /// Expected events that did not happen.
    unmet: Vec<String>,
    /// Time (s) and every scalar observable of the last frame, in the units of the record.
    last_frame: BTreeMap<&'a str, f64>,
    /// Time (s) of the checkpoint from which the run continued; `None` if it began at its start.
    resumed_from: Option<f64>,
    /// Whether a job that was run again gave the bits of the sweep's record; `None` without one.
    same_bits: Option<bool>,
}

impl<'a> Answer<'a> {
    fn new(record: &'a RunRecord, seconds: f64, path: &'a Path) -> Self {
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
        let standing = StepMargin::decisive(&record.scene);
        Self {
            record: path,
            seed: record.scene.seed,
            outcome,
            instability,
            seconds,
            cpu_seconds: record.cpu_seconds,
            sphere_steps: record.work,
            frames: observations.frames(),
            dt: record.scene.time.dt,
            dt_over_limit: standing.map(|it| it.ratio),
            limit: standing.map(|it| it.limit.name),
            milestones: record.milestones.clone(),
            unmet: unmet(record),
            last_frame,
            resumed_from: None,
            same_bits: None,
        }
    }
}

/// Expected events that did not happen.
fn unmet(record: &RunRecord) -> Vec<String> {
    let scene = &record.scene;
    let happened = |kind| record.milestones.iter().any(|it| it.kind == kind);
    let last = |series: &[f32]| series.last().map_or(0.0, |count| *count);
    let (observations, all) = (&record.observations, record.radius.len());
    let mut unmet = Vec::new();
    if matches!(scene.start, Start::Feed { .. }) && !happened(MilestoneKind::Filled) {
        unmet.push(format!(
            "NOT FILLED: {} of {all} spheres entered; the inlet was blocked, or the run ended too \
             early",
            last(&observations.released)
        ));
    }
    if scene.dem.rest.is_some()
        && !happened(MilestoneKind::AtRest)
        && !happened(MilestoneKind::Emptied)
    {
        unmet.push("NEVER AT REST".to_owned());
    }
    if scene.dem.door.is_some() && !happened(MilestoneKind::DoorOpened) {
        unmet.push("THE DOOR NEVER OPENED".to_owned());
    }
    if record.is_steady() == Some(false) {
        unmet.push("NOT STEADY: the run reached its duration first".to_owned());
    }
    let spilled = last(&observations.spilled);
    if spilled > 0.0 {
        unmet.push(format!(
            "SPILLED: {spilled} spheres left before the door opened, over the rim or past the silo"
        ));
    }
    unmet
}

/// How the run ended, and the state of its last frame.
fn summary(record: &RunRecord, seconds: f64) -> String {
    let observations = &record.observations;
    let steps = record.work as f64;
    let mut text = match &record.outcome {
        Outcome::Completed => "completed".to_owned(),
        Outcome::Unstable(instability) => format!("unstable: {instability}"),
    };
    text += &format!(
        "\n  {:<14} {} ({})",
        "took",
        format::duration(seconds),
        format::rate(
            steps / record.cpu_seconds.max(1e-9),
            model_of(&record.scene).work_unit()
        )
    );
    text += &format!("\n  {:<14} {}", "frames", observations.frames());
    for milestone in &record.milestones {
        text += &format!(
            "\n  {:<14} at {}",
            milestone.kind.name(),
            format::time(milestone.time)
        );
    }
    for unmet in unmet(record) {
        text += &format!("\n  {unmet}");
    }
    if let Some(time) = observations.time.last() {
        text += &format!("\nlast frame, at {}", format::time(*time));
    }
    for series in observations.scalars() {
        // Without spheres there are no means.
        if let Some(value) = series.values.last().filter(|value| value.is_finite()) {
            let value = format!("{value:.4e}");
            text += &format!(
                "\n  {:<14} {value:>11} {:<6} {}",
                series.name, series.unit, series.description
            );
        }
    }
    text
}
