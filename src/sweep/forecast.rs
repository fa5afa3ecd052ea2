//! What a sweep will cost, from a short trial of a few of its jobs.

use super::{Job, work};
use crate::run::{self, RunError};
use crate::scene::Scene;
use crate::store::{self, StoreError};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// What a sweep will cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forecast {
    /// Number of jobs that were tried.
    pub tried: usize,
    /// Sphere-steps of all jobs.
    pub sphere_steps: u64,
    /// Sphere-steps per second of one worker while all work.
    pub rate: f64,
    /// Time (s).
    pub seconds: f64,
    /// Memory while it runs (bytes), roughly.
    pub memory: f64,
    /// Size of all records (bytes).
    pub disk: f64,
}

/// Why there is no forecast.
#[derive(Debug, thiserror::Error)]
pub enum ForecastError {
    /// A job of the trial failed.
    #[error("the trial of job {id} failed: {source}")]
    Run {
        /// Identity of the run.
        id: String,
        /// Why.
        source: RunError,
    },
    /// A record of the trial could not be written.
    #[error("the trial cannot write a record: {0}")]
    Store(#[from] StoreError),
    /// There is no place for temporary files.
    #[error("the trial cannot write temporary files: {0}")]
    Io(#[from] std::io::Error),
    /// The system gives no threads.
    #[error("cannot start the workers: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

/// Cost of one job, as tried.
struct Trial {
    /// Sphere-steps per second.
    rate: f64,
    /// Size of the whole record (bytes).
    disk: f64,
    /// Memory of the run (bytes).
    memory: f64,
}

/// Runs the first part of some jobs, the corners and the middle of the grid, for about `budget`
/// altogether on that many workers, and extrapolates.
///
/// # Errors
/// If a job of the trial fails.
pub fn forecast(jobs: &[Job], workers: usize, budget: Duration) -> Result<Forecast, ForecastError> {
    let chosen = representatives(jobs);
    let rounds = chosen.len().div_ceil(workers.max(1)).max(1);
    let budget = budget / rounds as u32;
    let trials = work::map(workers, &chosen, |job| try_job(job, budget))?;
    let trials: Vec<Trial> = trials.into_iter().collect::<Result<_, _>>()?;
    let mean = |value: fn(&Trial) -> f64| {
        trials.iter().map(value).sum::<f64>() / trials.len().max(1) as f64
    };
    let sphere_steps = jobs.iter().map(|job| work::sphere_steps(&job.scene)).sum();
    // Times add up, so the mean rate is the harmonic one.
    let rate = 1.0 / mean(|trial| 1.0 / trial.rate);
    let at_once = workers.min(jobs.len()).max(1) as f64;
    Ok(Forecast {
        tried: chosen.len(),
        sphere_steps,
        rate,
        seconds: sphere_steps as f64 / rate / at_once,
        memory: PROGRAM_MEMORY + at_once * mean(|trial| trial.memory),
        disk: jobs.len() as f64 * mean(|trial| trial.disk),
    })
}

/// Memory of the program without any run (bytes).
const PROGRAM_MEMORY: f64 = 10e6;

/// The jobs at the corners and in the middle of the grid, of the first seed.
fn representatives(jobs: &[Job]) -> Vec<&Job> {
    let (Some(first), Some(last)) = (jobs.first(), jobs.last()) else {
        return Vec::new();
    };
    let mut chosen: Vec<&Job> = Vec::new();
    let is_end =
        |(axis, value): (usize, &f64)| *value == first.values[axis] || *value == last.values[axis];
    for job in jobs.iter().filter(|job| job.seed == first.seed) {
        if job.values.iter().enumerate().all(is_end) {
            chosen.push(job);
        }
    }
    let middle = &jobs[jobs.len() / 2];
    if !chosen.iter().any(|job| job.id == middle.id) {
        chosen.push(middle);
    }
    chosen
}

/// Runs the beginning of a job for about the time of the budget.
fn try_job(job: &&Job, budget: Duration) -> Result<Trial, ForecastError> {
    let failed = |source| ForecastError::Run {
        id: job.id.clone(),
        source,
    };
    let all_frames = run::frames(&job.scene).1.max(1) as f64;
    // One run that the budget interrupts tells how many frames a second run may have. Only a run
    // that ends leaves a record, whose size is to be known too.
    let start = Instant::now();
    let mut share = 0.0;
    let timed = run::run(&job.scene, &mut |progress| {
        share = progress.frame as f64 / progress.frames as f64;
        if start.elapsed() < budget {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(())
        }
    });
    let seconds = start.elapsed().as_secs_f64();
    let (record, done) = match timed {
        Ok(record) => {
            let done = work::sphere_steps_run(&record.scene, &record.outcome) as f64;
            (record, done)
        }
        Err(RunError::Interrupted) => {
            let scene = first_frames(&job.scene, (all_frames * share / 10.0).clamp(1.0, 100.0));
            let record = run::run(&scene, &mut |_| ControlFlow::Continue(())).map_err(failed)?;
            (record, share * work::sphere_steps(&job.scene) as f64)
        }
        Err(error) => return Err(failed(error)),
    };
    let frames = record.observations.frames().max(1) as f64;
    let spheres = job.scene.spheres.count as f64;
    let stored = |scene: &Scene| stored_states(scene) * spheres * STATE_BYTES;
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("trial.h5");
    store::write_record(&record, &path)?;
    let per_frame =
        (std::fs::metadata(&path)?.len() as f64 - stored(&record.scene)).max(0.0) / frames;
    let disk = per_frame * all_frames + stored(&job.scene);
    Ok(Trial {
        rate: done.max(1.0) / seconds,
        disk,
        // The record in memory and as the bytes of its file, neither compressed.
        memory: 4.0 * disk + spheres * ENGINE_BYTES,
    })
}

/// Bytes of one sphere's state in a snapshot: position, velocity, spin.
const STATE_BYTES: f64 = 72.0;

/// Bytes the engine needs per sphere: its state, forces and neighbours.
const ENGINE_BYTES: f64 = 2000.0;

/// How often the state of all spheres is stored in a whole run.
fn stored_states(scene: &Scene) -> f64 {
    let every = |interval: f64| {
        if interval > 0.0 {
            (scene.time.duration / interval).floor()
        } else {
            0.0
        }
    };
    let trajectory = if scene.output.trajectory {
        every(scene.time.frame_interval)
    } else {
        0.0
    };
    1.0 + every(scene.output.snapshot_interval) + trajectory
}

/// The scene, ended after that many frames.
fn first_frames(scene: &Scene, frames: f64) -> Scene {
    let mut scene = scene.clone();
    scene.time.duration = frames.round() * scene.time.frame_interval;
    scene
}
