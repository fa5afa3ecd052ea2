//! What is measured of snapshots: positions and radii, whichever model made them.

mod badness;
mod grid;
mod packing;
mod polyhedron;
mod radial_distribution;
mod region;
mod stagnant;
mod surface;
#[cfg(test)]
mod synthetic;
mod voronoi;

pub use badness::Badness;
pub use grid::{CellGrid, Centres};
pub use packing::packing_fraction;
pub use radial_distribution::RadialDistribution;
pub use region::Region;
pub use stagnant::stagnant_height;
pub use surface::surface_angle;
pub use voronoi::{VoronoiCell, Walls, local_packing_fraction, voronoi_cells};
