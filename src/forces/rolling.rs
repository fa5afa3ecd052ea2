//! Rolling resistance: keys, law, limit of the time step.

use super::contact::Contact;
use super::friction::Spring;
use super::limit::{Limit, Regime};
use crate::document::quantity;
use crate::particles::vector::Vector;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A torque against rolling at contacts: a spring, capped at mu_r R_eff F_n, and a dashpot below
/// the cap (Ai, Chen, Rotter and Ooi, 2011, type C). It needs a friction law with sliding, so any
/// law but `spin`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rolling {
    /// Coefficient mu_r: a sphere stays on a slope up to tan(theta) = mu_r. It sets the stiffness
    /// too, k_r = 2.25 k_n mu_r^2 R_eff^2 with the stiffness k_n of the contact.
    #[schemars(
        transform = quantity("μ_r", "", "coefficient of rolling resistance")
            .at_least(0.0)
            .at_most(100.0)
    )]
    pub coefficient: f64,
    /// Viscous damping ratio eta_r below the cap: 1 is critical.
    #[serde(default)]
    #[schemars(transform = quantity("η_r", "", "damping ratio of rolling").at_least(0.0))]
    pub damping: f64,
}

impl Rolling {
    /// The law for the engine.
    pub(crate) fn law(&self) -> RollingLaw {
        RollingLaw::new(self.coefficient, self.damping)
    }

    /// Its limit of the time step with a contact law: for the smallest sphere at an equal one, or
    /// at something that does not turn.
    pub(crate) fn limit(&self, contact: &Contact, regime: &Regime<'_>) -> Limit {
        let (radius, mass) = (regime.smallest_radius, regime.smallest_mass);
        let inertia = regime.smallest_inertia();
        // At a contact where this many of both partners are such spheres, and the rest at rest.
        let at = |turning: f64| {
            let (effective_radius, effective_mass) = (radius / turning, mass / turning);
            let stiffness = contact.stiffest(regime, effective_radius, effective_mass);
            let rolling_inertia = (inertia + mass * radius * radius) / turning;
            let [squared, rate] = self.law().rates(
                stiffness,
                effective_radius,
                rolling_inertia,
                turning / inertia,
            );
            regime.scheme.oscillator(squared.sqrt(), rate)
        };
        let alone = regime.has_walls || regime.smallest_radius < regime.largest_radius;
        Limit {
            name: "rolling resistance",
            seconds: match alone {
                true => at(1.0).min(at(2.0)),
                false => at(2.0),
            },
            decisive: true,
            explanation: "(w dt)^2 + 2 q g dt < 4 of the rolling spring, w^2 = k_r (1 / I_1 + 1 / \
                          I_2) and g = C_r (1 / I_1 + 1 / I_2), at the stiffest impact; q = 2 for \
                          synchronised-verlet, else 1",
            consequence: Limit::COARSE,
        }
    }
}

/// The elastic-plastic spring-dashpot model of rolling resistance, type C of Ai, Chen, Rotter and
/// Ooi, Powder Technology 206, 269 (2011): the moment of a spring grows by dM = -k_r dtheta with
/// the relative rolling of the partners, up to M_max = mu_r R_eff F_n, and below that a dashpot
/// adds -C_r dtheta/dt with C_r = 2 eta_r (I_r k_r)^1/2.
///
/// The paper names two stiffnesses. Here k_r = 2.25 k_n mu_r^2 R_eff^2 is used, with k_n = dF_n /
/// dxi at the present overlap: every contact law has it, while k_t R_eff^2 has no meaning for
/// Coulomb friction. The factor 2.25 is derived for spheres and also used for discs. The spring is
/// full after an angle of F_n / (2.25 k_n mu_r R_eff).
///
/// The dashpot itself has no cap, as in the paper: partners that already roll fast when they meet
/// are braked hard until the spring is full.
///
/// When the normal force falls, the spring keeps its moment while its stiffness falls, so that the
/// model can gain energy, as in Mindlin's friction.
#[derive(Clone, Copy, Debug)]
pub struct RollingLaw {
    coefficient: f64,
    damping: f64,
}

/// A contact in the form that rolling laws take. The torque acts on the first partner, and its
/// opposite on the other.
#[derive(Clone, Copy, Debug)]
pub struct RollingTouch {
    /// Unit normal.
    pub normal: Vector,
    /// Normal force (N), not negative.
    pub normal_force: f64,
    /// r1 r2 / (r1 + r2), or the sphere's own radius at a wall (m).
    pub effective_radius: f64,
    /// Stiffness dF_n / dxi of the contact (N/m).
    pub stiffness: f64,
    /// I_r: 1 / I_r is the sum over both partners of 1 / (I + m r^2) (kg m2).
    pub inertia: f64,
    /// Spin of the first relative to the other, the part across the normal (rad/s).
    pub rate: Vector,
    /// Its mean since the latest evaluation (rad/s), by which the spring is loaded.
    pub loading_rate: Vector,
    /// The mean stiffness of the contact since then (N/m).
    pub loading_stiffness: f64,
    /// The time since then (s).
    pub loading_time: f64,
}

impl RollingLaw {
    /// The law with coefficient mu_r and damping ratio eta_r.
    pub fn new(coefficient: f64, damping: f64) -> Self {
        Self {
            coefficient,
            damping,
        }
    }

