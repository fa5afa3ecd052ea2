//! Sweeps into a results folder.

use crate::error::Failure;
use crate::run::refuse_program;
use crate::text::Source;
use crate::watch::{Watch, threads_or_all, watched};
use phase::store;
use phase::sweep::{
    Event, Folder, Job, Labelling, Learnt, LocalThreads, Plan, Pool, Report, Sweep, WatchRounds,
    Wishes, refuse_to_lose_labels,
};
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

/// The files of a results folder that a sweep replaces.
const FILES: [&str; 6] = [
    "sweep.json",
    "labels.csv",
    "points.csv",
    "failed.csv",
    "refined.csv",
    "borders.csv",
];

/// Runs what is missing of a sweep in a results folder, and labels it. Returns what went wrong with
/// jobs that failed.
#[pyfunction]
pub(crate) fn sweep(
    py: Python<'_>,
    sweep: Source,
    out: PathBuf,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Vec<String>> {
    watched(py, progress.as_ref(), |watch| {
        let sweep = sweep.read(phase::sweep::load, phase::sweep::from_str)?;
        sweep.scenes().into_iter().try_for_each(refuse_program)?;
        make(&sweep, &Folder::new(out), threads_or_all(threads)?, watch)
    })
}

fn make(
    sweep: &Sweep,
    folder: &Folder,
    threads: usize,
    watch: &Watch,
) -> Result<Vec<String>, Failure> {
    let jobs = sweep.jobs()?;
    sweep.check_sieves(&jobs)?;
    refuse_foreign(folder)?;
    folder.create()?;
    let access = folder.enter(sweep, &|_| {})?;
    let given = sweep.jobs_given_by(folder)?;
    let kept = jobs.iter().chain(&given).map(|job| job.id.as_str());
    refuse_to_lose_labels(folder, kept)?;
    let _access = folder.open(access, sweep)?;
    let threads_of_runs = LocalThreads::new(threads);
    let pool = Pool {
        workers: threads,
        wishes: Wishes {
            stop: watch.stop(),
            ..Wishes::default()
        },
        ..Pool::new(folder, sweep, &threads_of_runs)
    };
    let report = match &sweep.refine {
        None => {
            let plan = pool.plan(jobs)?;
            Progress::of(&plan, plan.jobs.len(), watch).run(&pool, &plan)?
        }
        Some(_) => pool.refine(&mut Rounds(watch))?.report,
    };
    if let Some(halt) = report.halted {
        return Err(Failure::failed(halt).of(folder.root()));
    }
    if !watch.is_stopped() {
        label(sweep, folder, threads)?;
    }
    let failures = report.failures.iter();
    Ok(failures
        .map(|it| format!("job {}: {}", it.id, it.reason))
        .collect())
}

/// Labels the runs and writes the tables of the folder.
fn label(sweep: &Sweep, folder: &Folder, threads: usize) -> Result<(), Failure> {
    let Some(_lease) = folder.lease_of_labels(&|_| {})? else {
        return Ok(());
    };
    let refining = folder.read_refining(sweep)?;
    let jobs = sweep.jobs_so_far(refining.as_ref())?;
    let labelled = Labelling::new(folder, sweep, &jobs, threads)?.write(folder)?;
    if let Some(problem) = labelled.problems.first() {
        return Err(Failure::failed(problem).of(folder.root()));
    }
    if labelled.table.rows.is_empty() {
        return Ok(());
    }
    let learnt = Learnt::of(sweep, refining.as_ref(), &labelled.table);
    if let Some(learnt) = learnt.map_err(Failure::failed)? {
        learnt.write(folder, sweep, labelled.table.family)?;
    }
    Ok(())
}

/// Refuses a folder of a study, and one in which files of another program are in the way.
fn refuse_foreign(folder: &Folder) -> Result<(), Failure> {
    if folder.read_sweep().is_ok_and(|it| it.study.is_some()) {
        let root = folder.root();
        let refused = format!(
            "{}: this folder holds the results of a study",
            root.display()
        );
        return Err(Failure::refused(refused)
            .help("choose another `out`")
            .of(root));
    }
    let paths = FILES.map(|name| folder.root().join(name));
    match paths.iter().find(|path| !store::is_own_file(path)) {
        None => Ok(()),
        Some(path) => Err(Failure::refused(format_args!(
            "{}: phase did not write this file and would overwrite it",
            path.display()
        ))
        .help("choose another `out`, or move it away")
        .of(path)),
    }
}

/// The rounds of a refined sweep, watched.
struct Rounds<'a>(&'a Watch);

impl WatchRounds for Rounds<'_> {
    type Error = Failure;

    fn run(
        &mut self,
        pool: &Pool<'_>,
        plan: &Plan,
        _: &phase::sweep::Refinement,
    ) -> Result<Report, Failure> {
        let budget = pool.sweep.refine.as_ref().map_or(0, |it| it.budget);
        Progress::of(plan, budget.max(plan.jobs.len()), self.0).run(pool, plan)
    }
}

/// How far the jobs of a plan are.
struct Progress<'a> {
    watch: &'a Watch,
    /// Number of all jobs.
    jobs: usize,
    jobs_done: AtomicUsize,
    /// Work of all jobs.
    work: f64,
    work_done: AtomicU64,
}

impl<'a> Progress<'a> {
    /// The progress of a plan that is part of so many jobs in total.
    fn of(plan: &Plan, jobs: usize, watch: &'a Watch) -> Self {
        let done: Vec<&Job> = plan.labelled().collect();
        let planned = plan.jobs.iter().map(|(job, _)| job.work()).sum::<u64>();
        // Jobs that are not planned yet take as much work as the others do on average.
        let scale = jobs as f64 / plan.jobs.len().max(1) as f64;
        Self {
            watch,
            jobs,
            jobs_done: AtomicUsize::new(done.len()),
            work: (planned as f64 * scale).max(1.0),
            work_done: AtomicU64::new(done.iter().map(|job| job.work()).sum()),
        }
    }

    /// Runs the plan in a pool, and tells what happens.
    fn run(&self, pool: &Pool<'_>, plan: &Plan) -> Result<Report, Failure> {
        let watch = |event: Event<'_>| self.note(event);
        let pool = Pool {
            wishes: Wishes {
                watch: &watch,
                ..pool.wishes
            },
            ..*pool
        };
        Ok(pool.run(plan)?)
    }

    fn note(&self, event: Event<'_>) {
        let (work, jobs) = match event {
            Event::Resumed(_, work) | Event::Advanced(_, work) => (work, 0),
            Event::Finished(_, _, work) => (work, 1),
            Event::Failed(..) | Event::Made(_) => (0, 1),
            _ => return,
        };
        let work = self.work_done.fetch_add(work, Ordering::Relaxed) + work;
        let jobs = self.jobs_done.fetch_add(jobs, Ordering::Relaxed) + jobs;
        let share = (work as f64 / self.work).min(1.0);
        self.watch
            .tell(share, format!("{jobs} of {} jobs", self.jobs));
    }
}
