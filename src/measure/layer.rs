//! A horizontal layer of a tank, and what is measured in it.

use crate::scene::{Layer, Scene};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// The layer of a scene's output, which may depend on how high the spheres are.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LayerOfScene {
    /// Cross-section of the tank (m2).
    area: f64,
    /// Height of the floor (m).
    floor: f64,
    /// The layer that the scene states.
    stated: Option<Layer>,
    /// Period along z (m): the layer is then the whole period.
    period: Option<f64>,
}

impl LayerOfScene {
    /// That of a scene that has a cross-section, and a floor, a stated layer or a period along z.
    pub fn new(scene: &Scene) -> Option<Self> {
        let floor = scene.tank.as_ref().and_then(|tank| tank.floor);
        let stated = scene.output.layer;
        let bottom = stated.map(|it| it.z_min);
        let [_, _, period] = scene.domain().periods();
        Some(Self {
            area: scene.cross_section()?,
            floor: floor.or(bottom).or(period.map(|_| 0.0))?,
            stated,
            period,
        })
    }

    /// The layer when the centres are at this mean height (m).
    pub fn at(&self, height_mean: f64) -> TankLayer {
        let [bottom, top] = match self.stated {
            Some(Layer { z_min, z_max }) => [z_min, z_max],
            None => [self.floor, self.floor + 2.0 * (height_mean - self.floor)],
        };
        TankLayer {
            bottom,
            top,
            area: self.area,
            period: self.period,
        }
    }
}

/// A horizontal layer of a tank.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TankLayer {
    /// Height of its lower side (m).
    pub bottom: f64,
    /// Height of its upper side (m).
    pub top: f64,
    /// Cross-section of the tank (m2).
    pub area: f64,
    /// Period along z (m). The layer is then the whole period, whatever its sides.
    pub period: Option<f64>,
}

impl TankLayer {
    /// Its volume (m3); not a number of a layer without height.
    pub fn volume(&self) -> f64 {
        let height = self.period.unwrap_or(self.top - self.bottom);
        if height > 0.0 {
            self.area * height
        } else {
            f64::NAN
        }
    }

    /// Whether a height (m) is in it. Its lower side belongs to it.
    pub fn contains(&self, z: f64) -> bool {
        self.period.is_some() || (self.bottom <= z && z < self.top)
    }

    /// Volume (m3) of the part of a sphere that is in it: between two planes.
    pub fn part_of_sphere(&self, z: f64, radius: f64) -> f64 {
        if self.period.is_some() {
            return 4.0 / 3.0 * PI * radius * radius * radius;
        }
        // Below a plane at t radii above the centre lies pi r^3 (2/3 + t - t^3/3).
        let below = |height: f64| {
            let t = ((height - z) / radius).clamp(-1.0, 1.0);
            t - t * t * t / 3.0
        };
        PI * radius * radius * radius * (below(self.top) - below(self.bottom))
    }

    /// Share of a line between two heights (m) that is in it.
    pub fn share_of_line(&self, ends: [f64; 2]) -> f64 {
        let [low, high] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
        if self.period.is_some() || (low >= self.bottom && high <= self.top) {
            return 1.0;
        }
        let inside = high.min(self.top) - low.max(self.bottom);
        // A level line outside has no length either.
        if inside > 0.0 {
            inside / (high - low)
        } else {
            0.0
        }
    }
}

/// Sums over spheres, from which their shear rate follows.
#[derive(Clone, Copy, Debug, Default)]
pub struct ShearSums {
    count: f64,
    height: f64,
    height_squared: f64,
    velocity: [f64; 2],
    product: [f64; 2],
}

impl ShearSums {
    /// Adds a sphere at a height (m) above any fixed one, with this horizontal velocity (m/s).
    pub fn add(&mut self, height: f64, velocity: [f64; 2]) {
        self.count += 1.0;
        self.height += height;
        self.height_squared += height * height;
        for (axis, velocity) in velocity.into_iter().enumerate() {
            self.velocity[axis] += velocity;
            self.product[axis] += height * velocity;
        }
    }

    /// Change of the horizontal velocity with height (1/s), by least squares; not a number for
    /// spheres of one height.
    pub fn rate(&self) -> f64 {
        let spread = self.height_squared - self.height * self.height / self.count;
        let slope = |axis: usize| {
            let together = self.height * self.velocity[axis] / self.count;
            (self.product[axis] - together) / spread
        };
        if spread > 0.0 {
            libm::hypot(slope(0), slope(1))
        } else {
            f64::NAN
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const LAYER: TankLayer = TankLayer {
        bottom: 1.0,
        top: 3.0,
        area: 2.0,
        period: None,
    };

    /// Rows: height, radius, volume over pi.
    #[test]
    fn the_part_of_a_sphere_in_the_layer_is_exact() {
        for (z, radius, expected) in [
            (2.0, 0.5, 4.0 / 3.0 * 0.125),
            (1.0, 0.5, 2.0 / 3.0 * 0.125),
            (3.0, 0.5, 2.0 / 3.0 * 0.125),
            (0.5, 0.5, 0.0),
            (4.0, 0.5, 0.0),
            // A cap of height h: pi h^2 (3 r - h) / 3.
            (0.75, 0.5, 0.0625 * 1.25 / 3.0),
            // A layer thinner than the sphere, about its middle: pi (2 r^2 - 2/3) h for h = 1.
            (2.0, 2.0, 8.0 - 2.0 / 3.0),
        ] {
            let volume = LAYER.part_of_sphere(z, radius) / PI;
            assert!((volume - expected).abs() < 1e-12, "{z}, {radius}: {volume}");
        }
    }

    /// Rows: both ends, share.
    #[test]
    fn the_share_of_a_line_in_the_layer_is_exact() {
        for (ends, expected) in [
            ([1.0, 3.0], 1.0),
            ([2.0, 2.0], 1.0),
            ([0.0, 2.0], 0.5),
            ([5.0, 1.0], 0.5),
            ([0.0, 4.0], 0.5),
            ([0.0, 0.5], 0.0),
            ([4.0, 4.0], 0.0),
        ] {
            assert_eq!(LAYER.share_of_line(ends), expected);
        }
    }

    proptest! {
        #[test]
        fn linear_shear_has_its_rate_wherever_it_moves(
            rates in prop::array::uniform2(-10.0..10.0),
            drift in prop::array::uniform2(-10.0..10.0),
            heights in prop::collection::vec(0.0..1.0, 2..40),
        ) {
            let mut sums = ShearSums::default();
            for z in [0.0, 1.0].into_iter().chain(heights) {
                sums.add(z, [0, 1].map(|axis| drift[axis] + rates[axis] * z));
            }
            let expected = libm::hypot(rates[0], rates[1]);
            prop_assert!((sums.rate() - expected).abs() < 1e-10);
        }
    }
}
