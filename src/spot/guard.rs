//! Guards: a simulation that breaks one ends with an error and is never corrected.

use crate::particles::vector::Vector;
use std::fmt;

/// What ended a simulation, when and where.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{guard} guard at move {moves} (t = {time:.6} s) at {place:?}{}: {detail}", of(*.sphere))]
pub struct SpotFailure {
    /// Which guard.
    pub guard: SpotGuard,
    /// Moves of spots made before it.
    pub moves: u64,
    /// Time (s).
    pub time: f64,
    /// Where: the centre of the sphere, or of the spot (m).
    pub place: Vector,
    /// Number of the sphere, from 0, if a sphere broke the guard.
    pub sphere: Option<u32>,
    /// The value that broke the limit, and the limit.
    pub detail: String,
}

fn of(sphere: Option<u32>) -> String {
    sphere.map_or_else(String::new, |number| format!(", sphere {number}"))
}

/// What is guarded against.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpotGuard {
    /// A displacement is not a number: two centres coincide.
    NotANumber,
    /// A sphere was displaced by more than half a diameter at once.
    Displacement,
    /// More spheres are near one sphere than is possible.
    Crowded,
    /// A spot found no sphere, although there are spheres above it on all sides.
    EmptySpot,
}

impl SpotGuard {
    /// Name, as in records and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::NotANumber => "not-a-number",
            Self::Displacement => "displacement",
            Self::Crowded => "crowded",
            Self::EmptySpot => "empty-spot",
        }
    }
}

impl fmt::Display for SpotGuard {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
    }
}

/// A broken guard where time and count of moves are not known.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Fault {
    pub(crate) guard: SpotGuard,
    pub(crate) place: Vector,
    /// Slot of the sphere in the arrays, if it is one.
    pub(crate) slot: Option<u32>,
    pub(crate) detail: String,
}
