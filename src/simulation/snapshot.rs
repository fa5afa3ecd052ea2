//! All spheres at one instant.

use crate::particles::Domain;
use crate::particles::vector::Vector;
use ndarray::Array2;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

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

impl Snapshot {
    /// The same with every sphere at its image in the box of a periodic space.
    pub fn wrapped(&self, domain: Domain) -> Cow<'_, Self> {
        if domain.is_open() {
            return Cow::Borrowed(self);
        }
        let mut snapshot = self.clone();
        for mut centre in snapshot.position.rows_mut() {
            let Vector { x, y, z, .. } =
                domain.wrapped(Vector::new(centre[0], centre[1], centre[2]));
            [centre[0], centre[1], centre[2]] = [x, y, z];
        }
        Cow::Owned(snapshot)
    }
}
