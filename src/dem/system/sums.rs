//! Forces and torques, as contacts add to them.

use crate::forces::friction::TangentialLaw;
use crate::particles::vector::Vector;
use fearless_simd::{Simd, f64x4};

/// Forces and torques of some spheres, one after the other.
pub(super) struct Sums<'a> {
    /// The first one, as the partners of contacts are counted; wrapped where it comes before these.
    pub(super) first: usize,
    /// Forces (N).
    pub(super) force: &'a mut [Vector],
    /// Torques (N m), of spheres that turn.
    pub(super) torque: &'a mut [Vector],
}

impl Sums<'_> {
    /// The same, for a loop: whose bounds then stay in registers, whatever is written.
    #[inline(always)]
    pub(super) fn here<T: TangentialLaw>(&mut self) -> Sums<'_> {
        let torque = match T::ROTATES {
            true => &mut self.torque[..self.force.len()],
            false => &mut [],
        };
        Sums {
            first: self.first,
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
fn add<S: Simd>(simd: S, sum: &mut Vector, force: f64x4<S>) {
    *sum = Vector::of_row((sum.simd(simd) + force).into());
}
