//! Whether a sphere passed a floor beside its opening.
//!
//! A floor with an opening has two sides, because spheres that left through the opening may come
//! under it. So a sphere pressed through it from above would continue below, and no overlap would
//! show it.

use super::Free;
use crate::particles::Particles;
use crate::particles::vector::Vector;
use crate::scene::{Scene, Tank};
use crate::simulation::{Guard, Instability};
use std::collections::BTreeSet;

/// Watches the plane of a floor with an opening.
pub(super) struct FloorWatch {
    tank: Tank,
    /// Height of the floor (m).
    height: f64,
    /// Numbers of the spheres that have come below it.
    pub(super) below: BTreeSet<u32>,
}

impl FloorWatch {
    /// A watch over the floor of a scene, if the floor has an opening.
    pub(super) fn of_scene(scene: &Scene) -> Option<Self> {
        let tank = scene.tank.as_ref().filter(|tank| tank.has_opening())?;
        Some(Self {
            tank: tank.clone(),
            height: tank.floor?,
            below: BTreeSet::new(),
        })
    }

    /// Reports the first sphere that passed the floor beside its opening since the latest check.
    pub(super) fn check(
        &mut self,
        particles: &Particles,
        free: &Free,
        step: u64,
        dt: f64,
    ) -> Result<(), Instability> {
        let mut below = BTreeSet::new();
        for i in free.indices(particles) {
            let centre = particles.position[i];
            if !(centre.z < self.height) {
                continue;
            }
            let number = particles.number[i];
            below.insert(number);
            let place = crossing(centre, particles.velocity[i], self.height);
            // Spheres that start there did not pass the floor.
            let was_below = step == 0 || self.below.contains(&number);
            if was_below || self.tank.inside_opening(place.x, place.y) > 0.0 {
                continue;
            }
            return Err(Instability {
                guard: Guard::WallPassed,
                step,
                time: step as f64 * dt,
                sphere: i,
                detail: format!(
                    "through the floor at ({:.4}, {:.4}) m, beside its opening; stiffen the \
                     contact, or make the spheres lighter or slower",
                    place.x, place.y
                ),
            });
        }
        self.below = below;
        Ok(())
    }
}

/// Where a sphere crossed a height (m), if it went straight.
fn crossing(centre: Vector, velocity: Vector, height: f64) -> Vector {
    let ago = match velocity.z < 0.0 {
        true => (height - centre.z) / -velocity.z,
        false => 0.0,
    };
    let place = centre - velocity * ago;
    Vector::new(place.x, place.y, height)
}
