//! Spheres at a wall in blocks of contacts.

use super::PairBlock;
use crate::dem::block::{BLOCK, ROWS, row};
use crate::dem::contact::NormalLaw;
use crate::dem::friction::{History, TangentialLaw};
use crate::dem::system::couple::Solid;
use crate::dem::system::meeting::Laws;
use crate::dem::system::partners::Partners;
use crate::dem::system::sums::Sums;
use crate::dem::system::wall_contacts::NearSphere;
use crate::dem::vector::Vector;
use crate::dem::walls::Wall;
use fearless_simd::{Simd, SimdFrom, f64x4};

impl<H: History> PairBlock<H> {
    /// Fetches spheres near a wall, with what they remember.
    #[inline(always)]
    pub(in crate::dem::system) fn take_spheres<
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
            self.solid[0].take::<N, T>(partners, |k| spheres[k].i);
        }
        self.take_springs(
            simd,
            #[inline(always)]
            |k| histories.get(k).copied().unwrap_or_default(),
        );
        if Self::REMEMBERS && !partners.earlier.is_empty() {
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

    /// Finds how every sphere meets a wall.
    #[inline(always)]
    pub(in crate::dem::system) fn meet<W: Wall, N: NormalLaw, T: TangentialLaw<History = H>>(
        &mut self,
        wall: W,
        laws: &Laws<N, T>,
    ) {
        for k in 0..BLOCK {
            let contact = wall.contact(self.offset.vector(k), self.solid[0].radius[k]);
            self.meeting.set(k, &contact);
        }
        if Self::REMEMBERS && laws.loading.age > 0.0 {
            for k in 0..BLOCK {
                let (place, velocity) = (self.offset.vector(k), self.earlier_velocity.vector(k));
                let place = laws.earlier_place(place, velocity);
                let contact = wall.contact(place, self.solid[0].radius[k]);
                self.earlier_meeting.set(k, &contact);
            }
        }
    }

    /// Computes the laws for every sphere, as it [meets](Self::meet) a wall.
    #[inline(always)]
    pub(in crate::dem::system) fn interact_with_wall<
        N: NormalLaw,
        T: TangentialLaw<History = H>,
    >(
        &mut self,
        laws: &Laws<N, T>,
    ) {
        match Self::REMEMBERS && laws.loading.age > 0.0 {
            true => self.interact_with_wall_as::<N, T, true>(laws),
            false => self.interact_with_wall_as::<N, T, false>(laws),
        }
    }

    #[inline(always)]
    fn interact_with_wall_as<N: NormalLaw, T: TangentialLaw<History = H>, const EARLIER: bool>(
        &mut self,
        laws: &Laws<N, T>,
    ) {
        self.turn_springs(
            #[inline(always)]
            |block, k| block.meeting.at(k).normal,
        );
        for k in 0..BLOCK {
            let mut couple = self.couple::<T, EARLIER>(k, Solid::WALL);
            couple.spin[1] = Vector::ZERO;
            if let Some(earlier) = &mut couple.earlier {
                earlier.spin[1] = Vector::ZERO;
            }
            let earlier = self.earlier_meeting.at(k);
            let earlier = EARLIER.then_some(&earlier);
            let contact = self.meeting.at(k);
            let spring = self.spring(k);
            match Self::REMEMBERS {
                true => {
                    let pressed = laws.pressed_at_contact(&couple, contact, earlier, spring);
                    self.hold::<T>(k, &pressed);
                }
                false => {
                    self.keep::<T>(k, &laws.at_contact(&couple, contact, earlier, spring));
                }
            }
        }
        self.rub::<T, true>(
            #[inline(always)]
            |block, k| block.meeting.at(k).normal,
        );
    }

    /// Adds forces and torques of a wall to those of so many spheres whose sums these are.
    #[inline(always)]
    pub(in crate::dem::system) fn add_to_spheres<S: Simd, T: TangentialLaw<History = H>>(
        &mut self,
        simd: S,
        spheres: &[NearSphere; BLOCK],
        contacts: usize,
        sums: &mut Sums<'_>,
    ) {
        self.clear_from(contacts);
        let mut sums = sums.here::<T>();
        for at in (0..BLOCK).step_by(ROWS) {
            let force = self.force.rows(simd, at);
            let torque = match T::ROTATES {
                true => self.torque[0].rows(simd, at),
                false => force,
            };
            for k in 0..ROWS {
                sums.add::<S, T>(simd, spheres[at + k].i, force[k], torque[k]);
            }
        }
    }
}
