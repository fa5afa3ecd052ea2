//! The record of one run, in memory.

use crate::observe::{Observations, Snapshot};
use crate::scene::Scene;
use serde::{Deserialize, Serialize};

/// Everything kept of one run.
#[derive(Clone, Debug, PartialEq)]
pub struct RunRecord {
    /// The resolved scene.
    pub scene: Scene,
    /// The program that ran it.
    pub program: Program,
    /// How the run ended.
    pub outcome: Outcome,
    /// Radius of every sphere (m).
    pub radius: Vec<f64>,
    /// Mass of every sphere (kg).
    pub mass: Vec<f64>,
    /// What happened once, in order of time; only in scenes where spheres come or go.
    pub milestones: Vec<Milestone>,
    /// Observables of every frame.
    pub observations: Observations,
    /// All spheres now and then; the last one is the end of the run.
    pub snapshots: Vec<Snapshot>,
    /// All spheres at every frame, if the scene's output asks for it; else empty.
    pub trajectory: Vec<Snapshot>,
    /// Processor time of the run (s). Differs from run to run.
    pub cpu_seconds: f64,
}

/// States of all spheres that a record holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum States<'a> {
    /// At every frame.
    Trajectory(&'a [Snapshot]),
    /// Now and then.
    Snapshots(&'a [Snapshot]),
}

impl RunRecord {
    /// The finest states of all spheres that the record holds: its trajectory, or else its
    /// snapshots.
    pub fn states(&self) -> States<'_> {
        if self.trajectory.is_empty() {
            States::Snapshots(&self.snapshots)
        } else {
            States::Trajectory(&self.trajectory)
        }
    }

    /// Those states without the one that broke a guard, whose numbers mean nothing.
    pub fn sound_states(&self) -> &[Snapshot] {
        let states = self.states().all();
        match &self.outcome {
            Outcome::Unstable(broken) => {
                let sound = states.iter().take_while(|state| state.time < broken.time);
                &states[..sound.count()]
            }
            Outcome::Completed => states,
        }
    }
}

impl<'a> States<'a> {
    /// The states, in order of time.
    pub fn all(self) -> &'a [Snapshot] {
        match self {
            Self::Trajectory(states) | Self::Snapshots(states) => states,
        }
    }
}

impl std::fmt::Display for States<'_> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Trajectory(_) => formatter.write_str("the trajectory, every frame"),
            Self::Snapshots(_) => formatter.write_str("the snapshots, as there is no trajectory"),
        }
    }
}

/// The program that made a record.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Program {
    /// Version of this package.
    pub version: String,
    /// Commit it was built from, or "unknown".
    pub commit: String,
}

impl Program {
    /// The program that is running.
    pub fn current() -> Self {
        Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            commit: env!("PHASE_COMMIT").to_owned(),
        }
    }
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// It reached its duration.
    Completed,
    /// A guard ended it.
    Unstable(Instability),
}

/// Something that happened once in a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Milestone {
    /// What it was.
    pub kind: MilestoneKind,
    /// When (s).
    pub time: f64,
}

/// What may happen once in a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MilestoneKind {
    /// The last sphere came in.
    Filled,
    /// The spheres came to rest; the time is that from which they were.
    AtRest,
    /// The door opened.
    DoorOpened,
    /// The last sphere left.
    Emptied,
}

impl MilestoneKind {
    /// All kinds.
    pub const ALL: [Self; 4] = [Self::Filled, Self::AtRest, Self::DoorOpened, Self::Emptied];

    /// Name, as in records and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Filled => "filled",
            Self::AtRest => "at rest",
            Self::DoorOpened => "door opened",
            Self::Emptied => "emptied",
        }
    }
}

/// What broke, when and where.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{guard} guard at step {step} (t = {time:.6} s), sphere {sphere}: {detail}")]
pub struct Instability {
    /// Which guard.
    pub guard: Guard,
    /// Step at which it was found, counted from 1.
    pub step: u64,
    /// Time of that step (s).
    pub time: f64,
    /// Index of the sphere, from 0.
    pub sphere: usize,
    /// The value that broke the limit, and the limit.
    pub detail: String,
}

/// A numerical guard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Guard {
    /// A position or velocity is not a number, or a spin beyond all numbers.
    NotANumber,
    /// A centre is out of bounds.
    OutOfBounds,
    /// Two spheres, or a sphere and a wall, overlap too far.
    Overlap,
    /// A sphere moved too far in one step.
    Displacement,
    /// A disc passed between two fixed ones where there is no way through.
    WallPassed,
}

impl Guard {
    /// All guards.
    pub const ALL: [Self; 5] = [
        Self::NotANumber,
        Self::OutOfBounds,
        Self::Overlap,
        Self::Displacement,
        Self::WallPassed,
    ];

    /// Name, as in records and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::NotANumber => "not-a-number",
            Self::OutOfBounds => "out-of-bounds",
            Self::Overlap => "overlap",
            Self::Displacement => "displacement",
            Self::WallPassed => "wall-passed",
        }
    }
}

impl std::fmt::Display for Guard {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str(self.name())
    }
}
