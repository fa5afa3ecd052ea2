//! Pairs and walls that may touch, and the state of such a contact.

use super::System;
use super::contact_laws::Laws;
use super::contact_state::{ContactState, EarlierMotion, SphereProperties};
use super::contact_task::{AtWalls, ContactSlice};
use super::wall_contacts::{NearSphere, WallContacts};
use crate::dem::neighbours::NearPair;
use crate::dem::walls::TankWall;
use crate::forces::contact::NormalLaw;
use crate::forces::friction::TangentialLaw;
use crate::particles::block::Row;
use crate::particles::vector::Vector;

/// Contacts that may exist: near pairs, and spheres near walls.
#[derive(Default)]
pub(super) struct Candidates {
    /// Pairs, in the order of the list.
    pub(super) pairs: Vec<NearPair>,
    /// Where their histories are, of pairs that are not all there are.
    pub(super) entries: Vec<u32>,
    /// Spheres near each wall.
    pub(super) walls: [Vec<NearSphere>; TankWall::MOST],
}

impl Candidates {
    /// The pairs, with where their histories are.
    pub(super) fn pairs(&self) -> impl Iterator<Item = (NearPair, usize)> {
        let entry = |k: usize| self.entries.get(k).map_or(k, |&entry| entry as usize);
        let pairs = self.pairs.iter().enumerate();
        pairs.map(move |(k, &pair)| (pair, entry(k)))
    }

    /// Pairs and spheres near walls, each with its history.
    pub(super) fn with_histories<'a, H>(
        &'a self,
        pair_history: &'a mut [H],
        at_walls: &'a mut [WallContacts<H>],
    ) -> (ContactSlice<'a, NearPair, H>, AtWalls<'a, H>) {
        let mut walls = [const { None }; TankWall::MOST];
        for ((place, wall), near) in walls.iter_mut().zip(at_walls).zip(&self.walls) {
            let known = ContactSlice {
                contacts: near,
                histories: &mut wall.histories,
            };
            *place = Some((wall.wall, known));
        }
        let pairs = ContactSlice {
            contacts: &self.pairs,
            histories: pair_history,
        };
        (pairs, walls)
    }
}

impl<N: NormalLaw, T: TangentialLaw> System<N, T> {
    /// The laws of this step's contacts.
    #[inline(always)]
    pub(super) fn laws(&self) -> Laws<N, T> {
        Laws {
            normal: self.normal,
            tangential: self.tangential,
            loading: self.loading,
            overlap_limit: self.setup.limits.overlap,
        }
    }

    /// Two spheres, with their earlier motion if springs are loaded by that.
    pub(super) fn contact_state(&self, i: u32, j: u32) -> ContactState {
        let (one, other) = (self.state_at_wall(i), self.state_at_wall(j));
        let earlier = one.earlier.zip(other.earlier);
        ContactState {
            offset: one.offset - other.offset,
            velocity: one.velocity - other.velocity,
            spin: [one.spin[0], other.spin[0]],
            properties: [one.properties[0], other.properties[0]],
            inverse_sum: 1.0 / (one.properties[0].radius + other.properties[0].radius),
            earlier: earlier.map(|(one, other)| EarlierMotion {
                velocity: one.velocity - other.velocity,
                spin: [one.spin[0], other.spin[0]],
            }),
        }
    }

    /// A sphere at a wall.
    pub(super) fn state_at_wall(&self, i: u32) -> ContactState {
        let (i, particles) = (i as usize, &self.particles);
        let of = |vectors: &[Vector]| vectors.get(i).copied().unwrap_or_default();
        let sphere = SphereProperties {
            radius: particles.radius[i],
            mass: particles.mass[i],
            inverse_mass: particles.inverse_mass[i],
            inertia: particles.inertia.get(i).copied().unwrap_or(0.0),
        };
        let earlier = self.earlier.get(i).filter(|_| self.loading.age > 0.0);
        ContactState {
            offset: particles.position[i],
            velocity: particles.velocity[i],
            spin: [of(&particles.spin), Vector::ZERO],
            properties: [sphere, SphereProperties::WALL],
            inverse_sum: 1.0 / sphere.radius,
            earlier: earlier.map(|&[velocity, spin]: &[Row; 2]| EarlierMotion {
                velocity: Vector::of_row(velocity),
                spin: [Vector::of_row(spin), Vector::ZERO],
            }),
        }
    }
}
