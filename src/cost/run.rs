//! What a run costs, and what each of its parts does.

use crate::cpu_time;
use crate::dem::{BuildError, Part, Profile, Seconds};
use crate::record::RunRecord;
use crate::run::Run;
use crate::scene::Scene;
use crate::store::{self, StoreError};
use crate::sweep::work;
use std::time::{Duration, Instant};

/// Why a cost is not known.
#[derive(Debug, thiserror::Error)]
pub enum CostError {
    /// The scene cannot be built.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// The record cannot be written.
    #[error("cannot write a record to measure with: {0}")]
    Store(#[from] StoreError),
    /// There is no place for temporary files.
    #[error("cannot write temporary files: {0}")]
    Io(#[from] std::io::Error),
}

/// What a run costs, from itself or from its first part.
#[derive(Clone, Debug)]
pub struct RunCost {
    /// Processor time of each part of what was run (s), by [`Part::ALL`].
    parts: Seconds,
    /// Time of day that it took (s), all but the record.
    pub elapsed: f64,
    /// Steps that were run, each times the spheres that moved in it.
    pub sphere_steps: u64,
    /// Frames that were run, the start not counted.
    pub frames: u64,
    /// Sphere-steps of the whole run: the same if all of it was run, else the most that it may take.
    pub all_sphere_steps: u64,
    /// Whether the run came to its end.
    pub whole: bool,
    /// What was run.
    pub record: RunRecord,
}

impl RunCost {
    /// Runs a scene until its end or, if that comes first, for so much processor time, and measures what
    /// its parts cost. The motion is that of any other run.
    ///
    /// # Errors
    /// If the scene cannot be built, or no record written to a temporary folder.
    pub fn measure(scene: &Scene, budget: Duration) -> Result<Self, CostError> {
        let profile = Profile::new();
        let clock = Instant::now();
        let reading = profile.reading;
        let mut meter = Meter::new();
        let mut run = Run::new(scene)?;
        run.keep_profile(profile);
        let mut parts = Seconds::default();
        parts[Part::Start as usize] = meter.lap(reading);
        let (mut advancing, mut frames) = (0.0, 0);
        let budget = budget.as_secs_f64();
        // One frame at least, or nothing is known of a step.
        while !run.ended() && (frames == 0 || meter.latest - meter.started < budget) {
            run.advance_steps();
            advancing += meter.lap(reading);
            run.look();
            parts[Part::Observers as usize] += meter.lap(reading);
            frames += 1;
        }
        let elapsed = clock.elapsed().as_secs_f64();
        let mut sphere_steps = 0;
        if let Some(profile) = run.profile() {
            sphere_steps = profile.sphere_steps();
            for (part, seconds) in parts.iter_mut().zip(profile.parts()) {
                *part += seconds;
            }
            let between = match Part::Process.is_in(scene) {
                true => Part::Process,
                false => Part::Rest,
            };
            let inside = profile.seconds() + profile.readings();
            parts[between as usize] += (advancing - inside).max(0.0);
        }
        let whole = run.ended();
        let record = run.finish();
        let folder = tempfile::tempdir()?;
        store::write_record(&record, &folder.path().join("cost.h5"))?;
        parts[Part::Record as usize] = meter.lap(reading);
        let all_sphere_steps = match whole {
            true => sphere_steps,
            false => work::sphere_steps(scene).max(sphere_steps),
        };
        Ok(Self {
            parts,
            elapsed,
            sphere_steps,
            frames,
            all_sphere_steps,
            whole,
            record,
        })
    }

    /// Processor time of a part of what was run (s).
    pub fn seconds(&self, part: Part) -> f64 {
        self.parts[part as usize]
    }

    /// Processor time of a part of the whole run (s), if it goes on as it began: start and record come
    /// only once.
    pub fn all_seconds(&self, part: Part) -> f64 {
        match part {
            Part::Start | Part::Record => self.seconds(part),
            _ => {
                let rest = self.all_sphere_steps as f64 / self.sphere_steps.max(1) as f64;
                self.seconds(part) * rest
            }
        }
    }

    /// Processor time of what was run (s).
    pub fn total(&self) -> f64 {
        self.parts.iter().sum()
    }
}

/// Processor time from one reading to the next.
struct Meter {
    started: f64,
    latest: f64,
}

impl Meter {
    fn new() -> Self {
        let now = cpu_time::of_this_thread();
        Self {
            started: now,
            latest: now,
        }
    }

    /// Time since the latest reading (s), without what one `reading` takes (s).
    fn lap(&mut self, reading: f64) -> f64 {
        let now = cpu_time::of_this_thread();
        let lap = now - self.latest - reading;
        self.latest = now;
        lap
    }
}
