//! Gravity: F = m g, straight down or tilted.

use super::OneBody;
use crate::dem::block::BLOCK;
use crate::dem::bodies::{Asked, Bodies};
use crate::dem::particles::Particles;
use crate::dem::profile::Part;
use crate::dem::vector::Vector;
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
    const ASKS: Asked = Asked {
        motion: false,
        turn: false,
    };

    #[inline(always)]
    fn add(&self, bodies: &mut Bodies) {
        let [x, z] = self.acceleration;
        let ([force_x, _, force_z], mass) = (&mut bodies.force.0, &bodies.mass);
        for k in 0..BLOCK {
            force_z[k] += mass[k] * z;
        }
        if x != 0.0 {
            for k in 0..BLOCK {
                force_x[k] += mass[k] * x;
            }
        }
    }

    fn acceleration(&self) -> Option<Vector> {
        let [x, z] = self.acceleration;
        Some(Vector::new(x, 0.0, z))
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