    /// k_r (N m) of a contact with that stiffness (N/m) and effective radius (m).
    pub fn stiffness(&self, stiffness: f64, effective_radius: f64) -> f64 {
        let arm = self.coefficient * effective_radius;
        2.25 * stiffness * arm * arm
    }

    /// C_r (N m s) for a k_r (N m) and an I_r (kg m2).
    fn drag(&self, stiffness: f64, inertia: f64) -> f64 {
        2.0 * self.damping * (inertia * stiffness).sqrt()
    }

    /// Squared frequency (1/s2) and damping rate (1/s) of a contact's rolling, for its stiffness
    /// (N/m), its effective radius (m), I_r (kg m2), and the sum of 1 / I of both (1/(kg m2)).
    ///
    /// I and not I_r counts: where surfaces slide, the spring turns each sphere about its centre.
    pub(crate) fn rates(
        &self,
        stiffness: f64,
        effective_radius: f64,
        inertia: f64,
        turning: f64,
    ) -> [f64; 2] {
        let stiffness = self.stiffness(stiffness, effective_radius);
        [stiffness * turning, self.drag(stiffness, inertia) * turning]
    }

    /// The torque on the first partner, and the moment of the spring that is left (N m), from the
    /// moment that the spring had.
    pub fn torque(&self, touch: &RollingTouch, moment: Vector) -> [Vector; 2] {
        let turned = Spring { force: moment }.turned(touch.normal).force;
        let stiffness = self.stiffness(touch.loading_stiffness, touch.effective_radius);
        let loaded = turned - touch.loading_rate * (stiffness * touch.loading_time);
        let most = self.coefficient * touch.effective_radius * touch.normal_force;
        let squared = loaded.norm_squared();
        if squared < most * most {
            let stiffness = self.stiffness(touch.stiffness, touch.effective_radius);
            let drag = self.drag(stiffness, touch.inertia);
            return [loaded - touch.rate * drag, loaded];
        }
        let capped = match squared > 0.0 {
            true => loaded * (most / squared.sqrt()),
            false => Vector::ZERO,
        };
        [capped; 2]
    }

    /// Energy M^2 / (2 k_r) (J) of a spring with that moment (N m), for a k_r (N m).
    pub(crate) fn energy(moment: Vector, stiffness: f64) -> f64 {
        match stiffness > 0.0 {
            true => 0.5 * moment.norm_squared() / stiffness,
            false => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sphere of 4 mm that rolls along x on a floor: k_r = 2.25 * 1e4 * (0.1 * 0.004)^2 = 3.6e-3
    /// N m, M_max = 0.1 * 0.004 * 2 = 8e-4 N m.
    fn touch(rate: f64) -> RollingTouch {
        let rate = Vector::new(0.0, rate, 0.0);
        RollingTouch {
            normal: Vector::new(0.0, 0.0, 1.0),
            normal_force: 2.0,
            effective_radius: 0.004,
            stiffness: 1e4,
            inertia: 1e-8,
            rate,
            loading_rate: rate,
            loading_stiffness: 1e4,
            loading_time: 1e-3,
        }
    }

    #[track_caller]
    fn assert_close(found: Vector, expected: Vector) {
        assert!((found - expected).norm() < 1e-15, "{found:?} {expected:?}");
    }

    #[test]
    fn the_spring_loads_is_capped_and_turns_back_at_once() {
        let law = RollingLaw::new(0.1, 0.0);
        let along = |moment: f64| Vector::new(0.0, moment, 0.0);
        let [torque, mut moment] = law.torque(&touch(10.0), Vector::ZERO);
        assert_close(torque, along(-3.6e-5));
        for _ in 0..100 {
            moment = law.torque(&touch(10.0), moment)[1];
        }
        assert_close(moment, along(-8e-4));
        assert_close(law.torque(&touch(-10.0), moment)[0], along(-8e-4 + 3.6e-5));
    }

    #[test]
    fn the_dashpot_acts_below_the_cap_alone() {
        let law = RollingLaw::new(0.1, 0.5);
        let [torque, moment] = law.torque(&touch(1.0), Vector::ZERO);
        // C_r = 2 * 0.5 * sqrt(1e-8 * 3.6e-3) = 6e-6 N m s.
        assert_close(torque - moment, Vector::new(0.0, -6e-6, 0.0));
        let [torque, moment] = law.torque(&touch(1.0), Vector::new(0.0, -1.0, 0.0));
        assert_close(torque, moment);
        assert_close(moment, Vector::new(0.0, -8e-4, 0.0));
        let loose = RollingTouch {
            normal_force: 0.0,
            ..touch(1.0)
        };
        assert_close(law.torque(&loose, moment)[0], Vector::ZERO);
        let still = RollingTouch {
            normal_force: 0.0,
            ..touch(0.0)
        };
        assert_close(law.torque(&still, Vector::ZERO)[0], Vector::ZERO);
    }

    #[test]
    fn the_moment_follows_the_contact() {
        let law = RollingLaw::new(0.1, 0.0);
        let tilted = RollingTouch {
            normal: Vector::new(0.0, 0.6, 0.8),
            ..touch(0.0)
        };
        let torque = law.torque(&tilted, Vector::new(0.0, 1e-4, 0.0))[0];
        assert_close(torque, Vector::new(0.0, 0.8e-4, -0.6e-4));
    }
}
