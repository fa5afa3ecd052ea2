//! The horizontal floor.

use super::Wall;
use crate::dem::vector::Vector;

/// A horizontal floor.
#[derive(Clone, Copy, Debug)]
pub struct Floor {
    /// Its height (m).
    pub height: f64,
}

impl Wall for Floor {
    #[inline(always)]
    fn touch(&self, centre: Vector, radius: f64) -> Option<(f64, Vector)> {
        let overlap = radius - (centre.z - self.height);
        (overlap > 0.0).then_some((overlap, Vector::new(0.0, 0.0, 1.0)))
    }
}
