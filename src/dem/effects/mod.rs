//! Effects on single spheres: one file each, its formula, its parameters, its loop.

mod drag;
mod gravity;
mod spin_damping;
mod swirl;
mod updraught;

use super::bodies::{Asked, Bodies};
use super::particles::Particles;
use super::profile::Part;
use super::vector::Vector;
use crate::scene::Scene;
use fearless_simd::Level;

/// An effect adds to the forces and torques of the spheres.
pub(super) trait Effect: Send + Sync {
    /// Makes ready for a step. `shielding` holds, where the scene has an updraught, the number of
    /// spheres that shield each one, of all of them, from below.
    fn prepare(&mut self, shielding: &[u32]);

    /// Adds its forces and torques to those of a block of spheres.
    fn apply(&self, level: Level, bodies: &mut Bodies);

    /// What it asks for.
    fn asks(&self) -> Asked;

    /// The acceleration (m/s2) that it gives to all spheres, if it does nothing else: they then
    /// need no blocks.
    fn acceleration(&self) -> Option<Vector>;

    /// What it is called in a profile.
    fn part(&self) -> Part;

    /// Follows spheres into a new order.
    fn reorder(&mut self, order: &[u32]);

    /// The potential energy (J) of a force that has one; none of the others.
    fn energy(&self, particles: &Particles) -> Option<f64>;
}

/// The loop of an effect, to be compiled once per instruction set.
trait OneBody: Send + Sync {
    /// What it is called in a profile.
    const PART: Part;

    /// As [`Effect::asks`].
    const ASKS: Asked;

    /// As [`Effect::prepare`].
    fn prepare(&mut self, _shielding: &[u32]) {}

    /// As [`Effect::apply`]; implementations must be inlined always.
    fn add(&self, bodies: &mut Bodies);

    /// As [`Effect::acceleration`].
    fn acceleration(&self) -> Option<Vector> {
        None
    }

    /// As [`Effect::reorder`], of an effect that keeps something per sphere.
    fn reorder(&mut self, _order: &[u32]) {}

    /// As [`Effect::energy`].
    fn energy(&self, _particles: &Particles) -> Option<f64> {
        None
    }
}

impl<E: OneBody> Effect for E {
    fn prepare(&mut self, shielding: &[u32]) {
        OneBody::prepare(self, shielding);
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

    fn part(&self) -> Part {
        E::PART
    }

    fn reorder(&mut self, order: &[u32]) {
        OneBody::reorder(self, order);
    }

    fn energy(&self, particles: &Particles) -> Option<f64> {
        OneBody::energy(self, particles)
    }
}

/// The effects that a scene names, in the order in which they are applied.
pub(super) fn of_scene(scene: &Scene, particles: &Particles) -> Vec<Box<dyn Effect>> {
    let mut effects: Vec<Box<dyn Effect>> = Vec::new();
    if let Some(gravity) = &scene.dem.effects.gravity {
        effects.push(Box::new(gravity::Gravity::new(gravity)));
    }
    if let Some(drag) = &scene.dem.effects.drag {
        if let Some(swirl) = &scene.dem.effects.swirl {
            effects.push(swirl::of_scene(swirl, drag, particles));
        }
        if let Some(updraught) = &scene.dem.effects.updraught {
            effects.push(updraught::of_scene(
                updraught,
                scene.dem.effects.swirl.as_ref(),
                drag,
                particles,
            ));
        }
    }
    if let Some(damping) = &scene.dem.effects.spin_damping {
        effects.push(Box::new(spin_damping::SpinDamping::new(damping)));
    }
    effects
}
