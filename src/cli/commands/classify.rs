//! `phase classify`: labels the runs of a results folder again, from their records, or those of a
//! folder of dumps.

mod dumps;
mod edited;

use crate::cli::console::{Console, name_first};
use crate::cli::exit::{Exit, Failure};
use crate::cli::folders::{self, Entry, Undone};
use crate::cli::format;
use crate::cli::values;
use phase::classify::{ClassifyError, Label, LabelTable};
use phase::sweep::{
    Folder, Job, Labelled, Labelling, LabellingError, Learnt, Since, Sweep, refuse_to_lose_labels,
    work,
};
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Label the runs of a results folder from their records, without any new simulation.
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
A dump has no velocities, spins or contact energies: the sieves get along without them, but the
order parameters rotation and mobility are then those of displacements from frame to frame.")]
pub(crate) struct Arguments {
    /// A results folder of `phase sweep`, or a folder that holds several; or, with --scene, a
    /// folder of dumps.
    dir: PathBuf,
    /// The folder holds dumps (.npy) of runs of this scene.
    #[arg(long, value_name = "FILE")]
    scene: Option<PathBuf>,
    /// Take the thresholds, the title and the plot settings from this sweep file from now on. The
    /// scene, the axes and the seeds must be those that were run. With --scene, the thresholds
    /// only.
    #[arg(long, value_name = "FILE")]
    sweep: Option<PathBuf>,
    /// Records to read at the same time [default: all cores].
    #[arg(short, long, value_name = "N", value_parser = values::at_least_one)]
    jobs: Option<usize>,
    /// Print the result as one JSON object (docs/json.md) instead of text.
    #[arg(long)]
    pub(super) json: bool,
}

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    let workers = arguments.jobs.unwrap_or_else(work::default_workers);
    let edited = match &arguments.sweep {
        Some(file) => Some(phase::sweep::load(file).map_err(Failure::refused)?),
        None => None,
    };
    let folders = match &arguments.scene {
        Some(scene) => {
            let sieves = edited.map(|sweep| sweep.sieves).unwrap_or_default();
            let labelled = dumps::label(&arguments.dir, scene, &sieves, workers, console)?;
            let summary = Summary::new(&Folder::new(&arguments.dir), &labelled);
            vec![Entry::Done(summary)]
        }
        None => label_folders(&arguments.dir, edited.as_ref(), workers, console)?,
    };
    let exit = Entry::exit(&folders, |summary| summary.problems.is_empty());
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
) -> Result<Vec<Entry<Summary>>, Failure> {
    let found = Folder::find(dir).map_err(|error| dumps::hint(dir, &error))?;
    if let Some(edited) = edited {
        return edited::label(dir, found, edited, workers, console);
    }
    folders::go_through(dir, found, console, |folder| {
        let sweep = sweep_with_records(folder)?;
        let jobs = jobs_to_label(folder, &sweep)?;
        let labelled = label_folder(folder, &sweep, &jobs, workers, console)?;
        Ok(Summary::new(folder, &labelled))
    })
}

/// The jobs of the sweep of a folder so far, which its sieves can judge.
fn jobs_to_label(folder: &Folder, sweep: &Sweep) -> Result<Vec<Job>, Failure> {
    let refining = folder.read_refining(sweep).map_err(Failure::failed)?;
    let jobs = sweep
        .jobs_so_far(refining.as_ref())
        .map_err(Failure::refused)?;
    sweep.check_sieves(&jobs).map_err(cannot_label)?;
    Ok(jobs)
}

/// The sweep of a folder. Refuses to label runs whose records are not there: where none of them is,
/// as in results that were published, the labels are kept.
fn sweep_with_records(folder: &Folder) -> Result<Sweep, Undone> {
    let sweep = folder.read_sweep().map_err(Failure::failed)?;
    match refuse_to_lose_labels(folder, []) {
        Ok(()) => Ok(sweep),
        Err(error @ LabellingError::Lost { rows, lost, .. }) if rows == lost => {
            Err(Undone::Kept(cannot_write(error)))
        }
        Err(error) => Err(Undone::Failed(cannot_write(error))),
    }
}

/// The failure of sieves that cannot judge the runs.
pub(super) fn cannot_label(error: ClassifyError) -> Failure {
    Failure::refused(format_args!(
        "the sieves cannot label these runs: {error} (`phase sweep --no-classify` only runs them)"
    ))
}

/// The failure of labels that cannot be written.
pub(super) fn cannot_write(error: LabellingError) -> Failure {
    match error {
        LabellingError::Lost { .. } => Failure::refused(error),
        _ => Failure::failed(error),
    }
}

/// What `--json` prints.
#[derive(Serialize)]
struct Answer {
    folders: Vec<Entry<Summary>>,
    /// The files written.
    files: Vec<String>,
}

/// The labels of a folder in numbers.
#[derive(Serialize)]
pub(super) struct Summary {
    folder: String,
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
    /// Runs that had a label before and have none now; none if there were no labels before.
    lost: Option<usize>,
    /// Runs that had a label before and are not of the sweep now; none if there were no labels
    /// before.
    unused: Option<usize>,
    /// Runs that were not steady when their time was up.
    not_steady: usize,
}

/// Labels that changed.
#[derive(Serialize)]
struct Change {
    from: &'static str,
    to: &'static str,
    runs: usize,
}

