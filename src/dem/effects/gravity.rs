//! Gravity: F = -m g along z.

use super::Effect;
use crate::dem::particles::Particles;
use crate::scene;

pub(super) struct Gravity {
    acceleration: f64,
}

impl Gravity {
    pub(super) fn new(parameters: &scene::Gravity) -> Self {
        Self {
            acceleration: parameters.acceleration,
        }
    }
}

impl Effect for Gravity {
    fn apply(&mut self, particles: &mut Particles, _: &[u32]) {
        for (force, mass) in particles.force.iter_mut().zip(&particles.mass) {
            force.z -= mass * self.acceleration;
        }
    }
}
