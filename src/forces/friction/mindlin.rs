//! Mindlin friction by increments.

use super::{
    Coulomb, FrictionKeys, Keeps, LoadedSpring, Spring, SpringAtRadius, TangentialLaw, Touch,
};
use crate::document::quantity;
use crate::forces::contact::{Collision, ElasticSolid, contact_radius};
use crate::forces::limit::{Limit, Regime};
use crate::particles::vector::Vector;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Mindlin's history spring by increments, capped at mu F_n; needs the hertz or tsuji
/// contact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mindlin {
    /// Coefficient mu.
    #[schemars(transform = quantity("μ", "", "coefficient of friction").at_least(0.0))]
    pub coefficient: f64,
    /// Whether the spring keeps its displacement while the contact is released, and its force while
    /// it is pressed harder, so that it never creates energy (Thornton, Cummins and Cleary, 2013;
    /// `mindlin_rescale/force` of LAMMPS). Otherwise it keeps its force.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub rescale: bool,
}

impl Mindlin {
    /// Name of the law, as in a scene file.
    pub(crate) const NAME: &'static str = "mindlin";
}

impl<C: ElasticSolid> FrictionKeys<C> for Mindlin {
    type Law = MindlinLaw;

    fn law(&self, contact: &C, _: f64) -> MindlinLaw {
        let law = MindlinLaw::new(
            self.coefficient,
            contact.young_modulus(),
            contact.poisson_ratio(),
        );
        match self.rescale {
            true => law.keeping(Keeps::Lesser),
            false => law,
        }
    }

    fn limit(&self, contact: &C, collisions: &[Collision], regime: &Regime<'_>) -> Option<Limit> {
        mindlin_limit(contact, collisions, regime)
    }

    fn simpler(&self, _: &C) -> Option<Coulomb> {
        Some(Coulomb::instead(self.coefficient))
    }
}

/// The limit of the time step from Mindlin's spring at a sticking contact.
pub(super) fn mindlin_limit(
    contact: &impl ElasticSolid,
    collisions: &[Collision],
    regime: &Regime<'_>,
) -> Option<Limit> {
    let nu = contact.poisson_ratio();
    let stiffness_ratio = 2.0 * (1.0 - nu) / (2.0 - nu);
    let factor = (regime.surface_factor() * stiffness_ratio).sqrt();
    Some(Limit {
        name: "sticking contact",
        seconds: (regime.scheme).oscillator(factor * collisions.first()?.frequency, 0.0),
        decisive: true,
        explanation: "2/w of the tangential spring, w^2 = (1 + m r^2 / I) k_t / m_eff with \
                      k_t / k_n = 2 (1 - nu) / (2 - nu)",
        consequence: Limit::COARSE,
    })
}

/// 8 G* (Pa) from Young's modulus (Pa) and Poisson's ratio of both partners.
pub(super) fn mindlin_modulus(young_modulus: f64, poisson_ratio: f64) -> f64 {
    let shear_modulus = young_modulus / (2.0 * (1.0 + poisson_ratio));
    8.0 * shear_modulus / (2.0 * (2.0 - poisson_ratio))
}

/// Mindlin's tangential stiffness k_t = 8 G* sqrt(R_eff xi) of a sticking contact, loaded and
/// unloaded by increments of the sliding displacement, df = -k_t du, and capped at mu F_n; G* = G /
/// (2 (2 - nu)) for equal materials (Mindlin, J. Appl. Mech. 16, 259 (1949); Chung and Ooi,
/// Granular Matter 13, 643 (2011)).
///
/// When the normal force of a contact at rest falls, the spring keeps its force although its
/// stiffness falls, unless the law keeps something else ([`Keeps`]). An elastic impact can thus
/// gain energy: a fraction below 1e-5 for nu >= 0.22 and mu < 3, up to 4e-4 for nu = 0 and mu =
/// 0.5. Closed paths can gain more.
#[derive(Clone, Copy, Debug)]
pub struct MindlinLaw {
    coefficient: f64,
    /// 8 G* (Pa).
    modulus: f64,
    keeps: Keeps,
}

impl MindlinLaw {
    /// The law with coefficient mu, Young's modulus (Pa) and Poisson's ratio of both partners.
    pub fn new(coefficient: f64, young_modulus: f64, poisson_ratio: f64) -> Self {
        Self {
            coefficient,
            modulus: mindlin_modulus(young_modulus, poisson_ratio),
            keeps: Keeps::Force,
        }
    }

    /// The same law with a spring that keeps something else.
    #[must_use]
    pub fn keeping(self, keeps: Keeps) -> Self {
        Self { keeps, ..self }
    }
}

impl TangentialLaw for MindlinLaw {
    const USES_CONTACT_RADIUS: bool = true;
    type History = SpringAtRadius;

    fn with_coefficient(self, coefficient: f64) -> Self {
        Self {
            coefficient,
            ..self
        }
    }

    #[inline(always)]
    fn keeps(&self) -> Keeps {
        self.keeps
    }

    #[inline(always)]
    fn load(&self, touch: &Touch, spring: Spring) -> LoadedSpring {
        let stiffness = self.modulus * self.keeps.loading_radius(touch);
        let limit = self.coefficient * touch.normal_force;
        spring.loaded(touch, stiffness, Vector::ZERO, limit)
    }

    #[inline(always)]
    fn stiffness(&self, overlap: f64, effective_radius: f64) -> f64 {
        self.modulus * contact_radius(overlap, effective_radius)
    }

    fn energy(&self, spring: &SpringAtRadius, overlap: f64, effective_radius: f64) -> f64 {
        let contact_radius = contact_radius(overlap, effective_radius);
        spring.energy(self.keeps, self.modulus, contact_radius)
    }
}
