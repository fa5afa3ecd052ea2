//! Labels of other thresholds, which the folder keeps.

use super::{jobs_to_label, sweep_with_records};
use crate::cli::console::Console;
use crate::cli::exit::Failure;
use crate::cli::folders::{self, Entry, Undone};
use crate::cli::format;
use crate::cli::labels::{Summary, labelling_of, write};
use crate::cli::programs;
use phase::store;
use phase::sweep::{Access, Folder, Job, Labelling, Learnt, Sweep};
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
            Ok(sweep) => Ok(edit(folder, sweep, edited, console)?),
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
        folder.write_sweep(&edit.sweep)?;
        let refining = folder.read_refining(&edit.sweep)?;
        if let Ok(Some(learnt)) = Learnt::of(&edit.sweep, refining.as_ref(), &labelled.table)
            && let Some(mut refining) = refining
        {
            refining.widths = phase::refine::widths(&learnt.lattice, &learnt.map);
            folder.write_refining(&refining)?;
        }
        Ok(Summary::new(folder, &labelled))
    })
}

/// A folder whose runs are to be labelled again, and the right to change it.
struct ToLabel {
    sweep: Sweep,
    jobs: Vec<Job>,
    _access: Access,
}

/// The sweep of a folder with the thresholds of an edited sweep. The folder keeps it, so that
/// labels and thresholds always agree. Refuses an edited sweep with other runs.
fn edit(
    folder: &Folder,
    sweep: Sweep,
    edited: &Sweep,
    console: &Console,
) -> Result<ToLabel, Failure> {
    let mut edited = refined_alike(edited, &sweep);
    programs::take_versions(&mut edited, folder);
    let keys = sweep.keys_of_other_runs(&edited);
    if !keys.is_empty() {
        return Err(Failure::refused(format_args!(
            "the edited sweep describes other runs than this folder holds; they differ in {}. Only \
             thresholds may change: `phase sweep` makes new runs",
            keys.join(", ")
        ))
        .at(folder.root()));
    }
    let wait = |holder: &_| folders::tell_of_waiting(folder, holder, console);
    let access = folder.lock(&wait)?;
    check_files(folder, &sweep)?;
    Ok(ToLabel {
        jobs: jobs_to_label(folder, &edited)?,
        sweep: edited,
        _access: access,
    })
}

/// Checks that the files of a folder that are to change can be written.
fn check_files(folder: &Folder, sweep: &Sweep) -> Result<(), Failure> {
    let mut files = vec![folder.labels(), folder.points(), folder.sweep()];
    if sweep.refine.is_some() {
        files.extend([folder.progress(), folder.refined(), folder.borders()]);
    }
    let mut files = files.iter();
    Ok(files.try_for_each(|file| store::check_writable(file))?)
}

/// The edited sweep, with the [refine] of the folder's sweep if it has none itself.
fn refined_alike(edited: &Sweep, sweep: &Sweep) -> Sweep {
    let mut edited = edited.clone();
    if sweep.refine.is_some() && edited.refine.is_none() && edited.refine_by_default().is_ok() {
        edited.refine.clone_from(&sweep.refine);
        edited.seeds.clone_from(&sweep.seeds);
    }
    edited
}

/// Refuses to change a folder with records that cannot be labelled: their labels would be lost, or
/// not follow from the sweep's thresholds.
fn refuse_problems(folder: &Folder, labelling: &Labelling) -> Result<(), Failure> {
    let Some(first) = labelling.problems.first() else {
        return Ok(());
    };
    Err(Failure::failed(format_args!(
        "{} cannot be labelled, so this folder was left unchanged ({first}); `phase sweep` \
         replaces damaged records",
        format::count(labelling.problems.len(), "record")
    ))
    .at(folder.root()))
}
