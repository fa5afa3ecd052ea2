//! Scattering: from the columns of a block to the sums and histories in memory.

use super::ContactBlock;
use crate::dem::system::sums::Sums;
use crate::dem::system::touching::{ContactLanes, Entries};
use crate::dem::system::wall_contacts::NearSphere;
use crate::forces::friction::{History, TangentialLaw};
use crate::particles::block::{BLOCK, ROWS};
use fearless_simd::{Simd, f64x4};

/// Vectors of eight contacts.
type EightRows<S> = [f64x4<S>; ROWS];

impl<H: History> ContactBlock<H> {
    /// Adds forces and torques to the sums of both spheres of each pair, one after the other.
    #[inline(always)]
    pub(in crate::dem::system) fn scatter_to_pairs<S: Simd, T: TangentialLaw<History = H>>(
        &mut self,
        simd: S,
        pairs: &ContactLanes<'_>,
        sums: &mut Sums<'_>,
    ) {
        self.clear_from(pairs.count);
        // Spheres that are alike get the same torque, which is then turned into rows once.
        match self.alike {
            true => self.scatter::<S, T, true>(simd, pairs, sums.here::<T>()),
            false => self.scatter::<S, T, false>(simd, pairs, sums.here::<T>()),
        }
    }

    #[inline(always)]
    fn scatter<S: Simd, T: TangentialLaw<History = H>, const ALIKE: bool>(
        &self,
        simd: S,
        pairs: &ContactLanes<'_>,
        mut sums: Sums<'_>,
    ) {
        for at in (0..BLOCK).step_by(ROWS) {
            let (force, one) = self.force_and_torque::<S, T>(simd, at);
            let other = match T::ROTATES && !ALIKE {
                true => self.torque[1].rows(simd, at),
                false => one,
            };
            for k in 0..ROWS {
                sums.add::<S, T>(simd, pairs.pairs[at + k].i(), force[k], one[k]);
                sums.add::<S, T>(simd, pairs.pairs[at + k].j(), -force[k], other[k]);
            }
        }
    }

    /// Adds forces and torques of a wall to the sums of the first `contacts` of these spheres. The
    /// other lanes repeat a sphere, and add zero.
    #[inline(always)]
    pub(in crate::dem::system) fn scatter_to_spheres<S: Simd, T: TangentialLaw<History = H>>(
        &mut self,
        simd: S,
        spheres: &[NearSphere; BLOCK],
        contacts: usize,
        sums: &mut Sums<'_>,
    ) {
        self.clear_from(contacts);
        let mut sums = sums.here::<T>();
        for at in (0..BLOCK).step_by(ROWS) {
            let (force, torque) = self.force_and_torque::<S, T>(simd, at);
            for k in 0..ROWS {
                sums.add::<S, T>(simd, spheres[at + k].i, force[k], torque[k]);
            }
        }
    }

    /// Forces and torques on the first partners of eight contacts. Without rotation the torques are
    /// not read.
    #[inline(always)]
    fn force_and_torque<S: Simd, T: TangentialLaw>(
        &self,
        simd: S,
        at: usize,
    ) -> (EightRows<S>, EightRows<S>) {
        let force = self.force.rows(simd, at);
        let torque = match T::ROTATES {
            true => self.torque[0].rows(simd, at),
            false => force,
        };
        (force, torque)
    }

    /// Sets forces and torques to zero in the lanes from `contacts` on.
    #[inline(always)]
    fn clear_from(&mut self, contacts: usize) {
        if contacts < BLOCK {
            let [one, other] = &mut self.torque;
            for columns in [&mut self.force, one, other] {
                for column in &mut columns.0 {
                    column[contacts..].fill(0.0);
                }
            }
        }
    }

    /// Stores the histories of pairs.
    #[inline(always)]
    pub(in crate::dem::system) fn store_pair_histories<S: Simd>(
        &self,
        simd: S,
        histories: &mut [H],
        entries: Entries<'_>,
    ) {
        match entries {
            Entries::Listed(entries) => self.store_histories(
                simd,
                histories,
                #[inline(always)]
                |k| entries[k] as usize,
            ),
            Entries::From(first) => {
                self.store_histories(simd, &mut histories[first..first + BLOCK], |k| k);
            }
        }
    }

    /// Stores the histories of the contacts, each at its entry.
    #[inline(always)]
    pub(in crate::dem::system) fn store_histories<S: Simd>(
        &self,
        simd: S,
        histories: &mut [H],
        entry: impl Fn(usize) -> usize,
    ) {
        if !Self::HAS_HISTORY {
            return;
        }
        for at in (0..BLOCK).step_by(ROWS) {
            let rows = match H::HAS_RADIUS {
                true => self.spring.rows_of_four(simd, at, &self.spring_radius),
                false => self.spring.rows(simd, at),
            };
            for k in 0..ROWS {
                if let Some(history) = histories.get_mut(entry(at + k)) {
                    let turning = self.turning(at + k);
                    *history = H::of_row(rows[k].into()).with_turning(turning);
                }
            }
        }
    }
}
