//! The complete state of a simulation, which checkpoints hold.

use super::slack::Wear;
use super::walk::MovingSpot;
use crate::particles::vector::Vector;
use serde::{Deserialize, Serialize};

/// Everything on which the rest of a simulation depends, besides its parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct SpotState {
    pub(crate) seed: u64,
    /// Up to which time everything has happened (s).
    pub(crate) time: f64,
    /// Time of the next insertion or move (s).
    pub(crate) next_event: f64,
    /// Number of steps so far.
    pub(crate) steps: u64,
    /// Spots, in order of insertion if they move in steps.
    pub(crate) spots: Vec<MovingSpot>,
    /// Centres in the order of the last sorting (m).
    pub(crate) position: Vec<Vector>,
    /// The same at the time of the sorting (m).
    pub(crate) reference: Vec<Vector>,
    /// Numbers of these spheres.
    pub(crate) id: Vec<u32>,
    /// Where spheres were when they left (m), in order of their numbers.
    pub(crate) left: Vec<Option<Vector>>,
    pub(crate) wear: Wear,
    /// If the newest spots move first: number of present spots that move in the lower part of the
    /// next step.
    pub(crate) lower: u32,
    pub(crate) counts: SpotCounts,
    /// Number of random numbers drawn for the walk, and for relaxations.
    pub(crate) drawn: [u64; 2],
}

/// What has happened.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct SpotCounts {
    /// Spots inserted.
    pub inserted: u64,
    /// Spots removed above the packing.
    pub removed: u64,
    /// Moves of spots.
    pub moves: u64,
    /// Relaxations around spots.
    pub relaxations: u64,
    /// Relaxations of all spheres.
    pub global_relaxations: u64,
    /// How often the spheres were sorted.
    pub sorts: u64,
}

/// Why a simulation cannot start or be restored.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SpotError {
    /// A parameter is invalid.
    #[error(transparent)]
    Parameter(#[from] super::check::ParameterError),
    /// A sphere lies outside the box.
    #[error("sphere {sphere} at {place:?} is not inside the box")]
    Outside {
        /// Its number.
        sphere: usize,
        /// Its centre (m).
        place: Vector,
    },
    /// There are too many spheres for 32-bit numbers.
    #[error("{0} spheres are too many")]
    TooMany(usize),
    /// Spheres are too near each other for lists of neighbours.
    #[error("{0}")]
    Failure(Box<super::guard::SpotFailure>),
    /// A checkpoint cannot be read.
    #[error("not a checkpoint of a spot simulation: {0}")]
    Checkpoint(String),
    /// A checkpoint was made with other parameters.
    #[error("the checkpoint belongs to a simulation with other parameters")]
    OtherParameters,
    /// Threads cannot be started.
    #[error("cannot start threads: {0}")]
    Threads(String),
}

impl SpotState {
    /// Finds what would make the engine fail: arrays of different lengths, numbers out of range.
    pub(crate) fn check(&self) -> Result<(), String> {
        let spheres = self.id.len();
        if self.position.len() != spheres || self.reference.len() != spheres {
            return Err("its arrays have different lengths".to_owned());
        }
        if self.lower as usize > self.spots.len() {
            return Err("it has fewer spots than its lower part".to_owned());
        }
        if self.id.iter().any(|&id| id as usize >= self.left.len()) {
            return Err("a number of a sphere is out of range".to_owned());
        }
        let centres = self.reference.iter().chain(&self.position);
        if centres.into_iter().any(|it| !it.norm_squared().is_finite()) {
            return Err("a centre is not a number".to_owned());
        }
        Ok(())
    }
}
