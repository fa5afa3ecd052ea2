//! The loaded spring of a contact that sticks.

use super::{Touch, Traction};
use crate::dem::math::inverse_square_root;
use crate::dem::vector::Vector;
use serde::{Deserialize, Serialize};

/// The loaded spring of a contact that sticks.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct Spring {
    /// Its force (N).
    pub(in crate::dem) force: Vector,
}

/// Of the squares of two forces (N4): those of a spring of 1e-70 N.
const LEAST_PRODUCT: f64 = 1e-280;

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
        let elastic = self.force - loading;
        let force = elastic - drag;
        let squared = force.norm_squared();
        // Selects, not branches: so the loop over a block of contacts is turned into vector instructions.
        let slides = squared > limit * limit;
        let capped = force * (limit * inverse_square_root(squared));
        self.force = select(slides, capped + drag, elastic);
        touch.traction(select(slides, capped, force))
    }

    /// Its energy f^2 / (2 k) (J) at a stiffness k (N/m).
    pub(super) fn energy(&self, stiffness: f64) -> f64 {
        0.5 * self.force.norm_squared() / stiffness
    }

    /// The same in the plane across `normal`: the plane turns with the pair, and the force with it, its length
    /// kept.
    #[inline(always)]
    pub fn turned(&self, normal: Vector) -> Self {
        let turned = self.force.perpendicular_to(normal);
        let (before, after) = (self.force.norm_squared(), turned.norm_squared());
        // One root for |before| / |after|; what is too small for it is no force.
        let product = before * after;
        let scale = before * inverse_square_root(product);
        let force = select(product > LEAST_PRODUCT, turned * scale, Vector::ZERO);
        Self { force }
    }
}

/// The first where that is so, else the second.
#[inline(always)]
fn select(so: bool, first: Vector, second: Vector) -> Vector {
    Vector::new(
        if so { first.x } else { second.x },
        if so { first.y } else { second.y },
        if so { first.z } else { second.z },
    )
}
