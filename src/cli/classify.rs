//! `phase classify`: labels the runs of a results folder again, from their records, or those of a
//! folder of dumps.

mod dumps;

use super::console::{Console, name_first};
use super::exit::{Exit, Failure};
use super::format;
use phase::classify::{Label, Sieves};
use phase::scene::Scene;
use phase::store;
use phase::sweep::{
    Folder, Job, LabelTable, Labelling, PlotSettings, Sweep, changes, differing_keys, work,
};
use std::path::PathBuf;

/// Label the runs of a results folder from their records, without any new simulation.
///
/// Writes labels.csv and points.csv and says how many labels changed.
#[derive(clap::Args)]
#[command(after_help = "\
Example: other thresholds. Edit [sieves] in a copy of the sweep file, then
  phase classify results/quick --sweep edited.toml
  phase plot results/quick

Example: dumps as the thesis's program wrote them (dump_r00.003_p03750.0_f006.0.npy: frames x spheres
x 4 of x, y, z and energy). Radius, density and Omega come from the names, the rest from the scene
  phase classify dumps --scene sweeps/scenes/theoretical.toml
A dump has no velocities, spins or contact energies: the sieves get along without them, but the
order parameters rotation and mobility are then those of displacements from frame to frame.")]
pub(crate) struct Arguments {
    /// A results folder of `phase sweep`, or a folder that holds several; or, with --scene, a folder
    /// of dumps.
    dir: PathBuf,
    /// The folder holds dumps (.npy) of runs of this scene.
    #[arg(long, value_name = "FILE")]
    scene: Option<PathBuf>,
    /// Take the thresholds, the title and the plot settings from this sweep file from now on. The
    /// scene, the axes and the seeds must be those that were run. With --scene, the thresholds only.
    #[arg(long, value_name = "FILE")]
    sweep: Option<PathBuf>,
    /// Records to read at the same time [default: all cores].
    #[arg(short, long, value_name = "N", value_parser = super::sweep::at_least_one)]
    jobs: Option<usize>,
}

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    let workers = arguments.jobs.unwrap_or_else(work::default_workers);
    let edited = match &arguments.sweep {
        Some(file) => Some(phase::sweep::load(file).map_err(Failure::refused)?),
        None => None,
    };
    if let Some(scene) = &arguments.scene {
        let sieves = edited.map(|sweep| sweep.sieves).unwrap_or_default();
        return dumps::label(&arguments.dir, scene, &sieves, workers, console);
    }
    let mut exit = Exit::Done;
    let folders =
        Folder::find(&arguments.dir).map_err(|error| dumps::hint(&arguments.dir, &error))?;
    for folder in folders {
        let mut sweep = folder.read_sweep().map_err(Failure::failed)?;
        // The sweep is kept with its new thresholds, so that the labels are always those it says.
        let mut lock = None;
        if let Some(edited) = &edited {
            refuse_other_runs(&folder, &sweep, edited)?;
            lock = Some(folder.lock().map_err(Failure::refused)?);
            sweep = edited.clone();
        }
        let jobs = sweep.jobs().map_err(Failure::refused)?;
        check_sieves(&sweep, &jobs)?;
        let labelled = label_folder(&folder, &sweep, &jobs, workers, console)?;
        if lock.is_some() {
            folder.write_sweep(&sweep).map_err(Failure::failed)?;
        }
        if labelled.problems > 0 {
            exit = Exit::Failed;
        }
    }
    Ok(exit)
}

/// Refuses an edited sweep whose runs are not those of the folder.
fn refuse_other_runs(folder: &Folder, sweep: &Sweep, edited: &Sweep) -> Result<(), Failure> {
    let runs = |sweep: &Sweep| Sweep {
        title: None,
        scene: Scene {
            title: None,
            ..sweep.scene.clone()
        },
        sieves: Sieves::default(),
        plot: PlotSettings::default(),
        ..sweep.clone()
    };
    let keys = differing_keys(&runs(sweep), &runs(edited));
    if keys.is_empty() {
        return Ok(());
    }
    Err(Failure::refused(format_args!(
        "{}: the runs in this folder are not those of the edited sweep; they differ in {}. \
         Thresholds may change, runs may not: `phase sweep` makes new ones",
        folder.root().display(),
        keys.join(", ")
    )))
}

