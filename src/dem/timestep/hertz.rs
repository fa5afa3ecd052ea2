//! Limits of the Hertz contact.

use super::overlap::deepest_at_start;
use super::{Limit, scheme_of};
use crate::forces::contact::restitution::{dissipation_time_from_restitution, time_scale};
use crate::scene::{Contact, Friction, Scene, Shape};
use std::f64::consts::PI;

/// An elastic head-on impact of two equal spheres, in Hertz's theory (Landau and Lifshitz, Theory
/// of Elasticity, section 9).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// Effective mass m1 m2 / (m1 + m2) (kg).
    pub effective_mass: f64,
    /// K = 2 Y sqrt(R_eff) / (3 (1 - nu^2)) (N/m^1.5), of F = K xi^1.5.
    pub stiffness: f64,
    /// Relative speed (m/s).
    pub speed: f64,
}

impl Impact {
    /// Two spheres of one radius (m) and density (kg/m3), with Young's modulus (Pa) and Poisson's
    /// ratio, at a relative speed (m/s).
    pub fn of_equal_spheres(
        radius: f64,
        density: f64,
        young_modulus: f64,
        poisson_ratio: f64,
        speed: f64,
    ) -> Self {
        let effective_radius = 0.5 * radius;
        Self {
            effective_mass: 0.5 * Shape::Sphere.mass(density, radius),
            stiffness: 2.0 * young_modulus * effective_radius.sqrt()
                / (3.0 * (1.0 - poisson_ratio * poisson_ratio)),
            speed,
        }
    }

    /// T = (m_eff / K)^(2/5) v^(-1/5) (s).
    pub fn time_scale(&self) -> f64 {
        time_scale(self.effective_mass, self.stiffness, self.speed)
    }

    /// The impact that ends like the release of such a pair at rest from an overlap (m): that is
    /// where it is deepest.
    pub fn from_overlap(self, overlap: f64) -> Self {
        let speed_squared = 0.8 * self.stiffness * overlap * overlap * overlap.sqrt();
        Self {
            speed: (speed_squared / self.effective_mass).sqrt(),
            ..self
        }
    }

    /// Duration of the contact, 3.218065460 T (s).
    pub fn contact_time(&self) -> f64 {
        3.218_065_460 * self.time_scale()
    }

    /// Deepest overlap, (5/4)^(2/5) v T (m).
    pub fn deepest_overlap(&self) -> f64 {
        libm::pow(1.25, 0.4) * self.speed * self.time_scale()
    }

    /// Largest force (N).
    pub fn largest_force(&self) -> f64 {
        let overlap = self.deepest_overlap();
        self.stiffness * overlap * overlap.sqrt()
    }

    /// Angular frequency w (1/s) of the linearised contact at its deepest overlap, where it is
    /// stiffest: w^2 = (3/2) K sqrt(xi) / m_eff, so that 2/w = contact time / 2.015.
    pub fn angular_frequency(&self) -> f64 {
        (1.5 * self.stiffness * self.deepest_overlap().sqrt() / self.effective_mass).sqrt()
    }
}

/// Rayleigh time (s): a surface wave's way around half a sphere of that radius (m),
/// pi r sqrt(rho / G) / (0.1631 nu + 0.8766) with the shear modulus G = Y / (2 (1 + nu))
/// (Thornton and Randall, 1988; Ning and Ghadiri, 2006).
pub fn rayleigh_time(radius: f64, density: f64, young_modulus: f64, poisson_ratio: f64) -> f64 {
    let shear_modulus = young_modulus / (2.0 * (1.0 + poisson_ratio));
    PI * radius * (density / shear_modulus).sqrt() / (0.1631 * poisson_ratio + 0.8766)
}

/// Dissipation time A (s) of the scene's contact law: as given, or the one that gives a pair of
/// mean spheres the scene's restitution. Zero without a contact law.
pub fn dissipation_time(scene: &Scene) -> f64 {
    let Some(Contact::Hertz {
        young_modulus,
        poisson_ratio,
        dissipation_time,
        restitution,
        restitution_speed,
        dissipation_factor,
    }) = scene.dem.contact
    else {
        return 0.0;
    };
    match (dissipation_time, restitution) {
        (Some(time), _) => time,
        (None, None) => 0.0,
        (None, Some(restitution)) => {
            let impact = Impact::of_equal_spheres(
                scene.spheres.radius.mean(),
                scene.spheres.density,
                young_modulus,
                poisson_ratio,
                restitution_speed,
            );
            dissipation_time_from_restitution(restitution, impact.time_scale(), dissipation_factor)
        }
    }
}

