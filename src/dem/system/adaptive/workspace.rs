//! What a step of adaptive Verlet works with.

use super::islands::{Island, Islands};
use crate::dem::particles::Particles;
use crate::dem::vector::Vector;
use crate::dem::walls::Wall;

/// What a sub-step may take of an island's fastest oscillation, h (w + g) with angular frequency w and
/// damping rate g: an impact then lasts 27 sub-steps or more.
const RESOLUTION: f64 = 0.15;

/// What a step of the scheme works with; nothing of it is needed from step to step.
#[derive(Default)]
pub(in crate::dem::system) struct Workspace<H> {
    pub(super) start: Start<H>,
    /// Forces and torques of all but contacts in the middle of the step.
    pub(super) force: Vec<Vector>,
    pub(super) torque: Vec<Vector>,
    /// What the forces at the start of the step may add to the speed of each sphere, were they twice as
    /// large (m/s), and how far it may get (m).
    pub(super) gain: Vec<f64>,
    pub(super) reach: Vec<f64>,
    /// Contacts that a step found at its end without having looked for them.
    pub(super) missed_pairs: Vec<[u32; 2]>,
    pub(super) missed_spheres: Vec<u32>,
    pub(super) islands: Islands,
    /// Squared frequency (1/s2) and damping rate (1/s) of each sphere at its contacts.
    pub(super) stiffness: Vec<f64>,
    pub(super) damping: Vec<f64>,
}

/// The spheres at the start of a step.
#[derive(Default)]
pub(super) struct Start<H> {
    pub(super) position: Vec<Vector>,
    pub(super) velocity: Vec<Vector>,
    pub(super) spin: Vec<Vector>,
    /// Latest forces and torques.
    pub(super) force: Vec<Vector>,
    pub(super) torque: Vec<Vector>,
    pub(super) pair_history: Vec<H>,
    pub(super) wall_history: [Vec<H>; 2],
}

impl<H: Copy> Start<H> {
    pub(super) fn keep(&mut self, particles: &Particles) {
        self.position.clone_from(&particles.position);
        self.velocity.clone_from(&particles.velocity);
        self.spin.clone_from(&particles.spin);
        self.force.clone_from(&particles.force);
        self.torque.clone_from(&particles.torque);
    }

    pub(super) fn put_back(&self, particles: &mut Particles) {
        particles.position.copy_from_slice(&self.position);
        particles.velocity.copy_from_slice(&self.velocity);
        particles.spin.copy_from_slice(&self.spin);
    }
}

impl<H> Workspace<H> {
    /// Finds how far each sphere may get in a step. The largest of these ways (m).
    pub(super) fn find_reach(&mut self, particles: &Particles, dt: f64) -> f64 {
        let forces = particles.force.iter().zip(&particles.inverse_mass);
        self.gain.clear();
        self.gain
            .extend(forces.map(|(force, inverse)| 2.0 * force.norm() * (inverse * dt)));
        let speeds = particles.velocity.iter().zip(&self.gain);
        self.reach.clear();
        self.reach
            .extend(speeds.map(|(velocity, gain)| (velocity.norm() + gain) * dt));
        self.reach.iter().copied().fold(0.0, f64::max)
    }

    pub(super) fn add(&mut self, i: usize, [squared, damping]: [f64; 2]) {
        self.stiffness[i] += squared;
        self.damping[i] += damping;
    }

    /// How many sub-steps of a step the contacts of an island need.
    pub(super) fn sub_steps(&self, island: &Island, dt: f64) -> u64 {
        let rate = |&i: &u32| self.stiffness[i as usize].sqrt() + self.damping[i as usize];
        let fastest = island.spheres.iter().map(rate).fold(0.0, f64::max);
        ((dt * fastest / RESOLUTION).ceil() as u64).max(1)
    }

    pub(super) fn miss_at_wall<W: Wall>(
        &mut self,
        wall: Option<W>,
        near: &[u32],
        particles: &Particles,
    ) {
        let Some(wall) = wall else { return };
        for &sphere in near {
            let i = sphere as usize;
            let contact = wall.contact(particles.position[i], particles.radius[i]);
            if i >= particles.fixed && contact.touches && self.islands.is_free(i) {
                self.missed_spheres.push(sphere);
            }
        }
    }
}
