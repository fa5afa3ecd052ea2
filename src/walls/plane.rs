//! A plane wall: the floor, or a side.

use super::{ContactSurface, WallContact};
use crate::particles::vector::Vector;

/// A plane, with the spheres before it.
#[derive(Clone, Copy, Debug)]
pub struct Plane {
    /// Unit normal into the tank.
    pub normal: Vector,
    /// Where it is along its normal (m).
    pub place: f64,
}

impl Plane {
    /// A horizontal floor at that height (m).
    pub fn floor(height: f64) -> Self {
        Self {
            normal: Vector::new(0.0, 0.0, 1.0),
            place: height,
        }
    }

    /// The two sides across a horizontal `axis`, a unit vector, each that far (m) from the origin.
    pub fn sides(axis: Vector, reach: f64) -> [Self; 2] {
        [axis, -axis].map(|normal| Self {
            normal,
            place: -reach,
        })
    }

    #[inline(always)]
    fn overlap(&self, centre: Vector, radius: f64) -> f64 {
        radius - (centre.dot(self.normal) - self.place)
    }
}

impl ContactSurface for Plane {
    #[inline(always)]
    fn contact(&self, centre: Vector, radius: f64) -> WallContact {
        let overlap = self.overlap(centre, radius);
        WallContact {
            touches: overlap > 0.0,
            overlap,
            normal: self.normal,
        }
    }

    #[inline(always)]
    fn is_near(&self, centre: Vector, radius: f64, margin: f64) -> bool {
        self.overlap(centre, radius) > -margin
    }
}
