//! Gathering: from rows of spheres in memory to the columns of a block.
//!
//! All closures are inlined: others are compiled without the wide instruction set.

use super::ContactBlock;
use crate::dem::system::contact_laws::Laws;
use crate::dem::system::contact_state::SphereProperties;
use crate::dem::system::partners::Partners;
use crate::dem::system::touching::{ContactLanes, Entries};
use crate::dem::system::wall_contacts::NearSphere;
use crate::forces::contact::NormalLaw;
use crate::forces::friction::{History, TangentialLaw};
use crate::particles::block::{BLOCK, ROWS, row};
use fearless_simd::{Simd, SimdBase, SimdFrom, f64x4, f64x8};

impl<H: History> ContactBlock<H> {
    /// Gathers positions, velocities, spins, properties and histories of pairs.
    #[inline(always)]
    pub(in crate::dem::system) fn gather_pairs<
        S: Simd,
        N: NormalLaw,
        T: TangentialLaw<History = H>,
    >(
        &mut self,
        simd: S,
        pairs: &ContactLanes<'_>,
        histories: &[H],
        partners: &Partners<'_>,
    ) {
        self.gather_motion::<S, T>(simd, pairs, partners);
        if !self.alike {
            self.gather_properties::<N, T>(pairs, partners);
        } else if Laws::<N, T>::NEEDS_EFFECTIVE_MASS {
            self.weigh_fixed::<N, T>(pairs, partners);
        }
        match pairs.entries {
            Entries::Listed(entries) => self.gather_springs(
                simd,
                #[inline(always)]
                |k| histories[entries[k] as usize],
            ),
            Entries::From(first) => {
                let histories = &histories[first..first + BLOCK];
                self.gather_springs(
                    simd,
                    #[inline(always)]
                    |k| histories[k],
                );
            }
        }
        if Self::HAS_HISTORY && !partners.earlier.is_empty() {
            self.gather_earlier_motion(simd, pairs, partners);
        }
    }

    /// Gathers offsets, velocities and spins of pairs.
    #[inline(always)]
    fn gather_motion<S: Simd, T: TangentialLaw<History = H>>(
        &mut self,
        simd: S,
        pairs: &ContactLanes<'_>,
        partners: &Partners<'_>,
    ) {
        // All slices have one length, so that each index is checked once.
        let spheres = partners.position.len();
        let (position, velocity) = (partners.position, &partners.velocity[..spheres]);
        let spin = if T::ROTATES {
            &partners.spin[..spheres]
        } else {
            position
        };
        let known = self.copy_offsets(simd, pairs);
        let pairs = pairs.pairs;
        let [first_spin, second_spin] = &mut self.spin;
        for at in (0..BLOCK).step_by(ROWS) {
            if !known {
                self.offset.fill_from::<S>(
                    at,
                    #[inline(always)]
                    |k| row(simd, position, pairs[k].i()) - row(simd, position, pairs[k].j()),
                );
                partners.domain.wrap(simd, &mut self.offset, at);
            }
            self.velocity.fill_from::<S>(
                at,
                #[inline(always)]
                |k| row(simd, velocity, pairs[k].i()) - row(simd, velocity, pairs[k].j()),
            );
            // Spheres that are alike have the same lever. Laws then need only the sum of both
            // spins, which is written to the first.
            if T::ROTATES && self.alike {
                first_spin.fill_from::<S>(
                    at,
                    #[inline(always)]
                    |k| row(simd, spin, pairs[k].i()) + row(simd, spin, pairs[k].j()),
                );
            } else if T::ROTATES {
                first_spin.fill_from::<S>(
                    at,
                    #[inline(always)]
                    |k| row(simd, spin, pairs[k].i()),
                );
                second_spin.fill_from::<S>(
                    at,
                    #[inline(always)]
                    |k| row(simd, spin, pairs[k].j()),
                );
            }
        }
    }

    /// Copies the offsets, if they are known. Returns whether they are.
    #[inline(always)]
    fn copy_offsets<S: Simd>(&mut self, simd: S, pairs: &ContactLanes<'_>) -> bool {
        let Some(offset) = pairs.offset else {
            return false;
        };
        for (column, lanes) in self.offset.0.iter_mut().zip(offset) {
            for at in (0..BLOCK).step_by(ROWS) {
                let eight = f64x8::from_slice(simd, &lanes[at..at + ROWS]);
                eight.store_slice(&mut column[at..at + ROWS]);
            }
        }
        true
    }

