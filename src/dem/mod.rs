//! The discrete element engine.
//!
//! The effects of a [`Scene`](crate::scene::Scene) are fixed when its [`DemSimulation`] is built:
//! the inner loops are compiled for the laws in use, and what the scene does not name allocates and
//! computes nothing.
//!
//! The page `docs/engine.md` explains how it works: lists, blocks of pairs, threads, and why bits
//! depend on nothing but the input.

mod barrier;
mod bodies;
mod check;
mod columns;
mod frame;
mod guard;
mod laws;
mod model;
pub mod neighbours;
pub mod order;
mod overlap;
mod process;
mod profile;
mod simplifications;
mod simulation;
mod state;
mod system;
mod threads;
pub mod timestep;
mod wall_loads;

mod work;

pub use barrier::{WallFailure, WeakestWall};
pub(crate) use check::SAFETY_FACTOR;
pub use laws::DemBuildError;
pub use model::Dem;
pub use overlap::{Overlap, OverlapPartner, Release};
pub use profile::StepPart;
pub use simplifications::{Simplification, simplifications};
pub use simulation::DemSimulation;
pub use state::SimulationState;
