//! The loaded spring of a contact that sticks.

use crate::dem::vector::Vector;
use serde::{Deserialize, Serialize};

/// The loaded spring of a contact that sticks.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct Spring {
    /// Its force (N).
    pub(super) force: Vector,
}

impl Spring {
    /// The force (N) in the plane across `normal`: the plane turns with the pair, and the force with
    /// it, its length kept.
    #[inline(always)]
    pub(super) fn turned(&self, normal: Vector) -> Vector {
        let turned = self.force.perpendicular_to(normal);
        let (before, after) = (self.force.norm_squared(), turned.norm_squared());
        if after > 0.0 {
            turned * (before / after).sqrt()
        } else {
            Vector::ZERO
        }
    }
}
