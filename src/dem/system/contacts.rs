//! What may touch, and what the laws of contacts ask about it.

use super::System;
use super::couple::{Couple, Earlier, Solid};
use super::meeting::Laws;
use super::share::{AtWalls, Known};
use super::wall_contacts::{NearSphere, WallContacts};
use crate::dem::block::Row;
use crate::dem::contact::NormalLaw;
use crate::dem::friction::TangentialLaw;
use crate::dem::neighbours::NearPair;
use crate::dem::vector::Vector;
use crate::dem::walls::TankWall;

/// Contacts, possible ones included.
#[derive(Default)]
pub(super) struct Among {
    /// Pairs, in the order of the list.
    pub(super) pairs: Vec<NearPair>,
    /// Where their histories are, of pairs that are not all there are.
    pub(super) entries: Vec<u32>,
    /// Spheres near each wall.
    pub(super) walls: [Vec<NearSphere>; TankWall::MOST],
}

impl Among {
    /// The pairs, with where their histories are.
    pub(super) fn pairs(&self) -> impl Iterator<Item = (NearPair, usize)> {
        let entry = |k: usize| self.entries.get(k).map_or(k, |&entry| entry as usize);
        let pairs = self.pairs.iter().enumerate();
        pairs.map(move |(k, &pair)| (pair, entry(k)))
    }

    /// Pairs and spheres near walls, with their histories, of which there is one for each of them.
    pub(super) fn known<'a, H>(
        &'a self,
        pair_history: &'a mut [H],
        at_walls: &'a mut [WallContacts<H>],
    ) -> (Known<'a, NearPair, H>, AtWalls<'a, H>) {
        let mut walls = [const { None }; TankWall::MOST];
        for ((place, wall), near) in walls.iter_mut().zip(at_walls).zip(&self.walls) {
            let known = Known {
                contacts: near,
                histories: &mut wall.histories,
            };
            *place = Some((wall.wall, known));
        }
        let pairs = Known {
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
            overlap_limit: self.parts.limits.overlap,
        }
    }

    /// Two spheres, with what they did before if springs are loaded by that.
    pub(super) fn couple(&self, i: u32, j: u32) -> Couple {
        let (one, other) = (self.alone(i), self.alone(j));
        let earlier = one.earlier.zip(other.earlier);
        Couple {
            offset: one.offset - other.offset,
            velocity: one.velocity - other.velocity,
            spin: [one.spin[0], other.spin[0]],
            solid: [one.solid[0], other.solid[0]],
            inverse_sum: 1.0 / (one.solid[0].radius + other.solid[0].radius),
            earlier: earlier.map(|(one, other)| Earlier {
                velocity: one.velocity - other.velocity,
                spin: [one.spin[0], other.spin[0]],
            }),
        }
    }

    /// A sphere by itself, as walls meet it.
    pub(super) fn alone(&self, i: u32) -> Couple {
        let (i, particles) = (i as usize, &self.parts.particles);
        let of = |vectors: &[Vector]| vectors.get(i).copied().unwrap_or_default();
        let sphere = Solid {
            radius: particles.radius[i],
            mass: particles.mass[i],
            inverse_mass: particles.inverse_mass[i],
            inertia: particles.inertia.get(i).copied().unwrap_or(0.0),
        };
        let earlier = self.earlier.get(i).filter(|_| self.loading.age > 0.0);
        Couple {
            offset: particles.position[i],
            velocity: particles.velocity[i],
            spin: [of(&particles.spin), Vector::ZERO],
            solid: [sphere, Solid::WALL],
            inverse_sum: 1.0 / sphere.radius,
            earlier: earlier.map(|&[velocity, spin]: &[Row; 2]| Earlier {
                velocity: Vector::of_row(velocity),
                spin: [Vector::of_row(spin), Vector::ZERO],
            }),
        }
    }
}
