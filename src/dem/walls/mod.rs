//! Walls: one file each. A wall says where a sphere touches it; the contact laws do the rest.

mod cylinder;
mod plane;

pub use cylinder::Cylinder;
pub use plane::Floor;

use super::vector::Vector;

/// A wall at rest.
pub trait Wall: Copy + Send + 'static {
    /// Overlap (m, positive) and unit normal into the tank, if a sphere there touches the wall.
    fn touch(&self, centre: Vector, radius: f64) -> Option<(f64, Vector)>;
}
