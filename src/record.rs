//! The record of one run, in memory.

use crate::observe::{Observations, Snapshot};
use crate::scene::Scene;
pub use crate::simulation::{Guard, Instability, Milestone, MilestoneKind};

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
    /// What happened once, in order of time; only in scenes where spheres come or go, or that end
    /// when they are steady.
    pub milestones: Vec<Milestone>,
    /// Observables of every frame.
    pub observations: Observations,
    /// All spheres at the times of snapshots; the last one is the end of the run.
    pub snapshots: Vec<Snapshot>,
    /// All spheres at every frame, if the scene's output asks for it; else empty.
    pub trajectory: Vec<Snapshot>,
    /// Work of the run, in the unit of its model; 0 if it is not known.
    pub work: u64,
    /// Processor time of the run (s). Differs from run to run.
    pub cpu_seconds: f64,
}

/// States of all spheres that a record holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum States<'a> {
    /// At every frame.
    Trajectory(&'a [Snapshot]),
    /// At the times of snapshots.
    Snapshots(&'a [Snapshot]),
}

impl RunRecord {
    /// Whether the run became steady before its time was up; none in a scene that does not ask for
    /// it, and of a run that a guard ended.
    pub fn is_steady(&self) -> Option<bool> {
        let is_asked = self.scene.steady.is_some() && self.outcome == Outcome::Completed;
        is_asked.then(|| self.steady_since().is_some())
    }

    /// Time (s) since when the run is steady, in a scene that asks for it, if it ever was.
    pub fn steady_since(&self) -> Option<f64> {
        let mut milestones = self.milestones.iter();
        let steady = milestones.find(|it| it.kind == MilestoneKind::Steady);
        steady.map(|it| it.time)
    }

    /// The finest states of all spheres that the record holds: its trajectory, or else its
    /// snapshots.
    pub fn states(&self) -> States<'_> {
        if self.trajectory.is_empty() {
            States::Snapshots(&self.snapshots)
        } else {
            States::Trajectory(&self.trajectory)
        }
    }

    /// The record with every sphere at its image in the box of a periodic space, as pictures and
    /// other programs show it.
    #[must_use]
    pub fn wrapped(mut self) -> Self {
        let domain = self.scene.domain();
        if !domain.is_open() {
            for state in self.snapshots.iter_mut().chain(&mut self.trajectory) {
                *state = state.wrapped(domain).into_owned();
            }
        }
        self
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
    /// It reached its duration, or an earlier end that its scene asks for.
    Completed,
    /// A guard ended it.
    Unstable(Instability),
}
