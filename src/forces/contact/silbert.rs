//! The Hertz contact of Silbert et al.

use super::keys::elastic;
use super::{Collision, ContactKeys, HertzLaw, Impact, NormalLaw, contact_radius};
use crate::document::quantity;
use crate::forces::limit::Regime;
use crate::forces::simplification::Simplification;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Hertzian spring and a dashpot that grows with the masses (Silbert et al., 2001;
/// `gran/hertz/history` of LAMMPS): F = sqrt(R_eff xi) (k_n xi + gamma_n m_eff dxi/dt).
/// Attractive at the end of a contact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Silbert {
    /// Stiffness k_n (Pa).
    #[schemars(transform = quantity("k", "Pa", "spring constant of a contact").above(0.0))]
    pub stiffness: f64,
    /// Damping gamma_n (1/(m s)).
    #[schemars(
        transform = quantity("b", "1/(m s)", "drag constant of a contact").at_least(0.0)
    )]
    pub damping: f64,
}

impl ContactKeys for Silbert {
    type Law = SilbertLaw;
    const NAME: &'static str = "silbert";
    const CONTACT_LIMIT: &'static str = "2/w of the two smallest spheres at their deepest overlap, \
                                         at the start or in the fastest impact, \
                                         w^2 = (3/2) k_n sqrt(R_eff xi) / m_eff";
    const DAMPED_LIMIT: &'static str = "(w dt)^2 + 2 q g dt < 4 with the w of the contact and the \
                                        damping rate g = gamma_n sqrt(R_eff xi), of pairs and at \
                                        walls; q = 2 for synchronised-verlet, else 1";

    fn law(&self, _: f64, _: f64) -> SilbertLaw {
        SilbertLaw::new(self.stiffness, self.damping)
    }

    /// The stiffest one first: at the fastest speed, or from the deepest overlap at the start. Two
    /// of the smallest spheres are the stiffest, w^2 = (3/2) k_n sqrt(R_eff xi) / m_eff; the
    /// damping rate gamma_n sqrt(R_eff xi) grows with the radius and is largest for the largest
    /// sphere at a wall. In between the limit has no minimum: the sum of rate and frequency is
    /// convex in the radius.
    fn collisions(&self, regime: &Regime<'_>) -> Vec<Collision> {
        let collision = |effective_radius: f64, effective_mass: f64| {
            let impact = Impact {
                effective_mass,
                stiffness: self.stiffness * effective_radius.sqrt(),
                speed: regime.fastest_impact,
            };
            let impact = impact.or_release_from(*regime.deepest_at_start);
            let root = (effective_radius * impact.deepest_overlap()).sqrt();
            Collision::of_impact(&impact, effective_radius, self.damping * root)
        };
        let sizes = [
            (regime.smallest_radius, regime.smallest_mass),
            (regime.largest_radius, regime.largest_mass),
        ];
        let pairs = sizes.map(|(radius, mass)| collision(0.5 * radius, 0.5 * mass));
        let walls = sizes.map(|(radius, mass)| collision(radius, mass));
        // A small sphere meets a much larger one like a wall.
        let has_walls = regime.has_walls || regime.smallest_radius < regime.largest_radius;
        let walls = walls.into_iter().filter(|_| has_walls);
        let all = pairs.into_iter().chain(walls);
        all.filter(|collision| collision.speed > 0.0).collect()
    }

    fn simplifications(&self) -> Vec<Simplification> {
        elastic(self.damping > 0.0, "contact.damping", 0.0).collect()
    }
}

/// F = sqrt(R_eff xi) (k_n xi + gamma_n m_eff dxi/dt), with overlap xi, stiffness k_n, damping
/// gamma_n and m_eff = m_i m_j / (m_i + m_j), the mass of the sphere at a wall or a fixed sphere
/// (Silbert et al., Phys. Rev. E 64, 051302 (2001), for Hertzian spheres, in the form of
/// `gran/hertz/history` of LAMMPS).
///
/// As in LAMMPS, it attracts at the end of a contact, where spheres part faster than their
/// elasticity recovers: they are in contact until their overlap is zero. (LAMMPS removes the
/// attraction with `limit_damping`.)
#[derive(Clone, Copy, Debug)]
pub struct SilbertLaw {
    /// sqrt(R_eff xi) k_n xi.
    elastic: HertzLaw,
    /// gamma_n (1/(m s)).
    damping: f64,
}

impl SilbertLaw {
    /// The law with stiffness k_n (Pa) and damping gamma_n (1/(m s)).
    pub fn new(stiffness: f64, damping: f64) -> Self {
        Self {
            elastic: HertzLaw::elastic(stiffness),
            damping,
        }
    }
}

impl NormalLaw for SilbertLaw {
    const ATTRACTS: bool = true;
    const NEEDS_EFFECTIVE_MASS: bool = true;
    const USES_CONTACT_RADIUS: bool = true;

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
