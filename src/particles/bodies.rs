//! A block of spheres, one column per quantity. Effects on single spheres are computed for a whole
//! block at once.

use super::block::{BLOCK, BlockColumn, VectorColumns};

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
    pub(crate) force: VectorColumns,
    /// Centres (m), if requested.
    pub(crate) position: VectorColumns,
    /// Velocities (m/s), if requested.
    pub(crate) velocity: VectorColumns,
    /// Spins (rad/s), if requested.
    pub(crate) spin: VectorColumns,
    /// Torques so far (N m), if requested.
    pub(crate) torque: VectorColumns,
    /// Masses (kg).
    pub(crate) mass: BlockColumn,
}

impl Bodies {
    pub(crate) fn new() -> Self {
        Self {
            first: 0,
            count: 0,
            force: VectorColumns::ZERO,
            position: VectorColumns::ZERO,
            velocity: VectorColumns::ZERO,
            spin: VectorColumns::ZERO,
            torque: VectorColumns::ZERO,
            mass: [0.0; BLOCK],
        }
    }
}
