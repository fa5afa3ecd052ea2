//! `phase classify`: labels the runs of a results folder again, from their records, or those of a
//! folder of dumps.

mod dumps;

use super::console::{Console, name_first};
use super::exit::{Exit, Failure};
use super::{format, kind};
use phase::classify::{Label, Sieves};
use phase::scene::Scene;
use phase::store;
use phase::sweep::{
    Folder, Job, LabelRow, LabelTable, Labelling, PlotSettings, Sweep, changes, differing_keys,
    irreplaceable, work,
};
use serde::Serialize;
use std::collections::{BTreeMap, HashSet};
use std::path::{Path, PathBuf};

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
    /// Print the result as one JSON object (docs/json.md) instead of text.
    #[arg(long)]
    pub(super) json: bool,
}

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    let workers = arguments.jobs.unwrap_or_else(work::default_workers);
    let edited = match &arguments.sweep {
        Some(file) => Some(kind::load_sweep(file)?),
        None => None,
    };
    let folders = match &arguments.scene {
        Some(scene) => {
            let sieves = edited.map(|sweep| sweep.sieves).unwrap_or_default();
            vec![dumps::label(&arguments.dir, scene, &sieves, workers, console)?.summary]
        }
        None => label_folders(&arguments.dir, edited.as_ref(), workers, console)?,
    };
    let exit = match folders.iter().all(|folder| folder.problems.is_empty()) {
        true => Exit::Done,
        false => Exit::Failed,
    };
    console.answer(&Answer {
        folders,
        files: console.files(),
    });
    Ok(exit)
}

