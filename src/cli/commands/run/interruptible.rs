//! A run that can be interrupted and continued from its checkpoint.

use crate::cli::console::Console;
use crate::cli::exit::Failure;
use crate::cli::format;
use crate::cli::interrupt;
use crate::cli::progress::{Progress, Work};
use phase::external::{self, RunFolder};
use phase::record::RunRecord;
use phase::resume::{Checkpoints, Ending};
use phase::run::{self, Run};
use phase::scene::Scene;
use phase::simulation::Counts;
use std::ops::ControlFlow;
use std::sync::atomic::Ordering;

/// A run that ended.
pub(super) struct Ran {
    pub(super) record: RunRecord,
    /// How long it took now (s).
    pub(super) seconds: f64,
    /// Time (s) of the checkpoint from which it continued.
    pub(super) resumed_from: Option<f64>,
}

/// Runs a scene on this number of threads, with a progress bar and checkpoints. If it is
/// interrupted, says how to continue and returns `None`.
pub(super) fn run(
    (scene, run_folder): (&Scene, &RunFolder),
    threads: usize,
    checkpoints: &Checkpoints,
    resume: bool,
    console: &Console,
) -> Result<Option<Ran>, Failure> {
    let stop = interrupt::stop_on_signal(console)?;
    let begun = match scene.is_external() {
        true => external::begin(scene, run_folder.clone(), resume),
        false => Run::new(scene),
    };
    let mut run = begun.map_err(Failure::failed)?;
    run.use_threads(threads)?;
    let resumed = begin(&mut run, checkpoints, resume, console)?;
    let resumed_from = resumed.then(|| run.time());
    let model = run::model_of(scene);
    let work = model.work_of(scene);
    let done = |now: &run::Progress| (now.share() * work as f64) as u64;
    let mut told = done(&run.progress());
    let progress = Progress::new(
        console,
        Work {
            jobs: 1,
            jobs_done: 0,
            steps: work,
            steps_done: told,
            head: String::new(),
            unit: model.work_unit(),
        },
    );
    let mut worked = run.work();
    let mut frame = 0;
    let mut control = |now: run::Progress| {
        let done = done(&now);
        let phase = now.counts.as_ref().map(phase_of).unwrap_or_default();
        progress.advance_to(now.work - worked, done - told, phase);
        (told, worked) = (done, now.work);
        frame = now.frame;
        if stop.load(Ordering::Relaxed) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    };
    let mut warned = false;
    let mut warn = |error| {
        // The next ones fail in the same way, most likely.
        if !std::mem::replace(&mut warned, true) {
            progress.note(format_args!(
                "cannot write a checkpoint; the run continues: {error}"
            ));
        }
    };
    let ending = checkpoints.run(run, &mut control, &mut warn);
    let seconds = progress.finish();
    match ending {
        Ending::Finished(record) => Ok(Some(Ran {
            record: *record,
            seconds,
            resumed_from,
        })),
        Ending::Lost(error) => Err(Failure::failed(error)),
        Ending::Failed(reason) => Err(Failure::failed(reason)),
        Ending::Interrupted | Ending::EarlierKept => {
            if scene.is_external() {
                console.note(
                    match scene.program.as_ref().is_some_and(|it| it.resume.is_some()) {
                        true => {
                            "interrupted; the same command with --resume goes on from what it left"
                        }
                        false => "interrupted; the same command begins anew",
                    },
                );
                return Ok(None);
            }
            let frames = scene.time.frames();
            tell_of_interruption(&ending, (frame, frames), checkpoints, console);
            Ok(None)
        }
    }
}

/// Says where a run was interrupted, and what continues it.
fn tell_of_interruption(
    ending: &Ending,
    (frame, frames): (u64, u64),
    checkpoints: &Checkpoints,
    console: &Console,
) {
    let path = checkpoints.path().display();
    match ending {
        Ending::EarlierKept => console.note(format_args!(
            "interrupted; nothing was stored. The earlier checkpoint is kept: --resume continues \
             from it ({path})"
        )),
        _ => console.note(format_args!(
            "interrupted at frame {frame} of {frames}; the same command with --resume continues \
             from there ({path})"
        )),
    }
}

/// Continues a run from its checkpoint, if requested and present, and says where it begins.
fn begin(
    run: &mut Run,
    checkpoints: &Checkpoints,
    resume: bool,
    console: &Console,
) -> Result<bool, Failure> {
    let path = checkpoints.path().display();
    if !run.can_be_saved() {
        return Ok(false);
    }
    if !resume {
        if checkpoints.path().exists() {
            console.note(format_args!(
                "starting from the beginning, which replaces the checkpoint {path} of an \
                 interrupted run; --resume would continue from it"
            ));
        }
        return Ok(false);
    }
    let resumed = checkpoints.restore(run).map_err(|error| {
        Failure::refused(format_args!(
            "{error}; without --resume the run starts from the beginning and replaces the \
             checkpoint"
        ))
    })?;
    if resumed {
        console.note(format_args!(
            "continuing at {}, frame {} of {}, from {path}",
            format::time(run.time()),
            run.progress().frame,
            run.progress().frames
        ));
    } else {
        console.note(format_args!(
            "no checkpoint {path}; starting from the beginning"
        ));
    }
    Ok(resumed)
}

/// The phase of a run where spheres enter and leave.
fn phase_of(counts: &Counts) -> String {
    let Counts {
        all,
        released,
        discharged,
        is_closed,
        ..
    } = *counts;
    if released < all {
        format!("filling, {released} of {all} inside")
    } else if is_closed {
        format!("coming to rest, all {all} inside")
    } else {
        format!("draining, {discharged} of {all} left")
    }
}
