//! The laws at a wall, for a block of spheres near it.

use super::ContactBlock;
use crate::dem::system::contact_laws::Laws;
use crate::dem::system::contact_state::SphereProperties;
use crate::dem::walls::Wall;
use crate::forces::contact::{NormalLaw, contact_radius};
use crate::forces::friction::{History, TangentialLaw};
use crate::particles::block::BLOCK;
use crate::particles::vector::Vector;

impl<H: History> ContactBlock<H> {
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
                let velocity = self.earlier_velocity.vector(k);
                let position = laws.earlier_position(self.offset.vector(k), velocity);
                let contact = wall.contact(position, self.properties[0].radius[k]);
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
