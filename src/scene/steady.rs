//! When a run counts as steady, and ends.

use crate::document::quantities::seconds;
use crate::document::{quantity, unit};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A run ends when it is steady: when the energy of motion, the rotation and the mean height have
/// no trend over the last `window` seconds, or the last third of the run if that is longer.
/// `time.duration` is the latest end; a run that reaches it is marked as not steady.
///
/// The change of each quantity over this time, plus the error of this change, must be at most
/// `tolerance` times a scale. For the energy of motion (kinetic and rotational) the scale is its
/// mean, or m g r of all spheres if larger; for the rotation its mean, or the rate at which a
/// sphere at the wall has the energy m g r; for the mean height the radius of the tank, half its
/// narrower side, or without walls the diameter of a sphere.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Steady {
    /// Shortest time without a trend (s, default 2), rounded to whole frames. At least the longest
    /// window of the sieves, which evaluate this time.
    #[schemars(transform = seconds("T_{steady}", "least steady time"))]
    pub window: f64,
    /// Largest negligible change over this time, as a share of the scale (default 0.05).
    #[schemars(
        transform = quantity("δ", "", "change that does not matter").above(0.0).at_most(1.0)
    )]
    pub tolerance: f64,
    /// Probability that one check does not end a run that changes by exactly the tolerance (default
    /// 0.95).
    #[schemars(
        transform = unit("").at_least(0.5).at_most(0.999_999)
    )]
    pub confidence: f64,
    /// Time between checks (s, default 0.5), rounded to whole frames.
    #[schemars(transform = seconds("Δt_{check}", "time between checks"))]
    pub check_interval: f64,
}

impl Default for Steady {
    fn default() -> Self {
        Self {
            window: 2.0,
            tolerance: 0.05,
            confidence: 0.95,
            check_interval: 0.5,
        }
    }
}

impl Steady {
    /// Frames from the first to the last of the window, which has one more.
    pub fn frames_of_window(&self, frame_interval: f64) -> u64 {
        (self.window / frame_interval).round() as u64
    }

    /// Frames between two checks.
    pub fn frames_per_check(&self, frame_interval: f64) -> u64 {
        ((self.check_interval / frame_interval).round() as u64).max(1)
    }
}
