//! Viscoelastic Hertz contact.

use super::{NormalLaw, contact_radius};

/// F = K (xi^1.5 + c A sqrt(xi) dxi/dt), never attractive, with
/// K = 2 Y sqrt(R_eff) / (3 (1 - nu^2)), overlap xi, dissipation time A and factor c:
/// c = 3/2 in Brilliantov et al., Phys. Rev. E 53, 5382 (1996), c = 1 in Rice (2012), eq. 9.
#[derive(Clone, Copy, Debug)]
pub struct Hertz {
    /// K / sqrt(R_eff) (Pa).
    modulus: f64,
    /// c A (s).
    dissipation: f64,
}

impl Hertz {
    /// The law for partners of the same material: Young's modulus (Pa), Poisson's ratio,
    /// dissipation time A (s) and the factor c.
    pub fn new(young_modulus: f64, poisson_ratio: f64, dissipation_time: f64, factor: f64) -> Self {
        Self {
            modulus: 2.0 * young_modulus / (3.0 * (1.0 - poisson_ratio * poisson_ratio)),
            dissipation: factor * dissipation_time,
        }
    }

    /// The law without losses, of that K / sqrt(R_eff) (Pa).
    pub(super) fn elastic(modulus: f64) -> Self {
        Self {
            modulus,
            dissipation: 0.0,
        }
    }

    /// K / sqrt(R_eff) (Pa).
    #[inline(always)]
    pub(super) fn modulus(&self) -> f64 {
        self.modulus
    }
}

impl NormalLaw for Hertz {
    const WIDENS: bool = true;

    #[inline(always)]
    fn force(&self, overlap: f64, overlap_rate: f64, contact_radius: f64, _: f64) -> f64 {
        let force = self.modulus * contact_radius * (overlap + self.dissipation * overlap_rate);
        if force < 0.0 { 0.0 } else { force }
    }

    #[inline(always)]
    fn elastic_energy(&self, overlap: f64, effective_radius: f64) -> f64 {
        0.4 * self.modulus * contact_radius(overlap, effective_radius) * overlap * overlap
    }

    fn stiffness(&self, overlap: f64, effective_radius: f64) -> f64 {
        1.5 * self.modulus * contact_radius(overlap, effective_radius)
    }

    fn damping(&self, overlap: f64, effective_radius: f64, _: f64) -> f64 {
        self.modulus * contact_radius(overlap, effective_radius) * self.dissipation
    }

    fn deepest_overlap(
        &self,
        overlap: f64,
        speed: f64,
        effective_radius: f64,
        effective_mass: f64,
    ) -> f64 {
        let stiffness = self.modulus * effective_radius.sqrt();
        let kinetic = 1.25 * effective_mass * speed * speed / stiffness;
        libm::pow(overlap * overlap * overlap.sqrt() + kinetic, 0.4)
    }
}
