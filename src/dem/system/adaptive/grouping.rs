//! Groups of spheres that may touch within a step, and how fast their contacts oscillate.

use super::workspace::Workspace;
use crate::dem::system::System;
use crate::dem::system::wall_contacts::{NearSphere, WallContacts};
use crate::dem::walls::Wall;
use crate::forces::contact::NormalLaw;
use crate::forces::friction::{Grip, TangentialLaw};
use crate::particles::Particles;

/// Two partners that may touch within a step.
struct Approach<'a> {
    /// The spheres among them.
    spheres: &'a [usize],
    /// Present overlap (m).
    overlap: f64,
    /// Relative speed (m/s), and how much it may gain.
    speed: f64,
    gain: f64,
    effective_radius: f64,
    /// 1 / m_eff, and what rotation adds to it (1/kg).
    yielding: f64,
    turning: f64,
}

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
        let yielding = inverse_mass[i] + inverse_mass[j];
        if yielding == 0.0 {
            // Two driven spheres, which do not oscillate.
            return;
        }
        let rates = self.rates(&Approach {
            spheres: &[i, j],
            overlap: (sum - squared.sqrt()).max(0.0),
            speed: (velocity[i] - velocity[j]).norm(),
            gain: work.gain[i] + work.gain[j],
            effective_radius: radius[i] * radius[j] / sum,
            yielding,
            turning: self.turning(i) + self.turning(j),
        });
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
            if particles.inverse_mass[i] == 0.0 {
                continue;
            }
            let contact = wall.contact(centre, radius);
            let rates = self.rates(&Approach {
                spheres: &[i],
                overlap: match contact.touches {
                    true => contact.overlap,
                    false => 0.0,
                },
                speed: particles.velocity[i].norm(),
                gain: work.gain[i],
                effective_radius: radius,
                yielding: particles.inverse_mass[i],
                turning: self.turning(i),
            });
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

    /// Squared frequency (1/s2) and damping rate (1/s) of an impact at its deepest.
    fn rates(&self, approach: &Approach<'_>) -> [f64; 2] {
        let Approach {
            spheres,
            overlap,
            speed,
            gain,
            effective_radius,
            yielding,
            turning,
        } = *approach;
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
        let [rolling, drag] = self.rolling_rates(spheres, overlap, effective_radius);
        [squared.max(rolling), damping.max(friction).max(drag)]
    }
}