/// The impact of the two smallest spheres at the fastest speed, or from the deepest overlap at the
/// start. A wall or a larger partner is softer: w^2 falls with the effective mass faster than it
/// grows with the effective radius.
pub(super) fn stiffest_impact(scene: &Scene) -> Option<Impact> {
    let Contact::Hertz {
        young_modulus,
        poisson_ratio,
        ..
    } = scene.dem.contact.as_ref()?
    else {
        return None;
    };
    let impact = Impact::of_equal_spheres(
        scene.smallest_radius(),
        scene.spheres.density,
        *young_modulus,
        *poisson_ratio,
        super::fastest_impact(scene),
    );
    let release = impact.from_overlap(deepest_at_start(scene));
    let fastest = if release.speed > impact.speed {
        release
    } else {
        impact
    };
    (fastest.speed > 0.0).then_some(fastest)
}

/// Limits of the contact and of the friction at it; none without a Hertz contact.
pub(super) fn limits(scene: &Scene) -> Vec<Limit> {
    let (
        Some(impact),
        Some(Contact::Hertz {
            young_modulus,
            poisson_ratio,
            dissipation_factor,
            ..
        }),
    ) = (stiffest_impact(scene), &scene.dem.contact)
    else {
        return Vec::new();
    };
    let radius = scene.smallest_radius();
    let scheme = scheme_of(scene);
    let frequency = impact.angular_frequency();
    // The law's damping at overlap xi: g = K c A sqrt(xi) / m_eff.
    let rate = 2.0 / 3.0 * dissipation_factor * dissipation_time(scene) * frequency * frequency;
    let mut limits = vec![
        Limit {
            name: "contact",
            seconds: 2.0 / frequency,
            decisive: true,
            explanation: "2/w of the two smallest spheres at their deepest overlap, at the start or in \
                          the fastest impact, w^2 = (3/2) K sqrt(xi) / m_eff",
        },
        super::twelve_contacts(scheme, frequency, rate),
        Limit {
            name: "Rayleigh time",
            seconds: rayleigh_time(
                radius,
                scene.spheres.density,
                *young_modulus,
                *poisson_ratio,
            ),
            decisive: false,
            explanation: "pi r sqrt(rho/G) / (0.1631 nu + 0.8766) of the smallest sphere; a \
                          fifth of it is customary",
        },
        super::displacement(scene, impact.speed),
    ];
    if rate > 0.0 {
        limits.push(Limit {
            name: "damped contact",
            seconds: scheme.oscillator(frequency, rate),
            decisive: true,
            explanation: "(w dt)^2 + 2 q g dt < 4 with the w of the contact limit and the damping rate \
                          g = (2/3) c A w^2; q = 2 for synchronised-verlet, else 1",
        });
    }
    limits.extend(friction_limit(scene, &impact, *poisson_ratio));
    limits
}

fn friction_limit(scene: &Scene, impact: &Impact, poisson_ratio: f64) -> Option<Limit> {
    match scene.dem.friction.as_ref()? {
        // Its stability does not depend on the step: see the range of its coefficient.
        Friction::Spin { .. } => None,
        // Go with other contacts.
        Friction::CundallStrack { .. } | Friction::Silbert { .. } => None,
        // The surfaces of two equal spheres move like a mass m_eff / (1 + 5/2).
        Friction::Coulomb {
            coefficient,
            regularisation,
        } => Some(Limit {
            name: "regularised friction",
            seconds: scheme_of(scene).oscillator(
                0.0,
                3.5 * coefficient * impact.largest_force()
                    / (regularisation * impact.effective_mass),
            ),
            decisive: false,
            explanation: "2 u_0 m_eff / (3.5 q mu F) at the largest force; above it sliding that \
                          should stop changes sign from step to step; q = 2 for synchronised-verlet, \
                          else 1",
        }),
        Friction::Mindlin { .. } => {
            let stiffness_ratio = 2.0 * (1.0 - poisson_ratio) / (2.0 - poisson_ratio);
            Some(Limit {
                name: "sticking contact",
                seconds: scheme_of(scene).oscillator(
                    (3.5 * stiffness_ratio).sqrt() * impact.angular_frequency(),
                    0.0,
                ),
                decisive: true,
                explanation: "2/w of the tangential spring, w^2 = 3.5 k_t / m_eff with \
                              k_t / k_n = 2 (1 - nu) / (2 - nu)",
            })
        }
    }
}
