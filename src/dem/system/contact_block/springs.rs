//! Springs of a block of contacts, and the limit of friction.

use super::{ContactBlock, NOT_DEEP, if_touching, store};
use crate::dem::system::contact_laws::LoadedContact;
use crate::forces::friction::{
    ForceChange, History, Keeps, LoadedSpring, Spring, TangentialLaw, Turning, arm,
};
use crate::particles::block::{BLOCK, ROWS};
use crate::particles::math::inverse_square_root;
use crate::particles::vector::Vector;

impl<H: History> ContactBlock<H> {
    /// Adds friction to the forces: the springs, up to the limit of friction. `FIRST_ONLY` leaves
    /// out the second torque, where it equals the first or is not needed.
    #[inline(always)]
    pub(super) fn add_friction_to_all<T: TangentialLaw<History = H>, const FIRST_ONLY: bool>(
        &mut self,
        normal: impl Fn(&Self, usize) -> Vector,
    ) {
        if !Self::HAS_HISTORY {
            return;
        }
        for at in (0..BLOCK).step_by(ROWS) {
            let eight = at..at + ROWS;
            let slides = |k: usize| self.squared[k] > self.limit[k] * self.limit[k];
            // In a bed at rest hardly any contact slides, and the root takes long.
            if eight.clone().fold(false, |any, k| any | slides(k)) {
                for k in eight.clone() {
                    self.inverse_root[k] = inverse_square_root(self.squared[k]);
                }
                for k in eight {
                    let loaded = self.loaded::<T>(k);
                    let (force, spring) = loaded.capped(self.squared[k], self.inverse_root[k]);
                    self.spring.set(k, spring.force);
                    self.add_friction::<FIRST_ONLY>(k, force, normal(self, k));
                }
            } else {
                for k in eight {
                    let force = self.loaded::<T>(k).force();
                    self.add_friction::<FIRST_ONLY>(k, force, normal(self, k));
                }
            }
        }
    }

    #[inline(always)]
    fn loaded<T: TangentialLaw>(&self, k: usize) -> LoadedSpring {
        LoadedSpring {
            elastic: self.spring.vector(k),
            drag: match T::DRAGS {
                true => self.drag.vector(k),
                false => Vector::ZERO,
            },
            limit: self.limit[k],
        }
    }

    #[inline(always)]
    fn add_friction<const FIRST_ONLY: bool>(&mut self, k: usize, force: Vector, normal: Vector) {
        let arm = arm(force, normal);
        self.force.set(k, self.force.vector(k) + force);
        let [one, other] = [0, 1].map(|side| self.properties[side].radius[k] * self.lever[k]);
        self.torque[0].set(k, arm * one);
        if !FIRST_ONLY {
            self.torque[1].set(k, arm * other);
        }
    }

    /// Stores a contact whose spring is loaded. The limit of friction is applied later.
    #[inline(always)]
    pub(super) fn store_loaded<T: TangentialLaw>(&mut self, k: usize, loaded: &LoadedContact) {
        let touches = loaded.touches;
        self.too_deep[k] = if loaded.too_deep {
            loaded.overlap
        } else {
            NOT_DEEP
        };
        store(&mut self.force, k, touches, loaded.force);
        store(&mut self.spring, k, touches, loaded.spring.elastic);
        if T::DRAGS {
            store(&mut self.drag, k, touches, loaded.spring.drag);
        }
        if H::HAS_RADIUS {
            self.spring_radius[k] = if_touching(touches, loaded.contact_radius);
        }
        self.limit[k] = loaded.spring.limit;
        self.squared[k] = if_touching(touches, loaded.spring.squared());
        self.lever[k] = loaded.lever;
    }

    /// Turns springs and turning points into the planes across the normals, by `turned`, and
    /// changes the forces of springs with the contact radius (m), in a separate loop, like the
    /// roots.
    #[inline(always)]
    pub(super) fn bring_springs(
        &mut self,
        keeps: Keeps,
        radius: impl Fn(&Self, usize) -> f64,
        turned: impl Fn(&Self, usize, Spring, ForceChange) -> Spring,
    ) {
        if !Self::HAS_HISTORY {
            return;
        }
        if H::HAS_RADIUS && keeps != Keeps::Force {
            for k in 0..BLOCK {
                let change = keeps.change(self.spring_radius[k], radius(self, k));
                let force = turned(self, k, self.spring(k), change).force;
                self.spring.set(k, force);
            }
        } else {
            for k in 0..BLOCK {
                let force = turned(self, k, self.spring(k), ForceChange::NONE).force;
                self.spring.set(k, force);
            }
        }
        if H::TURNS {
            for k in 0..BLOCK {
                let force = self.turning_force.vector(k);
                let force = turned(self, k, Spring { force }, ForceChange::NONE).force;
                self.turning_force.set(k, force);
            }
        }
    }

    #[inline(always)]
    pub(super) fn turning(&self, k: usize) -> Turning {
        match H::TURNS {
            true => Turning {
                force: self.turning_force.vector(k),
                normal_force: self.turning_normal_force[k],
                peak: self.turning_peak[k],
            },
            false => Turning::default(),
        }
    }

    #[inline(always)]
    pub(super) fn set_turning(&mut self, k: usize, turning: Turning) {
        if H::TURNS {
            self.turning_force.set(k, turning.force);
            self.turning_normal_force[k] = turning.normal_force;
            self.turning_peak[k] = turning.peak;
        }
    }

    #[inline(always)]
    pub(super) fn spring(&self, k: usize) -> Spring {
        let force = match Self::HAS_HISTORY {
            true => self.spring.vector(k),
            false => Vector::ZERO,
        };
        Spring { force }
    }
}
