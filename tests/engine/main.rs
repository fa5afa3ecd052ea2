//! The engine: what its motion must keep, whatever the scene, the integrator and the threads.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod allocations;
mod collisions;
mod columns;
mod determinism;
mod driven;
mod fastest;
mod integrators;
mod invariants;
mod large;
mod ledger;
mod lift;
mod motion;
mod openings;
mod order;
mod packing;
mod periodic;
mod plane_sides;
mod prescribed;
mod reproduction;
mod rolling;
#[path = "../scenes/mod.rs"]
mod scenes;
mod shaking;
mod silo;
mod spins;
mod spring_energy;
mod stability;
mod starts;
mod steel;
#[path = "../support/mod.rs"]
mod support;
mod time_scales;
mod time_step;
mod verification;
mod wall_forces;
mod walls;
