//! What is measured of snapshots: positions and radii, whichever model made them.

mod packing;

pub use packing::packing_fraction;
