//! What is measured on a simulation while it runs, frame by frame.

mod frame;
mod observations;
mod observer;
mod reduce;

pub use frame::{FRAME_BLOCK, Flow, Frame, FrameView, Ledger};
pub use observations::{Observations, Series, Snapshot};
pub use observer::Observer;