/// Refuses sieves that cannot judge the runs of a sweep, before any time is spent on these.
pub(super) fn check_sieves(sweep: &Sweep, jobs: &[Job]) -> Result<(), Failure> {
    let check = |job: &Job| sweep.sieves.check(&job.scene);
    jobs.iter().try_for_each(check).map_err(|error| {
        Failure::refused(format_args!(
            "the sieves cannot label these runs: {error} (`phase sweep --no-classify` only runs them)"
        ))
    })
}

/// The labels of a folder.
pub(super) struct Labelled {
    pub(super) table: LabelTable,
    /// Number of records that could not be labelled.
    pub(super) problems: usize,
}

/// Labels the runs of a folder, writes the tables and prints what they say.
pub(super) fn label_folder(
    folder: &Folder,
    sweep: &Sweep,
    jobs: &[Job],
    workers: usize,
    console: &Console,
) -> Result<Labelled, Failure> {
    let labelling = Labelling::new(folder, sweep, jobs, workers).map_err(Failure::failed)?;
    let problems = labelling.problems.len();
    if labelling.missing > 0 {
        console.note(format_args!(
            "{}: {} of {} not yet run, and without a label",
            folder.root().display(),
            labelling.missing,
            format::count(jobs.len(), "job")
        ));
    }
    Ok(Labelled {
        table: write_tables(labelling, folder, console)?,
        problems,
    })
}

/// Writes labels.csv and points.csv of a folder and prints what they say.
fn write_tables(
    labelling: Labelling,
    folder: &Folder,
    console: &Console,
) -> Result<LabelTable, Failure> {
    let before = read_labels_before(folder, console);
    let Labelling {
        table, problems, ..
    } = labelling;
    name_first(&problems, |problem| {
        console.error(format_args!("no label: {problem}"))
    });
    store::write_labels(&table, &folder.labels()).map_err(Failure::failed)?;
    store::write_points(&table, &folder.points()).map_err(Failure::failed)?;
    console.result(counts(&table))?;
    if let Some(before) = before {
        console.result(describe_changes(&before, &table))?;
    }
    console.result(folder.labels().display())?;
    console.result(folder.points().display())?;
    Ok(table)
}

fn read_labels_before(folder: &Folder, console: &Console) -> Option<LabelTable> {
    let path = folder.labels();
    if !path.exists() {
        return None;
    }
    store::read_labels(&path)
        .map_err(|error| {
            console.note(format_args!(
                "cannot compare with the labels before: {error}"
            ))
        })
        .ok()
}

/// How many runs have each label.
fn counts(table: &LabelTable) -> String {
    let mut text = format!("{} labelled", format::count(table.rows.len(), "run"));
    for label in Label::ALL {
        let number = table
            .rows
            .iter()
            .filter(|row| row.verdict.label == label)
            .count();
        if number > 0 {
            let share = format::percent(number, table.rows.len());
            text += &format!("\n  {:<12} {number:>6} {share:>6}", label.name());
        }
    }
    text
}

/// How many labels changed, and from what to what.
fn describe_changes(before: &LabelTable, after: &LabelTable) -> String {
    let changes = changes(before, after);
    let changed: usize = changes.values().sum();
    let mut text = format!(
        "{changed} of {} changed",
        format::count(after.rows.len(), "label")
    );
    for ((from, to), number) in changes {
        let arrow = format!("{} -> {}", from.name(), to.name());
        text += &format!("\n  {arrow:<26} {number:>6}");
    }
    text
}
