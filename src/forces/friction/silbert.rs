//! The friction of Silbert et al.

use super::{
    FrictionKeys, Grip, Keeps, LoadedSpring, Spring, SpringAtRadius, TangentialLaw, Touch,
};
use crate::document::quantity;
use crate::forces::contact::contact_radius;
use crate::forces::contact::{Collision, Silbert};
use crate::forces::limit::{Limit, Regime};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A spring sqrt(R_eff xi) k_t, which keeps its displacement while the overlap xi changes, and a
/// dashpot sqrt(R_eff xi) gamma_t m_eff, together capped at mu |F_n| (Silbert et al., 2001;
/// `gran/hertz/history` of LAMMPS); needs the silbert contact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SilbertFriction {
    /// Coefficient mu.
    #[schemars(transform = quantity("μ", "", "coefficient of friction").at_least(0.0))]
    pub coefficient: f64,
    /// Tangential stiffness k_t (Pa).
    #[schemars(transform = quantity("k_t", "Pa", "tangential spring constant").above(0.0))]
    pub stiffness: f64,
    /// Tangential damping gamma_t (1/(m s)).
    #[serde(default)]
    #[schemars(
        transform = quantity("b_t", "1/(m s)", "tangential drag constant").at_least(0.0)
    )]
    pub damping: f64,
    /// Whether the spring keeps its displacement while the contact is released, and its force while
    /// it is pressed harder, so that it never creates energy (Thornton, Cummins and Cleary, 2013;
    /// `mindlin_rescale/force` of LAMMPS). Otherwise it keeps its displacement.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub rescale: bool,
}

impl SilbertFriction {
    /// Name of the law, as in a scene file.
    pub(crate) const NAME: &'static str = "silbert";
}

impl FrictionKeys<Silbert> for SilbertFriction {
    type Law = SilbertFrictionLaw;

    fn law(&self, _: &Silbert, _: f64) -> SilbertFrictionLaw {
        let law = SilbertFrictionLaw::new(self.coefficient, self.stiffness, self.damping);
        match self.rescale {
            true => law.keeping(Keeps::Lesser),
            false => law,
        }
    }

    fn limit(&self, _: &Silbert, collisions: &[Collision], regime: &Regime<'_>) -> Option<Limit> {
        let of_collision = |collision: &Collision| {
            let root = regime.surface_factor() * collision.contact_radius;
            let squared = self.stiffness * root / collision.effective_mass;
            regime
                .scheme
                .oscillator(squared.sqrt(), self.damping * root)
        };
        Some(Limit {
            name: "sticking contact",
            seconds: collisions.iter().map(of_collision).reduce(f64::min)?,
            decisive: true,
            explanation: "(w dt)^2 + 2 q g dt < 4 with w^2 = f k_t sqrt(R_eff xi) / m_eff and \
                          g = f gamma_t sqrt(R_eff xi), f = 1 + m r^2 / I, of pairs and at walls; \
                          q = 2 for synchronised-verlet, else 1",
            consequence: Limit::COARSE,
        })
    }
}

/// A spring of stiffness sqrt(R_eff xi) k_t in parallel with a dashpot sqrt(R_eff xi) gamma_t
/// m_eff, f = -sqrt(R_eff xi) (k_t u + gamma_t m_eff du/dt), together capped at mu |F_n| (Silbert
/// et al., Phys. Rev. E 64, 051302 (2001), for Hertzian spheres, in the form of
/// `gran/hertz/history` of LAMMPS). The cap also holds while partners attract each other.
///
/// The spring keeps its displacement u: if a contact at rest is pressed harder, the tangential
/// force grows. This creates energy, unlike [`Keeps::Lesser`]. The displacement turns with the
/// normal and keeps its length, while LAMMPS projects it: both agree as the step shrinks.
#[derive(Clone, Copy, Debug)]
pub struct SilbertFrictionLaw {
    coefficient: f64,
    /// k_t (Pa).
    stiffness: f64,
    /// gamma_t (1/(m s)).
    damping: f64,
    keeps: Keeps,
}

impl SilbertFrictionLaw {
    /// The law with coefficient mu, tangential stiffness k_t (Pa) and damping gamma_t (1/(m s)).
    pub fn new(coefficient: f64, stiffness: f64, damping: f64) -> Self {
        Self {
            coefficient,
            stiffness,
            damping,
            keeps: Keeps::Displacement,
        }
    }

    /// The same law with a spring that keeps something else.
    #[must_use]
    pub fn keeping(self, keeps: Keeps) -> Self {
        Self { keeps, ..self }
    }
}

impl TangentialLaw for SilbertFrictionLaw {
    const NEEDS_EFFECTIVE_MASS: bool = true;
    const USES_CONTACT_RADIUS: bool = true;
    const DRAGS: bool = true;
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
        let stiffness = self.stiffness * self.keeps.loading_radius(touch);
        let damping = self.damping * touch.effective_mass * touch.contact_radius;
        let limit = self.coefficient * touch.force_along_normal.abs();
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

    fn energy(&self, spring: &SpringAtRadius, overlap: f64, effective_radius: f64) -> f64 {
        let contact_radius = contact_radius(overlap, effective_radius);
        spring.energy(self.keeps, self.stiffness, contact_radius)
    }
}
