//! Groups of spheres that may touch within a step, and how fast their contacts oscillate.

use super::workspace::Workspace;
use crate::dem::system::System;
use crate::dem::system::wall_contacts::{NearSphere, WallContacts};
use crate::dem::walls::Wall;
use crate::forces::contact::NormalLaw;
use crate::forces::friction::{Grip, TangentialLaw};
use crate::particles::Particles;

impl<N: NormalLaw, T: TangentialLaw> System<N, T> {
    /// Finds the islands, and how stiff the contacts of their spheres may become.
    pub(super) fn group(&self, work: &mut Workspace<T::History>) {
        let particles = &self.particles;
        let (count, fixed) = (particles.len(), particles.fixed);
        work.islands.reset(count);
        work.stiffness.clear();
        work.stiffness.resize(count, 0.0);
        work.damping.clear();
        work.damping.resize(count, 0.0);
        if !N::ACTS {
            return;
        }
        for pair in self.neighbours.near.pairs() {
            self.group_pair(pair.i() as usize, pair.j() as usize, work);
        }
        for wall in &self.walls {
            self.group_wall(wall, work);
        }
        let walls = self.walls.iter().map(|wall| &wall.near[..]);
        work.islands
            .collect(self.neighbours.near.pairs(), walls, fixed);
    }

    fn group_pair(&self, i: usize, j: usize, work: &mut Workspace<T::History>) {
        let Particles {
            position,
            velocity,
            radius,
            inverse_mass,
            fixed,
            ..
        } = &self.particles;
        let sum = radius[i] + radius[j];
        let way = work.reach[i] + work.reach[j];
        let squared = (position[i] - position[j]).norm_squared();
        if squared >= (sum + way) * (sum + way) {
            return;
        }
        work.islands.join(i as u32, j as u32, *fixed);
        let rates = self.rates(
            (sum - squared.sqrt()).max(0.0),
            (velocity[i] - velocity[j]).norm(),
            work.gain[i] + work.gain[j],
            radius[i] * radius[j] / sum,
            inverse_mass[i] + inverse_mass[j],
            self.turning(i) + self.turning(j),
        );
        work.add(i, rates);
        work.add(j, rates);
    }

    fn group_wall(&self, wall: &WallContacts<T::History>, work: &mut Workspace<T::History>) {
        let particles = &self.particles;
        for &NearSphere { i: sphere, .. } in &wall.near {
            let (wall, i) = (wall.wall, sphere as usize);
            let (centre, radius) = (particles.position[i], particles.radius[i]);
            if i < particles.fixed || !wall.is_near(centre, radius, work.reach[i]) {
                continue;
            }
            work.islands.touch(sphere);
            let contact = wall.contact(centre, radius);
            let rates = self.rates(
                if contact.touches {
                    contact.overlap
                } else {
                    0.0
                },
                particles.velocity[i].norm(),
                work.gain[i],
                radius,
                particles.inverse_mass[i],
                self.turning(i),
            );
            work.add(i, rates);
        }
    }

    /// How easily a force at its surface turns a sphere: r^2 / I (1/kg).
    fn turning(&self, i: usize) -> f64 {
        let particles = &self.particles;
        let radius = particles.radius[i];
        let inverse = particles.inverse_inertia.get(i).copied().unwrap_or(0.0);
        radius * radius * inverse
    }

    /// Squared frequency (1/s2) and damping rate (1/s) of an impact at its deepest. It has this
    /// overlap (m) and speed (m/s), and may gain the speed `gain` (m/s). `yielding` is 1 / m_eff,
    /// and `turning` is what rotation adds to it (1/kg).
    fn rates(
        &self,
        overlap: f64,
        speed: f64,
        gain: f64,
        effective_radius: f64,
        yielding: f64,
        turning: f64,
    ) -> [f64; 2] {
        let (normal, tangential) = (&self.normal, &self.tangential);
        let effective_mass = 1.0 / yielding;
        let overlap =
            normal.deepest_overlap(overlap, speed + gain, effective_radius, effective_mass);
        let grip = Grip {
            overlap,
            effective_radius,
            effective_mass,
            normal_force: normal.elastic_force(overlap, effective_radius),
            speed,
        };
        let along = yielding + turning;
        let squared = (normal.stiffness(overlap, effective_radius) * yielding)
            .max(tangential.stiffness(overlap, effective_radius) * along);
        // Sliding that stops faster than the contact oscillates is not resolved. Its force
        // oscillates within the limit of friction.
        let friction = (tangential.damping(&grip) * along).min(squared.sqrt());
        let damping = normal.damping(overlap, effective_radius, effective_mass) * yielding;
        [squared, damping.max(friction)]
    }
}
