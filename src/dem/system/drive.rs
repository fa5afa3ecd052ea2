//! Spheres that move along prescribed paths.
//!
//! Such a sphere has infinite inertia, so that forces leave its velocity alone. In every step it
//! has the velocity that takes it to the point of its path at the end of the step. It passes
//! through walls, fixed spheres and other driven spheres: forces between them are computed but move
//! nothing, so no guard checks their overlaps.
//!
//! A path names its sphere by the number in the scene. The index in memory changes when spheres
//! come, go or are sorted, and is then found again.

use super::System;
use crate::forces::contact::NormalLaw;
use crate::forces::friction::TangentialLaw;
use crate::particles::Particles;
use crate::scene::Driven;

/// Gives infinite inertia to the driven spheres that are in. Returns the index of each, and the
/// place of its path among `paths`, which are in the order of their spheres.
pub(super) fn find(paths: &[Driven], particles: &mut Particles) -> Vec<(usize, usize)> {
    if paths.is_empty() {
        return Vec::new();
    }
    let path_of = |i| {
        let number = particles.number_in_scene(i);
        paths.binary_search_by_key(&number, |path| path.sphere)
    };
    let moving = particles.fixed..particles.len();
    let found: Vec<_> = moving.filter_map(|i| Some((i, path_of(i).ok()?))).collect();
    for &(sphere, _) in &found {
        particles.inverse_mass[sphere] = 0.0;
        if particles.rotate() {
            particles.inverse_inertia[sphere] = 0.0;
        }
    }
    found
}

impl<N: NormalLaw, T: TangentialLaw> System<N, T> {
    /// Gives driven spheres their mean velocity between two moments of the present step: 0 is its
    /// start, 1 its end.
    pub(super) fn drive(&mut self, from: f64, to: f64) {
        if self.driven.is_empty() {
            return;
        }
        let (steps, dt) = ((self.step.number - 1) as f64, self.setup.dt);
        // There is no path before the start.
        let time = |part: f64| (steps + part).max(0.0) * dt;
        for &(sphere, path) in &self.driven {
            let path = &self.setup.driven[path];
            self.particles.velocity[sphere] = path.mean_velocity(time(from), time(to));
        }
    }

    /// Finds the driven spheres again, after indices have changed.
    pub(super) fn find_driven(&mut self) {
        self.driven = find(&self.setup.driven, &mut self.particles);
    }
}
