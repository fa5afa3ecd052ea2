//! Viscous damping of spins: torque = -c w.

use super::OneBody;
use crate::dem::particles::Particles;
use crate::dem::profile::Part;
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

impl OneBody for SpinDamping {
    const PART: Part = Part::SpinDamping;

    #[inline(always)]
    fn add(&mut self, particles: &mut Particles, _: &[u32]) {
        for (torque, &spin) in particles.torque.iter_mut().zip(&particles.spin) {
            *torque -= spin * self.coefficient;
        }
    }
}
