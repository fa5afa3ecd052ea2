//! Buffers of a step of adaptive Verlet.

use super::islands::{Island, Islands};
use crate::dem::system::rolling::RollingSprings;
use crate::particles::Particles;
use crate::particles::vector::Vector;

/// The largest h (w + g) of a sub-step at contacts that are held, which need only be stable:
/// (w h)^2 + 4 g h < 4.
pub(super) const HELD: f64 = 0.6;

/// Tolerance on a sphere's displacement beyond the prediction from its speed and the slow forces,
/// in radii. If a sphere exceeds it, the step is repeated. Contacts that the step resolves stay
/// within it.
const LEEWAY: f64 = 1e-4;

/// Buffers of a step of the scheme. They carry nothing from one step to the next.
#[derive(Default)]
pub(in crate::dem::system) struct Workspace<H> {
    pub(super) start: StepStart<H>,
    pub(super) held: Held,
    /// Forces and torques of the effects in the middle of the step.
    pub(super) force: Vec<Vector>,
    pub(super) torque: Vec<Vector>,
    /// How much twice the force at the start of the step adds to the speed of each sphere (m/s),
    /// and how far the sphere may move (m).
    pub(super) gain: Vec<f64>,
    pub(super) reach: Vec<f64>,
    /// Whether a sphere went farther in an earlier attempt than predicted: it collides.
    strayed: Vec<bool>,
    /// The largest displacement of each sphere so far, squared (m2).
    way_squared: Vec<f64>,
    pub(super) islands: Islands,
    /// Squared frequency (1/s2) and damping rate (1/s) of each sphere at its contacts; contacts
    /// that are held count as slow as if all were followed at the same resolution.
    pub(super) stiffness: Vec<f64>,
    pub(super) damping: Vec<f64>,
}

/// Velocities and forces that are put back after a prediction.
#[derive(Default)]
pub(super) struct Held {
    /// For every sphere.
    pub(super) velocity: Vec<Vector>,
    pub(super) spin: Vec<Vector>,
    /// For the spheres of an island.
    pub(super) force: Vec<Vector>,
    pub(super) torque: Vec<Vector>,
}

/// The spheres at the start of a step.
#[derive(Default)]
pub(super) struct StepStart<H> {
    pub(super) position: Vec<Vector>,
    pub(super) velocity: Vec<Vector>,
    pub(super) spin: Vec<Vector>,
    /// Latest forces and torques.
    pub(super) force: Vec<Vector>,
    pub(super) torque: Vec<Vector>,
    pub(super) pair_history: Vec<H>,
    pub(super) wall_history: Vec<Vec<H>>,
    pub(super) rolling: RollingSprings,
}

impl<H: Copy> StepStart<H> {
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
    /// Finds how far each sphere may move in a step. Returns the largest of these distances (m).
    pub(super) fn find_reach(&mut self, particles: &Particles, dt: f64) -> f64 {
        let forces = particles.force.iter().zip(&particles.inverse_mass);
        self.gain.clear();
        self.gain
            .extend(forces.map(|(force, inverse)| 2.0 * force.norm() * (inverse * dt)));
        let speeds = particles.velocity.iter().zip(&self.gain);
        let spheres = speeds.zip(&particles.radius);
        self.reach.clear();
        self.reach.extend(spheres.map(|((velocity, gain), radius)| {
            (1.1 * velocity.norm() + gain) * dt + LEEWAY * radius
        }));
        self.way_squared.clear();
        self.way_squared.resize(particles.len(), 0.0);
        self.strayed.clear();
        self.strayed.resize(particles.len(), false);
        self.reach.iter().copied().fold(0.0, f64::max)
    }

    pub(super) fn add(&mut self, i: usize, [squared, damping]: [f64; 2]) {
        self.stiffness[i] += squared;
        self.damping[i] += damping;
    }

    /// The acceleration of a sphere by the latest forces (m/s2).
    pub(super) fn acceleration(&self, i: usize, inverse_mass: f64) -> f64 {
        self.start.force[i].norm() * inverse_mass
    }

    /// Whether one of these spheres went farther than predicted.
    pub(super) fn any_strayed(&self, spheres: &[usize]) -> bool {
        spheres.iter().any(|&i| self.strayed[i])
    }

    /// How many sub-steps of a step the contacts of an island need, at a resolution (rad).
    pub(super) fn sub_steps(&self, island: &Island, dt: f64, resolution: f64) -> u64 {
        let rate = |&i: &u32| self.stiffness[i as usize].sqrt() + self.damping[i as usize];
        let fastest = island.spheres.iter().map(rate).fold(0.0, f64::max);
        ((dt * fastest / resolution).ceil() as u64).max(1)
    }

    /// Notes how far a sphere is from its position at the start.
    pub(super) fn note_way(&mut self, i: usize, particles: &Particles) {
        let squared = (particles.position[i] - self.start.position[i]).norm_squared();
        self.way_squared[i] = self.way_squared[i].max(squared);
    }

    /// Allows spheres that moved too far twice their displacement. Returns the largest reach (m),
    /// if there are such spheres.
    pub(super) fn widen(&mut self, dt: f64) -> Option<f64> {
        let mut strayed = false;
        for (((squared, reach), gain), sphere_strayed) in self
            .way_squared
            .iter_mut()
            .zip(&mut self.reach)
            .zip(&mut self.gain)
            .zip(&mut self.strayed)
        {
            if *squared > *reach * *reach && squared.is_finite() {
                *reach = 2.0 * squared.sqrt();
                *gain = *reach / dt;
                (strayed, *sphere_strayed) = (true, true);
            }
            *squared = 0.0;
        }
        strayed.then(|| self.reach.iter().copied().fold(0.0, f64::max))
    }
}
