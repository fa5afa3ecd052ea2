//! How far spheres may move before they are sorted again.

use super::parameters::{Parameters, Relaxation};
use crate::particles::vector::Vector;
use serde::{Deserialize, Serialize};

/// Greatest slack, in diameters.
const MOST: f64 = 0.4;

/// Intended largest share of their slack that spheres use, so that an unusually long step does not
/// use all of it.
const MOST_USED: f64 = 0.85;

/// How much of their slack spheres have used since they were sorted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Wear {
    /// One has used so much that another step may use all of it.
    pub(crate) worn: bool,
    /// One has used all of it: the spheres must be sorted before the next move.
    pub(crate) stale: bool,
    /// Number of steps since the sorting, including the present one.
    steps: u32,
    /// Square of the share of a slack from which the spheres are worn.
    limit: f64,
}

impl Wear {
    /// Begins a step. Most spheres that have moved far got there by a random walk: after s steps,
    /// the squares of distances grow by 1/s in the next step.
    pub(crate) fn begin_step(&mut self) {
        self.steps = self.steps.saturating_add(1);
        let steps = f64::from(self.steps);
        self.limit = MOST_USED * MOST_USED * steps / (steps + 1.0);
    }

    /// Nothing noted yet, at the same time.
    pub(crate) fn unused(self) -> Self {
        Self {
            worn: false,
            stale: false,
            ..self
        }
    }

    /// Notes the square of a sphere's distance from where it was sorted, and of its slack (m2).
    #[inline(always)]
    pub(crate) fn note(&mut self, distance_squared: f64, slack_squared: f64) {
        self.worn |= distance_squared > self.limit * slack_squared;
        self.stale |= distance_squared > slack_squared;
    }

    /// Merges the notes of another.
    pub(crate) fn note_all(&mut self, other: Self) {
        self.worn |= other.worn;
        self.stale |= other.stale;
    }
}

/// The distance that a sphere may move before the next sorting, as a function of its place.
///
/// Flow to an orifice is fastest there and falls off with the distance, until the random motion of
/// spheres is greater. With a slack of the same shape, spheres everywhere use it up about equally
/// fast.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slack {
    /// Slack at a distance of one diameter from the orifice's centre (m).
    near: f64,
    /// Bounds (m).
    least: f64,
    most: f64,
    diameter: f64,
    /// Greatest displacement by one move of a spot (m).
    step: f64,
}

impl Slack {
    /// The slack for these parameters: short neighbour lists if spheres are relaxed often,
    /// otherwise rare sorting.
    pub(crate) fn of(parameters: &Parameters) -> Self {
        let (near, least) = match parameters.relaxation {
            Relaxation::EveryMove => (1.2, 0.065),
            Relaxation::Off => (3.0, 0.3),
            _ => (1.8, 0.1),
        };
        let (diameter, step) = (parameters.diameter, parameters.greatest_displacement());
        Self {
            near: near * diameter,
            least: (least * diameter).max(2.0 * step),
            most: (MOST * diameter).max(2.0 * step),
            diameter,
            step,
        }
    }

    /// The same slack at all places, without spots (m).
    pub(crate) fn uniform(slack: f64, diameter: f64) -> Self {
        Self {
            near: 0.0,
            least: slack,
            most: slack,
            diameter,
            step: 0.0,
        }
    }

    /// Slack of a sphere at a place (m).
    pub(crate) fn at(&self, place: Vector) -> f64 {
        self.near_to(place, 0.0)
    }

    /// The greatest slack of spheres nearer than a distance to a place (m).
    #[inline(always)]
    pub(crate) fn near_to(&self, place: Vector, distance: f64) -> f64 {
        let from_orifice = (place.norm() - distance).max(self.diameter);
        let slack = self.near * self.diameter / from_orifice;
        slack.max(self.least).min(self.most)
    }

    /// The greatest slack anywhere (m).
    pub(crate) fn most(&self) -> f64 {
        self.most
    }

    /// How far a sphere of this slack may be from where it was sorted before the next move, which
    /// may displace it, begins (m).
    pub(crate) fn before_a_move(&self, slack: f64) -> f64 {
        slack - self.step
    }

    /// The distance (m) within which all spheres must be listed that may touch a sphere before the
    /// next sorting.
    pub(crate) fn reach(&self, place: Vector) -> f64 {
        let farthest = self.diameter + 2.0 * self.most;
        self.diameter + self.at(place) + self.near_to(place, farthest)
    }
}
