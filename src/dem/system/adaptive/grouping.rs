//! Groups of spheres that may touch within a step, and how fast their contacts oscillate.

use super::workspace::{HELD, Workspace};
use crate::dem::system::System;
use crate::dem::system::wall_contacts::{NearSphere, WallContacts};
use crate::forces::contact::NormalLaw;
use crate::forces::friction::{Grip, TangentialLaw};
use crate::particles::Particles;

/// A contact is held if an oscillation of its speed would not change its overlap by more than this
/// fraction.
const SWING: f64 = 0.1;

/// Partners that do not touch yet are held if their speed, now and a step later, is below this
/// fraction of what the slow forces alone may add to it in a step: others hold them.
const SLOW: f64 = 0.05;

/// Two partners that may touch within a step.
struct Approach<'a> {
    /// The spheres among them.
    spheres: &'a [usize],
    /// Present overlap (m).
    overlap: f64,
    /// Relative speed (m/s), how much of it is along the normal, and how much it may gain.
    speed: f64,
    along: f64,
    gain: f64,
    /// Sum of the accelerations that the latest forces give both (m/s2).
    accelerations: f64,
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
            domain,
            position,
            velocity,
            radius,
            inverse_mass,
            fixed,
            ..
        } = &self.particles;
        let sum = radius[i] + radius[j];
        let way = work.reach[i] + work.reach[j];
        let offset = domain.offset(position[i], position[j]);
        let squared = offset.norm_squared();
        if squared >= (sum + way) * (sum + way) {
            return;
        }
        work.islands.join(i as u32, j as u32, *fixed);
        let yielding = inverse_mass[i] + inverse_mass[j];
        if yielding == 0.0 {
            // Two driven spheres, which do not oscillate.
            return;
        }
        let (distance, velocity) = (squared.sqrt(), velocity[i] - velocity[j]);
        let rates = self.rates(
            work,
            &Approach {
                spheres: &[i, j],
                overlap: (sum - distance).max(0.0),
                speed: velocity.norm(),
                along: velocity.dot(offset) / distance,
                accelerations: work.acceleration(i, inverse_mass[i])
                    + work.acceleration(j, inverse_mass[j]),
                gain: work.gain[i] + work.gain[j],
                effective_radius: radius[i] * radius[j] / sum,
                yielding,
                turning: self.turning(i) + self.turning(j),
            },
            &self.tangential,
        );
        work.add(i, rates);
        work.add(j, rates);
    }

    fn group_wall(&self, wall: &WallContacts<T::History>, work: &mut Workspace<T::History>) {
        let particles = &self.particles;
        let (near, wall) = (&wall.near, &wall.wall);
        let tangential = self.laws().at_wall(wall).tangential;
        for &NearSphere { i: sphere, .. } in near {
            let i = sphere as usize;
            let (centre, radius) = (particles.position[i], particles.radius[i]);
            if i < particles.fixed || !wall.is_near(centre, radius, work.reach[i]) {
                continue;
            }
            work.islands.touch(sphere);
            if particles.inverse_mass[i] == 0.0 {
                continue;
            }
            let contact = wall.contact(centre, radius);
            let rates = self.rates(
                work,
                &Approach {
                    spheres: &[i],
                    overlap: match contact.touches {
                        true => contact.overlap,
                        false => 0.0,
                    },
                    speed: particles.velocity[i].norm(),
                    along: particles.velocity[i].dot(contact.normal),
                    accelerations: work.acceleration(i, particles.inverse_mass[i]),
                    gain: work.gain[i],
                    effective_radius: radius,
                    yielding: particles.inverse_mass[i],
                    turning: self.turning(i),
                },
                &tangential,
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

    /// Whether a contact is held, so that it changes little within a step: nothing collides.
    fn is_held(&self, work: &Workspace<T::History>, approach: &Approach<'_>) -> bool {
        let Approach {
            spheres,
            overlap,
            speed,
            along,
            gain,
            accelerations,
            effective_radius,
            yielding,
            ..
        } = *approach;
        // Before the first step there are no latest forces.
        if self.step.number == 1 || work.any_strayed(spheres) {
            return false;
        }
        if overlap == 0.0 {
            let gained = accelerations * self.setup.dt;
            return speed.max(gained) < SLOW * gain;
        }
        let swing = SWING * overlap;
        let squared = self.normal.stiffness(overlap, effective_radius) * yielding;
        along * along < squared * swing * swing && accelerations < squared * swing
    }

    /// Squared frequency (1/s2) and damping rate (1/s) of an impact at its deepest.
    fn rates(
        &self,
        work: &Workspace<T::History>,
        approach: &Approach<'_>,
        tangential: &T,
    ) -> [f64; 2] {
        let Approach {
            spheres,
            overlap,
            speed,
            along: _,
            accelerations: _,
            gain,
            effective_radius,
            yielding,
            turning,
        } = *approach;
        let normal = &self.normal;
        if yielding == 0.0 {
            return [0.0; 2];
        }
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
        let share = match self.is_held(work, approach) {
            true => (self.setup.resolution / HELD).min(1.0),
            false => 1.0,
        };
        let damping = damping.max(friction).max(drag);
        [squared.max(rolling) * share * share, damping * share]
    }
}
