//! Limits of the linear contact.

use super::{Limit, fastest_impact, scheme_of};
use crate::scene::{Contact, Friction, Scene};
use std::f64::consts::PI;

/// A head-on impact under F = k delta + b d(delta)/dt, from the first touch until the centres are
/// as far apart again: half a period of a damped oscillator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearImpact {
    /// Effective mass m1 m2 / (m1 + m2) (kg).
    pub effective_mass: f64,
    /// Spring constant k (N/m).
    pub stiffness: f64,
    /// Drag constant b (N s/m).
    pub damping: f64,
}

impl LinearImpact {
    /// Angular frequency w = sqrt(k / m_eff) without damping (1/s).
    pub fn angular_frequency(&self) -> f64 {
        (self.stiffness / self.effective_mass).sqrt()
    }

    /// Rate g = b / m_eff at which the damping slows the approach (1/s).
    pub fn damping_rate(&self) -> f64 {
        self.damping / self.effective_mass
    }

    /// Duration of the contact (s), pi / sqrt(w^2 - g^2 / 4); infinite if it is overdamped.
    pub fn contact_time(&self) -> f64 {
        let (frequency, rate) = (self.angular_frequency(), self.damping_rate());
        let squared = frequency * frequency - 0.25 * rate * rate;
        if squared > 0.0 {
            PI / squared.sqrt()
        } else {
            f64::INFINITY
        }
    }

    /// Coefficient of restitution, exp(-g t_c / 2); zero if it is overdamped.
    pub fn restitution(&self) -> f64 {
        match self.contact_time() {
            time if time.is_finite() => libm::exp(-0.5 * self.damping_rate() * time),
            _ => 0.0,
        }
    }
}

/// The impact of the two smallest spheres; all others have larger effective masses, and are softer.
pub(super) fn stiffest_impact(scene: &Scene) -> Option<LinearImpact> {
    let Some(Contact::Linear {
        stiffness, damping, ..
    }) = scene.dem.contact
    else {
        return None;
    };
    Some(LinearImpact {
        effective_mass: 0.5 * scene.smallest_mass(),
        stiffness,
        damping,
    })
}

/// Limits of the contact and of the friction at it; none without a linear contact.
pub(super) fn limits(scene: &Scene) -> Vec<Limit> {
    let Some(impact) = stiffest_impact(scene) else {
        return Vec::new();
    };
    let scheme = scheme_of(scene);
    let frequency = impact.angular_frequency();
    let speed = fastest_impact(scene);
    let mut limits = vec![
        Limit {
            name: "contact",
            seconds: 2.0 / frequency,
            decisive: true,
            explanation: "2/w of the two smallest spheres, w^2 = k / m_eff",
        },
        super::twelve_contacts(scheme, frequency, impact.damping_rate()),
        super::displacement(scene, speed),
    ];
    if impact.damping > 0.0 {
        limits.push(Limit {
            name: "damped contact",
            seconds: scheme.oscillator(frequency, impact.damping_rate()),
            decisive: true,
            explanation: "(w dt)^2 + 2 q g dt < 4 with the w of the contact limit and the damping rate \
                          g = b / m_eff; q = 2 for synchronised-verlet, else 1",
        });
    }
    if let Some(Friction::CundallStrack {
        stiffness, damping, ..
    }) = scene.dem.friction
    {
        // A force at the surface moves it as if the mass were that much less.
        let moved = (1.0 + 1.0 / scene.spheres.shape.inertia_factor()) / impact.effective_mass;
        limits.push(Limit {
            name: "sticking contact",
            seconds: scheme.oscillator((stiffness * moved).sqrt(), damping * moved),
            decisive: true,
            explanation: "(w dt)^2 + 2 q g dt < 4 with w^2 = k_t / m_t and g = b_t / m_t, \
                          m_t = m_eff / (1 + m r^2 / I); q = 2 for synchronised-verlet, else 1",
        });
    }
    if let Some(Friction::Coulomb {
        coefficient,
        regularisation,
    }) = scene.dem.friction
    {
        let force = impact.stiffness * speed / frequency;
        limits.push(Limit {
            name: "regularised friction",
            seconds: scheme.oscillator(
                0.0,
                (1.0 + 1.0 / scene.spheres.shape.inertia_factor()) * coefficient * force
                    / (regularisation * impact.effective_mass),
            ),
            decisive: false,
            explanation: "2 u_0 m_eff / ((1 + m r^2 / I) q mu F) at the largest force; above it sliding \
                          that should stop changes sign from step to step; q = 2 for \
                          synchronised-verlet, else 1",
        });
    }
    limits
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn impacts_of_the_silo() {
        // m = rho R^2 with rho = 1, R = 0.04; k = 100, b = 0.05: a pair, and a grain on a fixed
        // one.
        let mass = 1.0 * 0.04 * 0.04;
        let cases = [
            (0.5 * mass, 8.921e-3, 0.756_713, 5.657e-3),
            (mass, 1.2591e-2, 0.821_409, 8.0e-3),
        ];
        for (effective_mass, contact_time, restitution, limit) in cases {
            let impact = LinearImpact {
                effective_mass,
                stiffness: 100.0,
                damping: 0.05,
            };
            assert!((impact.contact_time() / contact_time - 1.0).abs() < 1e-4);
            assert!((impact.restitution() / restitution - 1.0).abs() < 1e-5);
            assert!((2.0 / impact.angular_frequency() / limit - 1.0).abs() < 1e-4);
        }
    }
}
