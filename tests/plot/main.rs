//! Figures of synthetic tables: what they show, what their files hold, what they refuse.
//!
//! Every figure drawn here is left in `target/tmp` to look at.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod bench;
mod diagrams;
mod files;
mod panels;
