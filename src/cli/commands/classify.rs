//! `phase classify`: labels the runs of a results folder, or of a folder of dumps, from their
//! records.

mod dumps;
mod edited;

use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::folders::{self, Entry, Undone};
use crate::cli::labels::{OF_STUDY, Summary, cannot_label, cannot_write, label_folder};
use crate::cli::options::Workers;
use phase::sweep::{Folder, Job, LabellingError, NamePattern, Sweep, refuse_to_lose_labels};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Label the runs of a results folder from their records, without new simulations.
///
/// Writes labels.csv and points.csv and says how many labels changed.
#[derive(clap::Args)]
#[command(after_help = "\
Example: other thresholds. Edit [sieves] in a copy of the sweep file, then
  phase classify results/quick --sweep edited.toml
  phase plot results/quick

Example: dumps as the thesis's program wrote them (dump_r00.003_p03750.0_f006.0.npy: frames x
spheres x 4 of x, y, z and energy). Radius, density and Omega come from the names, the rest from the
scene
  phase classify dumps --scene sweeps/scenes/theoretical.toml

Example: dumps with other names, such as tilt-0.1-run-2.npy. A mark @{KEY} is where the value of a
numeric key of the scene stands; it becomes an axis of the table, as in a sweep over the key.
@{seed} is the seed, @{name} any text, and [...] around them may be missing
  phase classify dumps --scene scene.toml --names 'tilt-@{gravity.tilt}[-run-@{seed}].npy'

A dump has no velocities, spins or contact energies. The sieves do not need them, but the order
parameters rotation and mobility are then computed from displacements between frames.")]
pub(crate) struct Arguments {
    /// A results folder of `phase sweep`, or a folder that holds several; or, with --scene, a
    /// folder of dumps.
    dir: PathBuf,
    /// The folder holds dumps (.npy, or .npz with one array) of runs of this scene.
    #[arg(long, value_name = "FILE")]
    scene: Option<PathBuf>,
    /// The names of the dumps, with marks in the place of values.
    #[arg(long, value_name = "PATTERN", requires = "scene", default_value = NamePattern::OF_THESIS)]
    names: String,
    /// From now on take thresholds, title and plot settings from this sweep file. Its scene, axes
    /// and seeds must be the ones that were run. With --scene only the thresholds are taken.
    #[arg(long, value_name = "FILE")]
    sweep: Option<PathBuf>,
    #[command(flatten)]
    workers: Workers,
}

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    let workers = arguments.workers.count();
    let edited = match &arguments.sweep {
        Some(file) => Some(phase::sweep::load(file)?),
        None => None,
    };
    let folders = match &arguments.scene {
        Some(scene) => {
            let sieves = edited.map(|sweep| sweep.sieves).unwrap_or_default();
            let labelled = dumps::label(
                &arguments.dir,
                scene,
                &arguments.names,
                &sieves,
                workers,
                console,
            )?;
            let summary = Summary::new(&Folder::new(&arguments.dir), &labelled);
            vec![Entry::Done(summary)]
        }
        None => label_folders(&arguments.dir, edited.as_ref(), workers, console)?,
    };
    let exit = Entry::exit(&folders, |summary| summary.problems.is_empty());
    console.answer_with_files(&Answer { folders });
    Ok(exit)
}

/// Labels the runs of every results folder at `dir`.
fn label_folders(
    dir: &Path,
    edited: Option<&Sweep>,
    workers: usize,
    console: &Console,
) -> Result<Vec<Entry<Summary>>, Failure> {
    let found = Folder::find(dir).map_err(|error| dumps::hint(dir, &error))?;
    if let Some(edited) = edited {
        return edited::label(dir, found, edited, workers, console);
    }
    folders::go_through(dir, found, console, |folder| {
        let sweep = sweep_with_records(folder)?;
        let wait = |holder: &_| folders::tell_of_waiting(folder, holder, console);
        let _access = folder.lock(&wait)?;
        let jobs = jobs_to_label(folder, &sweep)?;
        let labelled = label_folder(folder, &sweep, &jobs, workers, console)?;
        Ok(Summary::new(folder, &labelled))
    })
}

/// The jobs of the sweep of a folder so far, which its sieves can judge.
fn jobs_to_label(folder: &Folder, sweep: &Sweep) -> Result<Vec<Job>, Failure> {
    let refining = folder.read_refining(sweep)?;
    let jobs = sweep.jobs_so_far(refining.as_ref())?;
    sweep.check_sieves(&jobs).map_err(cannot_label)?;
    Ok(jobs)
}

/// The sweep of a folder. Refuses to label runs without records. If no run has a record, as in
/// published results, the labels are kept.
fn sweep_with_records(folder: &Folder) -> Result<Sweep, Undone> {
    let sweep = folder.read_sweep()?;
    if sweep.study.is_some() {
        return Err(Undone::Kept(Failure::refused(OF_STUDY).at(folder.root())));
    }
    match refuse_to_lose_labels(folder, []) {
        Ok(()) => Ok(sweep),
        Err(error @ LabellingError::Lost { rows, lost, .. }) if rows == lost => {
            Err(Undone::Kept(cannot_write(error)))
        }
        Err(error) => Err(Undone::Failed(cannot_write(error))),
    }
}

/// The `--json` result.
#[derive(Serialize)]
struct Answer {
    folders: Vec<Entry<Summary>>,
}
