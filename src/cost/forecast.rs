//! The cost of a sweep, from a short trial of a few of its jobs.

use super::representatives::{Representative, representatives};
use super::{CostError, RECORD, RunCost, START};
use crate::record::RunRecord;
use crate::run::{self, RunError};
use crate::scene::{Scene, Start};
use crate::store::{self, StoreError};
use crate::sweep::{Job, work};
use serde::Serialize;
use std::ops::ControlFlow;
use std::time::Duration;

/// The cost of a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Forecast {
    /// Number of jobs that were tried.
    pub tried: usize,
    /// Work of all jobs, in the unit of their model.
    #[serde(rename = "sphere_steps")]
    pub work: u64,
    /// Work per second of one worker while all work.
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
    /// A job of the trial cannot be measured.
    #[error("the trial of job {id} failed: {source}")]
    Cost {
        /// Identity of the run.
        id: String,
        /// Why.
        source: CostError,
    },
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

crate::refusal::always!(false: ForecastError);

/// Cost of one job, as tried.
struct Trial {
    /// Seconds per unit of work.
    step: f64,
    /// Seconds that come once for every job: start and record.
    once: f64,
    /// Size of the whole record (bytes).
    disk: f64,
    /// Memory of the run (bytes).
    memory: f64,
}

/// Measures what some jobs cost, at the corners and in the middle of the grid, for about `budget`
/// altogether on that many workers, and extrapolates: each stands for the jobs nearest to it.
///
/// # Errors
/// If a job of the trial fails.
pub fn forecast(jobs: &[Job], workers: usize, budget: Duration) -> Result<Forecast, ForecastError> {
    let chosen = representatives(jobs);
    let rounds = chosen.len().div_ceil(workers.max(1)).max(1);
    let budget = budget / rounds as u32;
    let trials = work::map(workers, &chosen, |it| try_job(it.job, budget))?;
    let trials: Vec<Trial> = trials.into_iter().collect::<Result<_, _>>()?;
    let sum = |value: &dyn Fn(&Trial, &Representative<'_>) -> f64| -> f64 {
        let pairs = trials.iter().zip(&chosen);
        pairs.map(|(trial, chosen)| value(trial, chosen)).sum()
    };
    let mean = |value: fn(&Trial) -> f64| {
        sum(&|trial, chosen| value(trial) * chosen.jobs as f64) / jobs.len().max(1) as f64
    };
    let work = chosen.iter().map(|it| it.work).sum();
    // Times add up, not rates.
    let seconds =
        sum(&|trial, chosen| trial.step * chosen.work as f64 + trial.once * chosen.jobs as f64);
    let rate = work as f64 / seconds;
    let at_once = workers.min(jobs.len()).max(1) as f64;
    Ok(Forecast {
        tried: chosen.len(),
        work,
        rate,
        seconds: work as f64 / rate / at_once,
        memory: PROGRAM_MEMORY + at_once * mean(|trial| trial.memory),
        disk: jobs.len() as f64 * mean(|trial| trial.disk),
    })
}

/// Memory of the program without any run (bytes).
const PROGRAM_MEMORY: f64 = 10e6;

/// Runs the beginning of a job for about the time of the budget.
fn try_job(job: &Job, budget: Duration) -> Result<Trial, ForecastError> {
    let failed = |source| ForecastError::Cost {
        id: job.id.clone(),
        source,
    };
    let scene = job.scene();
    if matches!(scene.start, Start::Packing {}) {
        // A packing is made once and kept: before the clock runs.
        let built = run::model_of(&scene).build(&scene);
        built.map_err(|source| failed(source.into()))?;
    }
    // The rest of the budget is for runs that end, since only these tell the size of a whole
    // record.
    let cost = RunCost::measure(&scene, budget / 2).map_err(failed)?;
    let disk = match cost.whole {
        true => size_of_record(&cost.record)?,
        false => {
            let all_frames = scene.time.frames();
            size_of_whole_run(job, (cost.frames / 2).max(2).min(all_frames))?
        }
    };
    Ok(Trial {
        step: cost.elapsed / cost.work.max(1) as f64,
        // The record is written by the same worker.
        once: cost.seconds(START) + cost.seconds(RECORD),
        disk,
        // The record in memory and as the bytes of its file, neither compressed.
        memory: 4.0 * disk + scene.spheres.count as f64 * ENGINE_BYTES,
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

/// Size of the record of a whole run (bytes), from runs of `frames` frames and of half as many:
/// part of a file does not grow with the number of frames. Very short runs are not compressed, so
/// that they forecast too much.
fn size_of_whole_run(job: &Job, frames: u64) -> Result<f64, ForecastError> {
    let states = |scene: &Scene| stored_states(scene) * scene.spheres.count as f64 * STATE_BYTES;
    let whole = job.scene();
    let size_without_states = |frames: u64| {
        let mut scene = whole.clone();
        scene.time.duration = frames as f64 * scene.time.frame_interval;
        let record = run::run(&scene, &mut |_| ControlFlow::Continue(()));
        let record = record.map_err(|source| ForecastError::Run {
            id: job.id.clone(),
            source,
        })?;
        let observed = record.observations.frames().max(1) as f64;
        Ok::<_, ForecastError>((size_of_record(&record)? - states(&scene), observed))
    };
    let (size, observed) = size_without_states(frames)?;
    let (half_size, half_observed) = size_without_states((frames / 2).max(1))?;
    let per_frame = (size - half_size) / (observed - half_observed).max(1.0);
    let all_frames = whole.time.frames() as f64;
    Ok(size + per_frame.max(0.0) * (all_frames - observed).max(0.0) + states(&whole))
}

/// Size of the file of a record (bytes).
fn size_of_record(record: &RunRecord) -> Result<f64, ForecastError> {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("trial.h5");
    store::write_record(record, &path)?;
    Ok(std::fs::metadata(&path)?.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = r#"
        spheres = { count = 8, radius = 0.004, density = 1000.0 }
        start = { kind = "random", z_min = 0.01, z_max = 0.05 }
        tank = { radius = 0.03, floor = 0.0 }
        contact.law = "hertz"
        contact.young_modulus = 5e5
        contact.poisson_ratio = 0.3
        contact.dissipation_time = 1e-3
        gravity = { acceleration = 9.8 }
        time = { dt = 1e-4, duration = 3.0, frame_interval = 1e-3 }
    "#;

    fn job() -> Job {
        let scene: Scene = toml::from_str(SCENE).unwrap();
        Job::alone(scene.identity(), vec![], scene)
    }

    #[test]
    fn two_short_runs_tell_the_size_of_a_whole_record() {
        let job = job();
        let record = run::run(&job.scene(), &mut |_| ControlFlow::Continue(())).unwrap();
        let size = size_of_record(&record).unwrap();
        // The spheres come to rest, and frames at rest take a quarter of the place of the first
        // ones: a trial of the first frames forecasts too much, never too little.
        for (frames, most) in [(2400, 1.3), (200, 5.0)] {
            let forecast = size_of_whole_run(&job, frames).unwrap();
            let ratio = forecast / size;
            assert!(
                (0.8..most).contains(&ratio),
                "{frames} frames: {forecast} for {size}"
            );
        }
    }
}
