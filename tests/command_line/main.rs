//! What each command prints, writes and returns.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod arguments;
mod bench;
mod results;
mod scenes;
#[path = "../support/mod.rs"]
mod support;
mod sweeps;
