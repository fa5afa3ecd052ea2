//! The loaded spring of a contact that sticks.

use super::{Touch, Traction};
use crate::dem::vector::Vector;
use serde::{Deserialize, Serialize};

/// The loaded spring of a contact that sticks.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct Spring {
    /// Its force (N).
    pub(super) force: Vector,
}

impl Spring {
    /// The traction of the spring, of a stiffness (N/m), and of a dashpot beside it (N s/m), together
    /// capped at `limit` (N). It is loaded by the sliding since the latest evaluation, df = -k du; one that
    /// slides keeps the length with which it would go on sticking from there (Luding, Granular Matter 10, 235
    /// (2008), section 2.3).
    #[inline(always)]
    pub(super) fn load(
        &mut self,
        touch: &Touch,
        stiffness: f64,
        damping: f64,
        limit: f64,
    ) -> Traction {
        let drag = touch.sliding_velocity() * damping;
        let loading = touch.loading_velocity * (stiffness * touch.loading_time);
        let elastic = self.turned(touch.normal) - loading;
        let mut force = elastic - drag;
        self.force = elastic;
        let norm = force.norm();
        if norm > limit {
            force = force * (limit / norm);
            self.force = force + drag;
        }
        touch.traction(force)
    }

    /// Its energy f^2 / (2 k) (J) at a stiffness k (N/m).
    pub(super) fn energy(&self, stiffness: f64) -> f64 {
        0.5 * self.force.norm_squared() / stiffness
    }

    /// The force (N) in the plane across `normal`: the plane turns with the pair, and the force with
    /// it, its length kept.
    #[inline(always)]
    fn turned(&self, normal: Vector) -> Vector {
        let turned = self.force.perpendicular_to(normal);
        let (before, after) = (self.force.norm_squared(), turned.norm_squared());
        if after > 0.0 {
            turned * (before / after).sqrt()
        } else {
            Vector::ZERO
        }
    }
}
