//! The cost of a run and of each of its parts.

use crate::cpu_time;
use crate::record::RunRecord;
use crate::refusal::Refusal;
use crate::run::{self, Run};
use crate::scene::Scene;
use crate::simulation::{BuildError, Model, PartOfStep, Profile};
use crate::store::{self, StoreError};
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

impl Refusal for CostError {
    fn is_refusal(&self) -> bool {
        matches!(self, Self::Build(_))
    }
}

/// The cost of a part of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartCost {
    /// Its name in tables.
    pub name: &'static str,
    /// Whether the scene has it at all. What it does not have costs nothing.
    pub is_present: bool,
    /// Whether it comes once in a run, however long that is.
    pub is_once: bool,
    /// Processor time (s).
    pub seconds: f64,
}

/// Name of the part that measures frames. Elastic energies of contacts belong to it.
pub const OBSERVERS: &str = "observers";

/// Name of the part that takes the last snapshot and writes the record.
pub const RECORD: &str = "record";

/// Name of the part that places the spheres and makes all that the first step needs.
pub const START: &str = "start";

/// The cost of a run, measured on the whole or on its first part.
#[derive(Clone, Debug)]
pub struct RunCost {
    /// The cost of each part: the parts of the model's step, then observers, record and start.
    pub parts: Vec<PartCost>,
    /// Time of day that its frames took (s): all but start and record.
    pub elapsed: f64,
    /// Work of what was run, in the unit of the model, sub-steps not counted.
    pub work: u64,
    /// Frames that were run, the start not counted.
    pub frames: u64,
    /// Work of the whole run: the same if all of it was run, else the most that it may take.
    pub all_work: u64,
    /// Whether the run came to its end.
    pub whole: bool,
    /// The record of the part that was run.
    pub record: RunRecord,
}

impl RunCost {
    /// Runs a scene until its end or, if that comes first, for so much processor time, and measures
    /// what its parts cost. The motion is the same as in any other run.
    ///
    /// # Errors
    /// If the scene cannot be built, or no record written to a temporary folder.
    pub fn measure(scene: &Scene, budget: Duration) -> Result<Self, CostError> {
        Self::measure_model(run::model_of(scene), scene, budget)
    }

    /// The same with a model of the caller's.
    ///
    /// # Errors
    /// As for [`measure`](Self::measure).
    pub fn measure_model(
        model: &dyn Model,
        scene: &Scene,
        budget: Duration,
    ) -> Result<Self, CostError> {
        let mut meter = Meter::new();
        let mut run = Run::with_simulation(scene, model.build(scene)?);
        let start = meter.lap();
        run.keep_profile();
        // The profile finds out what one reading of the clock takes, which is no part of the run.
        let reading = run.profile().map_or(0.0, Profile::reading);
        meter.skip();
        let (clock, begun) = (Instant::now(), meter.latest);
        let (mut advancing, mut observing, mut frames) = (0.0, 0.0, 0);
        let budget = budget.as_secs_f64();
        // One frame at least, or nothing is known of a step.
        while !run.ended() && (frames == 0 || meter.latest - begun < budget) {
            run.advance_steps();
            advancing += meter.lap() - reading;
            run.look();
            observing += meter.lap() - reading;
            frames += 1;
        }
        let elapsed = clock.elapsed().as_secs_f64();
        let mut parts = parts_of_steps(model.parts_of(scene), run.profile(), advancing);
        let work = run.profile().map_or(run.work(), Profile::work);
        let whole = run.ended();
        let record = run.finish();
        let folder = tempfile::tempdir()?;
        store::write_record(&record, &folder.path().join("cost.h5"))?;
        let writing = meter.lap() - reading;
        for (name, is_once, seconds) in [
            (OBSERVERS, false, observing),
            (RECORD, true, writing),
            (START, true, start),
        ] {
            parts.push(PartCost {
                name,
                is_present: true,
                is_once,
                seconds,
            });
        }
        let all_work = match whole {
            true => work,
            false => model.work_of(scene).max(work),
        };
        Ok(Self {
            parts,
            elapsed,
            work,
            frames,
            all_work,
            whole,
            record,
        })
    }

    /// Processor time of a part of what was run (s); 0 of one that there is not.
    pub fn seconds(&self, part: &str) -> f64 {
        let part = self.parts.iter().find(|it| it.name == part);
        part.map_or(0.0, |part| part.seconds)
    }

    /// Processor time of a part of the whole run (s), if it continues as it began.
    pub fn all_seconds(&self, part: &PartCost) -> f64 {
        match part.is_once {
            true => part.seconds,
            false => part.seconds * self.all_work as f64 / self.work.max(1) as f64,
        }
    }

    /// Processor time of what was run (s).
    pub fn total(&self) -> f64 {
        self.parts.iter().map(|part| part.seconds).sum()
    }
}

/// The costs of the parts of the steps, which took this long in total (s).
fn parts_of_steps(
    parts: Vec<PartOfStep>,
    profile: Option<&Profile>,
    advancing: f64,
) -> Vec<PartCost> {
    let seconds = profile.map_or_else(|| vec![0.0; parts.len()], Profile::parts);
    let inside = profile.map_or(0.0, |it| it.seconds() + it.readings());
    let between = (advancing - inside).max(0.0);
    let owner = parts
        .iter()
        .position(|it| it.is_between_steps && it.is_present);
    let owner = owner.or_else(|| parts.iter().rposition(|it| it.is_present));
    let costs = parts.iter().zip(seconds).enumerate();
    costs
        .map(|(index, (part, seconds))| PartCost {
            name: part.name,
            is_present: part.is_present,
            is_once: false,
            seconds: match owner == Some(index) {
                true => seconds + between,
                false => seconds,
            },
        })
        .collect()
}

/// Processor time from one reading to the next.
struct Meter {
    latest: f64,
}

impl Meter {
    fn new() -> Self {
        Self {
            latest: cpu_time::of_this_thread(),
        }
    }

    /// Time since the latest reading (s).
    fn lap(&mut self) -> f64 {
        let now = cpu_time::of_this_thread();
        let lap = now - self.latest;
        self.latest = now;
        lap
    }

    /// Leaves the time since the latest reading out.
    fn skip(&mut self) {
        self.latest = cpu_time::of_this_thread();
    }
}
