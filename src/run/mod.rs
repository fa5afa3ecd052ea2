//! One run: from a scene to its record.

mod edits;
mod external;
mod load;
mod models;
mod packed;
mod recorder;
mod state;
mod steady;

pub use edits::Edits;
pub(crate) use load::{Reading, base_of_completed, base_of_document, base_of_tree, load_base_with};
pub use models::model_of;
pub use recorder::{EndOfRun, FrameInfo, Recorder};
pub use state::frame_of_state;

use crate::cpu_time;
use crate::record::{Outcome, RunRecord};
use crate::scene::Scene;
use crate::simulation::{BuildError, Counts, Profile, Simulation};
use rayon::ThreadPoolBuildError;
use std::ops::ControlFlow;

/// The progress of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Frames done, the start not counted.
    pub frame: u64,
    /// All frames, if nothing ends the run early.
    pub frames: u64,
    /// How many spheres came and went, if they do.
    pub counts: Option<Counts>,
    /// Work done, in the unit of the model.
    pub work: u64,
}

impl Progress {
    /// The completed fraction of the run: of its frames or, if larger, of the entries and exits of
    /// its spheres.
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
    /// The caller requested to stop.
    #[error("interrupted")]
    Interrupted,
    /// The run failed without a broken guard.
    #[error("{0}")]
    Failed(String),
}

/// Runs a scene to its end, or until it breaks a guard. `control` decides after every frame whether
/// to continue.
///
/// # Errors
/// If the scene cannot be built, or `control` breaks before the end.
pub fn run(
    scene: &Scene,
    control: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Result<RunRecord, RunError> {
    let mut run = Run::new(scene)?;
    while !run.ended() {
        run.advance_frame();
        if control(run.progress()).is_break() && !run.ended() {
            return Err(RunError::Interrupted);
        }
    }
    match run.failure() {
        Some(reason) => Err(RunError::Failed(reason.to_owned())),
        None => Ok(run.finish()),
    }
}

/// A run in progress: a simulation and the recorder of its frames, advanced frame by frame, on one
/// thread by default.
///
/// ```
/// # let scene: phase::scene::Scene = toml::from_str(r#"
/// #     spheres = { count = 1, radius = 0.004, density = 1000.0 }
/// #     start = { kind = "list", spheres = [{ position = [0.0, 0.0, 1.0] }] }
/// #     gravity = { acceleration = 9.8 }
/// #     time = { dt = 1e-3, duration = 0.01, frame_interval = 1e-3 }
/// # "#).unwrap();
/// use phase::run::Run;
///
/// let mut first = Run::new(&scene)?;
/// first.advance_frame();
/// // Another run continues from the saved state.
/// let mut saved = Vec::new();
/// first.save(&mut saved)?;
/// let mut second = Run::new(&scene)?;
/// second.restore(&saved)?;
/// while !second.ended() {
///     second.advance_frame();
/// }
/// let record = second.finish();
/// assert_eq!(record.observations.frames(), 11);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Run {
    simulation: Box<dyn Simulation>,
    recorder: Recorder,
    outcome: Outcome,
    frame: u64,
    frames: u64,
    /// Processor time that the run took before `started` (s).
    cpu_seconds_before: f64,
    /// Processor time of this thread when the run began or was restored (s).
    started: f64,
}

impl Run {
    /// A run at its start.
    ///
    /// # Errors
    /// If the scene cannot be built.
    pub fn new(scene: &Scene) -> Result<Self, BuildError> {
        let started = cpu_time::of_this_thread();
        let simulation = model_of(scene).build(scene)?;
        Ok(Self::begin(scene, simulation, started))
    }

    /// A run of a simulation that was built elsewhere and is at its start. The scene determines its
    /// duration and output.
    pub fn with_simulation(scene: &Scene, simulation: Box<dyn Simulation>) -> Self {
        Self::begin(scene, simulation, cpu_time::of_this_thread())
    }

    fn begin(scene: &Scene, simulation: Box<dyn Simulation>, started: f64) -> Self {
        let (radius, mass) = (simulation.radius(), simulation.mass());
        let frames = simulation.frames().unwrap_or(scene.time.frames());
        let mut run = Self {
            recorder: Recorder::new(scene, radius, mass, simulation.columns()),
            simulation,
            outcome: Outcome::Completed,
            frame: 0,
            frames,
            cpu_seconds_before: 0.0,
            started,
        };
        if run.simulation.has_frame() {
            run.look();
        }
        run
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        self.recorder.scene()
    }

    /// Advances to the next frame, or until a guard breaks. A run that has ended does not change.
    pub fn advance_frame(&mut self) {
        if self.ended() {
            return;
        }
        self.advance_steps();
        if self.simulation.has_frame() {
            self.look();
        }
    }

