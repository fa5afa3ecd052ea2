//! Friction by a tangential spring and dashpot.

use super::{Coulomb, FrictionKeys, Grip, LoadedSpring, Spring, TangentialLaw, Touch};
use crate::document::quantity;
use crate::forces::contact::{Collision, Linear};
use crate::forces::limit::{Limit, Regime};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A tangential spring and dashpot, together capped at mu F_n (Cundall and Strack, 1979); needs
/// the linear contact. A pile holds still, and grains can arch.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CundallStrack {
    /// Coefficient mu.
    #[schemars(transform = quantity("μ", "", "coefficient of friction").at_least(0.0))]
    pub coefficient: f64,
    /// Tangential spring constant k_t (N/m).
    #[schemars(transform = quantity("k_t", "N/m", "tangential spring constant").above(0.0))]
    pub stiffness: f64,
    /// Tangential drag constant b_t (N s/m).
    #[serde(default)]
    #[schemars(transform = quantity("b_t", "N s/m", "tangential drag constant").at_least(0.0))]
    pub damping: f64,
}

impl CundallStrack {
    /// Name of the law, as in a scene file.
    pub(crate) const NAME: &'static str = "cundall-strack";
}

impl FrictionKeys<Linear> for CundallStrack {
    type Law = CundallStrackLaw;

    fn law(&self, _: &Linear, _: f64) -> CundallStrackLaw {
        CundallStrackLaw::new(self.coefficient, self.stiffness, self.damping)
    }

    fn limit(&self, _: &Linear, collisions: &[Collision], regime: &Regime<'_>) -> Option<Limit> {
        let moved = regime.surface_factor() / collisions.first()?.effective_mass;
        let (frequency, rate) = ((self.stiffness * moved).sqrt(), self.damping * moved);
        Some(Limit {
            name: "sticking contact",
            seconds: regime.scheme.oscillator(frequency, rate),
            decisive: true,
            explanation: "(w dt)^2 + 2 q g dt < 4 with w^2 = k_t / m_t and g = b_t / m_t, \
                          m_t = m_eff / (1 + m r^2 / I); q = 2 for synchronised-verlet, else 1",
            consequence: Limit::COARSE,
        })
    }

    fn simpler(&self, _: &Linear) -> Option<Coulomb> {
        Some(Coulomb::instead(self.coefficient))
    }
}

/// A spring of constant stiffness k_t and a dashpot b_t along the contact, together capped at mu
/// F_n (Cundall and Strack, Geotechnique 29, 47 (1979)): df = -k_t du and f - b_t u while it
/// sticks.
#[derive(Clone, Copy, Debug)]
pub struct CundallStrackLaw {
    coefficient: f64,
    /// k_t (N/m).
    stiffness: f64,
    /// b_t (N s/m).
    damping: f64,
}

impl CundallStrackLaw {
    /// The law with coefficient mu, tangential stiffness k_t (N/m) and drag constant b_t (N s/m).
    pub fn new(coefficient: f64, stiffness: f64, damping: f64) -> Self {
        Self {
            coefficient,
            stiffness,
            damping,
        }
    }
}

impl TangentialLaw for CundallStrackLaw {
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
        let limit = self.coefficient * touch.normal_force;
        let drag = touch.sliding_velocity() * self.damping;
        spring.loaded(touch, self.stiffness, drag, limit)
    }

    fn stiffness(&self, _: f64, _: f64) -> f64 {
        self.stiffness
    }

    fn damping(&self, _: &Grip) -> f64 {
        self.damping
    }

    fn energy(&self, spring: &Spring, overlap: f64, effective_radius: f64) -> f64 {
        spring.energy(self.stiffness(overlap, effective_radius))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::particles::vector::Vector;

    const DT: f64 = 1e-3;

    /// A contact along x, whose surface slides with `speed` (m/s) along z.
    fn touch(speed: f64, normal: Vector) -> Touch {
        let along = Vector::new(-normal.z, 0.0, normal.x);
        Touch {
            normal,
            velocity: along * speed,
            spin: [Vector::ZERO; 2],
            lever: [0.04, 0.04],
            inertia: [1e-6; 2],
            lesser_mass: 1e-3,
            effective_mass: 5e-4,
            normal_force: 2.0,
            force_along_normal: 2.0,
            loading_velocity: along * speed,
            contact_radius: 1e-3,
            loading_radius: 1e-3,
            loading_time: DT,
        }
    }

    fn slide(law: CundallStrackLaw, spring: &mut Spring, speed: f64, steps: u32) -> f64 {
        let mut force = 0.0;
        for _ in 0..steps {
            force = law
                .traction(&touch(speed, Vector::new(1.0, 0.0, 0.0)), spring)
                .force
                .z;
        }
        force
    }

    #[test]
    fn it_sticks_slides_and_turns_back_like_a_spring_with_a_slider() {
        // k_t = 50 N/m, cap mu F_n = 0.6 N, reached after 12 mm.
        let law = CundallStrackLaw::new(0.3, 50.0, 0.0);
        let mut spring = Spring::default();
        let close =
            |found: f64, expected: f64| assert!((found - expected).abs() < 1e-12, "{found}");
        close(slide(law, &mut spring, 0.1, 100), -0.5);
        close(slide(law, &mut spring, 0.1, 100), -0.6);
        // It unloads at once, by k_t du, no matter how far it slid.
        close(slide(law, &mut spring, -0.1, 100), -0.6 + 0.5);
        close(slide(law, &mut spring, -0.1, 300), 0.6);
    }

    #[test]
    fn spring_and_dashpot_are_capped_together() {
        // b_t u = 0.5 N leaves the spring 0.1 N of the 0.6 N that friction can carry.
        let law = CundallStrackLaw::new(0.3, 50.0, 5.0);
        let mut spring = Spring::default();
        let force = slide(law, &mut spring, 0.1, 1000);
        assert!((force + 0.6).abs() < 1e-12, "{force}");
        assert!((spring.force.z + 0.1).abs() < 1e-12, "{:?}", spring.force);
        // When the sliding stops, only the spring remains.
        let force = slide(law, &mut spring, 0.0, 1);
        assert!((force + 0.1).abs() < 1e-12, "{force}");
    }

    #[test]
    fn the_spring_turns_with_the_pair() {
        let law = CundallStrackLaw::new(0.3, 50.0, 0.0);
        let mut spring = Spring::default();
        slide(law, &mut spring, 0.1, 100);
        let (sine, cosine) = libm::sincos(0.7);
        let normal = Vector::new(cosine, 0.0, sine);
        spring = spring.turned(normal);
        let force = law.traction(&touch(0.0, normal), &mut spring).force;
        assert!((force.norm() - 0.5).abs() < 1e-12);
        assert!(force.dot(normal).abs() < 1e-12);
    }
}
