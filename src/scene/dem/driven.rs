//! Spheres that move along prescribed paths.

use crate::document::unit;
use crate::particles::vector::Vector;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A sphere that moves along a prescribed path, independent of forces: x(t) = x(0) + v t + A (sin(w
/// t + p) - sin p). It keeps its initial spin. Other spheres collide with it; it passes through
/// walls, fixed spheres and other driven ones. It is never removed, may leave the bounds of
/// `guards`, and is ignored when spheres are checked to be at rest. A driven sphere from a feed
/// follows its path from its entry on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Driven {
    /// Index of the sphere in the start, from 0; for a feed, in the order of entry.
    pub sphere: usize,
    /// Constant velocity v (m/s); its initial velocity is ignored.
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

    /// The largest distance (m) from its start within a time (s).
    pub(crate) fn farthest(&self, time: f64) -> f64 {
        let swings = self.angular_frequency != 0.0;
        let swing = if swings { 2.0 } else { 0.0 } * Vector::from(self.amplitude).norm();
        Vector::from(self.velocity).norm() * time + swing
    }

    /// Its largest speed (m/s).
    pub(crate) fn fastest(&self) -> f64 {
        let swing = Vector::from(self.amplitude).norm() * self.angular_frequency.abs();
        Vector::from(self.velocity).norm() + swing
    }
}
