//! `phase run`: runs one scene, or one job of a sweep again.

mod again;
mod answer;
mod interruptible;

use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::programs::AllowProgram;
use crate::cli::values;
use crate::cli::{folders, overlaps, time_step};
use again::Original;
use answer::{Answer, summary};
use interruptible::Ran;
use phase::document::Problem;
use phase::external::RunFolder;
use phase::record::RunRecord;
use phase::resume::{Checkpoints, DEFAULT_INTERVAL};
use phase::run::{Edits, frame_of_state};
use phase::scene::Scene;
use phase::store::{self, Lease, StoreError};
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
    #[command(flatten)]
    program: AllowProgram,
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
    let AskedRun {
        mut scene,
        record: default_path,
        original,
    } = AskedRun::of(arguments, console)?;
    let file = arguments.scene.as_ref().or(arguments.from.as_ref());
    let file = file.map_or(Path::new(""), |it| it.as_path());
    arguments.program.prepare_scene(&mut scene, file, console)?;
    ask_for_more(&mut scene, arguments)?;
    let path = arguments.out.clone().unwrap_or(default_path);
    if let Some(original) = &original {
        original.refuse_to_replace(&path)?;
    }
    let table = scene.has_flow().then(|| beside(&path));
    refuse_foreign(&path, table.as_deref())?;
    folders::make_for(&path)?;
    let _lock = lock(&path)?;
    time_step::tell_of_scene(&scene, console);
    overlaps::warn_of_scene(&scene, console);
    let interval = arguments.checkpoint_interval.unwrap_or(DEFAULT_INTERVAL);
    let checkpoints = Checkpoints::beside(&path, interval);
    let signature = store::CHECKPOINT_SIGNATURE;
    folders::refuse_to_replace(checkpoints.path(), "a checkpoint", signature)?;
    let run_folder = RunFolder::beside(&path);
    let ran = interruptible::run(
        (&scene, &run_folder),
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
    run_folder.tidy(&record.scene);
    let verdict = answer::labelled(&record)?;
    console.result(summary(&record, verdict.as_ref(), seconds));
    console.file(&path);
    if let Some(table) = &table {
        store::write_observations(&record, table)?;
        console.file(table);
    }
    checkpoints.remove()?;
    let mut answer = Answer::new(&record, verdict.as_ref(), seconds, &path);
    answer.resumed_from = resumed_from;
    if let Some(original) = &original {
        answer.same_bits = original.compare(&record, console)?;
    }
    console.answer(&answer);
    Ok(Exit::Done)
}

/// What the command line asks to run.
struct AskedRun {
    scene: Scene,
    /// Where its record goes by default.
    record: PathBuf,
    /// The job of a sweep that is run again.
    original: Option<Original>,
}

impl AskedRun {
    fn of(arguments: &Arguments, console: &Console) -> Result<Self, Failure> {
        // The parser asks for --from beside --point only where no scene file is given.
        if arguments.point.is_some() && arguments.from.is_none() {
            return Err(Failure::refused(
                "--point selects a job of a sweep: give the sweep's results folder with --from \
                 instead of a scene file",
            ));
        }
        match (&arguments.scene, &arguments.from) {
            (Some(file), _) => {
                let edits = Edits {
                    set: &arguments.set,
                    remove: &arguments.without,
                    options: &arguments.own_keys(),
                };
                let mut scene = Scene::load_with(file, edits)?;
                scene.seed = arguments.seed.unwrap_or(scene.seed);
                Ok(Self {
                    scene,
                    record: default_record(file),
                    original: None,
                })
            }
            (None, Some(folder)) => {
                let point = arguments.point.as_deref().unwrap_or_default();
                let original = Original::find(folder, point, console)?;
                Ok(Self {
                    scene: original.job.scene(),
                    record: original.default_path(),
                    original: Some(original),
                })
            }
            // The parser of the command line asks for one of them.
            (None, None) => Err(Failure::refused("give a scene file, or --from and --point")),
        }
    }
}

/// Refuses to write where something else than a record, or than its table of observables, is.
fn refuse_foreign(record: &Path, table: Option<&Path>) -> Result<(), Failure> {
    folders::refuse_to_replace(record, "a record", store::HDF5_SIGNATURE)?;
    if let Err(StoreError::NotARecord { .. }) = store::read_record_header(record) {
        folders::refuse_foreign(Path::new(""), [record], "choose another name with --out")?;
    }
    if let Some(table) = table {
        // The first columns of what is observed; spots have no energies.
        let columns: [&[u8]; 2] = [b"time,height_mean,", b"time,kinetic,"];
        folders::refuse_to_replace_any(table, "a table of observables", &columns)?;
    }
    Ok(())
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
