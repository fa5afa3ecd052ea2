//! Figures of synthetic tables: what they show, what their files hold, what they refuse.
//!
//! Every figure drawn here is left in `target/tmp` to look at.

pub(crate) mod bench;
mod diagrams;
mod files;
mod panels;
mod places;
