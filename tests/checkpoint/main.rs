//! A run that was interrupted goes on from its checkpoint with the bits of one that was not.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod bench;
mod bits;
mod runs;
#[path = "../scenes/mod.rs"]
mod scenes;
#[path = "../support/mod.rs"]
mod support;
mod sweeps;
