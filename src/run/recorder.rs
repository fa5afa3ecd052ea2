//! What is kept of a run.

use super::steady::SteadyTest;
use crate::observe::{Observer, Snapshot};
use crate::record::{Outcome, Program, RunRecord};
use crate::scene::Scene;
use crate::simulation::{Column, Frame, Milestone, MilestoneKind};
use serde::{Deserialize, Serialize};

/// Makes the record of a run from its frames, from any source: the engine here, another program, a
/// device. It observes every frame, keeps the states that the scene's output requests, and tests
/// whether the run is steady.
///
/// Frames come in order, the start first; the last one [comes twice](Self::end).
pub struct Recorder {
    scene: Scene,
    recorded: Recorded,
    /// `Some` if the scene ends when it is steady.
    steady_test: Option<SteadyTest>,
    /// When the steady state began, once it is reached (s).
    steady_since: Option<f64>,
    /// `None` if only the last state is requested.
    frames_per_snapshot: Option<u64>,
}

/// What has been kept so far.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Recorded {
    observer: Observer,
    snapshots: Vec<Snapshot>,
    trajectory: Vec<Snapshot>,
}

/// Data of a frame besides its spheres.
#[derive(Clone, Copy, Debug)]
pub struct FrameInfo<'a> {
    /// Number of the frame; the start has 0.
    pub frame: u64,
    /// Time (s).
    pub time: f64,
    /// Values of the columns that the model declares, in their order.
    pub own: &'a [f64],
    /// Whether no frame follows.
    pub is_last: bool,
}

/// Data of a finished run besides its frames.
#[derive(Clone, Debug)]
pub struct EndOfRun {
    /// How it ended.
    pub outcome: Outcome,
    /// Radius of every sphere of the scene that moves (m).
    pub radius: Vec<f64>,
    /// Mass of every sphere of the scene that moves (kg).
    pub mass: Vec<f64>,
    /// Events that happened once, in order of time.
    pub milestones: Vec<Milestone>,
    /// Work, in the unit of the model; 0 if unknown.
    pub work: u64,
    /// Processor time (s).
    pub cpu_seconds: f64,
}

impl Recorder {
    /// A recorder before the first frame, for spheres with these radii (m) and masses (kg).
    /// `columns` are declared by the model.
    pub fn new(scene: &Scene, radius: &[f64], mass: &[f64], columns: &[Column]) -> Self {
        let ratio = scene.output.snapshot_interval / scene.time.frame_interval;
        Self {
            scene: scene.clone(),
            recorded: Recorded {
                observer: Observer::new(scene, radius).with_own(columns),
                snapshots: Vec::new(),
                trajectory: Vec::new(),
            },
            steady_test: SteadyTest::new(scene, radius, mass),
            steady_since: None,
            frames_per_snapshot: (ratio > 0.0).then(|| (ratio.round() as u64).max(1)),
        }
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Whether the run has become steady, in a scene that then ends.
    pub fn is_steady(&self) -> bool {
        self.steady_since.is_some()
    }

    /// Records a valid frame. [`end`](Self::end) keeps the last one as a state.
    pub fn record(&mut self, info: FrameInfo<'_>, frame: &dyn Frame) {
        let FrameInfo { time, own, .. } = info;
        self.recorded.observer.observe_own(own);
        self.recorded.observer.observe(time, frame);
        self.test(info.frame);
        let due = |frames| info.frame.is_multiple_of(frames);
        let is_last = info.is_last || self.is_steady();
        if !is_last && self.frames_per_snapshot.is_some_and(due) {
            self.recorded.snapshots.push(Snapshot::take(time, frame));
        }
        self.keep_trajectory(time, frame);
    }

    /// Records a frame at which a guard was broken, without observing it.
    pub fn record_broken(&mut self, time: f64, frame: &dyn Frame) {
        self.keep_trajectory(time, frame);
    }

    /// Keeps the state at the end, which comes after all others.
    pub fn end(&mut self, time: f64, frame: &dyn Frame) {
        self.recorded.snapshots.push(Snapshot::take(time, frame));
    }

    /// Keeps these states in place of all others.
    pub(super) fn replace_snapshots(&mut self, snapshots: Vec<Snapshot>) {
        self.recorded.snapshots = snapshots;
    }

    /// The record of the frames so far.
    pub fn finish(self, end: EndOfRun) -> RunRecord {
        let Recorded {
            observer,
            snapshots,
            trajectory,
        } = self.recorded;
        // Scenes that end when they are steady have no other milestones.
        let kind = MilestoneKind::Steady;
        let steady = self.steady_since.map(|time| Milestone { kind, time });
        RunRecord {
            scene: self.scene,
            program: Program::current(),
            outcome: end.outcome,
            radius: end.radius,
            mass: end.mass,
            milestones: end.milestones.into_iter().chain(steady).collect(),
            observations: observer.finish(),
            snapshots,
            trajectory,
            work: end.work,
            cpu_seconds: end.cpu_seconds,
        }
    }

    /// What has been kept so far, for a checkpoint.
    pub(super) fn recorded(&self) -> &Recorded {
        &self.recorded
    }

    /// Continues from what had been kept up to a frame.
    pub(super) fn restore(&mut self, frame: u64, recorded: Recorded) {
        self.recorded = recorded;
        self.test(frame);
    }

    fn test(&mut self, frame: u64) {
        let observations = self.recorded.observer.observations();
        let test = self.steady_test.as_ref();
        self.steady_since = test.and_then(|it| it.since(frame, observations));
    }

    fn keep_trajectory(&mut self, time: f64, frame: &dyn Frame) {
        if self.scene.output.trajectory {
            self.recorded.trajectory.push(Snapshot::take(time, frame));
        }
    }
}
