//! The spheres, and the mass of one.

use super::{Radii, is_default};
use crate::document::quantity;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The spheres: how many, how large, how heavy.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Spheres {
    /// Number of spheres, n.
    #[schemars(transform = quantity("n", "", "number of spheres").at_least(1))]
    pub count: usize,
    /// Radius r (m): one value, a list of `{ radius, share }`, or `{ file = "radii.txt" }`.
    #[schemars(transform = quantity("r", "m", "radius of the spheres"))]
    pub radius: Radii,
    /// Density rho: for spheres of the solid (kg/m3), for discs in kg/m2.
    #[schemars(
        transform = quantity("ρ", "kg/m³", "density of the spheres")
            .at_least(1e-9)
            .at_most(1e15)
            .unit_where("shape", "disc", "kg/m²")
    )]
    pub density: f64,
    /// Shape of the spheres.
    #[serde(default, skip_serializing_if = "is_default")]
    pub shape: Shape,
}

/// Shape of the spheres, from which their mass follows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Shape {
    /// A sphere in space, of mass 4/3 pi rho r^3.
    #[default]
    Sphere,
    /// A disc in the plane y = 0, of mass m = rho r^2 (Remmers, 2009) and moment of inertia m r^2 /
    /// 2.
    Disc,
}

impl Shape {
    /// Mass (kg) of a sphere of this density and radius (m).
    pub fn mass(self, density: f64, radius: f64) -> f64 {
        match self {
            Self::Sphere => density * (4.0 / 3.0 * std::f64::consts::PI * radius * radius * radius),
            Self::Disc => density * radius * radius,
        }
    }

    /// Moment of inertia about the centre, over mass times squared radius.
    pub fn inertia_factor(self) -> f64 {
        match self {
            Self::Sphere => 0.4,
            Self::Disc => 0.5,
        }
    }
}
