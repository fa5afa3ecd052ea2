//! The linear contact of Silbert et al.

use super::keys::elastic;
use super::{Collision, ContactKeys, LinearImpact, NormalLaw};
use crate::document::quantity;
use crate::forces::limit::Regime;
use crate::forces::simplification::Simplification;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Linear spring and a dashpot that grows with the masses (Silbert et al., 2001;
/// `gran/hooke/history` of LAMMPS): F = k_n xi + gamma_n m_eff dxi/dt. Attractive at the end of a
/// contact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Hooke {
    /// Spring constant k_n (N/m).
    #[schemars(transform = quantity("k", "N/m", "spring constant of a contact").above(0.0))]
    pub stiffness: f64,
    /// Damping rate gamma_n (1/s).
    #[schemars(transform = quantity("γ", "1/s", "damping rate of a contact").at_least(0.0))]
    pub damping_rate: f64,
}

impl ContactKeys for Hooke {
    type Law = HookeLaw;
    const NAME: &'static str = "hooke";
    const CONTACT_LIMIT: &'static str = "2/w of the two smallest spheres, w^2 = k_n / m_eff";
    const DAMPED_LIMIT: &'static str = "(w dt)^2 + 2 q g dt < 4 with the w of the contact limit \
                                        and the damping rate g = gamma_n; q = 2 for \
                                        synchronised-verlet, else 1";

    fn law(&self, _: f64, _: f64) -> HookeLaw {
        HookeLaw::new(self.stiffness, self.damping_rate)
    }

    /// The impact of the two smallest spheres; all others have larger effective masses, and are
    /// softer, with the same damping rate.
    fn collisions(&self, regime: &Regime<'_>) -> Vec<Collision> {
        let effective_mass = 0.5 * regime.smallest_mass;
        let impact = LinearImpact {
            effective_mass,
            stiffness: self.stiffness,
            damping: self.damping_rate * effective_mass,
        };
        vec![Collision::of_linear_impact(&impact, regime.fastest_impact)]
    }

    fn simplifications(&self) -> Vec<Simplification> {
        elastic(self.damping_rate > 0.0, "contact.damping_rate", 0.0).collect()
    }
}

/// F = k_n xi + gamma_n m_eff dxi/dt, with overlap xi, spring constant k_n, damping rate gamma_n
/// and m_eff = m_i m_j / (m_i + m_j), the mass of the sphere at a wall or a fixed sphere (Silbert
/// et al., Phys. Rev. E 64, 051302 (2001), for Hookean spheres; `gran/hooke/history` of
/// LAMMPS).
///
/// A head-on impact takes t = pi / sqrt(k_n / m_eff - gamma_n^2 / 4) and has the restitution
/// exp(-gamma_n t / 2). As in LAMMPS, the law attracts at the end of a contact, where spheres part
/// faster than their elasticity recovers: they are in contact until their overlap is zero.
#[derive(Clone, Copy, Debug)]
pub struct HookeLaw {
    /// k_n (N/m).
    stiffness: f64,
    /// gamma_n (1/s).
    damping_rate: f64,
}

impl HookeLaw {
    /// The law with a spring constant k_n (N/m) and a damping rate gamma_n (1/s).
    pub fn new(stiffness: f64, damping_rate: f64) -> Self {
        Self {
            stiffness,
            damping_rate,
        }
    }
}

impl NormalLaw for HookeLaw {
    const ATTRACTS: bool = true;
    const NEEDS_EFFECTIVE_MASS: bool = true;

    #[inline(always)]
    fn force(&self, overlap: f64, overlap_rate: f64, _: f64, effective_mass: f64) -> f64 {
        self.stiffness * overlap + self.damping_rate * effective_mass * overlap_rate
    }

    #[inline(always)]
    fn elastic_energy(&self, overlap: f64, _: f64) -> f64 {
        0.5 * self.stiffness * overlap * overlap
    }

    fn stiffness(&self, _: f64, _: f64) -> f64 {
        self.stiffness
    }

    fn damping(&self, _: f64, _: f64, effective_mass: f64) -> f64 {
        self.damping_rate * effective_mass
    }

    fn deepest_overlap(&self, overlap: f64, speed: f64, _: f64, effective_mass: f64) -> f64 {
        (overlap * overlap + effective_mass * speed * speed / self.stiffness).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::forces::contact::{ContactDrag, LinearLaw};
    use proptest::prelude::*;

    proptest! {
        /// For one pair it is the linear law with b = gamma_n m_eff.
        #[test]
        fn of_one_mass_it_is_the_linear_law(
            mass in 1e-6..1.0,
            rate in 0.0..1e4,
            overlap in 0.0..1e-3,
            speed in -1.0..1.0,
        ) {
            let law = HookeLaw::new(2000.0, rate);
            let linear = LinearLaw::new(2000.0, rate * mass, ContactDrag::Normal);
            let found = law.force(overlap, speed, 0.0, mass);
            prop_assert_eq!(found, linear.force(overlap, speed, 0.0, 0.0));
            prop_assert_eq!(law.damping(overlap, 0.0, mass), linear.damping(overlap, 0.0, 0.0));
        }
    }
}
