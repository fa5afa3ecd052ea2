//! Forces at contacts, block by block: which near pairs touch, and what acts on whom.

use super::System;
use super::pair_block::Laws;
use crate::dem::block::BLOCK;
use crate::dem::contact::NormalLaw;
use crate::dem::friction::TangentialLaw;
use crate::dem::neighbours::NearPair;
use crate::dem::walls::Wall;
use fearless_simd::Simd;

/// Contacts, possible ones included.
#[derive(Default)]
pub(super) struct Among {
    /// Pairs, in the order of the list.
    pub(super) pairs: Vec<NearPair>,
    /// Spheres near the floor.
    pub(super) floor: Vec<u32>,
    /// Spheres near the cylinder.
    pub(super) cylinder: Vec<u32>,
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

    #[inline(always)]
    pub(super) fn pair_forces<S: Simd>(&mut self, simd: S, pairs: &[NearPair]) {
        let laws = self.laws();
        let block = &mut self.block;
        block.set_alike(self.alike);
        for pairs in pairs.chunks(BLOCK) {
            block.take_pairs(pairs, &self.pair_history);
            block.gather_pairs::<S, T>(
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
        near: &[u32],
        histories: &mut [T::History],
    ) {
        let laws = self.laws();
        let block = &mut self.block;
        block.set_alike(self.alike);
        for spheres in near.chunks(BLOCK) {
            block.take_spheres(spheres, histories);
            block.gather_spheres::<S, T>(
                simd,
                &self.parts.particles,
                &self.earlier,
                self.alike.is_some(),
            );
            block.interact_with_wall(wall, &laws);
            if Self::REMEMBERS {
                for (k, &i) in spheres.iter().enumerate() {
                    histories[i as usize] = block.history(k);
                }
            }
            block.scatter_to_spheres::<S, T>(simd, spheres, &mut self.parts.particles);
            if let Some((k, overlap)) = block.first_too_deep(spheres.len()) {
                self.too_deep.get_or_insert((spheres[k] as usize, overlap));
            }
        }
    }
}
