//! `phase merge`: joins results folders of one sweep that were made apart.

use crate::cli::console::{Console, name_first};
use crate::cli::exit::{Exit, Failure};
use crate::cli::options::Workers;
use crate::cli::{figures, folders, format, labels};
use phase::sweep::{Folder, Job, Plan, Sweep, differing_keys};
use serde::Serialize;
use std::path::PathBuf;

/// Join results folders of one sweep that were made apart, such as shards on machines without a
/// common disk.
///
/// The first folder takes the records of the others, which stay as they are; then its runs are
/// labelled and its figures drawn.
#[derive(clap::Args)]
#[command(after_help = "\
Example: shards from two machines
  phase merge results/steel from-other-machine/steel")]
pub(crate) struct Arguments {
    /// The results folder that takes the records.
    into: PathBuf,
    /// Results folders of the same sweep.
    #[arg(required = true)]
    from: Vec<PathBuf>,
    #[command(flatten)]
    workers: Workers,
    /// Draw no figures.
    #[arg(long)]
    no_plot: bool,
}

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    let workers = arguments.workers.count();
    let into = Folder::new(&arguments.into);
    if !into.sweep().exists() {
        let message = "this is no results folder; give one of those that are to be joined first";
        return Err(Failure::refused(message).at(into.root()));
    }
    let sweep = into.read_sweep()?;
    let from: Vec<Folder> = arguments.from.iter().map(Folder::new).collect();
    // All are checked before the first record is taken.
    for folder in &from {
        refuse_other_sweep(&sweep, &into, folder)?;
    }
    let wait = |holder: &_| folders::tell_of_waiting(&into, holder, console);
    let _access = into.lock(&wait)?;
    into.create()?;
    let jobs = jobs_of(&sweep, &into, &from)?;
    let mut answer = Answer::default();
    for folder in &from {
        let taken = into.take_from(folder, &jobs, &sweep.axes)?;
        console.result(format_args!(
            "{}: {} taken, {} in both",
            folder.root().display(),
            format::count(taken.new, "record"),
            taken.both
        ));
        name_first(&taken.left, |problem| console.error(problem));
        answer.taken += taken.new;
        answer.problems.extend(taken.left);
    }
    // Which jobs a refined sweep has, it chooses itself when it is run again.
    let jobs = sweep.jobs_so_far(into.read_refining(&sweep)?.as_ref())?;
    let plan = Plan::new(&into, jobs, workers)?;
    answer.left = plan.pending().count();
    if sweep.study.is_some() {
        console.result("`phase study` with the same file writes tables and figures");
        return Ok(answer.end(console));
    }
    let jobs: Vec<Job> = plan.jobs.into_iter().map(|(job, _)| job).collect();
    let labelled = labels::label_folder(&into, &sweep, &jobs, workers, console)?;
    answer.problems.extend(labelled.problems.iter().cloned());
    if !arguments.no_plot {
        let problems = figures::draw_default_figures(&into, &sweep, &labelled.table, console);
        answer.problems.extend(problems);
    }
    answer.labels = Some(labels::Summary::new(&into, &labelled));
    if sweep.refine.is_some() {
        console.note("`phase sweep` with the same file continues with these runs");
    }
    Ok(answer.end(console))
}

impl Answer {
    /// Prints the answer, and says how the command ends.
    fn end(&self, console: &Console) -> Exit {
        console.answer_with_files(self);
        match self.problems.is_empty() {
            true => Exit::Done,
            false => Exit::Failed,
        }
    }
}

/// What `--json` prints.
#[derive(Default, Serialize)]
struct Answer {
    /// Number of records that were taken.
    taken: usize,
    /// Jobs without a record.
    left: usize,
    /// Records and figures that could not be used, and why.
    problems: Vec<String>,
    labels: Option<labels::Summary>,
}

/// The jobs of the sweep: of a refined one those that any of the folders has chosen.
fn jobs_of(sweep: &Sweep, into: &Folder, from: &[Folder]) -> Result<Vec<Job>, Failure> {
    let mut jobs = Vec::new();
    for folder in std::iter::once(into).chain(from) {
        let refining = folder.read_refining(sweep)?;
        jobs.extend(sweep.jobs_so_far(refining.as_ref())?);
    }
    let mut seen = std::collections::HashSet::new();
    jobs.retain(|job| seen.insert(job.id.clone()));
    Ok(jobs)
}

/// Refuses a folder of another sweep, by the keys that differ.
fn refuse_other_sweep(sweep: &Sweep, into: &Folder, folder: &Folder) -> Result<(), Failure> {
    let keys = differing_keys(sweep, &folder.read_sweep()?);
    if keys.is_empty() {
        return Ok(());
    }
    Err(Failure::refused(format_args!(
        "this folder holds another sweep than {}; they differ in {}",
        into.root().display(),
        keys.join(", ")
    ))
    .at(folder.root()))
}
