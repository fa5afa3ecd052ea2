//! Spheres that move along prescribed paths.

use crate::document::unit;
use crate::particles::vector::Vector;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A sphere that moves along a prescribed path, whatever acts on it:
/// x(t) = x(0) + v t + A (sin(w t + p) - sin p). It keeps the spin of its start. Others feel it as
/// any sphere; it passes walls, fixed spheres and other driven ones. It is never removed, may leave
/// the bounds of `guards`, and does not count when spheres are to be at rest. One that a feed lets
/// in moves along its path from then on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Driven {
    /// Which sphere of the start, from 0; of a feed, in the order in which they come in.
    pub sphere: usize,
    /// Constant velocity v (m/s); the velocity of its start does not count.
    #[serde(default)]
    #[schemars(transform = unit("m/s"))]
    pub velocity: [f64; 3],
    /// Amplitude A of an oscillation (m).
    #[serde(default)]
    #[schemars(transform = unit("m"))]
    pub amplitude: [f64; 3],
    /// Its angular frequency w (rad/s).
    #[serde(default)]
    #[schemars(transform = unit("rad/s"))]
    pub angular_frequency: f64,
    /// Its phase p at the start (rad).
    #[serde(default)]
    #[schemars(transform = unit("rad"))]
    pub phase: f64,
}

impl Driven {
    /// Mean velocity between two times (s).
    pub(crate) fn mean_velocity(&self, from: f64, to: f64) -> Vector {
        let sine = |time: f64| libm::sin(self.angular_frequency * time + self.phase);
        let swing = (sine(to) - sine(from)) / (to - from);
        Vector::from(self.velocity) + Vector::from(self.amplitude) * swing
    }

    /// How far from its start it may come within a time (s), at most (m).
    pub(crate) fn farthest(&self, time: f64) -> f64 {
        let swings = self.angular_frequency != 0.0;
        let swing = if swings { 2.0 } else { 0.0 } * Vector::from(self.amplitude).norm();
        Vector::from(self.velocity).norm() * time + swing
    }

    /// The fastest that it may be (m/s).
    pub(crate) fn fastest(&self) -> f64 {
        let swing = Vector::from(self.amplitude).norm() * self.angular_frequency.abs();
        Vector::from(self.velocity).norm() + swing
    }
}
