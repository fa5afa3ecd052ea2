//! Columns of a block of contacts that are not vectors.

use super::contact_laws::Laws;
use super::contact_state::SphereProperties;
use super::partners::Partners;
use crate::forces::contact::NormalLaw;
use crate::forces::friction::TangentialLaw;
use crate::particles::block::{BLOCK, BlockColumn, VectorColumns};
use crate::walls::WallContact;

/// A block of contacts; lanes without one repeat the first.
#[inline(always)]
pub(super) fn full_block<'a, C: Copy>(
    contacts: &'a [C],
    rest: &'a mut [C; BLOCK],
) -> &'a [C; BLOCK] {
    match <&[C; BLOCK]>::try_from(contacts) {
        Ok(all) => all,
        Err(_) => {
            for (k, lane) in rest.iter_mut().enumerate() {
                *lane = contacts[if k < contacts.len() { k } else { 0 }];
            }
            rest
        }
    }
}

/// Properties of the spheres of a block, which do not change with time.
pub(super) struct PropertyColumns {
    pub(super) radius: BlockColumn,
    mass: BlockColumn,
    inverse_mass: BlockColumn,
    inertia: BlockColumn,
}

impl PropertyColumns {
    pub(super) fn all(properties: SphereProperties) -> Self {
        Self {
            radius: [properties.radius; BLOCK],
            mass: [properties.mass; BLOCK],
            inverse_mass: [properties.inverse_mass; BLOCK],
            inertia: [properties.inertia; BLOCK],
        }
    }

    /// Gathers the properties of each lane's sphere, as far as the laws need them.
    #[inline(always)]
    pub(super) fn gather<N: NormalLaw, T: TangentialLaw>(
        &mut self,
        partners: &Partners<'_>,
        sphere: impl Fn(usize) -> u32,
    ) {
        for k in 0..BLOCK {
            self.radius[k] = partners.radius[sphere(k) as usize];
        }
        if T::WEIGHS {
            for k in 0..BLOCK {
                self.mass[k] = partners.mass[sphere(k) as usize];
                self.inertia[k] = partners.inertia[sphere(k) as usize];
            }
        }
        if Laws::<N, T>::NEEDS_EFFECTIVE_MASS {
            for k in 0..BLOCK {
                self.inverse_mass[k] = partners.inverse_mass[sphere(k) as usize];
            }
        }
    }

    #[inline(always)]
    pub(super) fn at(&self, k: usize) -> SphereProperties {
        SphereProperties {
            radius: self.radius[k],
            mass: self.mass[k],
            inverse_mass: self.inverse_mass[k],
            inertia: self.inertia[k],
        }
    }
}

/// Contacts of the spheres of a block with a wall.
pub(super) struct WallContactColumns {
    normal: VectorColumns,
    overlap: BlockColumn,
    /// 1 where they touch, else 0.
    touches: BlockColumn,
}

impl WallContactColumns {
    pub(super) const NONE: Self = Self {
        normal: VectorColumns::ZERO,
        overlap: [0.0; BLOCK],
        touches: [0.0; BLOCK],
    };

    #[inline(always)]
    pub(super) fn set(&mut self, k: usize, contact: &WallContact) {
        let [x, y, z] = &mut self.normal.0;
        (x[k], y[k], z[k]) = (contact.normal.x, contact.normal.y, contact.normal.z);
        self.overlap[k] = contact.overlap;
        self.touches[k] = if contact.touches { 1.0 } else { 0.0 };
    }

    #[inline(always)]
    pub(super) fn at(&self, k: usize) -> WallContact {
        WallContact {
            touches: self.touches[k] > 0.0,
            overlap: self.overlap[k],
            normal: self.normal.vector(k),
        }
    }
}
