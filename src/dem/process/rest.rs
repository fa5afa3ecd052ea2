//! When spheres count as at rest.

use super::Free;
use crate::particles::Particles;
use crate::scene::Rest;

/// The limit for one sphere is the limit for all spheres over this number, or over the number of
/// spheres if that is smaller.
const PARTS: usize = 100;

/// Watches the kinetic energy of all spheres and of every single one.
///
/// The total alone is not enough: a few spheres that still flow would be lost in the sum.
pub(super) struct RestWatch {
    /// Largest kinetic energy of all spheres at rest together (J), spins included.
    all: f64,
    /// Largest kinetic energy of one sphere at rest (J), its spin included.
    one: f64,
    /// Steps for which all spheres must stay below both limits.
    hold: u64,
    /// Step since which they have been below both limits.
    pub(super) since: Option<u64>,
}

impl RestWatch {
    /// A watch over a scene of `count` free spheres, including those that are not in yet.
    pub(super) fn new(rest: &Rest, count: usize, dt: f64) -> Self {
        Self {
            all: rest.kinetic_energy,
            one: rest.kinetic_energy / count.clamp(1, PARTS) as f64,
            hold: (rest.hold / dt).ceil() as u64,
            since: None,
        }
    }

    /// Starts to wait again.
    pub(super) fn reset(&mut self) {
        self.since = None;
    }

    /// Looks at the spheres, when all have come in. Returns the step since which they have been
    /// slow, if they are at rest by now.
    pub(super) fn since(&mut self, particles: &Particles, free: &Free, step: u64) -> Option<u64> {
        if !self.are_slow(particles, free) {
            self.since = None;
            return None;
        }
        let since = *self.since.get_or_insert(step);
        (step - since >= self.hold).then_some(since)
    }

    fn are_slow(&self, particles: &Particles, free: &Free) -> bool {
        let mut sum = 0.0;
        free.indices(particles).all(|sphere| {
            let energy = kinetic_energy(particles, sphere);
            sum += energy;
            energy < self.one
        }) && sum < self.all
    }
}

/// Translational and rotational kinetic energy of a sphere (J).
fn kinetic_energy(particles: &Particles, sphere: usize) -> f64 {
    let translational = particles.inertial_mass(sphere) * particles.velocity[sphere].norm_squared();
    let rotational = match particles.rotate() {
        true => particles.inertia[sphere] * particles.spin[sphere].norm_squared(),
        false => 0.0,
    };
    0.5 * (translational + rotational)
}
