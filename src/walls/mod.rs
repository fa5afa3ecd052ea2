//! Walls. Each surface has its own file: it says where a sphere touches it, and the contact laws do
//! the rest. [`Wall`] is a surface with what else a wall of a scene has.

mod cylinder;
mod joints;
mod opening;
mod outline;
mod parallelogram;
mod plane;
mod revolved;
mod segment;
mod surface;
#[cfg(test)]
mod tests;
mod wall;

pub use cylinder::Cylinder;
pub use joints::{sharers, with_joints};
pub use opening::{Orifice, Slit};
pub use parallelogram::Parallelogram;
pub use plane::Plane;
pub use revolved::Revolved;
pub use segment::Segment;
pub use surface::{ContactSurface, WallContact, WallSurface};
pub use wall::{SurfaceMotion, Wall, WallName};
