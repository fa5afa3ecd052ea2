//! Hertz contact whose restitution does not depend on the speed.

use super::hertz::hertz_modulus;
use super::keys::elastic;
use super::{Collision, ContactKeys, ElasticSolid, HertzLaw, NormalLaw, contact_radius};
use crate::document::quantity;
use crate::forces::limit::{Limit, Regime};
use crate::forces::simplification::Simplification;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Hertzian spring and a dashpot with which every impact has the same restitution, at any speed and
/// of any two masses (Tsuji, Tanaka and Ishida, 1992; `damping coeff_restitution` of LAMMPS, `model
/// hertz` of LIGGGHTS): F = K xi^(3/2) + alpha sqrt(m_eff K) xi^(1/4) dxi/dt. Attractive at the end
/// of a contact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Tsuji {
    /// Young's modulus Y (Pa).
    #[schemars(transform = quantity("Y", "Pa", "Young's modulus").above(0.0))]
    pub young_modulus: f64,
    /// Poisson's ratio nu.
    #[schemars(transform = quantity("ν", "", "Poisson's ratio").above(-1.0).at_most(0.5))]
    pub poisson_ratio: f64,
    /// Restitution e of every head-on impact.
    #[schemars(transform = quantity("e", "", "coefficient of restitution").above(0.0).at_most(1.0))]
    pub restitution: f64,
}

impl ElasticSolid for Tsuji {
    fn young_modulus(&self) -> f64 {
        self.young_modulus
    }

    fn poisson_ratio(&self) -> f64 {
        self.poisson_ratio
    }
}

impl ContactKeys for Tsuji {
    type Law = TsujiLaw;
    const NAME: &'static str = "tsuji";
    const CONTACT_LIMIT: &'static str = "2/w of the two smallest spheres at their deepest overlap, \
                                         at the start or in the fastest impact, \
                                         w^2 = (3/2) K sqrt(xi) / m_eff";
    const DAMPED_LIMIT: &'static str = "(w dt)^2 + 2 q g dt < 4 with the w of the contact limit \
                                        and the damping rate g = sqrt(10/3) z w, \
                                        z = -ln(e) / sqrt(pi^2 + ln(e)^2); q = 2 for \
                                        synchronised-verlet, else 1";

    fn law(&self, _: f64, _: f64) -> TsujiLaw {
        TsujiLaw::new(self.young_modulus, self.poisson_ratio, self.restitution)
    }

    fn collisions(&self, regime: &Regime<'_>) -> Vec<Collision> {
        let collision = self.stiffest_impact(regime).map(|fastest| {
            // The damping rate alpha sqrt(K sqrt(xi) / m_eff) in terms of w.
            let rate =
                damping_factor(self.restitution) * fastest.angular_frequency() / 1.5_f64.sqrt();
            Collision::of_impact(&fastest, 0.5 * regime.smallest_radius, rate)
        });
        collision.into_iter().collect()
    }

    fn other_limits(&self, regime: &Regime<'_>) -> Vec<Limit> {
        vec![self.rayleigh_limit(regime)]
    }

    fn simplifications(&self) -> Vec<Simplification> {
        elastic(self.restitution < 1.0, "contact.restitution", 1.0).collect()
    }
}

/// alpha = sqrt(5) z of a restitution e, with z = -ln(e) / sqrt(pi^2 + ln(e)^2).
///
/// In y = xi^(5/4) the impact is a linear oscillator, u du/dy = -w^2 y - 2 z w u with the speed u =
/// dxi/dt and w^2 = (4/5) K / m_eff. Half its period after the first touch the overlap is zero
/// again, and u = -exp(-pi z / sqrt(1 - z^2)) = -e of what it was, whatever it was.
fn damping_factor(restitution: f64) -> f64 {
    let logarithm = libm::log(restitution).abs();
    5.0_f64.sqrt() * logarithm / (PI * PI + logarithm * logarithm).sqrt()
}

/// F = K xi^(3/2) + alpha sqrt(m_eff K) xi^(1/4) dxi/dt, with overlap xi, K = 2 Y sqrt(R_eff) /
/// (3 (1 - nu^2)) and m_eff = m_i m_j / (m_i + m_j), the mass of the sphere at a wall or a fixed
/// sphere (Tsuji, Tanaka and Ishida, Powder Technology 71, 239 (1992)). The restitution e has alpha
/// = sqrt(5) z, z = -ln(e) / sqrt(pi^2 + ln(e)^2) (Antypov and Elliott, EPL 94, 50004 (2011)).
///
/// `damping tsuji` of LAMMPS fits a figure of Tsuji et al. by a polynomial, which is this alpha
/// over sqrt(2) to 2e-3: as if for the mass of one of two like spheres, but it multiplies
/// sqrt(m_eff).
/// So its impacts lose less than they are asked to: 0.616 is left of the speed in place of 0.5.
///
/// It attracts at the end of a contact, where spheres part faster than their elasticity recovers:
/// they are in contact until their overlap is zero. Only so is e the restitution of alpha; without
/// the attraction (Schwager and Poeschel, Granular Matter 9, 465 (2007)) spheres would part faster.
#[derive(Clone, Copy, Debug)]
pub struct TsujiLaw {
    /// K xi^(3/2).
    elastic: HertzLaw,
    /// alpha.
    damping_factor: f64,
}

