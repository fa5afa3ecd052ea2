//! What a block of contacts holds besides columns of vectors.

use super::couple::Solid;
use super::meeting::Laws;
use super::partners::Partners;
use crate::dem::block::{BLOCK, Column, Columns};
use crate::dem::contact::NormalLaw;
use crate::dem::friction::TangentialLaw;
use crate::dem::walls::WallContact;

/// A block of contacts; lanes without one repeat the first.
#[inline(always)]
pub(super) fn whole<'a, C: Copy>(contacts: &'a [C], rest: &'a mut [C; BLOCK]) -> &'a [C; BLOCK] {
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

/// What of the spheres of a block does not change.
pub(super) struct Solids {
    pub(super) radius: Column,
    mass: Column,
    inverse_mass: Column,
    inertia: Column,
}

impl Solids {
    pub(super) fn all(solid: Solid) -> Self {
        Self {
            radius: [solid.radius; BLOCK],
            mass: [solid.mass; BLOCK],
            inverse_mass: [solid.inverse_mass; BLOCK],
            inertia: [solid.inertia; BLOCK],
        }
    }

    /// Fetches it of the sphere of every lane.
    #[inline(always)]
    pub(super) fn take<N: NormalLaw, T: TangentialLaw>(
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
    pub(super) fn at(&self, k: usize) -> Solid {
        Solid {
            radius: self.radius[k],
            mass: self.mass[k],
            inverse_mass: self.inverse_mass[k],
            inertia: self.inertia[k],
        }
    }
}

/// How the spheres of a block meet a wall.
pub(super) struct WallMeetings {
    normal: Columns,
    overlap: Column,
    /// 1 where they touch, else 0.
    touches: Column,
}

impl WallMeetings {
    pub(super) const NONE: Self = Self {
        normal: Columns::ZERO,
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
