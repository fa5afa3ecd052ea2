//! All spheres at one instant.

use ndarray::Array2;
use serde::{Deserialize, Serialize};

/// All spheres at one instant, in double precision.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    /// Time (s).
    pub time: f64,
    /// Centres (m), n x 3.
    pub position: Array2<f64>,
    /// Velocities (m/s), n x 3.
    pub velocity: Array2<f64>,
    /// Spins (rad/s), n x 3; empty (0 x 3) in a scene without rotation.
    pub spin: Array2<f64>,
}
