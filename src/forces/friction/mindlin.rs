//! Mindlin friction by increments.

use super::{LoadedSpring, Spring, TangentialLaw, Touch};
use crate::forces::contact::contact_radius;
use crate::particles::vector::Vector;

/// Mindlin's tangential stiffness k_t = 8 G* sqrt(R_eff xi) on a contact that sticks, loaded and
/// unloaded by increments of the sliding displacement, df = -k_t du, and capped at mu F_n; G* = G /
/// (2 (2 - nu)) for equal materials (Mindlin, J. Appl. Mech. 16, 259 (1949); Chung and Ooi,
/// Granular Matter 13, 643 (2011)).
///
/// The force of a spring that holds still stays when the normal force falls, although its
/// stiffness does not (Thornton, Cummins and Cleary, Powder Technology 233, 30 (2013), shrink it):
/// an elastic impact can so gain energy, less than 1e-5 of it for nu > 0.2 and mu < 3, up to
/// 4e-4 for nu = 0 and mu = 0.5.
#[derive(Clone, Copy, Debug)]
pub struct Mindlin {
    coefficient: f64,
    /// 8 G* (Pa).
    modulus: f64,
}

impl Mindlin {
    /// The law with coefficient mu, Young's modulus (Pa) and Poisson's ratio of both partners.
    pub fn new(coefficient: f64, young_modulus: f64, poisson_ratio: f64) -> Self {
        let shear_modulus = young_modulus / (2.0 * (1.0 + poisson_ratio));
        Self {
            coefficient,
            modulus: 8.0 * shear_modulus / (2.0 * (2.0 - poisson_ratio)),
        }
    }
}

impl TangentialLaw for Mindlin {
    const WIDENS: bool = true;
    type History = Spring;

    #[inline(always)]
    fn load(&self, touch: &Touch, spring: Spring) -> LoadedSpring {
        let stiffness = self.modulus * touch.loading_radius;
        let limit = self.coefficient * touch.normal_force;
        spring.loaded(touch, stiffness, Vector::ZERO, limit)
    }

    #[inline(always)]
    fn stiffness(&self, overlap: f64, effective_radius: f64) -> f64 {
        self.modulus * contact_radius(overlap, effective_radius)
    }

    fn energy(&self, spring: &Spring, overlap: f64, effective_radius: f64) -> f64 {
        spring.energy(self.stiffness(overlap, effective_radius))
    }
}
