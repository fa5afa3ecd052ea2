//! One run out of a sweep, and its spheres in the formats of other programs.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

#[path = "../support/mod.rs"]
mod support;

mod browser;
mod dumps;
mod export;
mod flat;
mod run_again;
mod view;