    /// Gathers properties of pairs whose spheres are not alike.
    #[inline(always)]
    fn gather_properties<N: NormalLaw, T: TangentialLaw<History = H>>(
        &mut self,
        pairs: &ContactLanes<'_>,
        partners: &Partners<'_>,
    ) {
        self.properties[0].gather::<N, T>(partners, |k| pairs.pairs[k].i());
        self.properties[1].gather::<N, T>(partners, |k| pairs.pairs[k].j());
        let [one, other] = &self.properties;
        for (k, inverse) in self.inverse_sum.iter_mut().enumerate() {
            *inverse = 1.0 / (one.radius[k] + other.radius[k]);
        }
        for (k, effective) in self.effective_mass.iter_mut().enumerate() {
            *effective = Laws::<N, T>::effective_mass([one.at(k), other.at(k)]);
        }
    }

    /// Effective masses of pairs of spheres that differ only in whether they are fixed. Fixed
    /// spheres come first in a pair, and their pairs come first in the list: most blocks have none.
    #[inline(always)]
    fn weigh_fixed<N: NormalLaw, T: TangentialLaw<History = H>>(
        &mut self,
        pairs: &ContactLanes<'_>,
        partners: &Partners<'_>,
    ) {
        let inverse_mass = |sphere: u32| partners.inverse_mass[sphere as usize];
        let has_fixed = inverse_mass(pairs.pairs[0].i()) == 0.0;
        if !has_fixed && !self.has_fixed {
            return;
        }
        self.has_fixed = has_fixed;
        for (effective, pair) in self.effective_mass.iter_mut().zip(pairs.pairs) {
            let of = |sphere: u32| SphereProperties {
                inverse_mass: inverse_mass(sphere),
                ..SphereProperties::WALL
            };
            *effective = Laws::<N, T>::effective_mass([of(pair.i()), of(pair.j())]);
        }
    }

    /// Gathers earlier velocities and spins of pairs.
    #[inline(always)]
    fn gather_earlier_motion<S: Simd>(
        &mut self,
        simd: S,
        pairs: &ContactLanes<'_>,
        partners: &Partners<'_>,
    ) {
        let (pairs, earlier) = (pairs.pairs, partners.earlier);
        self.earlier_velocity.fill::<S>(
            #[inline(always)]
            |k| {
                let one = earlier[pairs[k].i() as usize][0];
                let other = earlier[pairs[k].j() as usize][0];
                f64x4::simd_from(simd, one) - f64x4::simd_from(simd, other)
            },
        );
        let [one, other] = &mut self.earlier_spin;
        one.fill::<S>(
            #[inline(always)]
            |k| f64x4::simd_from(simd, earlier[pairs[k].i() as usize][1]),
        );
        other.fill::<S>(
            #[inline(always)]
            |k| f64x4::simd_from(simd, earlier[pairs[k].j() as usize][1]),
        );
    }

    /// Gathers positions, velocities, spins, properties and histories of spheres near a wall.
    #[inline(always)]
    pub(in crate::dem::system) fn gather_spheres<
        S: Simd,
        N: NormalLaw,
        T: TangentialLaw<History = H>,
    >(
        &mut self,
        simd: S,
        spheres: &[NearSphere; BLOCK],
        histories: &[H],
        partners: &Partners<'_>,
    ) {
        self.offset.fill::<S>(
            #[inline(always)]
            |k| row(simd, partners.position, spheres[k].i),
        );
        self.velocity.fill::<S>(
            #[inline(always)]
            |k| row(simd, partners.velocity, spheres[k].i),
        );
        if T::ROTATES {
            self.spin[0].fill::<S>(
                #[inline(always)]
                |k| row(simd, partners.spin, spheres[k].i),
            );
        }
        if !self.alike {
            self.properties[0].gather::<N, T>(partners, |k| spheres[k].i);
        }
        self.gather_springs(
            simd,
            #[inline(always)]
            |k| histories.get(k).copied().unwrap_or_default(),
        );
        if Self::HAS_HISTORY && !partners.earlier.is_empty() {
            let earlier = partners.earlier;
            self.earlier_velocity.fill::<S>(
                #[inline(always)]
                |k| f64x4::simd_from(simd, earlier[spheres[k].i as usize][0]),
            );
            self.earlier_spin[0].fill::<S>(
                #[inline(always)]
                |k| f64x4::simd_from(simd, earlier[spheres[k].i as usize][1]),
            );
        }
    }

    /// Gathers springs out of histories.
    #[inline(always)]
    fn gather_springs<S: Simd>(&mut self, simd: S, history: impl Fn(usize) -> H) {
        if Self::HAS_HISTORY {
            match H::HAS_RADIUS {
                true => self.spring.fill_four::<S>(
                    &mut self.spring_radius,
                    #[inline(always)]
                    |k| f64x4::simd_from(simd, history(k).row()),
                ),
                false => self.spring.fill::<S>(
                    #[inline(always)]
                    |k| f64x4::simd_from(simd, history(k).row()),
                ),
            }
        }
        if H::TURNS {
            for k in 0..BLOCK {
                self.set_turning(k, history(k).turning());
            }
        }
    }
}
