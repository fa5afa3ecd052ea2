//! Observables of a running simulation, frame by frame.

mod columns;
mod observations;
mod observer;
mod reduce;

pub use crate::simulation::{Column, FRAME_BLOCK, Flow, Frame, FrameView, Ledger, Snapshot};
pub use observations::{Observations, OwnSeries, ScalarSeries};
pub use observer::Observer;
