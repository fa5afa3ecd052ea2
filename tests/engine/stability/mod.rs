//! Hard cases: what must hold at the limit of the time step, by every integrator, and what is
//! reported above it.
//!
//! The decisive limit is that of one contact ([`bench::at`]): there the motion stays bounded, and
//! an impact of two steps may end up to 2.4 times as fast as it began. Spheres with several
//! contacts need the limit of twelve ([`bench::crowded`]). Cases that claim accuracy besides
//! stability say at which part of a limit. Those that take minutes are ignored and have a short
//! form; `cargo test --test engine -- --ignored` runs them.

mod above;
mod bench;
mod contacts;
mod crowds;
mod extremes;
mod long;
mod size_ratio;
mod walls;
