//! The horizontal floor.

use super::{Wall, WallContact};
use crate::dem::vector::Vector;

/// A horizontal floor.
#[derive(Clone, Copy, Debug)]
pub struct Floor {
    /// Its height (m).
    pub height: f64,
}

impl Wall for Floor {
    #[inline(always)]
    fn contact(&self, centre: Vector, radius: f64) -> WallContact {
        let overlap = radius - (centre.z - self.height);
        WallContact {
            touches: overlap > 0.0,
            overlap,
            normal: Vector::new(0.0, 0.0, 1.0),
        }
    }

    #[inline(always)]
    fn is_near(&self, centre: Vector, radius: f64, margin: f64) -> bool {
        radius - (centre.z - self.height) > -margin
    }
}
