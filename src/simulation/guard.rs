//! Numerical guards, and what they report.

use serde::Serialize;

/// What broke, when and where.
#[derive(Clone, Debug, PartialEq, Serialize, thiserror::Error)]
#[error("{guard} guard at step {step} (t = {time:.6} s), sphere {sphere}: {detail}")]
pub struct Instability {
    /// Which guard.
    pub guard: Guard,
    /// Step at which it was found, counted from 1.
    pub step: u64,
    /// Time of that step (s).
    pub time: f64,
    /// Number of the sphere in the scene's start, from 0 (inside the engine, its index in memory).
    /// Fixed spheres break no guard and do not count.
    pub sphere: usize,
    /// The value that broke the limit, and the limit.
    pub detail: String,
}

/// A numerical guard.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Guard {
    /// A position or velocity is not a number, or a spin is infinite.
    NotANumber,
    /// A centre is out of bounds.
    OutOfBounds,
    /// Two spheres, or a sphere and a wall, overlap too far.
    Overlap,
    /// A sphere moved too far in one step.
    Displacement,
    /// A disc passed between two fixed ones where there is no way through.
    WallPassed,
    /// More spheres are near one sphere than is possible.
    Crowded,
    /// A spot found no sphere, although there are spheres above it.
    EmptySpot,
}

impl Guard {
    /// All guards.
    pub const ALL: [Self; 7] = [
        Self::NotANumber,
        Self::OutOfBounds,
        Self::Overlap,
        Self::Displacement,
        Self::WallPassed,
        Self::Crowded,
        Self::EmptySpot,
    ];

    /// Name, as in records and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::NotANumber => "not-a-number",
            Self::OutOfBounds => "out-of-bounds",
            Self::Overlap => "overlap",
            Self::Displacement => "displacement",
            Self::WallPassed => "wall-passed",
            Self::Crowded => "crowded",
            Self::EmptySpot => "empty-spot",
        }
    }
}

impl std::fmt::Display for Guard {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str(self.name())
    }
}
