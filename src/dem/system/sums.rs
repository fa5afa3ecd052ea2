//! Forces and torques, to which contacts add.

use crate::dem::threads::split;
use crate::forces::friction::TangentialLaw;
use crate::particles::vector::Vector;
use fearless_simd::{Simd, f64x4};

/// Forces and torques of some spheres, one after the other.
pub(super) struct Sums<'a> {
    /// The index of the first sphere, as [`Partners`](super::partners::Partners) count it. It wraps
    /// around zero if the sphere comes before them.
    pub(super) first: usize,
    /// Whether they are set to zero before anything is added.
    pub(super) clear: bool,
    /// Forces (N).
    pub(super) force: &'a mut [Vector],
    /// Torques (N m), of spheres that rotate.
    pub(super) torque: &'a mut [Vector],
}

impl<'a> Sums<'a> {
    /// Takes the sums of `count` spheres from the front.
    pub(super) fn split(&mut self, count: usize) -> Sums<'a> {
        let first = self.first;
        self.first += count;
        Sums {
            first,
            clear: self.clear,
            force: split(&mut self.force, count),
            torque: split(&mut self.torque, count),
        }
    }

    /// Borrows the sums for a loop. Their bounds then stay in registers, whatever is written.
    #[inline(always)]
    pub(super) fn here<T: TangentialLaw>(&mut self) -> Sums<'_> {
        let torque = match T::ROTATES {
            true => &mut self.torque[..self.force.len()],
            false => &mut [],
        };
        Sums {
            first: self.first,
            clear: false,
            force: self.force,
            torque,
        }
    }

    /// Adds to a sphere, if it is one of these.
    #[inline(always)]
    pub(super) fn add<S: Simd, T: TangentialLaw>(
        &mut self,
        simd: S,
        sphere: u32,
        force: f64x4<S>,
        torque: f64x4<S>,
    ) {
        let at = (sphere as usize).wrapping_sub(self.first);
        if at < self.force.len() {
            add(simd, &mut self.force[at], force);
            if T::ROTATES {
                add(simd, &mut self.torque[at], torque);
            }
        }
    }
}

#[inline(always)]
fn add<S: Simd>(simd: S, sum: &mut Vector, addend: f64x4<S>) {
    *sum = Vector::of_row((sum.simd(simd) + addend).into());
}
