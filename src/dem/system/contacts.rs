//! Forces at contacts: which listed pairs touch, and what their laws answer.

use super::{Parts, System};
use crate::dem::contact::NormalLaw;
use crate::dem::friction::{TangentialLaw, Touch};
use crate::dem::particles::Particles;
use crate::dem::vector::Vector;
use crate::dem::walls::Wall;

/// A pair that touches, and its entry in the list.
#[derive(Clone, Copy, Default)]
pub(super) struct TouchingPair {
    pub(super) i: u32,
    pub(super) j: u32,
    pub(super) entry: u32,
}

/// What a contact needs to know of a sphere, side by side in memory.
#[derive(Clone, Copy, Default)]
pub(super) struct Body {
    pub(super) position: Vector,
    pub(super) radius: f64,
    pub(super) velocity: Vector,
    pub(super) mass: f64,
    pub(super) spin: Vector,
    pub(super) inertia: f64,
}

/// What a contact adds to a sphere.
#[derive(Clone, Copy, Default)]
pub(super) struct Load {
    pub(super) force: Vector,
    pub(super) torque: Vector,
}

impl<N: NormalLaw, T: TangentialLaw> System<N, T> {
    /// Copies the state of the spheres into the order of memory that contacts read best.
    #[inline(always)]
    pub(super) fn gather(&mut self) {
        let Particles {
            position,
            velocity,
            radius,
            mass,
            spin,
            inertia,
            ..
        } = &self.parts.particles;
        self.bodies.clear();
        self.bodies.extend(
            position
                .iter()
                .zip(velocity)
                .zip(radius.iter().zip(mass))
                .map(|((&position, &velocity), (&radius, &mass))| Body {
                    position,
                    radius,
                    velocity,
                    mass,
                    ..Body::default()
                }),
        );
        for ((body, &spin), &inertia) in self.bodies.iter_mut().zip(spin).zip(inertia) {
            body.spin = spin;
            body.inertia = inertia;
        }
        self.loads.clear();
        self.loads.resize(self.bodies.len(), Load::default());
    }

    /// Copies forces and torques of the contacts back to the spheres.
    #[inline(always)]
    pub(super) fn scatter(&mut self) {
        let Particles { force, torque, .. } = &mut self.parts.particles;
        for (force, load) in force.iter_mut().zip(&self.loads) {
            *force = load.force;
        }
        for (torque, load) in torque.iter_mut().zip(&self.loads) {
            *torque = load.torque;
        }
    }

    /// Goes through the list once: notes the pairs that touch and counts the shielding spheres.
    #[inline(always)]
    pub(super) fn scan<const SHIELD: bool>(&mut self) {
        let Some(list) = &self.list else { return };
        if SHIELD {
            self.shielding.fill(0);
        }
        // One spare slot: a pair is always written, and kept only if it touches.
        self.touching
            .resize(list.pairs() + 1, TouchingPair::default());
        let mut kept = 0;
        let bodies = &self.bodies[..];
        for (i, bounds) in list.start().windows(2).enumerate() {
            let Body {
                position: centre,
                radius: ri,
                ..
            } = bodies[i];
            let mut below = 0;
            let first = bounds[0];
            let neighbours = &list.neighbour()[first as usize..bounds[1] as usize];
            for (entry, &j) in (first..).zip(neighbours) {
                let Body {
                    position,
                    radius: rj,
                    ..
                } = bodies[j as usize];
                let offset = centre - position;
                if N::ACTS {
                    self.touching[kept] = TouchingPair {
                        i: i as u32,
                        j,
                        entry,
                    };
                    let touches = offset.norm_squared() < (ri + rj) * (ri + rj);
                    kept += usize::from(touches);
                    if Self::REMEMBERS && !touches {
                        self.pair_history[entry as usize] = T::History::default();
                    }
                }
                if SHIELD {
                    let (dx, dy) = (offset.x.abs(), offset.y.abs());
                    let within = |diameter: f64| (dx < diameter) & (dy < diameter);
                    below += u32::from(within(2.0 * ri) & (offset.z > 0.0));
                    self.shielding[j as usize] += u32::from(within(2.0 * rj) & (offset.z < 0.0));
                }
            }
            if SHIELD {
                self.shielding[i] += below;
            }
        }
        self.touching.truncate(kept);
    }

    #[inline(always)]
    pub(super) fn pair_forces(&mut self) {
        let (bodies, loads) = (&self.bodies[..], &mut self.loads[..]);
        let overlap_limit = self.parts.limits.overlap;
        for &TouchingPair { i, j, entry } in &self.touching {
            let (i, j) = (i as usize, j as usize);
            let (one, other) = (&bodies[i], &bodies[j]);
            let offset = one.position - other.position;
            let distance = offset.norm();
            let normal = offset * (1.0 / distance);
            let sum = one.radius + other.radius;
            let overlap = sum - distance;
            let inverse_sum = 1.0 / sum;
            let effective_radius = one.radius * other.radius * inverse_sum;
            let velocity = one.velocity - other.velocity;
            let normal_force = self
                .normal
                .force(overlap, -velocity.dot(normal), effective_radius);
            if overlap > overlap_limit * one.radius.min(other.radius) || distance == 0.0 {
                self.too_deep.get_or_insert((i, overlap));
            }
            let mut force = normal * normal_force;
            if T::ROTATES {
                // Both centres turn about the point where the surfaces meet, so that the pair
                // keeps its angular momentum.
                let lever = distance * inverse_sum;
                let touch = Touch {
                    normal,
                    velocity,
                    spin: [one.spin, other.spin],
                    lever: [one.radius * lever, other.radius * lever],
                    inertia: [one.inertia, other.inertia],
                    lesser_mass: one.mass.min(other.mass),
                    overlap,
                    effective_radius,
                    normal_force,
                };
                let history = &mut self.pair_history[entry as usize];
                let traction = self.tangential.traction(&touch, history);
                force += traction.force;
                loads[i].torque += traction.torque[0];
                loads[j].torque += traction.torque[1];
            }
            loads[i].force += force;
            loads[j].force -= force;
        }
    }

    #[inline(always)]
    pub(super) fn wall_forces<W: Wall>(&mut self, wall: W, histories: &mut [T::History]) {
        let Parts {
            particles, limits, ..
        } = &mut self.parts;
        for i in 0..particles.len() {
            let radius = particles.radius[i];
            let Some((overlap, normal)) = wall.touch(particles.position[i], radius) else {
                if Self::REMEMBERS {
                    histories[i] = T::History::default();
                }
                continue;
            };
            let velocity = particles.velocity[i];
            let normal_force = self.normal.force(overlap, -velocity.dot(normal), radius);
            if overlap > limits.overlap * radius {
                self.too_deep.get_or_insert((i, overlap));
            }
            let mut force = normal * normal_force;
            if T::ROTATES {
                let touch = Touch {
                    normal,
                    velocity,
                    spin: [particles.spin[i], Vector::ZERO],
                    lever: [radius, 0.0],
                    inertia: [particles.inertia[i], 0.0],
                    lesser_mass: particles.mass[i],
                    overlap,
                    effective_radius: radius,
                    normal_force,
                };
                let traction = self.tangential.traction(&touch, &mut histories[i]);
                force += traction.force;
                particles.torque[i] += traction.torque[0];
            }
            particles.force[i] += force;
        }
    }
}
