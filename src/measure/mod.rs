//! What is measured of snapshots: positions and radii, whichever model made them.

mod axis;
mod badness;
mod bins;
mod blocks;
mod bond_angles;
mod crystal;
mod diffusion;
mod filled_box;
mod flow_width;
mod grid;
mod layers;
mod mixing;
mod outflow;
mod packing;
mod polyhedron;
mod radial_distribution;
mod region;
mod residence;
mod retention;
mod stagnant;
mod surface;
#[cfg(test)]
mod synthetic;
mod velocity_profile;
mod voronoi;

pub use axis::Axis;
pub use badness::Badness;
pub use bond_angles::BondAngles;
pub use crystal::solid_like;
pub use diffusion::Diffusion;
pub use filled_box::FilledBox;
pub use flow_width::{FlowSpread, FlowWidth, flow_spread, flow_width};
pub use grid::{CellGrid, Centres};
pub use layers::Layers;
pub use mixing::lacey_index;
pub use outflow::{count_left, outflow_rate};
pub use packing::packing_fraction;
pub use radial_distribution::RadialDistribution;
pub use region::Region;
pub use residence::{Residence, ResidenceTimes};
pub use retention::{NeighbourRetention, Retained};
pub use stagnant::stagnant_height;
pub use surface::surface_angle;
pub use velocity_profile::{ProfilePoint, VelocityProfile};
pub use voronoi::{VoronoiCell, Walls, local_packing_fraction, voronoi_cells};
