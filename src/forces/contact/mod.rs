//! Normal contact laws, one file each: keys, formula, what limits the time step.

mod elastic_solid;
mod hertz;
mod hooke;
mod impact;
mod keys;
mod linear;
pub mod restitution;
mod silbert;
mod tsuji;

pub(crate) use elastic_solid::ElasticSolid;
pub use elastic_solid::rayleigh_time;
pub use hertz::{Hertz, HertzLaw};
pub use hooke::{Hooke, HookeLaw};
pub use impact::{Impact, LinearImpact};
pub use keys::Contact;
pub(crate) use keys::{Collision, ContactKeys, with_keys};
pub use linear::{ContactDrag, Linear, LinearLaw};
pub use silbert::{Silbert, SilbertLaw};
pub use tsuji::{Tsuji, TsujiLaw};

/// Radius sqrt(R_eff xi) (m) of the disc in which partners touch (Hertz, 1882), from the overlap xi
/// (m) and the effective radius r1 r2 / (r1 + r2) (m; the sphere's own at a flat wall).
#[inline(always)]
pub fn contact_radius(overlap: f64, effective_radius: f64) -> f64 {
    // By rounding, the overlap of touching spheres can be slightly negative.
    let overlap = if overlap > 0.0 { overlap } else { 0.0 };
    (effective_radius * overlap).sqrt()
}

/// A normal contact law. The engine is compiled for each law by itself.
pub trait NormalLaw: Copy + Send + Sync + 'static {
    /// Whether there are contacts at all.
    const ACTS: bool = true;

    /// Whether partners that slide along each other are dragged, too.
    const DRAGS_SIDEWAYS: bool = false;

    /// Whether the force may be attractive.
    const ATTRACTS: bool = false;

    /// Whether the force depends on the [`contact_radius`].
    const USES_CONTACT_RADIUS: bool = false;

    /// Whether the law uses the effective mass. If not, [`force`](Self::force) ignores it.
    const NEEDS_EFFECTIVE_MASS: bool = false;

    /// Repulsive force (N) from the overlap (m), its rate (m/s), the [`contact_radius`] (m) and the
    /// effective mass m1 m2 / (m1 + m2) (kg; at a wall or a fixed sphere the mass of the moving
    /// sphere).
    fn force(
        &self,
        overlap: f64,
        overlap_rate: f64,
        contact_radius: f64,
        effective_mass: f64,
    ) -> f64;

    /// The force (N) at this overlap (m) without relative velocity.
    fn elastic_force(&self, overlap: f64, effective_radius: f64) -> f64 {
        let contact_radius = contact_radius(overlap, effective_radius);
        self.force(overlap, 0.0, contact_radius, 0.0)
    }

    /// Drag per tangential relative velocity of the centres (N s/m); used only if the law [drags
    /// sideways](Self::DRAGS_SIDEWAYS).
    fn sideways_drag(&self) -> f64 {
        0.0
    }

    /// Elastic energy (J) stored at this overlap.
    fn elastic_energy(&self, overlap: f64, effective_radius: f64) -> f64;

    /// dF / d overlap (N/m) at this overlap.
    fn stiffness(&self, overlap: f64, effective_radius: f64) -> f64;

    /// dF / d overlap rate (N s/m) at this overlap, for an effective mass (kg).
    fn damping(&self, overlap: f64, effective_radius: f64, effective_mass: f64) -> f64;

    /// Deepest overlap (m) of an impact without losses, which at the given overlap (m) still has
    /// the given speed (m/s).
    fn deepest_overlap(
        &self,
        overlap: f64,
        speed: f64,
        effective_radius: f64,
        effective_mass: f64,
    ) -> f64;
}

/// No contacts: spheres pass through each other and through walls.
#[derive(Clone, Copy, Debug)]
pub struct NoContact;

impl NormalLaw for NoContact {
    const ACTS: bool = false;

    #[inline(always)]
    fn force(&self, _: f64, _: f64, _: f64, _: f64) -> f64 {
        0.0
    }

    #[inline(always)]
    fn elastic_energy(&self, _: f64, _: f64) -> f64 {
        0.0
    }

    fn stiffness(&self, _: f64, _: f64) -> f64 {
        0.0
    }

    fn damping(&self, _: f64, _: f64, _: f64) -> f64 {
        0.0
    }

    fn deepest_overlap(&self, _: f64, _: f64, _: f64, _: f64) -> f64 {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::contact_radius;

    /// Symptom: NaN forces on spheres that just touch. Cause: the root of an overlap that rounding
    /// made slightly negative, although the squared distances said that they touch.
    #[test]
    fn partners_a_hair_apart_touch_in_a_point() {
        assert_eq!(contact_radius(-1e-19, 0.004), 0.0);
        assert_eq!(contact_radius(0.0, 0.004), 0.0);
        assert!(contact_radius(1e-6, 0.004) > 0.0);
    }
}
