//! Coulomb friction, regularised at rest.

use super::{FrictionKeys, Grip, Spring, TangentialLaw, Touch, Traction};
use crate::document::quantity;
use crate::forces::contact::Collision;
use crate::forces::limit::{Limit, Regime};
use crate::particles::math::inverse_square_root;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Sliding friction capped at mu F_n, from the velocity of the contact point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Coulomb {
    /// Coefficient mu.
    #[schemars(transform = quantity("μ", "", "coefficient of friction").at_least(0.0))]
    pub coefficient: f64,
    /// Sliding speed below which the force falls linearly to zero (m/s).
    #[schemars(transform = quantity("v_μ", "m/s", "sliding speed of full friction").above(0.0))]
    pub regularisation: f64,
}

impl Coulomb {
    /// Name of the law, as in a scene file.
    pub(crate) const NAME: &'static str = "coulomb";

    /// A simpler law in place of one with springs: regularised at a millimetre per second.
    pub(super) fn instead(coefficient: f64) -> Self {
        Self {
            coefficient,
            regularisation: 1e-3,
        }
    }
}

impl<C> FrictionKeys<C> for Coulomb {
    type Law = CoulombLaw;

    fn law(&self, _: &C, _: f64) -> CoulombLaw {
        CoulombLaw::new(self.coefficient, self.regularisation)
    }

    fn limit(&self, _: &C, collisions: &[Collision], regime: &Regime<'_>) -> Option<Limit> {
        let stiffest = collisions.first()?;
        let rate = regime.surface_factor() * self.coefficient * stiffest.largest_force
            / (self.regularisation * stiffest.effective_mass);
        Some(Limit {
            name: "regularised friction",
            seconds: regime.scheme.oscillator(0.0, rate),
            decisive: false,
            explanation: "2 u_0 m_eff / ((1 + m r^2 / I) q mu F) at the largest force; above it, \
                          sliding that should stop changes sign in every step; q = 2 for \
                          synchronised-verlet, else 1",
            consequence: Some("sliding that should stop may change sign in every step"),
        })
    }
}

/// f = -mu F_n u / max(|u|, u_0), with the sliding velocity u of the contact point (by velocities
/// and spins of both partners). Below the regularisation speed u_0 the force is viscous, so a pile
/// at rest creeps.
#[derive(Clone, Copy, Debug)]
pub struct CoulombLaw {
    coefficient: f64,
    regularisation: f64,
}

impl CoulombLaw {
    /// The law with coefficient mu and regularisation speed u_0 (m/s).
    pub fn new(coefficient: f64, regularisation: f64) -> Self {
        Self {
            coefficient,
            regularisation,
        }
    }
}

impl TangentialLaw for CoulombLaw {
    type History = ();

    fn with_coefficient(self, coefficient: f64) -> Self {
        Self {
            coefficient,
            ..self
        }
    }

    #[inline(always)]
    fn traction(&self, touch: &Touch, _: &mut Spring) -> Traction {
        let sliding = touch.sliding_velocity();
        let (squared, least) = (
            sliding.norm_squared(),
            self.regularisation * self.regularisation,
        );
        let squared = if squared < least { least } else { squared };
        let inverse_speed = inverse_square_root(squared);
        touch.traction(sliding * (-self.coefficient * touch.normal_force * inverse_speed))
    }

    fn damping(&self, grip: &Grip) -> f64 {
        self.coefficient * grip.normal_force / grip.speed.max(self.regularisation)
    }
}
