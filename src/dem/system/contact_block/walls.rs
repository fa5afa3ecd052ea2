//! Spheres at a wall in blocks of contacts.

use super::ContactBlock;
use crate::dem::system::contact_laws::Laws;
use crate::dem::system::contact_state::SphereProperties;
use crate::dem::system::partners::Partners;
use crate::dem::system::sums::Sums;
use crate::dem::system::wall_contacts::NearSphere;
use crate::dem::walls::Wall;
use crate::forces::contact::NormalLaw;
use crate::forces::friction::{History, TangentialLaw};
use crate::particles::block::{BLOCK, ROWS, row};
use crate::particles::vector::Vector;
use fearless_simd::{Simd, SimdFrom, f64x4};

impl<H: History> ContactBlock<H> {
    /// Gathers positions, velocities, spins and histories of spheres near a wall.
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
            self.properties[0].take::<N, T>(partners, |k| spheres[k].i);
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

    /// Finds the contact of every sphere with a wall.
    #[inline(always)]
    pub(in crate::dem::system) fn find_wall_contacts<
        W: Wall,
        N: NormalLaw,
        T: TangentialLaw<History = H>,
    >(
        &mut self,
        wall: W,
        laws: &Laws<N, T>,
    ) {
        for k in 0..BLOCK {
            let contact = wall.contact(self.offset.vector(k), self.properties[0].radius[k]);
            self.wall_contact.set(k, &contact);
        }
        if Self::HAS_HISTORY && laws.loading.age > 0.0 {
            for k in 0..BLOCK {
                let (place, velocity) = (self.offset.vector(k), self.earlier_velocity.vector(k));
                let place = laws.earlier_place(place, velocity);
                let contact = wall.contact(place, self.properties[0].radius[k]);
                self.earlier_wall_contact.set(k, &contact);
            }
        }
    }

    /// Applies the laws to the [contacts with a wall](Self::find_wall_contacts).
    #[inline(always)]
    pub(in crate::dem::system) fn apply_laws_at_wall<
        N: NormalLaw,
        T: TangentialLaw<History = H>,
    >(
        &mut self,
        laws: &Laws<N, T>,
    ) {
        match Self::HAS_HISTORY && laws.loading.age > 0.0 {
            true => self.apply_laws_at_wall_as::<N, T, true>(laws),
            false => self.apply_laws_at_wall_as::<N, T, false>(laws),
        }
    }

    #[inline(always)]
    fn apply_laws_at_wall_as<N: NormalLaw, T: TangentialLaw<History = H>, const EARLIER: bool>(
        &mut self,
        laws: &Laws<N, T>,
    ) {
        self.turn_springs(
            #[inline(always)]
            |block, k| block.wall_contact.at(k).normal,
        );
        for k in 0..BLOCK {
            let mut state = self.contact_state::<T, EARLIER>(k, SphereProperties::WALL);
            state.spin[1] = Vector::ZERO;
            if let Some(earlier) = &mut state.earlier {
                earlier.spin[1] = Vector::ZERO;
            }
            let earlier = self.earlier_wall_contact.at(k);
            let earlier = EARLIER.then_some(&earlier);
            let contact = self.wall_contact.at(k);
            let spring = self.spring(k);
            match Self::HAS_HISTORY {
                true => {
                    let loaded = laws.load_at_wall(&state, contact, earlier, spring);
                    self.store_loaded::<T>(k, &loaded);
                }
                false => {
                    self.store_force::<T>(k, &laws.wall_force_at(&state, contact, earlier, spring));
                }
            }
        }
        self.add_friction_to_all::<T, true>(
            #[inline(always)]
            |block, k| block.wall_contact.at(k).normal,
        );
    }

    /// Adds forces and torques of a wall to the sums of these spheres.
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
