//! The laws at a wall, for a block of spheres near it.

use super::ContactBlock;
use crate::dem::system::contact_laws::Laws;
use crate::dem::system::contact_state::SphereProperties;
use crate::forces::contact::{NormalLaw, contact_radius};
use crate::forces::friction::{History, TangentialLaw};
use crate::particles::block::BLOCK;
use crate::particles::vector::Vector;
use crate::walls::{ContactSurface, SurfaceMotion, Wall};

impl<H: History> ContactBlock<H> {
    /// Moves the centres to the middle of a wall, along the axes that have one.
    #[inline(always)]
    pub(in crate::dem::system) fn level(&mut self, wall: &Wall) {
        for (column, middle) in self.offset.0.iter_mut().zip(wall.middle) {
            if let Some(middle) = middle {
                column.fill(middle);
            }
        }
    }

    /// Finds the contact of every sphere with the surface of a wall.
    #[inline(always)]
    pub(in crate::dem::system) fn find_wall_contacts<
        W: ContactSurface,
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
                let velocity = self.earlier_velocity.vector(k);
                let position = laws.earlier_position(self.offset.vector(k), velocity);
                let contact = wall.contact(position, self.properties[0].radius[k]);
                self.earlier_wall_contact.set(k, &contact);
            }
        }
    }

    /// Makes the velocities relative to a wall that moves in itself. The contacts with it are
    /// known.
    #[inline(always)]
    pub(in crate::dem::system) fn see_wall_move<N: NormalLaw, T: TangentialLaw<History = H>>(
        &mut self,
        motion: &SurfaceMotion,
        laws: &Laws<N, T>,
    ) {
        for k in 0..BLOCK {
            let (centre, radius) = (self.offset.vector(k), self.properties[0].radius[k]);
            if Self::HAS_HISTORY && laws.loading.age > 0.0 {
                let velocity = self.earlier_velocity.vector(k);
                let earlier = laws.earlier_position(centre, velocity);
                let of_wall = motion.at_contact(earlier, radius, &self.earlier_wall_contact.at(k));
                self.earlier_velocity.set(k, velocity - of_wall);
            }
            let of_wall = motion.at_contact(centre, radius, &self.wall_contact.at(k));
            self.velocity.set(k, self.velocity.vector(k) - of_wall);
        }
    }

    /// Multiplies the forces and torques by the weight of a wall.
    #[inline(always)]
    pub(in crate::dem::system) fn weigh(&mut self, weight: f64) {
        if weight == 1.0 {
            return;
        }
        for columns in [&mut self.force, &mut self.torque[0]] {
            for value in columns.0.iter_mut().flatten() {
                *value *= weight;
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
        self.bring_springs(
            laws.tangential.keeps(),
            #[inline(always)]
            |block, k| {
                let overlap = block.wall_contact.at(k).overlap;
                contact_radius(overlap, block.properties[0].radius[k])
            },
            #[inline(always)]
            |block, k, spring, change| {
                let normal = block.wall_contact.at(k).normal;
                match EARLIER {
                    true => {
                        let earlier = block.earlier_wall_contact.at(k).normal;
                        spring.turned_by(normal, laws.turn_at_wall(normal, earlier), change)
                    }
                    false => spring.turned_to(normal, change),
                }
            },
        );
        for k in 0..BLOCK {
            let mut state = self.contact_state::<T, EARLIER>(k, SphereProperties::WALL);
            state.spin[1] = Vector::ZERO;
            if let Some(earlier) = &mut state.earlier {
                earlier.spin[1] = Vector::ZERO;
            }
            let earlier = self.earlier_wall_contact.at(k);
            let earlier = EARLIER.then_some(&earlier);
            let geometry = laws.geometry_at_wall(&state, self.wall_contact.at(k), earlier);
            self.apply_laws_to(k, laws, &state, &geometry);
        }
        self.add_friction_to_all::<T, true>(
            #[inline(always)]
            |block, k| block.wall_contact.at(k).normal,
        );
    }
}
