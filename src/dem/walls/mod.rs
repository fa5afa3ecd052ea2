//! Walls: one file each. A wall says where a sphere touches it; the contact laws do the rest.

mod cylinder;
mod plane;

pub use cylinder::Cylinder;
pub use plane::Floor;

use super::vector::Vector;

/// Where a sphere is with respect to a wall.
#[derive(Clone, Copy, Debug)]
pub struct WallContact {
    /// Whether it touches; the rest means nothing if it does not.
    pub touches: bool,
    /// Overlap (m, positive).
    pub overlap: f64,
    /// Unit normal into the tank.
    pub normal: Vector,
}

/// A wall at rest.
pub trait Wall: Copy + Send + 'static {
    /// 1 / the distance of a centre from the wall's axis (1/m), if it has one.
    fn inverse_distance(&self, centre: Vector) -> f64;

    /// How a sphere there, whose [`inverse_distance`](Self::inverse_distance) this is, touches the wall. Free of
    /// branches, for a block of spheres at once.
    fn contact(&self, centre: Vector, radius: f64, inverse_distance: f64) -> WallContact;

    /// The same where nothing is known.
    fn meet(&self, centre: Vector, radius: f64) -> WallContact {
        self.contact(centre, radius, self.inverse_distance(centre))
    }

    /// Whether a sphere there touches the wall, or will after a way of `margin` (m).
    fn is_near(&self, centre: Vector, radius: f64, margin: f64) -> bool;
}