    /// Advances on this number of threads from now on, if that pays. No bit of the record depends
    /// on it.
    ///
    /// # Errors
    /// If the system cannot start threads.
    pub fn use_threads(&mut self, threads: usize) -> Result<(), ThreadPoolBuildError> {
        self.simulation.use_threads(threads)
    }

    /// Begins to measure the times of the parts of a step. Never changes the run.
    pub(crate) fn keep_profile(&mut self) {
        self.simulation.keep_profile();
    }

    /// The profile, if one is kept.
    pub(crate) fn profile(&self) -> Option<&Profile> {
        self.simulation.profile()
    }

    /// Advances to the next frame, which [`look`](Self::look) shows.
    pub(crate) fn advance_steps(&mut self) {
        let had_frame = self.simulation.has_frame();
        if let Err(instability) = self.simulation.advance_frame() {
            self.outcome = Outcome::Unstable(instability);
        }
        // The first frame of a program is its start.
        self.frame += u64::from(had_frame);
    }

    /// Why the run has failed without a broken guard, if it has: it has no record.
    pub fn failure(&self) -> Option<&str> {
        self.simulation.failure()
    }

    /// Whether a checkpoint can keep its state.
    pub fn can_be_saved(&self) -> bool {
        self.simulation.can_be_saved()
    }

    /// Whether the run is over: its time is up, it is steady in a scene with `steady`, a guard is
    /// broken, or nothing more will happen.
    pub fn ended(&self) -> bool {
        self.frame == self.frames
            || self.recorder.is_steady()
            || self.is_unstable()
            || self.simulation.ended()
    }

    /// How far the run is.
    pub fn progress(&self) -> Progress {
        Progress {
            frame: self.frame,
            frames: self.frames,
            counts: self.simulation.counts(),
            work: self.simulation.work(),
        }
    }

    /// Work done so far, in the unit of the model.
    pub fn work(&self) -> u64 {
        self.simulation.work()
    }

    /// Time of the latest frame (s).
    pub fn time(&self) -> f64 {
        self.simulation.time()
    }

    /// The record of all frames so far.
    pub fn finish(mut self) -> RunRecord {
        if self.ended() {
            // A large scene needs most memory now, before the last state is kept.
            self.simulation.release_memory();
            let (time, recorder) = (self.simulation.time(), &mut self.recorder);
            self.simulation.look(&mut |frame| recorder.end(time, frame));
            if let Some(snapshots) = self.simulation.take_snapshots() {
                recorder.replace_snapshots(snapshots);
            }
        }
        let end = EndOfRun {
            cpu_seconds: self.cpu_seconds(),
            radius: self.simulation.radius().to_vec(),
            mass: self.simulation.mass().to_vec(),
            milestones: self.simulation.milestones().to_vec(),
            work: self.simulation.work(),
            outcome: self.outcome,
        };
        self.recorder.finish(end)
    }

    fn cpu_seconds(&self) -> f64 {
        let of_others = self.simulation.seconds_of_threads();
        self.cpu_seconds_before + (cpu_time::of_this_thread() - self.started) + of_others
    }

    /// Shows the present frame to the recorder.
    pub(crate) fn look(&mut self) {
        let is_broken = self.is_unstable();
        let own = self.simulation.values();
        let info = FrameInfo {
            frame: self.frame,
            time: self.simulation.time(),
            own: &own,
            is_last: self.ended(),
        };
        let recorder = &mut self.recorder;
        self.simulation.look(&mut |frame| match is_broken {
            true => recorder.record_broken(info.time, frame),
            false => recorder.record(info, frame),
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observe::Snapshot;

    /// Symptom: a run with only the last snapshot requested stored the first one too. Cause: frame
    /// 0 is a multiple of any number.
    #[test]
    fn snapshots_are_those_that_are_asked_for() {
        let times = |interval: f64| {
            let scene: Scene = toml::from_str(&format!(
                r#"
                spheres = {{ count = 1, radius = 0.004, density = 1000.0 }}
                start = {{ kind = "list", spheres = [{{ position = [0.0, 0.0, 1.0] }}] }}
                gravity = {{ acceleration = 9.8 }}
                time = {{ dt = 1e-3, duration = 0.01, frame_interval = 2e-3 }}
                output = {{ snapshot_interval = {interval:?} }}
                "#
            ))
            .unwrap();
            let record = run(&scene, &mut |_| ControlFlow::Continue(())).unwrap();
            let time = |snapshot: &Snapshot| (snapshot.time * 1e3).round();
            record.snapshots.iter().map(time).collect::<Vec<_>>()
        };
        assert_eq!(times(0.0), [10.0]);
        assert_eq!(times(4e-3), [0.0, 4.0, 8.0, 10.0]);
        assert_eq!(times(2e-3), [0.0, 2.0, 4.0, 6.0, 8.0, 10.0]);
    }
}
