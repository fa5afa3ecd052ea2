//! The friction of Silbert et al. at linear contacts.

use super::{FrictionKeys, Grip, LoadedSpring, Spring, TangentialLaw, Touch};
use crate::document::quantity;
use crate::forces::contact::{Collision, Hooke};
use crate::forces::limit::{Limit, Regime};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A spring k_t and a dashpot gamma_t m_eff, together capped at mu |F_n| (Silbert et al., 2001;
/// `gran/hooke/history` of LAMMPS); needs the hooke contact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HookeFriction {
    /// Coefficient mu.
    #[schemars(transform = quantity("μ", "", "coefficient of friction").at_least(0.0))]
    pub coefficient: f64,
    /// Tangential spring constant k_t (N/m). LAMMPS takes 2/7 of k_n for `NULL`.
    #[schemars(transform = quantity("k_t", "N/m", "tangential spring constant").above(0.0))]
    pub stiffness: f64,
    /// Tangential damping rate gamma_t (1/s). LAMMPS takes half of gamma_n for `NULL`, and 0 if
    /// `dampflag` is 0.
    #[serde(default)]
    #[schemars(transform = quantity("γ_t", "1/s", "tangential damping rate").at_least(0.0))]
    pub damping_rate: f64,
}

impl HookeFriction {
    /// Name of the law, as in a scene file.
    pub(crate) const NAME: &'static str = "hooke";
}

impl FrictionKeys<Hooke> for HookeFriction {
    type Law = HookeFrictionLaw;

    fn law(&self, _: &Hooke, _: f64) -> HookeFrictionLaw {
        HookeFrictionLaw::new(self.coefficient, self.stiffness, self.damping_rate)
    }

    fn limit(&self, _: &Hooke, collisions: &[Collision], regime: &Regime<'_>) -> Option<Limit> {
        let factor = regime.surface_factor();
        let squared = factor * self.stiffness / collisions.first()?.effective_mass;
        let rate = factor * self.damping_rate;
        Some(Limit {
            name: "sticking contact",
            seconds: regime.scheme.oscillator(squared.sqrt(), rate),
            decisive: true,
            explanation: "(w dt)^2 + 2 q g dt < 4 with w^2 = f k_t / m_eff and g = f gamma_t, \
                          f = 1 + m r^2 / I; q = 2 for synchronised-verlet, else 1",
            consequence: Limit::COARSE,
        })
    }
}

/// A spring of constant stiffness k_t in parallel with a dashpot gamma_t m_eff, f = -k_t u -
/// gamma_t m_eff du/dt, together capped at mu |F_n| (Silbert et al., Phys. Rev. E 64, 051302
/// (2001), for Hookean spheres; `gran/hooke/history` of LAMMPS). The cap also holds while
/// partners attract each other.
///
/// The displacement u turns with the normal and keeps its length, while LAMMPS projects it: both
/// agree as the step shrinks.
#[derive(Clone, Copy, Debug)]
pub struct HookeFrictionLaw {
    coefficient: f64,
    /// k_t (N/m).
    stiffness: f64,
    /// gamma_t (1/s).
    damping_rate: f64,
}

impl HookeFrictionLaw {
    /// The law with coefficient mu, spring constant k_t (N/m) and damping rate gamma_t (1/s).
    pub fn new(coefficient: f64, stiffness: f64, damping_rate: f64) -> Self {
        Self {
            coefficient,
            stiffness,
            damping_rate,
        }
    }
}

impl TangentialLaw for HookeFrictionLaw {
    const NEEDS_EFFECTIVE_MASS: bool = true;
    const DRAGS: bool = true;
    type History = Spring;

    fn with_coefficient(self, coefficient: f64) -> Self {
        Self {
            coefficient,
            ..self
        }
    }

    #[inline(always)]
    fn load(&self, touch: &Touch, spring: Spring) -> LoadedSpring {
        let drag = touch.sliding_velocity() * (self.damping_rate * touch.effective_mass);
        let limit = self.coefficient * touch.force_along_normal.abs();
        spring.loaded(touch, self.stiffness, drag, limit)
    }

    #[inline(always)]
    fn stiffness(&self, _: f64, _: f64) -> f64 {
        self.stiffness
    }

    fn damping(&self, grip: &Grip) -> f64 {
        self.damping_rate * grip.effective_mass
    }

    fn energy(&self, spring: &Spring, overlap: f64, effective_radius: f64) -> f64 {
        spring.energy(self.stiffness(overlap, effective_radius))
    }
}