/// Labels the runs of every results folder at `dir`.
fn label_folders(
    dir: &Path,
    edited: Option<&Sweep>,
    workers: usize,
    console: &Console,
) -> Result<Vec<Summary>, Failure> {
    let mut folders = Vec::new();
    for folder in Folder::find(dir).map_err(|error| dumps::hint(dir, &error))? {
        let mut sweep = folder.read_sweep().map_err(Failure::failed)?;
        // The sweep is kept with its new thresholds, so that the labels are always those it says.
        let mut lock = None;
        if let Some(edited) = edited {
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
        folders.push(labelled.summary);
    }
    Ok(folders)
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

/// Warns of sieves that find nothing in any run, as these are too short.
pub(super) fn warn_of_windows(sweep: &Sweep, jobs: &[Job], console: &Console) {
    let scenes = jobs.iter().map(|job| &job.scene);
    let longest = scenes.max_by(|one, other| one.time.duration.total_cmp(&other.time.duration));
    let Some(scene) = longest else { return };
    let duration = scene.time.duration;
    for (name, window) in sweep.sieves.without_room(scene) {
        console.warning(format_args!(
            "the window of the sieve {name}, {window} s, is longer than the runs, {duration} s: it finds nothing in \
             any of them; lengthen time.duration, or shorten `window` in [sieves.{name}]"
        ));
    }
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
    pub(super) summary: Summary,
}

/// What `--json` prints.
#[derive(Serialize)]
struct Answer {
    folders: Vec<Summary>,
    /// The files written.
    files: Vec<PathBuf>,
}

/// The labels of a folder in numbers.
#[derive(Serialize)]
pub(super) struct Summary {
    folder: PathBuf,
    /// Runs that have a label.
    labelled: usize,
    /// Runs by label; all labels of the family are there.
    labels: BTreeMap<&'static str, usize>,
    /// Jobs without a record.
    not_run: usize,
    /// Records that could not be labelled, and why.
    pub(super) problems: Vec<String>,
    /// Labels other than before; none if there were no labels before.
    changes: Option<Vec<Change>>,
    /// Runs that had no label before; none if there were no labels before.
    new: Option<usize>,
}

/// Labels that changed.
#[derive(Serialize)]
struct Change {
    from: &'static str,
    to: &'static str,
    runs: usize,
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
    if labelling.missing > 0 {
        console.note(format_args!(
            "{}: {} of {} not yet run, and without a label",
            folder.root().display(),
            labelling.missing,
            format::count(jobs.len(), "job")
        ));
    }
    let kept = labelling.table.rows.iter().map(|row| row.id.as_str());
    refuse_to_lose_labels(folder, kept)?;
    write_tables(labelling, folder, console)
}

/// Refuses to replace a table of labels that cannot be made again, as of results that were published
/// without their records. The new table has the runs that are `kept`.
pub(super) fn refuse_to_lose_labels<'a>(
    folder: &Folder,
    kept: impl IntoIterator<Item = &'a str>,
) -> Result<(), Failure> {
    let path = folder.labels();
    // What cannot be read is nothing to keep.
    let Ok(table) = store::read_labels(&path) else {
        return Ok(());
    };
    match irreplaceable(&table, folder, kept) {
        0 => Ok(()),
        lost => Err(Failure::refused(format_args!(
            "{}: the records of {lost} of its {} labels are not in {}, so that these labels would \
             be lost; bring the records back, use another folder, or remove the table first",
            path.display(),
            table.rows.len(),
            folder.records().display()
        ))),
    }
}

/// Writes labels.csv and points.csv of a folder and prints what they say.
fn write_tables(
    labelling: Labelling,
    folder: &Folder,
    console: &Console,
) -> Result<Labelled, Failure> {
    let before = read_labels_before(folder, console);
    let Labelling {
        table,
        problems,
        missing,
    } = labelling;
    name_first(&problems, |problem| {
        console.error(format_args!("no label: {problem}"))
    });
    store::write_labels(&table, &folder.labels()).map_err(Failure::failed)?;
    store::write_points(&table, &folder.points()).map_err(Failure::failed)?;
    let labels = counts(&table);
    console.result(describe_counts(&labels, table.rows.len()));
    let new = before.as_ref().map(|before| new_rows(before, &table));
    let changes = before.map(|before| changes_since(&before, &table));
    if let (Some(changes), Some(new)) = (&changes, new) {
        console.result(describe_changes(changes, table.rows.len() - new, new));
    }
    console.file(&folder.labels());
    console.file(&folder.points());
    let summary = Summary {
        folder: folder.root().to_owned(),
        labelled: table.rows.len(),
        labels: labels
            .into_iter()
            .map(|(label, runs)| (label.name(), runs))
            .collect(),
        not_run: missing,
        problems,
        changes,
        new,
    };
    Ok(Labelled { table, summary })
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
fn counts(table: &LabelTable) -> Vec<(Label, usize)> {
    let labels = table.rows.iter().map(|row| row.verdict.label);
    let count = |label| {
        (
            label,
            labels.clone().filter(|&other| other == label).count(),
        )
    };
    let family = table.family.labels().iter();
    family.copied().map(count).collect()
}

fn describe_counts(counts: &[(Label, usize)], runs: usize) -> String {
    let mut text = format!("{} labelled", format::count(runs, "run"));
    for (label, number) in counts.iter().filter(|(_, number)| *number > 0) {
        let share = format::percent(*number, runs);
        text += &format!("\n  {:<12} {number:>6} {share:>6}", label.name());
    }
    text
}

fn changes_since(before: &LabelTable, after: &LabelTable) -> Vec<Change> {
    let changes = changes(before, after).into_iter();
    changes
        .map(|((from, to), runs)| Change {
            from: from.name(),
            to: to.name(),
            runs,
        })
        .collect()
}

/// How many rows are of runs that had none before.
fn new_rows(before: &LabelTable, after: &LabelTable) -> usize {
    let known: HashSet<&str> = before.rows.iter().map(|row| row.id.as_str()).collect();
    let is_new = |row: &&LabelRow| !known.contains(row.id.as_str());
    after.rows.iter().filter(is_new).count()
}

/// How many labels of the runs that had one changed, and from what to what; and how many runs had
/// none.
fn describe_changes(changes: &[Change], runs: usize, new: usize) -> String {
    let changed: usize = changes.iter().map(|change| change.runs).sum();
    let mut text = format!("{changed} of {} changed", format::count(runs, "label"));
    if new > 0 {
        text += &format!(", {new} new");
    }
    for Change { from, to, runs } in changes {
        let arrow = format!("{from} -> {to}");
        text += &format!("\n  {arrow:<26} {runs:>6}");
    }
    text
}
