//! Drainage by spots: the model of Rycroft, Wong and Bazant, Powder Technology 200 (2010) 1-11.
//!
//! Spots of free volume rise from the orifice by a random walk. Each move of a spot displaces the
//! spheres in its range a little in the opposite direction, and then removes their overlaps. There
//! are no forces and no velocities.

mod arrangement;
mod batch;
mod board;
mod cells;
mod check;
mod crew;
mod drainage;
mod events;
mod global;
mod guard;
pub mod kinematic;
mod model;
mod moves;
mod neighbours;
pub mod packing;
mod parameters;
mod profile;
mod random;
mod region;
mod relax;
#[cfg(test)]
mod samples;
mod silo;
mod simulation;
mod slack;
mod state;
mod steps;
mod strips;
mod surface;
#[cfg(test)]
mod tests;
mod threads;
pub mod voids;
mod walk;
mod worker;

pub use check::ParameterError;
pub use drainage::SpotModel;
pub use guard::{SpotFailure, SpotGuard};
pub use parameters::{
    Influence, Parameters, Relaxation, SPOT_VOLUME_RATIO, Schedule, SpotOpening, Walk,
};
pub use simulation::SpotSimulation;
pub use state::{SpotCounts, SpotError};
pub use walk::MovingSpot;
