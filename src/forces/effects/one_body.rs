//! An effect on the spheres of a block, and its loop, compiled for each instruction set.

use crate::particles::Particles;
use crate::particles::bodies::{Asked, Bodies};
use crate::particles::vector::Vector;
use fearless_simd::Level;

/// An effect adds to the forces and torques of the spheres.
pub(crate) trait Effect: Send + Sync {
    /// Prepares the forces of a moment, `time` (s) after the start. `shielding` is, for each
    /// sphere, the number of lower spheres that shield it from the updraught; empty in a scene
    /// without updraught.
    fn prepare(&mut self, time: f64, shielding: &[u32]);

    /// Adds its forces and torques to a block of spheres.
    fn apply(&self, level: Level, bodies: &mut Bodies);

    /// Which columns it reads.
    fn asks(&self) -> Asked;

    /// The acceleration (m/s2) at the moment that was prepared, if it only accelerates all spheres
    /// equally; where all effects do, the block loop is skipped.
    fn acceleration(&self) -> Option<Vector>;

    /// Reorders per-sphere arrays after the spheres were sorted.
    fn reorder(&mut self, order: &[u32]);

    /// The potential energy (J) of all spheres, if the force has one.
    fn energy(&self, particles: &Particles) -> Option<f64>;
}

/// The loop of an effect, compiled once per instruction set.
pub(super) trait OneBody: Send + Sync {
    /// As [`Effect::asks`].
    const ASKS: Asked;

    /// As [`Effect::prepare`].
    fn prepare(&mut self, _time: f64, _shielding: &[u32]) {}

    /// As [`Effect::apply`]; implementations must be inlined always.
    fn add(&self, bodies: &mut Bodies);

    /// As [`Effect::acceleration`].
    fn acceleration(&self) -> Option<Vector> {
        None
    }

    /// As [`Effect::reorder`]; needed if the effect [keeps numbers per
    /// sphere](super::EffectKeys::keeps_numbers_per_sphere).
    fn reorder(&mut self, _order: &[u32]) {}

    /// As [`Effect::energy`].
    fn energy(&self, _particles: &Particles) -> Option<f64> {
        None
    }
}

impl<E: OneBody> Effect for E {
    fn prepare(&mut self, time: f64, shielding: &[u32]) {
        OneBody::prepare(self, time, shielding);
    }

    fn apply(&self, level: Level, bodies: &mut Bodies) {
        fearless_simd::dispatch!(level, simd => {
            let _ = simd;
            self.add(bodies);
        });
    }

    fn asks(&self) -> Asked {
        E::ASKS
    }

    fn acceleration(&self) -> Option<Vector> {
        OneBody::acceleration(self)
    }

    fn reorder(&mut self, order: &[u32]) {
        OneBody::reorder(self, order);
    }

    fn energy(&self, particles: &Particles) -> Option<f64> {
        OneBody::energy(self, particles)
    }
}
