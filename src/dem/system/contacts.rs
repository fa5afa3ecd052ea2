//! Forces at contacts, block by block: which near pairs touch, and what acts on whom.

use super::System;
use super::meeting::{Couple, Earlier, Laws, Solid};
use super::wall_contacts::NearSphere;
use crate::dem::block::BLOCK;
use crate::dem::block::Row;
use crate::dem::contact::NormalLaw;
use crate::dem::friction::TangentialLaw;
use crate::dem::neighbours::NearPair;
use crate::dem::vector::Vector;
use crate::dem::walls::{TankWall, Wall};
use fearless_simd::Simd;

/// Contacts, possible ones included.
#[derive(Default)]
pub(super) struct Among {
    /// Pairs, in the order of the list.
    pub(super) pairs: Vec<NearPair>,
    /// Spheres near each wall.
    pub(super) walls: [Vec<NearSphere>; TankWall::MOST],
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
            earlier: earlier.map(|&[velocity, spin]: &[Row; 2]| Earlier {
                velocity: Vector::of_row(velocity),
                spin: [Vector::of_row(spin), Vector::ZERO],
            }),
        }
    }

    #[inline(always)]
    pub(super) fn pair_forces<S: Simd>(&mut self, simd: S, pairs: &[NearPair]) {
        let laws = self.laws();
        let block = &mut self.block;
        block.set_alike(self.alike);
        for pairs in pairs.chunks(BLOCK) {
            block.take_pairs(pairs, &self.pair_history);
            block.gather_pairs::<S, N, T>(
                simd,
                &self.parts.particles,
                &self.earlier,
                self.alike.is_some(),
            );
            block.interact(&laws);
            if Self::REMEMBERS {
                for (k, pair) in pairs.iter().enumerate() {
                    self.pair_history[pair.entry as usize] = block.history(k);
                }
            }
            block.scatter::<S, T>(simd, pairs, &mut self.parts.particles);
            if let Some((k, overlap)) = block.first_too_deep(pairs.len()) {
                let NearPair { i, j, .. } = pairs[k];
                let sphere = self.parts.particles.moving_partner(i, j);
                self.too_deep.get_or_insert((sphere, overlap));
            }
        }
    }

    /// Forces of a wall on the spheres near it.
    #[inline(always)]
    pub(super) fn wall_forces<S: Simd, W: Wall>(
        &mut self,
        simd: S,
        wall: W,
        near: &[NearSphere],
        histories: &mut [T::History],
    ) {
        let laws = self.laws();
        let block = &mut self.block;
        block.set_alike(self.alike);
        for spheres in near.chunks(BLOCK) {
            block.take_spheres(spheres, histories);
            block.gather_spheres::<S, N, T>(
                simd,
                &self.parts.particles,
                &self.earlier,
                self.alike.is_some(),
            );
            block.interact_with_wall(wall, &laws);
            if Self::REMEMBERS {
                for (k, sphere) in spheres.iter().enumerate() {
                    histories[sphere.entry as usize] = block.history(k);
                }
            }
            block.scatter_to_spheres::<S, T>(simd, spheres, &mut self.parts.particles);
            if let Some((k, overlap)) = block.first_too_deep(spheres.len()) {
                self.too_deep
                    .get_or_insert((spheres[k].i as usize, overlap));
            }
        }
    }
}
