//! The Hertz contact of Silbert et al.

use super::{Hertz, NormalLaw, contact_radius};

/// F = sqrt(R_eff xi) (k_n xi + gamma_n m_eff dxi/dt), with overlap xi, stiffness k_n, damping
/// gamma_n and m_eff = m_i m_j / (m_i + m_j), the mass of the sphere at a wall or a fixed sphere
/// (Silbert et al., Phys. Rev. E 64, 051302 (2001), for Hertzian spheres, in the form of
/// `gran/hertz/history` of LAMMPS).
///
/// As there it attracts at the end of a contact, where spheres part faster than their elasticity
/// recovers: they are in contact until their overlap is zero. (LAMMPS leaves the attraction out if
/// it is asked to, by `limit_damping`.)
#[derive(Clone, Copy, Debug)]
pub struct Silbert {
    /// sqrt(R_eff xi) k_n xi.
    elastic: Hertz,
    /// gamma_n (1/(m s)).
    damping: f64,
}

impl Silbert {
    /// The law with stiffness k_n (Pa) and damping gamma_n (1/(m s)).
    pub fn new(stiffness: f64, damping: f64) -> Self {
        Self {
            elastic: Hertz::elastic(stiffness),
            damping,
        }
    }
}

impl NormalLaw for Silbert {
    const ATTRACTS: bool = true;
    const NEEDS_EFFECTIVE_MASS: bool = true;
    const WIDENS: bool = true;

    #[inline(always)]
    fn force(
        &self,
        overlap: f64,
        overlap_rate: f64,
        contact_radius: f64,
        effective_mass: f64,
    ) -> f64 {
        contact_radius
            * (self.elastic.modulus() * overlap + self.damping * effective_mass * overlap_rate)
    }

    #[inline(always)]
    fn elastic_energy(&self, overlap: f64, effective_radius: f64) -> f64 {
        self.elastic.elastic_energy(overlap, effective_radius)
    }

    fn stiffness(&self, overlap: f64, effective_radius: f64) -> f64 {
        self.elastic.stiffness(overlap, effective_radius)
    }

    fn damping(&self, overlap: f64, effective_radius: f64, effective_mass: f64) -> f64 {
        self.damping * effective_mass * contact_radius(overlap, effective_radius)
    }

    fn deepest_overlap(
        &self,
        overlap: f64,
        speed: f64,
        effective_radius: f64,
        effective_mass: f64,
    ) -> f64 {
        (self.elastic).deepest_overlap(overlap, speed, effective_radius, effective_mass)
    }
}
