//! Materials of the families, one type for each contact law.

use crate::dem::timestep::{Impact, LinearImpact};
use crate::scene::{Contact, Hertz, Hooke, Shape, Silbert, Tsuji};
use serde::Deserialize;

/// The material of spheres and walls.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Young's modulus Y (Pa).
    pub young_modulus: f64,
    /// Poisson's ratio nu.
    pub poisson_ratio: f64,
    /// Density (kg/m3).
    pub density: f64,
    /// Dissipation time A (s).
    #[serde(default)]
    pub dissipation_time: f64,
    /// Factor c of the dissipative term.
    #[serde(default = "one")]
    pub dissipation_factor: f64,
}

pub(super) fn one() -> f64 {
    1.0
}

impl Material {
    /// Mass of a sphere of this radius (kg).
    pub(super) fn mass(&self, radius: f64) -> f64 {
        Shape::Sphere.mass(self.density, radius)
    }

    /// An elastic head-on impact of an effective radius (m) and mass (kg) at a relative speed
    /// (m/s).
    pub(super) fn impact(&self, radius: f64, mass: f64, speed: f64) -> Impact {
        Impact {
            effective_mass: mass,
            stiffness: self.stiffness(radius),
            speed,
        }
    }

    /// K = 2 Y sqrt(R_eff) / (3 (1 - nu^2)) (N/m^1.5) of an effective radius.
    fn stiffness(&self, effective_radius: f64) -> f64 {
        2.0 * self.young_modulus * effective_radius.sqrt()
            / (3.0 * (1.0 - self.poisson_ratio * self.poisson_ratio))
    }

    /// The contact law.
    pub(super) fn contact(&self) -> Contact {
        Contact::Hertz(Hertz {
            young_modulus: self.young_modulus,
            poisson_ratio: self.poisson_ratio,
            dissipation_time: Some(self.dissipation_time),
            restitution: None,
            restitution_speed: 1.0,
            dissipation_factor: self.dissipation_factor,
        })
    }
}

/// A material of Silbert et al.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SilbertMaterial {
    /// Stiffness k_n (Pa).
    pub stiffness: f64,
    /// Damping gamma_n (1/(m s)).
    pub damping: f64,
    /// Density (kg/m3).
    pub density: f64,
}

impl SilbertMaterial {
    /// The contact law.
    fn contact(&self) -> Contact {
        Contact::Silbert(Silbert {
            stiffness: self.stiffness,
            damping: self.damping,
        })
    }
}

/// A material whose impacts all have the same restitution.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TsujiMaterial {
    /// Young's modulus Y (Pa).
    pub young_modulus: f64,
    /// Poisson's ratio nu.
    pub poisson_ratio: f64,
    /// Restitution e.
    pub restitution: f64,
    /// Density (kg/m3).
    pub density: f64,
}

impl TsujiMaterial {
    /// The same without losses.
    fn elastic(&self) -> Material {
        Material {
            young_modulus: self.young_modulus,
            poisson_ratio: self.poisson_ratio,
            density: self.density,
            dissipation_time: 0.0,
            dissipation_factor: 1.0,
        }
    }

    /// The contact law.
    fn contact(&self) -> Contact {
        Contact::Tsuji(Tsuji {
            young_modulus: self.young_modulus,
            poisson_ratio: self.poisson_ratio,
            restitution: self.restitution,
        })
    }
}

/// A material of Silbert et al. with linear springs.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HookeMaterial {
    /// Spring constant k_n (N/m).
    pub stiffness: f64,
    /// Damping rate gamma_n (1/s).
    pub damping_rate: f64,
    /// Density (kg/m3).
    pub density: f64,
}

impl HookeMaterial {
    /// The contact law.
    fn contact(&self) -> Contact {
        Contact::Hooke(Hooke {
            stiffness: self.stiffness,
            damping_rate: self.damping_rate,
        })
    }
}

/// A material of any of these laws, for set-ups that accept all.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(untagged)]
pub enum AnyMaterial {
    /// For the Hertz contact.
    Hertz(Material),
    /// For the Hertz contact of Tsuji et al.
    Tsuji(TsujiMaterial),
    /// For the Hertz contact of Silbert et al.
    Silbert(SilbertMaterial),
    /// For the linear contact of Silbert et al.
    Hooke(HookeMaterial),
}

/// The elastic part of a contact.
enum ElasticContact {
    /// K (N/m^1.5) of F = K xi^1.5.
    Hertzian(f64),
    /// k (N/m) of F = k xi.
    Linear(f64),
}

impl AnyMaterial {
    /// Density (kg/m3).
    pub(super) fn density(&self) -> f64 {
        match self {
            Self::Hertz(material) => material.density,
            Self::Tsuji(material) => material.density,
            Self::Silbert(material) => material.density,
            Self::Hooke(material) => material.density,
        }
    }

    /// Mass of a sphere of this radius (kg).
    pub(super) fn mass(&self, radius: f64) -> f64 {
        Shape::Sphere.mass(self.density(), radius)
    }

    /// The elastic part of a contact with an effective radius (m).
    fn elastic_contact(&self, effective_radius: f64) -> ElasticContact {
        use ElasticContact::{Hertzian, Linear};
        match self {
            Self::Hertz(material) => Hertzian(material.stiffness(effective_radius)),
            Self::Tsuji(material) => Hertzian(material.elastic().stiffness(effective_radius)),
            Self::Silbert(material) => Hertzian(material.stiffness * effective_radius.sqrt()),
            Self::Hooke(material) => Linear(material.stiffness),
        }
    }

    /// Overlap at which the elastic force of an effective radius is `force` (m).
    pub(super) fn overlap(&self, effective_radius: f64, force: f64) -> f64 {
        match self.elastic_contact(effective_radius) {
            ElasticContact::Hertzian(stiffness) => libm::pow(force / stiffness, 2.0 / 3.0),
            ElasticContact::Linear(stiffness) => force / stiffness,
        }
    }

    /// Duration (s) of a head-on impact without losses, of an effective radius (m) and mass (kg) at
    /// a relative speed (m/s).
    pub(super) fn elastic_time(&self, radius: f64, effective_mass: f64, speed: f64) -> f64 {
        match self.elastic_contact(radius) {
            ElasticContact::Hertzian(stiffness) => Impact {
                effective_mass,
                stiffness,
                speed,
            }
            .contact_time(),
            ElasticContact::Linear(stiffness) => LinearImpact {
                effective_mass,
                stiffness,
                damping: 0.0,
            }
            .contact_time(),
        }
    }

    /// The contact law.
    pub(super) fn contact(&self) -> Contact {
        match self {
            Self::Hertz(material) => material.contact(),
            Self::Tsuji(material) => material.contact(),
            Self::Silbert(material) => material.contact(),
            Self::Hooke(material) => material.contact(),
        }
    }
}