impl Summary {
    pub(super) fn new(folder: &Folder, labelled: &Labelled) -> Self {
        let labels = counts(&labelled.table).into_iter();
        let mut summary = Self {
            folder: folder.root().display().to_string(),
            labelled: labelled.table.rows.len(),
            labels: labels.map(|(label, runs)| (label.name, runs)).collect(),
            not_run: labelled.missing,
            problems: labelled.problems.clone(),
            changes: None,
            new: None,
            lost: None,
            unused: None,
            not_steady: labelled.table.unsteady(),
        };
        if let Since::Labels {
            changes,
            new,
            lost,
            unused,
        } = &labelled.since
        {
            summary.changes = Some(list(changes));
            summary.new = Some(*new);
            summary.lost = Some(*lost);
            summary.unused = Some(*unused);
        }
        summary
    }
}

/// Labels the runs of a folder, writes the tables and prints what they say.
pub(super) fn label_folder(
    folder: &Folder,
    sweep: &Sweep,
    jobs: &[Job],
    workers: usize,
    console: &Console,
) -> Result<Labelled, Failure> {
    let labelling = labelling_of(folder, sweep, jobs, workers, console)?;
    write(folder, sweep, labelling, console)
}

/// The labels of the runs of a folder; says which runs have none.
fn labelling_of(
    folder: &Folder,
    sweep: &Sweep,
    jobs: &[Job],
    workers: usize,
    console: &Console,
) -> Result<Labelling, Failure> {
    let labelling = Labelling::new(folder, sweep, jobs, workers).map_err(Failure::failed)?;
    if labelling.missing > 0 {
        console.note(format_args!(
            "{}: {} of {} not yet run, and without a label",
            folder.root().display(),
            labelling.missing,
            format::count(jobs.len(), "job")
        ));
    }
    tell_of_problems(&labelling, console);
    Ok(labelling)
}

/// Writes the tables of a folder and prints what they say.
fn write(
    folder: &Folder,
    sweep: &Sweep,
    labelling: Labelling,
    console: &Console,
) -> Result<Labelled, Failure> {
    let labelled = labelling.write(folder).map_err(cannot_write)?;
    tell_of_labels(&labelled, folder, console);
    write_refined(folder, sweep, &labelled.table, console)?;
    Ok(labelled)
}

/// Writes the tables of a refined sweep.
fn write_refined(
    folder: &Folder,
    sweep: &Sweep,
    table: &LabelTable,
    console: &Console,
) -> Result<(), Failure> {
    if table.rows.is_empty() {
        return Ok(());
    }
    let refining = folder.read_refining(sweep).map_err(Failure::failed)?;
    let learnt = Learnt::of(sweep, refining.as_ref(), table).map_err(Failure::failed)?;
    if let Some(learnt) = learnt {
        let written = learnt.write(folder, sweep, table.family);
        written.map_err(Failure::failed)?;
        console.file(&folder.refined());
        console.file(&folder.borders());
    }
    Ok(())
}

/// Says which records have no label, and why.
fn tell_of_problems(labelling: &Labelling, console: &Console) {
    name_first(&labelling.problems, |problem| {
        console.error(format_args!("no label: {problem}"));
    });
}

/// Prints what the tables of a folder say.
fn tell_of_labels(labelled: &Labelled, folder: &Folder, console: &Console) {
    let runs = labelled.table.rows.len();
    console.result(describe_counts(&counts(&labelled.table), runs));
    let unsteady = labelled.table.unsteady();
    if unsteady > 0 {
        let runs = format::count(unsteady, "run");
        console.result(format_args!("{runs} NOT STEADY when its time was up"));
    }
    match &labelled.since {
        Since::Nothing => {}
        Since::Unreadable(error) => console.note(format_args!(
            "cannot compare with the labels before: {error}"
        )),
        Since::Labels {
            changes,
            new,
            lost,
            unused,
        } => {
            let others = [*new, *lost, *unused];
            console.result(describe_changes(&list(changes), runs - new, others));
        }
    }
    console.file(&folder.labels());
    console.file(&folder.points());
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
    let family = table.family.labels.iter();
    family.copied().map(count).collect()
}

fn describe_counts(counts: &[(Label, usize)], runs: usize) -> String {
    let mut text = format!("{} labelled", format::count(runs, "run"));
    let counts = counts.iter().filter(|(_, number)| *number > 0);
    let widths = counts.clone().map(|(label, _)| label.name.len());
    let width = widths.max().unwrap_or(0).max(12);
    for (label, number) in counts {
        let share = format::percent(*number, runs);
        text += &format!("\n  {:<width$} {number:>6} {share:>6}", label.name);
    }
    text
}

fn list(changes: &BTreeMap<(Label, Label), usize>) -> Vec<Change> {
    let change = |(&(from, to), &runs): (&(Label, Label), &usize)| Change {
        from: from.name,
        to: to.name,
        runs,
    };
    changes.iter().map(change).collect()
}

/// How many labels of the runs that had one changed, and from what to what; and how many runs had
/// none, have none, and are not of the sweep any more.
fn describe_changes(changes: &[Change], runs: usize, [new, lost, unused]: [usize; 3]) -> String {
    let changed: usize = changes.iter().map(|change| change.runs).sum();
    let mut text = format!("{changed} of {} changed", format::count(runs, "label"));
    if new > 0 {
        text += &format!(", {new} new");
    }
    if lost > 0 {
        text += &format!(", {lost} lost, as their records cannot be labelled");
    }
    if unused > 0 {
        text += &format!(", {unused} left out, as they are not among these runs");
    }
    for Change { from, to, runs } in changes {
        let arrow = format!("{from} -> {to}");
        text += &format!("\n  {arrow:<26} {runs:>6}");
    }
    text
}
