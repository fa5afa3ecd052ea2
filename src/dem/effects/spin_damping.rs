//! Viscous damping of spins: torque = -c w.

use super::Effect;
use crate::dem::particles::Particles;
use crate::scene;

pub(super) struct SpinDamping {
    coefficient: f64,
}

impl SpinDamping {
    pub(super) fn new(parameters: &scene::SpinDamping) -> Self {
        Self {
            coefficient: parameters.coefficient,
        }
    }
}

impl Effect for SpinDamping {
    fn apply(&mut self, particles: &mut Particles, _: &[u32]) {
        for (torque, &spin) in particles.torque.iter_mut().zip(&particles.spin) {
            *torque -= spin * self.coefficient;
        }
    }
}
