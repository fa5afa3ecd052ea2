//! Viscoelastic Hertz contact.

use super::keys::elastic;
use super::restitution::dissipation_time_from_restitution;
use super::{Collision, ContactKeys, ElasticSolid, NormalLaw, contact_radius};
use crate::document::{Problem, quantity};
use crate::forces::limit::{Limit, Regime};
use crate::forces::one;
use crate::forces::simplification::Simplification;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Viscoelastic Hertz contact (Brilliantov et al., 1996), never attractive.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Hertz {
    /// Young's modulus Y (Pa).
    #[schemars(transform = quantity("Y", "Pa", "Young's modulus").above(0.0))]
    pub young_modulus: f64,
    /// Poisson's ratio nu.
    #[schemars(transform = quantity("ν", "", "Poisson's ratio").above(-1.0).at_most(0.5))]
    pub poisson_ratio: f64,
    /// Dissipation time A (s). Give this or `restitution`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = quantity("A", "s", "dissipation time").at_least(0.0))]
    pub dissipation_time: Option<f64>,
    /// Restitution of a head-on pair at `restitution_speed`, from which A follows for
    /// the scene's (mean) radius. Give this or `dissipation_time`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(
        transform = quantity("e", "", "coefficient of restitution").at_least(0.01).at_most(1.0)
    )]
    pub restitution: Option<f64>,
    /// Relative speed at which `restitution` holds (m/s, default 1).
    #[serde(default = "one")]
    #[schemars(
        transform = quantity("v_e", "m/s", "speed at which the restitution holds").above(0.0)
    )]
    pub restitution_speed: f64,
    /// Factor c of the dissipative term: 1 as the thesis prints it (default), 3/2 as
    /// Brilliantov et al. derive it.
    #[serde(default = "one")]
    #[schemars(transform = quantity("c", "", "factor of the dissipative term").above(0.0))]
    pub dissipation_factor: f64,
}

impl Hertz {
    /// Dissipation time A (s): as given, or such that two spheres of this radius (m) and mass (kg)
    /// have the given restitution.
    pub fn dissipation_time(&self, radius: f64, mass: f64) -> f64 {
        match (self.dissipation_time, self.restitution) {
            (Some(time), _) => time,
            (None, None) => 0.0,
            (None, Some(restitution)) => {
                let impact = self.impact(radius, mass, self.restitution_speed);
                let factor = self.dissipation_factor;
                dissipation_time_from_restitution(restitution, impact.time_scale(), factor)
            }
        }
    }
}

impl ElasticSolid for Hertz {
    fn young_modulus(&self) -> f64 {
        self.young_modulus
    }

    fn poisson_ratio(&self) -> f64 {
        self.poisson_ratio
    }
}

impl ContactKeys for Hertz {
    type Law = HertzLaw;
    const NAME: &'static str = "hertz";
    const CONTACT_LIMIT: &'static str = "2/w of the two smallest spheres at their deepest overlap, \
                                         at the start or in the fastest impact, \
                                         w^2 = (3/2) K sqrt(xi) / m_eff";
    const DAMPED_LIMIT: &'static str = "(w dt)^2 + 2 q g dt < 4 with the w of the contact limit \
                                        and the damping rate g = (2/3) c A w^2; q = 2 for \
                                        synchronised-verlet, else 1";

    fn law(&self, mean_radius: f64, mean_mass: f64) -> HertzLaw {
        HertzLaw::new(
            self.young_modulus,
            self.poisson_ratio,
            self.dissipation_time(mean_radius, mean_mass),
            self.dissipation_factor,
        )
    }

    fn collisions(&self, regime: &Regime<'_>) -> Vec<Collision> {
        let Some(fastest) = self.stiffest_impact(regime) else {
            return Vec::new();
        };
        let frequency = fastest.angular_frequency();
        // The law's damping at overlap xi: g = K c A sqrt(xi) / m_eff.
        let time = self.dissipation_time(regime.mean_radius, regime.mean_mass);
        let rate = 2.0 / 3.0 * self.dissipation_factor * time * frequency * frequency;
        let effective_radius = 0.5 * regime.smallest_radius;
        vec![Collision::of_impact(&fastest, effective_radius, rate)]
    }

    fn other_limits(&self, regime: &Regime<'_>) -> Vec<Limit> {
        vec![self.rayleigh_limit(regime)]
    }

    fn simplifications(&self) -> Vec<Simplification> {
        match (self.dissipation_time, self.restitution) {
            (Some(time), _) => elastic(time > 0.0, "contact.dissipation_time", 0.0).collect(),
            (_, Some(e)) => elastic(e < 1.0, "contact.restitution", 1.0).collect(),
            _ => Vec::new(),
        }
    }

    fn problems(&self) -> Vec<Problem> {
        match (self.dissipation_time, self.restitution) {
            (None, None) => {
                let message = "[contact] does not say how much it dissipates";
                let help = "add `dissipation_time` (0.0 is elastic) or `restitution`";
                vec![Problem::new("contact", message).help(help)]
            }
            (Some(_), Some(_)) => {
                let message =
                    "`contact.dissipation_time` and `contact.restitution` exclude each other";
                let help = "keep the one that is known and remove the other";
                vec![Problem::new("contact.restitution", message).help(help)]
            }
            _ => Vec::new(),
        }
    }
}

/// K / sqrt(R_eff) = 2 Y / (3 (1 - nu^2)) (Pa) of partners of the same Young's modulus (Pa) and
/// Poisson's ratio (Hertz, 1882).
pub(super) fn hertz_modulus(young_modulus: f64, poisson_ratio: f64) -> f64 {
    2.0 * young_modulus / (3.0 * (1.0 - poisson_ratio * poisson_ratio))
}

/// F = K (xi^1.5 + c A sqrt(xi) dxi/dt), never attractive, with
/// K = 2 Y sqrt(R_eff) / (3 (1 - nu^2)), overlap xi, dissipation time A and factor c:
/// c = 3/2 in Brilliantov et al., Phys. Rev. E 53, 5382 (1996), c = 1 in Rice (2012), eq. 9.
#[derive(Clone, Copy, Debug)]
pub struct HertzLaw {
    /// K / sqrt(R_eff) (Pa).
    modulus: f64,
    /// c A (s).
    dissipation: f64,
}

impl HertzLaw {
    /// The law for partners of the same material: Young's modulus (Pa), Poisson's ratio,
    /// dissipation time A (s) and the factor c.
    pub fn new(young_modulus: f64, poisson_ratio: f64, dissipation_time: f64, factor: f64) -> Self {
        Self {
            modulus: hertz_modulus(young_modulus, poisson_ratio),
            dissipation: factor * dissipation_time,
        }
    }

    /// The law without losses, with `modulus` = K / sqrt(R_eff) (Pa).
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

impl NormalLaw for HertzLaw {
    const USES_CONTACT_RADIUS: bool = true;

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
