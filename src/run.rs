//! One run: from a scene to its record.

use crate::cpu_time;
use crate::dem::{BuildError, Counts, Simulation};
use crate::observe::{Observer, Snapshot};
use crate::record::{Outcome, Program, RunRecord};
use crate::scene::Scene;
use std::ops::ControlFlow;

/// How far a run is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Frames done, the start not counted.
    pub frame: u64,
    /// Frames in all, if nothing ends the run before its time.
    pub frames: u64,
    /// Where spheres come and go: how many did.
    pub counts: Option<Counts>,
}

impl Progress {
    /// The share of the run that is done: of its frames or, if that is more, of the ways of its
    /// spheres in and out.
    pub fn share(&self) -> f64 {
        let frames = self.frame as f64 / self.frames.max(1) as f64;
        self.counts
            .map_or(frames, |counts| frames.max(counts.share()))
    }
}

/// Why a run has no record.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The scene cannot be built.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// The caller asked to stop.
    #[error("interrupted")]
    Interrupted,
}

/// Steps between frames, and frames of a run.
pub fn frames(scene: &Scene) -> (u64, u64) {
    let steps = (scene.time.frame_interval / scene.time.dt).round() as u64;
    let frames = (scene.time.duration / scene.time.frame_interval).round() as u64;
    (steps, frames)
}

/// Runs a scene to its end, or to the guard that it breaks. `control` is asked after every
/// frame whether to go on.
///
/// # Errors
/// If the scene cannot be built, or `control` breaks.
pub fn run(
    scene: &Scene,
    control: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Result<RunRecord, RunError> {
    let started = cpu_time::of_this_thread();
    let (steps, frames) = frames(scene);
    let mut simulation = Simulation::new(scene)?;
    let mut observer = Observer::new(scene, simulation.radius());
    let mut snapshots = Vec::new();
    let mut trajectory = Vec::new();
    let every = match scene.output.snapshot_interval / scene.time.frame_interval {
        ratio if ratio > 0.0 => (ratio.round() as u64).max(1),
        _ => u64::MAX,
    };
    let mut outcome = Outcome::Completed;
    for frame in 0..=frames {
        if frame > 0 {
            if let Err(instability) = simulation.advance(steps) {
                outcome = Outcome::Unstable(instability);
            }
            let counts = simulation.counts();
            if control(Progress {
                frame,
                frames,
                counts,
            })
            .is_break()
            {
                return Err(RunError::Interrupted);
            }
        }
        let ended = frame == frames || outcome != Outcome::Completed || simulation.ended();
        let time = simulation.time();
        let view = simulation.frame();
        if outcome == Outcome::Completed {
            observer.observe(time, &view);
        }
        if ended || frame.is_multiple_of(every) {
            snapshots.push(Snapshot::take(time, &view));
        }
        if scene.output.trajectory {
            trajectory.push(Snapshot::take(time, &view));
        }
        if ended {
            break;
        }
    }
    Ok(RunRecord {
        scene: scene.clone(),
        program: Program::current(),
        outcome,
        radius: simulation.radius().to_vec(),
        mass: simulation.mass().to_vec(),
        milestones: simulation.milestones().to_vec(),
        observations: observer.finish(),
        snapshots,
        trajectory,
        cpu_seconds: cpu_time::of_this_thread() - started,
    })
}
