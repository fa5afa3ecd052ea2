//! The cylindrical wall about the z axis.

use super::Wall;
use crate::dem::vector::Vector;

/// A vertical cylinder about the z axis, with the spheres inside.
#[derive(Clone, Copy, Debug)]
pub struct Cylinder {
    /// Its radius (m).
    pub radius: f64,
}

impl Wall for Cylinder {
    #[inline(always)]
    fn touch(&self, centre: Vector, radius: f64) -> Option<(f64, Vector)> {
        let reach = self.radius - radius;
        let distance_squared = centre.x * centre.x + centre.y * centre.y;
        if distance_squared <= reach * reach {
            return None;
        }
        let distance = distance_squared.sqrt();
        let normal = Vector::new(-centre.x / distance, -centre.y / distance, 0.0);
        Some((distance - reach, normal))
    }
}
