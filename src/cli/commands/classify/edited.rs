//! Labels of other thresholds, which the folder keeps.

use super::{Summary, jobs_to_label, labelling_of, sweep_with_records, write};
use crate::cli::console::Console;
use crate::cli::exit::Failure;
use crate::cli::folders::{self, Entry, Undone};
use crate::cli::format;
use phase::store::{self, Lock};
use phase::sweep::{Folder, Job, Labelling, Learnt, Sweep};
use std::path::Path;

/// Labels the runs of the results folders found at `dir` with the thresholds of an edited sweep.
pub(super) fn label(
    dir: &Path,
    found: Vec<Folder>,
    edited: &Sweep,
    workers: usize,
    console: &Console,
) -> Result<Vec<Entry<Summary>>, Failure> {
    // All are locked, and their files checked, before the first is changed.
    let mut edits = Vec::new();
    for folder in &found {
        edits.push(match sweep_with_records(folder) {
            Ok(sweep) => Ok(edit(folder, sweep, edited)?),
            Err(Undone::Failed(failure)) => return Err(failure),
            Err(kept) => Err(kept),
        });
    }
    let mut edits = edits.into_iter();
    folders::go_through(dir, found, console, |folder| {
        let edit = edits.next().expect("one for each folder")?;
        let labelling = labelling_of(folder, &edit.sweep, &edit.jobs, workers, console)?;
        refuse_problems(folder, &labelling)?;
        let labelled = write(folder, &edit.sweep, labelling, console)?;
        folder.write_sweep(&edit.sweep).map_err(Failure::failed)?;
        let refining = folder.read_refining(&edit.sweep).map_err(Failure::failed)?;
        if let Ok(Some(learnt)) = Learnt::of(&edit.sweep, refining.as_ref(), &labelled.table)
            && let Some(mut refining) = refining
        {
            refining.widths = phase::refine::widths(&learnt.lattice, &learnt.map);
            folder.write_refining(&refining).map_err(Failure::failed)?;
        }
        Ok(Summary::new(folder, &labelled))
    })
}

/// A folder whose runs are to be labelled anew, and the right to change it.
struct ToLabel {
    sweep: Sweep,
    jobs: Vec<Job>,
    _lock: Lock,
}

/// The sweep of a folder with the thresholds of an edited one, which it keeps, so that the labels
/// are always those that it says. Refuses one that has other runs.
fn edit(folder: &Folder, sweep: Sweep, edited: &Sweep) -> Result<ToLabel, Failure> {
    let edited = refined_alike(edited, &sweep);
    let keys = sweep.keys_of_other_runs(&edited);
    if !keys.is_empty() {
        return Err(Failure::refused(format_args!(
            "{}: the runs in this folder are not those of the edited sweep; they differ in {}. \
             Thresholds may change, runs may not: `phase sweep` makes new ones",
            folder.root().display(),
            keys.join(", ")
        )));
    }
    let lock = folder.lock().map_err(Failure::refused)?;
    check_files(folder, &sweep)?;
    Ok(ToLabel {
        jobs: jobs_to_label(folder, &edited)?,
        sweep: edited,
        _lock: lock,
    })
}

/// Checks that the files of a folder that are to change can be written.
fn check_files(folder: &Folder, sweep: &Sweep) -> Result<(), Failure> {
    let mut files = vec![folder.labels(), folder.points(), folder.sweep()];
    if sweep.refine.is_some() {
        files.extend([folder.progress(), folder.refined(), folder.borders()]);
    }
    let mut files = files.iter();
    files.try_for_each(|file| store::check_writable(file).map_err(Failure::failed))
}

/// An edited sweep, refined if that of the folder was and the edited one does not say so.
fn refined_alike(edited: &Sweep, sweep: &Sweep) -> Sweep {
    let mut edited = edited.clone();
    if sweep.refine.is_some() && edited.refine.is_none() && edited.refine_by_default().is_ok() {
        edited.refine.clone_from(&sweep.refine);
        edited.seeds.clone_from(&sweep.seeds);
    }
    edited
}

/// Refuses to change a folder with records that cannot be labelled: their labels would be lost, or
/// of other thresholds than the sweep says.
fn refuse_problems(folder: &Folder, labelling: &Labelling) -> Result<(), Failure> {
    let Some(first) = labelling.problems.first() else {
        return Ok(());
    };
    Err(Failure::failed(format_args!(
        "{}: {} cannot be labelled, so that this folder stays as it was ({first}); `phase sweep` \
         makes damaged records again",
        folder.root().display(),
        format::count(labelling.problems.len(), "record"),
    )))
}
