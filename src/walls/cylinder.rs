//! The cylindrical wall about the z axis.

use super::{ContactSurface, WallContact};
use crate::particles::math::inverse_square_root;
use crate::particles::vector::Vector;

/// A vertical cylinder about the z axis, with the spheres inside.
#[derive(Clone, Copy, Debug)]
pub struct Cylinder {
    /// Its radius (m).
    pub radius: f64,
}

impl ContactSurface for Cylinder {
    #[inline(always)]
    fn contact(&self, centre: Vector, radius: f64) -> WallContact {
        let reach = self.radius - radius;
        let distance_squared = centre.x * centre.x + centre.y * centre.y;
        let inverse_distance = inverse_square_root(distance_squared);
        WallContact {
            touches: !(distance_squared <= reach * reach),
            overlap: distance_squared * inverse_distance - reach,
            normal: Vector::new(-centre.x, -centre.y, 0.0) * inverse_distance,
        }
    }

    #[inline(always)]
    fn is_near(&self, centre: Vector, radius: f64, margin: f64) -> bool {
        // `contact` compares squares, so a negative reach counts by its absolute value.
        let reach = (self.radius - radius).abs() - margin;
        reach < 0.0 || centre.x * centre.x + centre.y * centre.y > reach * reach
    }
}
