//! One run.

use crate::error::Failure;
use crate::record::Record;
use crate::text::Source;
use crate::watch::{Watch, threads_or_all, watched};
use phase::record::RunRecord;
use phase::resume::{Checkpoints, DEFAULT_INTERVAL, Ending};
use phase::run::{Progress, Run};
use phase::scene::Scene;
use phase::store::{self, Lease, StoreError};
use pyo3::prelude::*;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

/// Changes of a scene that every run may ask for.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Wishes {
    seed: Option<u64>,
    trajectory: bool,
    ledger: bool,
    snapshot_interval: Option<f64>,
}

/// How a run is made.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Manner {
    /// The record to write.
    out: Option<PathBuf>,
    /// Whether it goes on from the checkpoint beside the record.
    resume: bool,
    threads: usize,
}

/// Runs a scene to its end. With `out` the run leaves checkpoints beside the record.
#[pyfunction]
pub(crate) fn run(
    py: Python<'_>,
    scene: Source,
    wishes: Wishes,
    manner: Manner,
    progress: Option<Py<PyAny>>,
) -> PyResult<Option<Record>> {
    watched(py, progress.as_ref(), |watch| {
        let mut scene = scene.read(Scene::load, Scene::from_toml)?;
        refuse_program(&scene)?;
        wishes.put_into(&mut scene)?;
        let record = match &manner.out {
            Some(path) => run_into(&scene, path, &manner, watch)?,
            None => run_alone(&scene, &manner, watch)?,
        };
        Ok(record.map(|record| Record(Arc::new(record))))
    })
}

/// Refuses scenes that start programs: who may start them is asked on the command line.
pub(crate) fn refuse_program(scene: &Scene) -> Result<(), Failure> {
    match scene.is_external() {
        false => Ok(()),
        true => Err(Failure::refused("the scene starts a program").help(
            "run it with `phase sweep FILE --allow-program`, and open the results here; a function \
             of Python is refined by phase.refine",
        )),
    }
}

impl Wishes {
    fn put_into(&self, scene: &mut Scene) -> Result<(), Failure> {
        scene.seed = self.seed.unwrap_or(scene.seed);
        let output = &mut scene.output;
        output.trajectory |= self.trajectory;
        output.ledger |= self.ledger;
        output.snapshot_interval = self.snapshot_interval.unwrap_or(output.snapshot_interval);
        match scene.problems().into_iter().next() {
            None => Ok(()),
            Some(problem) => {
                let refused = Failure::refused(&problem.message);
                Err(match problem.help {
                    Some(help) => refused.help(help),
                    None => refused,
                })
            }
        }
    }
}

/// Runs without a file. None if it was stopped.
fn run_alone(scene: &Scene, manner: &Manner, watch: &Watch) -> Result<Option<RunRecord>, Failure> {
    let mut run = begin(scene, manner)?;
    while !run.ended() {
        run.advance_frame();
        if control(watch, run.progress()).is_break() {
            return Ok(None);
        }
    }
    Ok(Some(run.finish()))
}

/// Runs with checkpoints, and writes the record. None if it was stopped.
fn run_into(
    scene: &Scene,
    path: &Path,
    manner: &Manner,
    watch: &Watch,
) -> Result<Option<RunRecord>, Failure> {
    refuse_foreign(path)?;
    let _lease = lease_of(path)?;
    let checkpoints = Checkpoints::beside(path, DEFAULT_INTERVAL);
    let mut run = begin(scene, manner)?;
    if manner.resume {
        checkpoints.restore(&mut run).map_err(|error| {
            let refused = Failure::refused(error).of(checkpoints.path());
            refused.help("without `resume` the run starts from the beginning")
        })?;
    }
    // One that cannot be written is missed only by a run that is interrupted, which says so.
    let mut warn = |_| {};
    match checkpoints.run(run, &mut |progress| control(watch, progress), &mut warn) {
        Ending::Finished(record) => {
            store::write_record(&record, path)?;
            checkpoints.remove()?;
            Ok(Some(*record))
        }
        Ending::Failed(reason) => Err(Failure::failed(reason)),
        Ending::Lost(error) => Err(error.into()),
        Ending::Interrupted | Ending::EarlierKept => Ok(None),
    }
}

fn begin(scene: &Scene, manner: &Manner) -> Result<Run, Failure> {
    let mut run = Run::new(scene).map_err(Failure::failed)?;
    run.use_threads(threads_or_all(Some(manner.threads))?)?;
    Ok(run)
}

/// Tells how far a run is, and whether it goes on.
fn control(watch: &Watch, progress: Progress) -> ControlFlow<()> {
    let Progress { frame, frames, .. } = progress;
    watch.tell(progress.share(), format!("frame {frame} of {frames}"));
    match watch.is_stopped() {
        true => ControlFlow::Break(()),
        false => ControlFlow::Continue(()),
    }
}

/// Refuses to write where something else than a record is.
fn refuse_foreign(path: &Path) -> Result<(), Failure> {
    let is_other = matches!(
        store::read_record_header(path),
        Err(StoreError::NotARecord { .. })
    );
    match is_other || path.is_dir() {
        true => Err(Failure::refused(format_args!(
            "{}: this is no record, and would be overwritten",
            path.display()
        ))
        .help("choose another `out`")
        .of(path)),
        false => Ok(()),
    }
}

/// Takes the right to write a record and what goes beside it, in a folder that is made if needed.
fn lease_of(path: &Path) -> Result<Lease, Failure> {
    let refuse = |error: std::io::Error| {
        let text = format!("{}: {error}{}", path.display(), store::advice(&error));
        Failure::failed(text).of(path)
    };
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(refuse)?;
    }
    let lease = Lease::take_beside(path, Duration::ZERO).map_err(refuse)?;
    lease.ok_or_else(|| {
        let file = path.display();
        Failure::refused(format_args!("{file}: another run is writing this record"))
            .help("wait until it ends, or choose another `out`")
            .of(path)
    })
}
