//! When spheres count as at rest.

use crate::dem::particles::Particles;
use crate::scene::Rest;

/// Watches the kinetic energy of the spheres.
pub(super) struct RestWatch {
    kinetic_energy: f64,
    /// Steps for which the energy must stay below the limit.
    hold: u64,
    /// Step since which it has.
    pub(super) since: Option<u64>,
}

impl RestWatch {
    pub(super) fn new(rest: &Rest, dt: f64) -> Self {
        Self {
            kinetic_energy: rest.kinetic_energy,
            hold: (rest.hold / dt).ceil() as u64,
            since: None,
        }
    }

    /// Begins anew.
    pub(super) fn reset(&mut self) {
        self.since = None;
    }

    /// Looks at the spheres. The step since which they have been slow, if they are at rest by now;
    /// never before all are `in`.
    pub(super) fn since(&mut self, particles: &Particles, all_in: bool, step: u64) -> Option<u64> {
        let moving = particles.fixed..particles.len();
        let energy = moving.fold(0.0, |sum, i| {
            sum + 0.5 * particles.mass[i] * particles.velocity[i].norm_squared()
        });
        if !(all_in && energy < self.kinetic_energy) {
            self.since = None;
            return None;
        }
        let since = *self.since.get_or_insert(step);
        (step - since >= self.hold).then_some(since)
    }
}
