//! Gravity: F = m g, straight down or tilted.

use super::OneBody;
use crate::dem::particles::Particles;
use crate::dem::profile::Part;
use crate::scene;

pub(super) struct Gravity {
    /// Components along x and z (m/s2).
    acceleration: [f64; 2],
}

impl Gravity {
    pub(super) fn new(parameters: &scene::Gravity) -> Self {
        Self {
            acceleration: parameters.components(),
        }
    }
}

impl OneBody for Gravity {
    const PART: Part = Part::Gravity;

    #[inline(always)]
    fn add(&mut self, particles: &mut Particles, _: &[u32]) {
        let [x, z] = self.acceleration;
        for (force, mass) in particles.force.iter_mut().zip(&particles.mass) {
            force.z += mass * z;
        }
        if x != 0.0 {
            for (force, mass) in particles.force.iter_mut().zip(&particles.mass) {
                force.x += mass * x;
            }
        }
    }

    fn energy(&self, particles: &Particles) -> Option<f64> {
        let [x, z] = self.acceleration;
        let moving = particles.fixed..particles.len();
        let energy = moving.map(|i| {
            let (mass, place) = (particles.mass[i], particles.position[i]);
            -mass * (x * place.x + z * place.z)
        });
        Some(energy.sum())
    }
}
