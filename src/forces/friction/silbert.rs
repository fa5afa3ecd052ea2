//! The friction of Silbert et al.

use super::{Grip, LoadedSpring, Spring, TangentialLaw, Touch};
use crate::forces::contact::contact_radius;

/// A spring of stiffness sqrt(R_eff xi) k_t and a dashpot sqrt(R_eff xi) gamma_t m_eff beside it,
/// together capped at mu F_n (Silbert et al., Phys. Rev. E 64, 051302 (2001), for Hertzian
/// spheres).
///
/// The spring is loaded by increments, df = -sqrt(R_eff xi) k_t du, and keeps its force, as
/// Mindlin's does: a contact that holds still and is only pressed harder is not pulled aside
/// harder. `gran/hertz/history` of LAMMPS keeps the displacement instead, so that there the force
/// grows and shrinks with sqrt(xi); and it caps at mu |F_n| also where partners attract each other,
/// where here no tangential force acts.
#[derive(Clone, Copy, Debug)]
pub struct SilbertFriction {
    coefficient: f64,
    /// k_t (Pa).
    stiffness: f64,
    /// gamma_t (1/(m s)).
    damping: f64,
}

impl SilbertFriction {
    /// The law with coefficient mu, tangential stiffness k_t (Pa) and damping gamma_t (1/(m s)).
    pub fn new(coefficient: f64, stiffness: f64, damping: f64) -> Self {
        Self {
            coefficient,
            stiffness,
            damping,
        }
    }
}

impl TangentialLaw for SilbertFriction {
    const NEEDS_EFFECTIVE_MASS: bool = true;
    const WIDENS: bool = true;
    const DRAGS: bool = true;
    type History = Spring;

    #[inline(always)]
    fn load(&self, touch: &Touch, spring: Spring) -> LoadedSpring {
        let stiffness = self.stiffness * touch.loading_radius;
        let damping = self.damping * touch.effective_mass * touch.contact_radius;
        let limit = self.coefficient * touch.normal_force;
        spring.loaded(touch, stiffness, touch.sliding_velocity() * damping, limit)
    }

    #[inline(always)]
    fn stiffness(&self, overlap: f64, effective_radius: f64) -> f64 {
        self.stiffness * contact_radius(overlap, effective_radius)
    }

    fn damping(&self, grip: &Grip) -> f64 {
        let contact_radius = contact_radius(grip.overlap, grip.effective_radius);
        self.damping * grip.effective_mass * contact_radius
    }

    fn energy(&self, spring: &Spring, overlap: f64, effective_radius: f64) -> f64 {
        spring.energy(self.stiffness(overlap, effective_radius))
    }
}
