//! When spheres count as at rest.

use crate::dem::particles::Particles;
use crate::scene::Rest;

/// Watches the kinetic energy of every sphere.
///
/// The limit of the scene is for all of its spheres together, so each of them may have an equal
/// share. A total alone says nothing of single spheres: a few that still flow are lost in the sum.
pub(super) struct RestWatch {
    /// Largest kinetic energy of one sphere at rest (J), that of its spin included.
    share: f64,
    /// Steps for which all spheres must stay below it.
    hold: u64,
    /// Step since which they have.
    pub(super) since: Option<u64>,
}

impl RestWatch {
    /// A watch over a scene of `count` spheres, those included that are not in yet.
    pub(super) fn new(rest: &Rest, count: usize, dt: f64) -> Self {
        Self {
            share: rest.kinetic_energy / count as f64,
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
        let mut moving = particles.fixed..particles.len();
        if !(all_in && moving.all(|sphere| kinetic_energy(particles, sphere) < self.share)) {
            self.since = None;
            return None;
        }
        let since = *self.since.get_or_insert(step);
        (step - since >= self.hold).then_some(since)
    }
}

/// Translational and rotational kinetic energy of a sphere (J).
fn kinetic_energy(particles: &Particles, sphere: usize) -> f64 {
    let translational = particles.mass[sphere] * particles.velocity[sphere].norm_squared();
    let rotational = match particles.rotate() {
        true => particles.inertia[sphere] * particles.spin[sphere].norm_squared(),
        false => 0.0,
    };
    0.5 * (translational + rotational)
}