impl TsujiLaw {
    /// The law for partners of the same material: Young's modulus (Pa), Poisson's ratio, and the
    /// restitution of head-on impacts, above 0 and at most 1.
    pub fn new(young_modulus: f64, poisson_ratio: f64, restitution: f64) -> Self {
        Self {
            elastic: HertzLaw::elastic(hertz_modulus(young_modulus, poisson_ratio)),
            damping_factor: damping_factor(restitution),
        }
    }

    /// alpha sqrt(m_eff K) xi^(1/4) (N s/m) at a contact radius (m).
    #[inline(always)]
    fn drag(&self, contact_radius: f64, effective_mass: f64) -> f64 {
        // K sqrt(xi) is the modulus times the contact radius.
        self.damping_factor * (effective_mass * (self.elastic.modulus() * contact_radius)).sqrt()
    }
}

impl NormalLaw for TsujiLaw {
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
        self.elastic.modulus() * contact_radius * overlap
            + self.drag(contact_radius, effective_mass) * overlap_rate
    }

    #[inline(always)]
    fn elastic_energy(&self, overlap: f64, effective_radius: f64) -> f64 {
        self.elastic.elastic_energy(overlap, effective_radius)
    }

    fn stiffness(&self, overlap: f64, effective_radius: f64) -> f64 {
        self.elastic.stiffness(overlap, effective_radius)
    }

    fn damping(&self, overlap: f64, effective_radius: f64, effective_mass: f64) -> f64 {
        self.drag(contact_radius(overlap, effective_radius), effective_mass)
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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const RADIUS: f64 = 0.003;
    const MASS: f64 = 2e-4;

    /// The restitution of a head-on impact at a speed (m/s), by Runge and Kutta's fourth order. In
    /// q = xi^(1/4), with dt = 4 q^3 ds, the motion is smooth: dq/ds = u, du/ds = -4 q^3 F / m_eff.
    fn measured(law: &TsujiLaw, speed: f64) -> f64 {
        let slope = |[q, u]: [f64; 2]| {
            let overlap = q * q * q * q;
            let force = law.force(overlap, u, contact_radius(overlap, RADIUS), MASS);
            [u, -4.0 * q * q * q * force / MASS]
        };
        let ahead =
            |[q, u]: [f64; 2], [dq, du]: [f64; 2], step: f64| [q + dq * step, u + du * step];
        let advanced = |state: [f64; 2], step: f64| {
            let k1 = slope(state);
            let k2 = slope(ahead(state, k1, 0.5 * step));
            let k3 = slope(ahead(state, k2, 0.5 * step));
            let k4 = slope(ahead(state, k3, step));
            let mean = |i: usize| (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]) / 6.0;
            ahead(state, [mean(0), mean(1)], step)
        };
        let deepest = law.deepest_overlap(0.0, speed, RADIUS, MASS);
        let step = deepest.sqrt().sqrt() / speed / 4000.0;
        let mut state = advanced([0.0, speed], step);
        loop {
            let next = advanced(state, step);
            if next[0] <= 0.0 {
                let rest = state[0] / (state[0] - next[0]) * step;
                return -advanced(state, rest)[1] / speed;
            }
            state = next;
        }
    }

    #[test]
    fn every_speed_has_the_restitution_that_was_asked_for() {
        for restitution in [1.0, 0.99, 0.9, 0.7, 0.5, 0.3, 0.1] {
            let law = TsujiLaw::new(1e7, 0.3, restitution);
            for speed in [1e-3, 0.1, 10.0] {
                let found = measured(&law, speed);
                let error = (found - restitution).abs();
                assert!(error < 1e-8, "{restitution} at {speed} m/s: {found}");
            }
        }
    }

    #[test]
    fn without_losses_it_is_the_law_of_hertz() {
        let (law, hertz) = (
            TsujiLaw::new(1e7, 0.3, 1.0),
            HertzLaw::new(1e7, 0.3, 0.0, 1.0),
        );
        let radius = contact_radius(1e-5, RADIUS);
        let forces = [
            law.force(1e-5, -0.3, radius, MASS),
            hertz.force(1e-5, -0.3, radius, MASS),
        ];
        assert_eq!(forces[0], forces[1]);
    }

    proptest! {
        /// The whole range of the key, on which speed, size and material have no influence.
        #[test]
        fn the_restitution_is_a_constant(
            restitution in 0.05..1.0,
            exponents in (-4.0..1.0, 4.0..11.0),
            poisson_ratio in -0.9..0.5,
        ) {
            let (speed, modulus) = (libm::exp10(exponents.0), libm::exp10(exponents.1));
            let law = TsujiLaw::new(modulus, poisson_ratio, restitution);
            prop_assert!((measured(&law, speed) - restitution).abs() < 1e-8);
        }

        /// The partial derivatives that limits of the time step and adaptive Verlet use.
        #[test]
        fn stiffness_and_damping_are_derivatives_of_the_force(
            restitution in 0.05..1.0,
            overlap in 1e-7..1e-4,
        ) {
            let law = TsujiLaw::new(1e7, 0.3, restitution);
            let force = |overlap: f64, rate: f64| {
                law.force(overlap, rate, contact_radius(overlap, RADIUS), MASS)
            };
            let step = 1e-4 * overlap;
            let slope = (force(overlap + step, 0.0) - force(overlap - step, 0.0)) / (2.0 * step);
            prop_assert!((slope / law.stiffness(overlap, RADIUS) - 1.0).abs() < 1e-6);
            let drag = force(overlap, 0.5) - force(overlap, -0.5);
            let expected = law.damping(overlap, RADIUS, MASS);
            prop_assert!((drag - expected).abs() < 1e-9 * expected.max(force(overlap, 0.0)));
        }
    }
}
