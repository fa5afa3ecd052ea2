//! What the contacts of elastic solids share: material, impacts, Rayleigh time.

use super::Impact;
use crate::forces::limit::{Limit, Regime};
use std::f64::consts::PI;

/// The keys of a contact law whose elastic force is Hertz's, between like spheres and walls of
/// their material.
pub(crate) trait ElasticSolid {
    /// Young's modulus Y (Pa).
    fn young_modulus(&self) -> f64;

    /// Poisson's ratio nu.
    fn poisson_ratio(&self) -> f64;

    /// The elastic impact of two spheres of one radius (m) and mass (kg) at a relative speed (m/s).
    fn impact(&self, radius: f64, mass: f64, speed: f64) -> Impact {
        let (young_modulus, poisson_ratio) = (self.young_modulus(), self.poisson_ratio());
        Impact::of_equal_spheres(radius, mass, young_modulus, poisson_ratio, speed)
    }

    /// The impact of the two smallest spheres at the fastest speed, or from the deepest overlap at
    /// the start; `None` if nothing moves. A wall or a larger partner is softer: w^2 falls with the
    /// effective mass faster than it grows with the effective radius.
    fn stiffest_impact(&self, regime: &Regime<'_>) -> Option<Impact> {
        let (radius, mass) = (regime.smallest_radius, regime.smallest_mass);
        let impact = self.impact(radius, mass, regime.fastest_impact);
        let fastest = impact.or_release_from(*regime.deepest_at_start);
        (fastest.speed > 0.0).then_some(fastest)
    }

    /// The customary limit of the time step by the Rayleigh time of the smallest sphere.
    fn rayleigh_limit(&self, regime: &Regime<'_>) -> Limit {
        let (young_modulus, poisson_ratio) = (self.young_modulus(), self.poisson_ratio());
        let (radius, density) = (regime.smallest_radius, regime.density);
        Limit {
            name: "Rayleigh time",
            seconds: rayleigh_time(radius, density, young_modulus, poisson_ratio),
            decisive: false,
            explanation: "pi r sqrt(rho/G) / (0.1631 nu + 0.8766) of the smallest sphere; a \
                          fifth of it is customary",
            consequence: None,
        }
    }
}

/// Rayleigh time (s): the time of a surface wave around half a sphere of this radius (m), pi r
/// sqrt(rho / G) / (0.1631 nu + 0.8766) with the shear modulus G = Y / (2 (1 + nu)) (Thornton and
/// Randall, 1988; Ning and Ghadiri, 2006).
pub fn rayleigh_time(radius: f64, density: f64, young_modulus: f64, poisson_ratio: f64) -> f64 {
    let shear_modulus = young_modulus / (2.0 * (1.0 + poisson_ratio));
    PI * radius * (density / shear_modulus).sqrt() / (0.1631 * poisson_ratio + 0.8766)
}
