//! Gravity: F = m g, straight down or tilted.

use super::{Effect, EffectKeys, Effects, OneBody, Targets};
use crate::document::quantity;
use crate::particles::Particles;
use crate::particles::block::BLOCK;
use crate::particles::bodies::{Asked, Bodies};
use crate::particles::vector::Vector;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Gravity.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Gravity {
    /// Acceleration g (m/s2).
    #[schemars(transform = quantity("g", "m/s²", "acceleration of gravity").at_least(0.0))]
    pub acceleration: f64,
    /// Tilt from straight down towards +x (rad, default 0): the floor is then an incline that
    /// descends along x.
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(transform = quantity("θ", "rad", "tilt of gravity"))]
    pub tilt: f64,
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

impl Gravity {
    /// Components along x and z (m/s2); there is none along y.
    pub fn components(&self) -> [f64; 2] {
        // Exact without a tilt.
        let (sine, cosine) = libm::sincos(self.tilt);
        [self.acceleration * sine, -self.acceleration * cosine]
    }

    /// Gravitational energy (J) of a mass (kg) at x and z (m): m g z without a tilt.
    pub fn energy(&self, mass: f64, x: f64, z: f64) -> f64 {
        let [gx, gz] = self.components();
        -(mass * gx * x) - mass * gz * z
    }
}

impl EffectKeys for Gravity {
    fn effect(&self, _: &Effects, _: &Targets<'_>) -> Option<Box<dyn Effect>> {
        Some(Box::new(GravityForce {
            acceleration: self.components(),
        }))
    }
}

/// F = m a, with one acceleration for all spheres.
pub(super) struct GravityForce {
    /// Components along x and z (m/s2).
    pub(super) acceleration: [f64; 2],
}

impl OneBody for GravityForce {
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
