//! The interface of running models to the rest of the program.

mod column;
mod counts;
mod frame;
mod guard;
mod milestone;
mod model;
mod profile;
mod snapshot;

pub use column::Column;
pub use counts::Counts;
pub use frame::{FRAME_BLOCK, Flow, Frame, FrameView, Ledger};
pub use guard::{Guard, Instability};
pub use milestone::{Milestone, MilestoneKind};
pub use model::{BuildError, Model, Simulation, StateError};
pub use profile::{PartOfStep, Profile};
pub use snapshot::Snapshot;
