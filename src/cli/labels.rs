//! Labels of runs: writes their tables, and says what they hold.

use super::console::{Console, name_first};
use super::exit::Failure;
use super::format;
use phase::classify::{ClassifyError, Label, LabelTable};
use phase::sweep::{Folder, Job, Labelled, Labelling, LabellingError, Learnt, Since, Sweep};
use serde::Serialize;
use std::collections::BTreeMap;

/// The failure of sieves that cannot judge the runs.
pub(super) fn cannot_label(error: ClassifyError) -> Failure {
    Failure::refused(format_args!(
        "the sieves cannot label these runs: {error} (`phase sweep --no-classify` runs them \
         without labels)"
    ))
}

/// The failure of labels that cannot be written.
pub(super) fn cannot_write(error: LabellingError) -> Failure {
    match error {
        LabellingError::Lost { .. } => Failure::refused(error),
        _ => Failure::failed(error),
    }
}

/// The labels of a folder of a sweep.
pub(super) fn read(folder: &Folder) -> Result<LabelTable, Failure> {
    let (root, path) = (folder.root(), folder.labels());
    if folder.read_sweep().is_ok_and(|it| it.study.is_some()) {
        return Err(Failure::refused(OF_STUDY).at(root));
    }
    if !path.exists() {
        return Err(Failure::refused(format_args!(
            "no labels yet; run `phase classify {}` first",
            root.display()
        ))
        .at(path));
    }
    folder.read_labels().map_err(|error| {
        Failure::failed(format_args!(
            "{error}; `phase classify {}` rewrites it",
            root.display()
        ))
    })
}

/// Why the labels of a folder are not made or looked at.
pub(super) const OF_STUDY: &str = "this folder holds the results of a study, which has its labels \
                                   in runs.csv and its own figures";

/// The labels of a folder in numbers.
#[derive(Serialize)]
pub(super) struct Summary {
    folder: String,
    /// Runs that have a label.
    labelled: usize,
    /// Number of runs by label, for all labels of the family.
    labels: BTreeMap<&'static str, usize>,
    /// Jobs without a record.
    not_run: usize,
    /// Records that could not be labelled, and why.
    pub(super) problems: Vec<String>,
    /// Changed labels; `None` if there were no labels before.
    changes: Option<Vec<Change>>,
    /// Number of newly labelled runs; `None` if there were no labels before.
    new: Option<usize>,
    /// Number of runs that lost their label; `None` if there were no labels before.
    lost: Option<usize>,
    /// Number of labelled runs that are no longer part of the sweep; `None` if there were no labels
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
pub(super) fn labelling_of(
    folder: &Folder,
    sweep: &Sweep,
    jobs: &[Job],
    workers: usize,
    console: &Console,
) -> Result<Labelling, Failure> {
    let labelling = Labelling::new(folder, sweep, jobs, workers)?;
    if labelling.missing > 0 {
        console.note(format_args!(
            "{}: {} of {} not run yet, and not labelled",
            folder.root().display(),
            labelling.missing,
            format::count(jobs.len(), "job")
        ));
    }
    tell_of_problems(&labelling, console);
    Ok(labelling)
}

/// Writes the tables of a folder and prints what they say.
pub(super) fn write(
    folder: &Folder,
    sweep: &Sweep,
    labelling: Labelling,
    console: &Console,
) -> Result<Labelled, Failure> {
    let labelled = labelling.write(folder)?;
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
    let refining = folder.read_refining(sweep)?;
    let learnt = Learnt::of(sweep, refining.as_ref(), table).map_err(Failure::failed)?;
    if let Some(learnt) = learnt {
        let written = learnt.write(folder, sweep, table.family);
        written?;
        console.file(&folder.refined());
        console.file(&folder.borders());
    }
    Ok(())
}

/// Says which records have no label, and why.
pub(super) fn tell_of_problems(labelling: &Labelling, console: &Console) {
    name_first(&labelling.problems, |problem| {
        console.error(format_args!("no label: {problem}"));
    });
}

/// Prints what the tables of a folder say.
pub(super) fn tell_of_labels(labelled: &Labelled, folder: &Folder, console: &Console) {
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
            "it is not counted which labels changed: {error}"
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
    let family = table.family.labels().into_iter();
    family.map(count).collect()
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

/// How many labels changed, and from what to what; and how many runs had no label, have none now,
/// or no longer belong to the sweep.
fn describe_changes(changes: &[Change], runs: usize, [new, lost, unused]: [usize; 3]) -> String {
    let changed: usize = changes.iter().map(|change| change.runs).sum();
    let mut text = format!("{changed} of {} changed", format::count(runs, "label"));
    if new > 0 {
        text += &format!(", {new} new");
    }
    if lost > 0 {
        text += &format!(", {lost} lost (their records cannot be labelled)");
    }
    if unused > 0 {
        text += &format!(", {unused} left out (not among these runs)");
    }
    for Change { from, to, runs } in changes {
        let arrow = format!("{from} -> {to}");
        text += &format!("\n  {arrow:<26} {runs:>6}");
    }
    text
}

/// Warns of sieves that find nothing in some runs, or in all, as these are too short.
pub(super) fn warn_of_windows(sweep: &Sweep, jobs: &[Job], console: &Console) {
    for sieve in sweep.sieves_without_room(jobs) {
        let (name, window, longest) = (sieve.sieve, sieve.window, sieve.longest);
        let which = match sieve.runs == jobs.len() {
            true => format!("the runs, {longest} s: it finds nothing in any of them"),
            false => format!(
                "{} of {}, which last at most {longest} s: it finds nothing in them",
                sieve.runs,
                format::count(jobs.len(), "run")
            ),
        };
        console.warning(format_args!(
            "the window of the sieve {name}, {window} s, is longer than {which}; increase \
             time.duration, or decrease `window` in [sieves.{name}]"
        ));
    }
}
