//! The loaded spring of a contact that sticks.

use super::Touch;
use crate::particles::math::inverse_square_root;
use crate::particles::vector::Vector;
use serde::{Deserialize, Serialize};

/// The loaded spring of a contact that sticks.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct Spring {
    /// Its force (N).
    pub(crate) force: Vector,
}

/// The least product of two squared forces (N4) that counts: that of two forces of 1e-70 N.
const LEAST_PRODUCT: f64 = 1e-280;

impl Spring {
    /// The spring, of a stiffness k (N/m), loaded by the sliding since the last evaluation, df = -k
    /// du, with the force `drag` (N) of a dashpot beside it, before both are capped at `limit` (N).
    #[inline(always)]
    pub(super) fn loaded(
        &self,
        touch: &Touch,
        stiffness: f64,
        drag: Vector,
        limit: f64,
    ) -> LoadedSpring {
        let loading = touch.loading_velocity * (stiffness * touch.loading_time);
        LoadedSpring {
            elastic: self.force - loading,
            drag,
            limit,
        }
    }

    /// Its energy f^2 / (2 k) (J) at a stiffness k (N/m).
    pub(super) fn energy(&self, stiffness: f64) -> f64 {
        0.5 * self.force.norm_squared() / stiffness
    }

    /// The spring turned into the plane across `normal`: it turns with the pair, and keeps its
    /// length.
    #[inline(always)]
    pub fn turned(&self, normal: Vector) -> Self {
        let turned = self.force.perpendicular_to(normal);
        let (before, after) = (self.force.norm_squared(), turned.norm_squared());
        // One root for |before| / |after|. Forces too small for it are set to zero.
        let product = before * after;
        let scale = before * inverse_square_root(product);
        let force = select(product > LEAST_PRODUCT, turned * scale, Vector::ZERO);
        Self { force }
    }
}

/// A loaded spring before it is capped by the limit of friction. The cap needs a root, which is
/// computed in a separate loop over many contacts.
#[derive(Clone, Copy, Debug, Default)]
pub struct LoadedSpring {
    /// Its force (N).
    pub(crate) elastic: Vector,
    /// The force that a dashpot beside it takes from that (N).
    pub(crate) drag: Vector,
    /// The most that friction carries of both (N).
    pub(crate) limit: f64,
}

impl LoadedSpring {
    /// The force of both (N), as long as friction carries it.
    #[inline(always)]
    pub(crate) fn force(&self) -> Vector {
        self.elastic - self.drag
    }

    /// Square of the force of both (N2).
    #[inline(always)]
    pub(crate) fn squared(&self) -> f64 {
        self.force().norm_squared()
    }

    /// The tangential force (N), and the spring that remains: at a sliding contact it keeps the
    /// length from which sticking would go on (Luding, Granular Matter 10, 235 (2008), section
    /// 2.3). Takes the square of the force (N2) and 1 / its root.
    #[inline(always)]
    pub(crate) fn capped(&self, squared: f64, inverse_root: f64) -> (Vector, Spring) {
        let force = self.force();
        // Selects, not branches: so the loop over a block of contacts is turned into vector
        // instructions.
        let slides = squared > self.limit * self.limit;
        let capped = force * (self.limit * inverse_root);
        let left = select(slides, capped + self.drag, self.elastic);
        (select(slides, capped, force), Spring { force: left })
    }
}

/// The first if `so`, else the second.
#[inline(always)]
fn select(so: bool, first: Vector, second: Vector) -> Vector {
    Vector::new(
        if so { first.x } else { second.x },
        if so { first.y } else { second.y },
        if so { first.z } else { second.z },
    )
}
