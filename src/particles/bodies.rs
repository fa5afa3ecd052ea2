//! A block of spheres, one column per quantity. Effects on single spheres are computed for a whole
//! block at once.

use super::block::{BLOCK, Column, Columns};

/// Columns that effects read besides masses and forces. The engine fills them in `dem/bodies.rs`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Asked {
    /// Centres and velocities.
    pub(crate) motion: bool,
    /// Spins, and torques to add to.
    pub(crate) turn: bool,
}

impl Asked {
    /// The columns of both.
    pub(crate) fn or(self, other: Self) -> Self {
        Self {
            motion: self.motion || other.motion,
            turn: self.turn || other.turn,
        }
    }
}

/// A block of spheres. Lanes without a sphere repeat the last one.
pub(crate) struct Bodies {
    /// Index of the first sphere.
    pub(crate) first: usize,
    /// Number of spheres.
    pub(crate) count: usize,
    /// Forces so far (N).
    pub(crate) force: Columns,
    /// Centres (m), if they are asked for.
    pub(crate) position: Columns,
    /// Velocities (m/s), if they are asked for.
    pub(crate) velocity: Columns,
    /// Spins (rad/s), if they are asked for.
    pub(crate) spin: Columns,
    /// Torques so far (N m), if they are asked for.
    pub(crate) torque: Columns,
    /// Masses (kg).
    pub(crate) mass: Column,
}

impl Bodies {
    pub(crate) fn new() -> Self {
        Self {
            first: 0,
            count: 0,
            force: Columns::ZERO,
            position: Columns::ZERO,
            velocity: Columns::ZERO,
            spin: Columns::ZERO,
            torque: Columns::ZERO,
            mass: [0.0; BLOCK],
        }
    }
}
